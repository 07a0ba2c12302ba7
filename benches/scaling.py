"""Cost per crossing of `sw.ensemble` against modes, sections, axles, samples and threads.

Run it with ``python benches/scaling.py FIGURE.png``: prints a table and draws it. All else is the
headline case; the sweep over modes has more masses on the bridge, which carries no more modes than
masses.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import spanwise as sw

LENGTH = 36.576
WHEELBASE = 4.2672

#: Runs of each case; the fastest counts, as it was disturbed least.
REPEATS = 3

#: From this many crossings on a case runs once: it averages over its own length.
LONG = 50_000


@dataclass(frozen=True)
class Case:
    """What differs from case to case."""

    modes: int = 3
    sections: int = 25
    axles: int = 2
    samples: int = 2000
    threads: int = 1
    masses: int = 3

    def arguments(self) -> tuple[sw.Bridge, sw.Vehicle, dict[str, Any]]:
        """What the ensemble is asked for."""
        bridge = sw.Bridge(
            spans=[LENGTH / 2] * 2,
            EI=1941464053.44,
            mass=6037.70066,
            stations_per_span=self.masses,
        )
        places = np.linspace(0.0, LENGTH, self.sections) if self.sections > 1 else [0.4 * LENGTH]
        options = {
            "samples": self.samples,
            "seed": 7,
            "road": sw.ISO8608("B", period=128.0),
            "speed": 22.86,
            "modes": self.modes,
            "damping": 0.0,
            "approach": 30,
            "ramp": 10,
            "advance": 0.02286,
            "tail": 0.0,
            "sections": places,
            "threads": self.threads,
        }
        return bridge, plain(self.axles), options


def plain(axles: int) -> sw.Vehicle:
    """One body on equal axles, as long and as heavy whatever their number: that of 1973 for two."""
    tyre, suspension, friction = (2 * total / axles for total in (7.005e6, 3.940e6, 21351.5))
    return sw.Vehicle(
        mass=29066.2,
        pitch_inertia=52199.0,
        cg_height=1.8288,
        axles=[
            sw.Axle(
                position=float(x),
                tyre_stiffness=tyre,
                suspension_stiffness=suspension,
                friction_limit=friction,
            )
            for x in np.linspace(0.5, -0.5, axles) * WHEELBASE
        ],
    )


def sweeps(most: int, threads: int) -> Iterator[tuple[str, list[Case]]]:
    """What is varied, and the cases."""
    base = Case()
    yield "modes", [replace(base, modes=n, masses=12) for n in (1, 2, 3, 5, 10, 15, 20)]
    yield "sections", [replace(base, sections=n) for n in (1, 5, 25, 50, 100, 200)]
    yield "axles", [replace(base, axles=n) for n in (2, 3, 4, 5)]
    counts = [10**n for n in range(2, 7) if 10**n <= most]
    yield "samples", [replace(base, samples=n) for n in counts]
    yield "threads", [replace(base, threads=n) for n in range(1, threads + 1)]


def seconds(ensemble: Callable[..., object], case: Case) -> float:
    """Time per crossing, all that the call does included."""
    bridge, vehicle, options = case.arguments()
    times = []
    for _ in range(REPEATS if case.samples < LONG else 1):
        started = time.perf_counter()
        ensemble(bridge, vehicle, **options)
        times.append(time.perf_counter() - started)
    return min(times) / case.samples


def draw(results: dict[str, list[tuple[int, float]]], path: Path) -> None:
    """One panel for each thing varied."""
    figure = Figure(figsize=(3 * len(results), 2.8), layout="constrained")
    for panel, (name, points) in zip(
        figure.subplots(1, len(results), squeeze=False).flat, results.items(), strict=True
    ):
        sizes, costs = zip(*points, strict=True)
        panel.plot(sizes, [1e6 * cost for cost in costs], "o-", ms=4)
        panel.set_xlabel(name)
        panel.set_ylim(0.0, 1.1e6 * max(costs))
        if name == "samples":
            panel.set_xscale("log")
        else:
            panel.xaxis.get_major_locator().set_params(integer=True)
        panel.grid(alpha=0.3)
    figure.axes[0].set_ylabel("time per crossing [µs]")
    figure.savefig(path, dpi=130)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figure", type=Path, help="where the figure goes (.png, .svg, .pdf)")
    parser.add_argument("--most", type=int, default=10**6, help="most samples (default: 10^6)")
    parser.add_argument(
        "--threads", type=int, default=min(2, os.cpu_count() or 1), help="most threads"
    )
    arguments = parser.parse_args()
    ensemble = getattr(sw, "ensemble", None)
    if ensemble is None:
        sys.exit("this build of spanwise has no sw.ensemble, which is what is measured here")
    results: dict[str, list[tuple[int, float]]] = {}
    headline = seconds(ensemble, Case())
    print("| varied | value | µs per crossing | crossings/s | to the headline case |")
    print("| --- | ---: | ---: | ---: | ---: |")
    for name, cases in sweeps(arguments.most, arguments.threads):
        for case in cases:
            value, cost = getattr(case, name), seconds(ensemble, case)
            results.setdefault(name, []).append((value, cost))
            row = (name, f"{value:,}", f"{1e6 * cost:.1f}", f"{1 / cost:,.0f}")
            print(f"| {' | '.join(row)} | {cost / headline:.2f} |", flush=True)
    arguments.figure.parent.mkdir(parents=True, exist_ok=True)
    draw(results, arguments.figure)


if __name__ == "__main__":
    main()
