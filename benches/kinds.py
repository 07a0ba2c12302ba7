"""Kinds of event by the thousand: an ensemble of different trucks against crossings in a loop.

Run it with `python benches/kinds.py [kinds]`, the package installed. Every truck crosses once; of
the loop some hundred crossings are timed, before and after the ensemble, on one thread as it is.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

import spanwise as sw

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
ROAD = sw.ISO8608("B", period=128.0)
GIVEN: dict[str, Any] = {
    "speed": 22.86,
    "modes": 3,
    "damping": 0.02,
    "tail": 0.0,
    "approach": 30.0,
    "ramp": 10.0,
}
ADVANCE = 0.02286


def trucks(count: int) -> list[sw.Vehicle]:
    """Two axles, no two trucks alike."""
    random = np.random.default_rng(1)
    axle = {"suspension_damping": 1e4, "friction_limit": 5e3}
    return [
        sw.Vehicle(
            bodies=[
                sw.Body(
                    mass=mass,
                    pitch_inertia=5.0 * mass,
                    axles=[
                        sw.Axle(
                            position=0.5 * base, tyre_stiffness=3e6, suspension_stiffness=k, **axle
                        ),
                        sw.Axle(
                            position=-0.5 * base, tyre_stiffness=6e6, suspension_stiffness=k, **axle
                        ),
                    ],
                )
            ]
        )
        for mass, base, k in zip(
            random.uniform(8e3, 3e4, count),
            random.uniform(3.0, 6.0, count),
            random.uniform(8e5, 3e6, count),
            strict=True,
        )
    ]


def main(count: int) -> None:
    """Prints microseconds a crossing, and the ratio of the two."""
    kinds = trucks(count)

    def loop(some: list[sw.Vehicle]) -> float:
        started = time.perf_counter()
        for i, each in enumerate(some):
            road = sw.ISO8608("B", period=128.0, seed=0, sample=i)
            sw.cross(BRIDGE, each, road=road, step=ADVANCE / GIVEN["speed"], **GIVEN)
        return (time.perf_counter() - started) / len(some)

    loop(kinds[:20])
    for threads in (1, 2):
        before = loop(kinds[:200])
        started = time.perf_counter()
        found = sw.ensemble(
            BRIDGE,
            kinds,
            samples=count,
            kind=range(count),
            road=ROAD,
            advance=ADVANCE,
            threads=threads,
            **GIVEN,
        )
        each = (time.perf_counter() - started) / count
        crossed = 0.5 * (before + loop(kinds[:200]))
        assert not found.failures
        print(
            f"{count} kinds, {threads} threads: {1e6 * each:.0f} us a crossing, "
            f"{1e6 * crossed:.0f} us by cross in a loop: ratio {each / crossed:.2f}"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5000)
