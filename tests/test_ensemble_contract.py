"""What the work does not change, what ends it, and what it may take: hash, failures, memory."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()
GIVEN: dict[str, Any] = {
    "speed": 21.0,
    "approach": 20.0,
    "ramp": 5.0,
    "modes": 3,
    "road": sw.ISO8608("B", period=160.0),
    "seed": 11,
}

#: Of some seconds, for what ends it before.
LONG = 60_000


def isas() -> list[str]:
    """The instruction sets of this processor, which the message about another tells."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SPANWISE_ISA", "none")
        with pytest.raises(ValueError, match='SPANWISE_ISA = "none": this processor has') as told:
            sw.ensemble(BRIDGE, TRUCK, samples=1, speed=20.0)
    return str(told.value).split(" has ")[1].split(", ")


def test_nothing_about_the_work_changes_a_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    speed = np.linspace(10.0, 30.0, 75)
    given = {**GIVEN, "speed": speed, "samples": 75}
    expected = sw.ensemble(BRIDGE, TRUCK, **given)
    for isa in isas():
        monkeypatch.setenv("SPANWISE_ISA", isa)
        for threads in (1, 2, 7):
            found = sw.ensemble(BRIDGE, TRUCK, threads=threads, **given)
            assert found.hash == expected.hash
            assert found.isa == isa
            assert found.threads == threads
    assert len(expected.hash) == 16
    int(expected.hash, 16)


def test_a_sample_alone_is_as_among_others() -> None:
    all_ = sw.ensemble(BRIDGE, TRUCK, samples=40, first=100, **GIVEN)
    for row in (0, 13, 39):
        alone = sw.ensemble(BRIDGE, TRUCK, samples=1, first=100 + row, **GIVEN)
        assert alone.digests[0] == all_.digests[row]
        assert_array_equal(
            alone.envelope("shear").max_time[0], all_.envelope("shear").max_time[row]
        )
    other = sw.ensemble(BRIDGE, TRUCK, samples=40, first=100, **{**GIVEN, "seed": 12})
    assert not (other.digests == all_.digests).any()


def test_results_are_not_to_be_written_to() -> None:
    found = sw.ensemble(BRIDGE, TRUCK, samples=3, **GIVEN)
    for values in (
        found.envelope("moment").max,
        found.envelope("moment").static_max,
        found.envelope("moment").max_time,
        found.envelope("shear").min,
        found.digests,
        found.dynamic_load_coefficients,
        found.sections,
    ):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.0


def test_progress() -> None:
    told: list[tuple[int, int]] = []
    sw.ensemble(
        BRIDGE,
        TRUCK,
        samples=300,
        progress=lambda done, total: told.append((done, total)),
        **GIVEN,
    )
    assert told[-1] == (300, 300)
    assert {total for _, total in told} == {300}
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    told.clear()
    started = time.perf_counter()
    sw.ensemble(BRIDGE, TRUCK, samples=1000, progress=lambda *now: told.append(now), **GIVEN)
    assert len(told) <= (time.perf_counter() - started) / 0.1 + 1


def test_what_the_listener_raises_ends_the_work() -> None:
    class Enough(Exception):
        pass

    def listener(done: int, total: int) -> None:
        raise Enough(f"{done} of {total}")

    with pytest.raises(Enough, match=f"of {LONG}") as raised:
        sw.ensemble(BRIDGE, TRUCK, samples=LONG, progress=listener, **GIVEN)
    # At the first that it was told.
    assert int(str(raised.value).split()[0]) < LONG / 4
    with pytest.raises(Enough, match="3 of 3"):
        sw.ensemble(BRIDGE, TRUCK, samples=3, progress=listener, **GIVEN)


def test_several_at_once() -> None:
    speeds = [15.0, 20.0, 25.0, 30.0]
    expected = [sw.ensemble(BRIDGE, TRUCK, samples=60, **{**GIVEN, "speed": v}) for v in speeds]
    told: list[int] = []

    def one(speed: float) -> sw.Ensemble:
        return sw.ensemble(
            BRIDGE,
            TRUCK,
            samples=60,
            progress=lambda done, _: told.append(done),
            **{**GIVEN, "speed": speed},
        )

    with ThreadPoolExecutor(4) as pool:
        found = [*pool.map(one, speeds)]
    assert [each.hash for each in found] == [each.hash for each in expected]
    assert told.count(60) == 4


