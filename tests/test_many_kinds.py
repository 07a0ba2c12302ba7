"""Kinds of event by the thousand: bounded memory, the same results as one by one.

That they take no more work than a loop of crossings is held by `make instructions`.
"""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spanwise as sw

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
GIVEN: dict[str, Any] = {"modes": 3, "damping": 0.02, "tail": 0.0, "advance": 0.05, "approach": 5.0}
ROAD = sw.ISO8608("B", period=128.0)


def truck(number: int) -> sw.Vehicle:
    """One of many, no two alike."""
    x = (number * 0.618034) % 1.0
    axle = {"tyre_stiffness": 3.5e6, "suspension_stiffness": 1e6, "suspension_damping": 1e4}
    return sw.Vehicle(
        bodies=[
            sw.Body(
                mass=15e3 + 15e3 * x,
                pitch_inertia=1e5,
                axles=[
                    sw.Axle(position=2.0 + 0.5 * x, mass=500.0, **axle),
                    sw.Axle(position=-2.0 - x, mass=900.0, **axle),
                ],
            )
        ]
    )


def test_every_kind_is_a_crossing_of_its_own() -> None:
    kinds = [truck(i) for i in range(40)]
    found = sw.ensemble(
        BRIDGE, kinds, samples=40, kind=range(40), speed=20.0, road=ROAD, seed=3, **GIVEN
    )
    assert not found.failures
    for row in (0, 17, 39):
        run = found.run(row)
        # Between instants of the history too, as an axle passes.
        assert (found.envelope("moment").max[row] >= run.moment.max(axis=0)).all()
        assert (found.envelope("reactions").max[row] >= run.reactions.max(axis=0)).all()
        factors = run.impact_factors.sagging
        there = ~np.isnan(factors)
        assert (found.impact_factors.sagging[row][there] == factors[there]).all()
        assert (found.envelope("moment").max_time[row] >= 0.0).all()


def test_kinds_of_several_vehicles() -> None:
    kinds = [
        [sw.Passage(vehicle=truck(i)), sw.Passage(vehicle=truck(i + 1), direction="left", lane=2)]
        for i in range(12)
    ]
    given = {key: value for key, value in GIVEN.items() if key != "advance"}
    found = sw.ensemble(BRIDGE, kinds, samples=12, kind=range(12), speed=20.0, step=2e-3, **given)
    assert not found.failures
    run = sw.cross(BRIDGE, kinds[7], speed=20.0, step=2e-3, **given)
    factors = run.impact_factors.sagging
    there = ~np.isnan(factors)
    assert (found.impact_factors.sagging[7][there] == factors[there]).all()


def test_speeds_that_kinds_bring_are_told() -> None:
    kinds = [sw.Passage(vehicle=truck(i), speed=15.0 + i) if i % 2 else truck(i) for i in range(6)]
    events = [
        [each] if isinstance(each, sw.Passage) else [sw.Passage(vehicle=each)] for each in kinds
    ]
    order = [5, 0, 1, 4, 3, 2]
    found = sw.ensemble(BRIDGE, events, samples=6, kind=order, speed=12.0, **GIVEN)
    np.testing.assert_array_equal(found.speed, [20.0, 12.0, 16.0, 12.0, 18.0, 12.0])


@pytest.mark.parametrize("advance", [0.05, None])
def test_a_sample_that_is_too_slow_is_marked(advance: float | None) -> None:
    who: Any = truck(0) if advance else sw.Passage(vehicle=truck(0), direction="left")
    given = {**GIVEN, "advance": advance}
    found = sw.ensemble(BRIDGE, who, samples=3, speed=[20.0, 1e-5, 20.0], **given)
    (failure,) = found.failures
    assert failure.row == 1
    assert "steps" in failure.cause
    assert "speed" in failure.cause
    assert np.isnan(found.envelope("moment").max[1]).all()
    whole = sw.ensemble(BRIDGE, who, samples=3, speed=20.0, **given)
    assert (found.digests[[0, 2]] == whole.digests[[0, 2]]).all()


MEASURE = """
    import resource, sys
    sys.path.insert(0, sys.argv[2])
    import spanwise as sw
    from test_many_kinds import BRIDGE, GIVEN, ROAD, truck
    count = int(sys.argv[1])
    kinds = [truck(i) for i in range(count)]
    given = dict(GIVEN, advance=0.01, speed=20.0, road=ROAD, threads=2)
    sw.ensemble(BRIDGE, kinds[:20], samples=20, kind=range(20), **given)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    found = sw.ensemble(BRIDGE, kinds, samples=count, kind=range(count), **given)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    assert not found.failures
    print(after - before)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="no such measure")
def test_memory_does_not_grow_with_tables() -> None:
    """A table of 4 600 steps is 8 MB; a hundred vehicles and their results are much less."""
    here = str(Path(__file__).parent)
    command = [sys.executable, "-c", textwrap.dedent(MEASURE), "100", here]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600)
    assert int(done.stdout) < 100e6
