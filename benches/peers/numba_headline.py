"""Random crossings of the 1973 bridge as careful Numba loops, the peers of `sw.ensemble`.

There are two, one crossing for each iteration of `prange` (`numba_single`) and eight, vectorised by
hand (`numba_lanes`). First their answers are held against `sw.cross` and `sw.ensemble`, then all
take turns. Both are handed their roads ready made, whereas the engine draws its own.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any

import numba
import numpy as np
from headline_common import (
    ADVANCE,
    APPROACH,
    BRIDGE,
    KINDS,
    MODES,
    PERIOD,
    RAMP,
    ROADS,
    SECTIONS,
    SEED,
    SPEED,
    THREADS,
    TRUCK,
    Array,
    Peer,
    road,
    tables,
)
from numba_lanes import LANES, Lanes
from numba_single import Single

import spanwise as sw

#: How often all take turns.
ROUNDS = 9

#: Largest deviation that fast arithmetic excuses, by the largest of a kind.
AGREED = 1e-9

# ---- Agreement. ----


def deviation(values: Array, others: Array) -> float:
    """Largest difference by the largest of the kind."""
    return float(np.abs(values - others).max() / np.abs(others).max())


def envelopes(found: Array, loads: Array) -> dict[str, Array]:
    """By kind largest, its step, smallest, its step; both sides of shear together."""
    by_kind = {kind: found[:, where] for kind, where in KINDS.items()} | {"axle_loads": loads}
    left, right = by_kind["shear"][:, :25], by_kind["shear"][:, 25:]
    most = np.where(left[0] >= right[0], left[:2], right[:2])
    least = np.where(left[2] <= right[2], left[2:], right[2:])
    return by_kind | {"shear": np.concatenate([most, least])}


def against_crossings(peer: Peer, numbers: tuple[int, ...]) -> tuple[float, float]:
    """Deviation from `sw.cross`: of extremes, and of the steps at which they occur."""
    worst, apart = 0.0, 0.0
    for number in numbers:
        run = sw.cross(
            BRIDGE,
            TRUCK,
            speed=SPEED,
            modes=MODES,
            damping=0.0,
            drive="constant-speed",
            approach=APPROACH,
            ramp=RAMP,
            tail=0.0,
            road=road(number % ROADS),
            step=peer.tables.h * (1.0 + 1e-12),
            sections=SECTIONS.tolist(),
        )
        assert len(run.time) == peer.tables.steps + 1
        for kind, found in envelopes(peer.found[number], peer.loads[number]).items():
            envelope = run.envelope(kind)  # type: ignore[arg-type]
            values = np.concatenate([envelope.max.value, envelope.min.value])
            times = np.concatenate([envelope.max.time, envelope.min.time])
            worst = max(worst, deviation(np.concatenate([found[0], found[2]]), values))
            steps = np.concatenate([found[1], found[3]])
            apart = max(apart, float(np.abs(steps - times / peer.tables.h).max()))
    return worst, apart


def against_ensemble(peer: Peer, ensemble: Any) -> float:
    """Deviation from the first samples of `sw.ensemble`."""
    worst = 0.0
    for number in range(min(ROADS, len(peer.found))):
        for kind, found in envelopes(peer.found[number], peer.loads[number]).items():
            extremes = getattr(ensemble, kind, None)
            if extremes is not None:
                worst = max(worst, deviation(found[0], np.asarray(extremes.max)[number]))
                worst = max(worst, deviation(found[2], np.asarray(extremes.min)[number]))
    return worst


# ---- Timing. ----


def timed(runs: Sequence[Callable[[], object]]) -> list[list[float]]:
    """Times [s] of runs that take turns, so that a busy machine treats them alike."""
    times: list[list[float]] = [[] for _ in runs]
    for _ in range(ROUNDS):
        for run, own in zip(runs, times, strict=True):
            started = time.perf_counter()
            run()
            own.append(time.perf_counter() - started)
    return times


def rate(samples: int, times: list[float]) -> str:
    """Crossings per second."""
    return f"{samples / statistics.median(times):.0f} crossings/s"


def engine(samples: int) -> Any:
    """The same crossings by the engine, on the roads of the pool and those that follow."""
    return sw.ensemble(
        BRIDGE,
        TRUCK,
        samples=samples,
        seed=SEED,
        road=sw.ISO8608("B", period=PERIOD),
        speed=SPEED,
        modes=MODES,
        damping=0.0,
        approach=APPROACH,
        ramp=RAMP,
        advance=ADVANCE,
        tail=0.0,
        sections=SECTIONS.tolist(),
        threads=THREADS,
    )


def main() -> None:
    """Checks, then times."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=4000, help="crossings, a multiple of lanes")
    samples = int(parser.parse_args().samples)
    if samples < ROADS or samples % LANES:
        parser.error(f"--samples {samples}: must be a multiple of {LANES}, at least {ROADS}")
    started = time.perf_counter()
    shared = tables()
    lanes = Lanes(shared, samples)
    peers: list[Peer] = [Single(shared, samples), lanes]
    print(f"tables and {ROADS} roads: {time.perf_counter() - started:.1f} s")

    ensemble = engine(samples)
    for peer in peers:
        started = time.perf_counter()
        peer.run()
        print(f"numba, {peer.name}: compiled in {time.perf_counter() - started:.1f} s")
        worst, apart = against_crossings(peer, (0, 1, 2, 21, 42, samples - 1))
        print(f"  against sw.cross: extremes to {worst:.1e} of the largest, steps to {apart:.1e}")
        assert worst < AGREED
        worst = against_ensemble(peer, ensemble)
        print(f"  against sw.ensemble: extremes to {worst:.1e} of the largest")
        assert worst < AGREED

    numba.set_num_threads(1)
    alone = timed([peer.run for peer in peers])
    for peer, times in zip(peers, alone, strict=True):
        print(f"numba, {peer.name}, one thread: {rate(samples, times)}")
    stepping, recovery = lanes.operations()
    gigaflops = (stepping + recovery) * samples / statistics.median(alone[-1]) / 1e9
    print(f"  {stepping} + {recovery} floating operations each: {gigaflops:.1f} GFLOP/s")
    numba.set_num_threads(THREADS)

    print(f"threads: {THREADS}; {samples} crossings, {ROUNDS} rounds in turns, medians; ", end="")
    print("roads are handed to Numba ready made, spanwise draws them")
    ours, *theirs = timed([lambda: engine(samples), *(peer.run for peer in peers)])
    print(f"spanwise: {rate(samples, ours)}")
    for peer, times in zip(peers, theirs, strict=True):
        ratio = statistics.median(times) / statistics.median(ours)
        by_round = [own / our for own, our in zip(times, ours, strict=True)]
        print(
            f"numba, {peer.name}: {rate(samples, times)}; spanwise is {ratio:.2f} times as fast "
            f"({min(by_round):.2f} to {max(by_round):.2f} by round)"
        )


if __name__ == "__main__":
    main()
