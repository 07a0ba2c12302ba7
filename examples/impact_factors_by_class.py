"""Impact factors of the moment at midspan by road class: a truck, a simple span, five roads each.

Run it with ``python examples/impact_factors_by_class.py``.
"""

from __future__ import annotations

import numpy as np

import spanwise as sw

CLASSES = "ABCD"
SEEDS = range(5)

#: Midspan of the bridge [m].
MIDSPAN = 12.5


def main() -> None:
    """Print a row for each class: the factor of each road, their mean and the largest."""
    bridge = sw.Bridge(spans=[2 * MIDSPAN], EI=1.2e10, mass=9e3)  # m, N m2, kg/m
    truck = sw.vehicles.hs20_44()
    columns = "".join(f"  seed {seed}" for seed in SEEDS)
    print(f"moment at midspan, dynamic over static [-]\nclass{columns}    mean     max")
    for road_class in CLASSES:
        factors = []
        for seed in SEEDS:
            road = sw.ISO8608(road_class, seed=seed)
            run = sw.cross(
                bridge, truck, speed=20.0, road=road, modes=3, damping=0.02, sections=[MIDSPAN]
            )
            factors.append(float(run.impact_factors.sagging[0]))
        row = "".join(f"{factor:8.3f}" for factor in (*factors, np.mean(factors), max(factors)))
        print(f"{road_class:5}{row}")


if __name__ == "__main__":
    main()
