"""What is kept from call to call, and what the system refuses, never shows as a panic."""

from __future__ import annotations

import os
import sys
import textwrap
from typing import Any

import numpy as np
import pytest

import spanwise as sw

TRUCK = sw.vehicles.kishan_1973()


def described() -> sw.Bridge:
    return sw.Bridge(spans=[20.0, 20.0], EI=3e9, mass=9e3, stations_per_span=2)


def given() -> sw.Bridge:
    whole = sw.Bridge(spans=[40.0], EI=3e9, mass=9e3, stations_per_span=4)
    x = np.array([5.0, 15.0, 20.0, 25.0, 35.0])
    f = whole.deflections(x, [*x])
    masses = [9e4, 9e4, 0.0, 9e4, 9e4]
    return sw.Bridge.from_flexibility(
        stations=[*x],
        flexibility=f,
        masses=masses,
        supports=[(0.0, "pinned"), (40.0, "pinned")],
        redundants=[20.0],
        length=40.0,
    )


def outcome(bridge: sw.Bridge, how: dict[str, Any]) -> object:
    """What a crossing gives: its extremes, or how it was refused."""
    try:
        run = sw.cross(bridge, TRUCK, speed=20.0, step=0.02, beta=0.25, **how)
    except ValueError as refused:
        return str(refused)
    return [
        run.envelope("moment").max.value.tolist(),
        run.envelope("deflection").min.value.tolist(),
    ]


def test_matrices_of_other_shapes_are_refused_as_by_a_fresh_bridge() -> None:
    bridge = described()
    fits, others = np.eye(4), [np.ones((3, 4)), np.eye(3), np.ones((4, 5)), np.zeros((0, 0))]
    for damping in (fits, *others, fits, *others[::-1]):
        how = {"modes": 2, "damping": damping}
        assert outcome(bridge, how) == outcome(described(), how)


@pytest.mark.parametrize("made", [described, given])
def test_no_call_before_matters(made: Any) -> None:
    rng = np.random.default_rng(17)
    ways: list[dict[str, Any]] = []
    matrices: list[Any] = [np.eye(4), 2.0 * np.eye(4), np.eye(3), np.ones((4, 5))]
    dampings = [0.0, [0.01, 0.02], [0.01] * 4, *matrices]
    sections: list[Any] = [None, [5.0], [5.0, 15.0, 35.0], [41.0]]
    for _ in range(150):
        how: dict[str, Any] = {
            "modes": int(rng.integers(1, 4)),
            "damping": dampings[rng.integers(len(dampings))],
            "sections": sections[rng.integers(len(sections))],
        }
        ways.append({key: value for key, value in how.items() if value is not None})
    bridge = made()
    for how in ways:
        assert outcome(bridge, how) == outcome(made(), how), how


#: What the runs below give without limits.
HASH = sw.ensemble(
    sw.Bridge(spans=[20.0], EI=3e9, mass=9e3), TRUCK, samples=100, speed=20.0, damping=0.02
).hash


#: What the programs below begin with.
BEFORE = """
    import resource
    import spanwise as sw

    bridge = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)
    truck = sw.vehicles.kishan_1973()

    def run(**more):
        return sw.ensemble(bridge, truck, samples=100, speed=20.0, damping=0.02, **more)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no copies of processes")
@pytest.mark.parametrize("stack", ["0", "1", str(2**40), str(2**64 - 1), "much"])
def test_the_environment_does_not_size_stacks(start: Any, stack: str) -> None:
    program = textwrap.dedent(BEFORE) + "print(run().hash, run(threads=4096).hash)"
    done = start(program, RUST_MIN_STACK=stack).wait()
    assert done.stderr == ""
    assert done.stdout == f"{HASH} {HASH}\n"


#: Lets the process have so many threads and no more; the user is one who has no others.
FEW = """
    import os
    if os.getuid() == 0:
        os.setuid(54321 + {most})
    resource.setrlimit(resource.RLIMIT_NPROC, ({most}, {most}))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits differ")
def test_where_no_thread_starts_that_is_said(start: Any) -> None:
    program = (
        BEFORE
        + FEW.format(most=0)
        + """
    for threads in (None, 1, 4):
        try:
            run(threads=threads)
        except RuntimeError as refused:
            print(refused)
    # A single crossing needs none.
    sw.cross(bridge, truck, speed=20.0, damping=0.02)
    """
    )
    done = start(program).wait()
    assert done.stderr == ""
    assert done.stdout.count("no thread can be started: ") == 3


@pytest.mark.skipif(sys.platform != "linux" or os.getuid() != 0, reason="limits by user")
def test_fewer_threads_do_the_same(start: Any) -> None:
    done = start(BEFORE + FEW.format(most=3) + "\n    print(run(threads=8).hash)").wait()
    assert done.stderr == ""
    assert done.stdout == f"{HASH}\n"
