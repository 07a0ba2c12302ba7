"""What the default step takes from the extremes: against steps an eighth as long.

The catalogue on bridges of 6 to 280 m over roads of several classes at three speeds; prints the
table of docs/theory.md, "Time step". Takes some minutes: ``python benches/accuracy.py``.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from typing import Any, Final, TypeAlias

import numpy as np

import spanwise as sw
from spanwise.roads import Road

Mover: TypeAlias = sw.Vehicle | sw.ForceTrain | sw.MovingMasses

FINER: Final = 8
SPEEDS: Final = (10.0, 22.0, 40.0)

#: Bridges with their number of modes.
BRIDGES: Final = (
    (sw.Bridge(spans=[6.0], EI=6e8, mass=6e3, stations_per_span=5), 2),
    (sw.Bridge(spans=[12.0], EI=3e9, mass=8e3, stations_per_span=9), 4),
    (sw.Bridge(spans=[18.288] * 2, EI=1.941464e9, mass=6037.7, stations_per_span=3), 3),
    (sw.Bridge(spans=[25.0], EI=8.4e9, mass=9e3, stations_per_span=11), 3),
    (sw.Bridge(spans=[40.0], ends=("clamped", "clamped"), EI=2e10, mass=1e4), 4),
    (sw.Bridge(spans=[30.0, 40.0, 30.0], EI=3.5e10, mass=9e3, stations_per_span=6), 6),
    (sw.Bridge(spans=[80.0, 120.0, 80.0], EI=6e11, mass=2e4, stations_per_span=9), 8),
)

VEHICLES: Final[dict[str, Mover]] = {
    "kishan-1973": sw.vehicles.kishan_1973(),
    "quarter-car": sw.vehicles.quarter_car(),
    "half-car": sw.vehicles.half_car(),
    "articulated-5-axle": sw.vehicles.articulated_5_axle(),
    "hs20-44": sw.vehicles.hs20_44(),
    "cl-625 (forces)": sw.vehicles.cl_625(),
    "two masses": sw.MovingMasses(masses=[8e3, 12e3], spacings=[4.0]),
}

ROADS: Final[dict[str, list[Road | None]]] = {
    "smooth": [None],
    "bump": [sw.Bump(at=-2.0, length=length, height=0.03) for length in (0.5, 3.0)],
    **{grade: [sw.ISO8608(grade, seed=seed) for seed in (3, 7)] for grade in "ABCE"},
}

RESPONSES: Final = ("deflection", "moment", "shear", "reactions", "axle_loads")


def extremes(run: sw.Run, name: str) -> np.ndarray:
    """All largest and smallest of a quantity."""
    envelope = run.envelope(name)
    return np.concatenate([envelope.max.value, envelope.min.value], axis=None)


def error(coarse: sw.Run, fine: sw.Run, name: str) -> float:
    """Largest difference, in parts of the largest value of this quantity."""
    found, right = extremes(coarse, name), extremes(fine, name)
    return float(np.abs(found - right).max() / np.abs(right).max())


def errors(vehicle: Mover, roads: list[Road | None]) -> Iterator[tuple[float, float]]:
    """Of responses and axle loads, and of the acceleration of the deck, case by case."""
    for bridge, modes in BRIDGES:
        for speed in SPEEDS:
            for road in roads:
                rough = {} if road is None else {"approach": 40.0, "ramp": 10.0}
                given: dict[str, Any] = {"speed": speed, "modes": modes, "damping": 0.02, **rough}
                coarse = sw.cross(bridge, vehicle, road=road, **given)
                step = float(coarse.time[1]) / FINER
                fine = sw.cross(bridge, vehicle, road=road, step=step, **given)
                most = max(error(coarse, fine, name) for name in RESPONSES)
                yield most, error(coarse, fine, "acceleration")


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--roads", default=",".join(ROADS), help="roads, by comma (default: all)")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    print("| road | vehicle | median | 90 % | largest | acceleration, median |")
    print("| --- | --- | ---: | ---: | ---: | ---: |")
    for road in options.roads.split(","):
        for name, vehicle in VEHICLES.items():
            if isinstance(vehicle, sw.ForceTrain) and road != "smooth":
                continue
            both = np.array([*errors(vehicle, ROADS[road])])
            own = [np.median(both[:, 0]), np.quantile(both[:, 0], 0.9), both[:, 0].max()]
            cells = " | ".join(f"{1e3 * each:.2f}" for each in (*own, np.median(both[:, 1])))
            print(f"| {road} | {name} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
