"""Trains of constant forces: 101 speeds of fifty axles over two spans of 20 m, in one ensemble.

Run it with `python benches/trains.py [axles [speeds]]`, the package installed: six modes, 2 %
damping, 37 sections, all usual quantities.
"""

from __future__ import annotations

import sys
import time

import numpy as np

import spanwise as sw

BRIDGE = sw.Bridge(spans=[20.0, 20.0], EI=6e9, mass=8e3, stations_per_span=9)

#: Runs; the fastest counts, as it was disturbed least.
REPEATS = 3


def main(axles: int, speeds: int) -> None:
    places = [-2.5 * (k % 4) - 18.0 * (k // 4) for k in range(axles)]
    train = sw.ForceTrain(loads=[170e3] * axles, positions=places)
    times = []
    for _ in range(REPEATS):
        started = time.perf_counter()
        many = sw.ensemble(
            BRIDGE,
            train,
            samples=speeds,
            speed=np.linspace(20.0, 100.0, speeds),
            modes=6,
            damping=0.02,
            sections=np.linspace(0.0, 40.0, 37).tolist(),
        )
        times.append(time.perf_counter() - started)
    print(f"{axles} axles, {speeds} speeds: {min(times):.3f} s, hash {many.hash}")


if __name__ == "__main__":
    given = [int(number) for number in sys.argv[1:]]
    main(*given, *(50, 101)[len(given) :])
