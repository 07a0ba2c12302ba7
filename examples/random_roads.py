"""Impact factors of a truck on random roads, class by class: percentiles, and a figure of them.

Run it with ``python examples/random_roads.py``; the figure goes to ``examples/figures``.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import spanwise as sw
from spanwise.plotting.figure import Figure

CLASSES = "ABCD"
PERCENTILES = (5, 50, 95, 99)

#: Midspan of the bridge [m].
MIDSPAN = 12.5


def factors_by_class(samples: int) -> dict[str, np.ndarray[tuple[int, ...], np.dtype[np.float64]]]:
    """Impact factors of the moment at midspan, on roads and at speeds of each sample's own."""
    bridge = sw.Bridge(spans=[2 * MIDSPAN], EI=1.2e10, mass=9e3)  # m, N m2, kg/m
    chance = np.random.default_rng(1)
    speeds = chance.uniform(15.0, 25.0, samples)  # m/s
    loads = chance.uniform(0.7, 1.1, samples)
    return {
        road_class: sw.ensemble(
            bridge,
            sw.vehicles.hs20_44(),
            samples=samples,
            seed=1,
            speed=speeds,
            road=sw.ISO8608(road_class),
            factors={"body_mass": loads},
            modes=3,
            damping=0.02,
            sections=[MIDSPAN],
            quantities=["moment"],
        ).impact_factors.sagging[:, 0]
        for road_class in CLASSES
    }


def figure_of(
    factors: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.float64]]],
) -> Figure:
    """How many samples exceed a factor, by class."""
    figure = Figure(figsize=(6.3, 3.2), layout="constrained")
    ax = figure.subplots()
    for (road_class, values), style in zip(factors.items(), ("-", "--", "-.", ":"), strict=True):
        exceeding = 1.0 - np.arange(len(values)) / len(values)
        ax.semilogy(np.sort(values), exceeding, style, label=f"class {road_class}")
    ax.set_xlabel("Impact factor of the moment at midspan [-]")
    ax.set_ylabel("Part of the samples beyond [-]")
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False)
    return figure


def main(arguments: Sequence[str] | None = None) -> None:
    """Print percentiles and draw the figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=2000, help="roads by class (default: 2000)")
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "figures")
    options = parser.parse_args(arguments)
    factors = factors_by_class(options.samples)
    columns = "".join(f"{f'{p} %':>8}" for p in PERCENTILES)
    print(f"moment at midspan, dynamic over static [-]\nclass    mean{columns}     max")
    for road_class, values in factors.items():
        row = (values.mean(), *np.percentile(values, PERCENTILES), values.max())
        print(f"{road_class:5}" + "".join(f"{each:8.3f}" for each in row))
    options.out.mkdir(parents=True, exist_ok=True)
    figure_of(factors).savefig(options.out / "random_roads.png", dpi=150)


if __name__ == "__main__":
    main()