def test_python_goes_on_meanwhile() -> None:
    ticks = 0
    over = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not over.wait(0.01):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    try:
        sw.ensemble(BRIDGE, TRUCK, samples=3000, **GIVEN)
    finally:
        over.set()
        thread.join()
    assert ticks >= 5


@pytest.mark.filterwarnings("ignore:loads, EI:spanwise.PlausibilityWarning")
def test_failures_are_marked_and_leave_the_others() -> None:
    # Heavy masses that ride side by side accelerate each other.
    masses = sw.MovingMasses(masses=[500.0] * 4, positions=[0.0, -0.01, -0.02, -0.03])
    heavy = np.ones(40)
    heavy[[3, 17]] = 1e6
    given = {**GIVEN, "advance": 0.2}
    found = sw.ensemble(BRIDGE, masses, samples=40, first=50, factors={"body_mass": heavy}, **given)
    assert [each.sample for each in found.failures] == [53, 67]
    assert "shorten the step" in found.failures[0].cause
    assert found.failures[0].step is not None
    for values in (
        found.envelope("moment").max,
        found.envelope("moment").max_time,
        found.envelope("shear").min_position,
        found.envelope("axle_loads").max,
        found.dynamic_load_coefficients,
        found.impact_factors.sagging,
        found.impact_factors.shear,
    ):
        assert np.isnan(values[[3, 17]]).all()
    for values in (
        found.envelope("moment").max,
        found.envelope("moment").max_time,
        found.envelope("axle_loads").max,
    ):
        assert np.isfinite(np.delete(values, [3, 17], axis=0)).all()
    sound = sw.ensemble(
        BRIDGE, masses, samples=40, first=50, factors={"body_mass": np.ones(40)}, **given
    )
    assert sound.failures == ()
    others = np.delete(np.arange(40), [3, 17])
    assert_array_equal(found.digests[others], sound.digests[others])
    assert "2 failed" in repr(found)
    assert "failed    sample 53 in step" in found.summary()
    with pytest.raises(RuntimeError, match="no convergence"):
        found.run(3)
    again = sw.ensemble(
        BRIDGE,
        masses,
        samples=40,
        first=50,
        factors={"body_mass": heavy},
        threads=1,
        **given,
    )
    assert again.hash == found.hash


@pytest.mark.filterwarnings("ignore:loads, EI:spanwise.PlausibilityWarning")
def test_every_sample_may_fail() -> None:
    given = {**GIVEN, "advance": 0.2}
    masses = sw.MovingMasses(masses=[500.0] * 4, positions=[0.0, -0.01, -0.02, -0.03])
    found = sw.ensemble(BRIDGE, masses, samples=3, factors={"body_mass": 1e6}, **given)
    assert len(found.failures) == 3
    assert "3 failed" in found.summary()


MEASURE = """
    import resource, sys
    import numpy as np
    import spanwise as sw

    bridge = sw.Bridge(spans=[18.288] * 2, EI=1.94148e9, mass=6037.7, stations_per_span=3)
    vehicle = sw.vehicles.kishan_1973()
    given = dict(speed=22.86, approach=30.0, ramp=10.0, modes=3, road=sw.ISO8608("B", period=128.0),
                 sections=np.linspace(0.0, 36.576, 25), advance=0.1)
    sw.ensemble(bridge, vehicle, samples=500, **given)
    unit = 1 if sys.platform == "darwin" else 1024
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
    found = sw.ensemble(bridge, vehicle, samples=int(sys.argv[1]), **given)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
    arrays = found._rows.numbers.nbytes + found._rows.instants.nbytes + found.digests.nbytes
    assert not found.failures
    print(after - before - arrays, arrays)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such measure")
@pytest.mark.parametrize(
    ("samples", "most"),
    [
        (10_000, 40e6),
        pytest.param(
            1_000_000,
            300e6,
            marks=pytest.mark.skipif(
                "SPANWISE_SLOW" not in os.environ, reason="minutes; SPANWISE_SLOW=1 runs it"
            ),
        ),
    ],
)
def test_memory(samples: int, most: float) -> None:
    command = [sys.executable, "-c", textwrap.dedent(MEASURE), str(samples)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=1800)
    beyond, arrays = map(int, done.stdout.split())
    assert arrays > 2000 * samples
    assert beyond < most
