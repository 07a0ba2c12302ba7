"""What does not fit is refused by name, whatever takes the memory; nothing ends the process."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

#: Allowed to a process, its libraries included [bytes].
LIMIT = 2_000_000_000

FRAME = """
    import resource
    import numpy as np
    import spanwise as sw
    bridge = sw.Bridge(spans=[18.0, 18.0], EI=2e9, mass=6e3, stations_per_span=3)
    truck = sw.vehicles.kishan_1973()
    given = dict(speed=20.0, damping=0.02, tail=0.0, modes=3)
    loads, behind = np.full(200, 1e4), -2.0 * np.arange(200)
    def many(sections):
        return np.linspace(0.0, 36.0, sections)
    resource.setrlimit(resource.{limit}, ({size}, {size}))
    try:
        {what}
    except (ValueError, MemoryError) as error:
        print(type(error).__name__, error)
    else:
        print("came through")
"""

#: What is asked, and the beginnings of refusals; without one it must come through.
ASKED = [
    ("sw.ensemble(bridge, truck, samples=10**6, advance=0.1, **given)", "InputError samples = "),
    (
        "sw.ensemble(bridge, sw.ForceTrain(loads=loads, positions=behind), samples=2, "
        "sections=many(2000), advance=0.1, **given)",
        "InputError sections = ",
    ),
    (
        "sw.cross(bridge, sw.ForceTrain(loads=loads, positions=behind), sections=many(2000), "
        "step=0.01, **given)",
        "InputError sections = ",
    ),
    ("sw.cross(bridge, truck, **dict(given, modes=6, step=1.2e-6))", "InputError step = "),
    ("r = sw.cross(bridge, truck, step=4e-6, **given); r.moment; r.deflection; r.shear_left", None),
    (
        "sw.ensemble(bridge, [truck] * 1000, samples=1000, kind=range(1000), advance=0.05, "
        "**given)",
        "",
    ),
    (
        "bridge.deflections(np.zeros(1), np.linspace(0.0, 36.0, 10**5))",
        "InputError loads = ",
    ),
    (
        "bridge.deflections(np.zeros(10**6), np.linspace(0.0, 36.0, 300))",
        "InputError x = ",
    ),
    ("sw.Profile(np.arange(10.0**7), np.zeros(10**7))", "InputError x = "),
    ("sw.ISO8608('A').elevation(np.zeros(15 * 10**6))", "InputError x = "),
    ("sw.ensemble(bridge, truck, samples=4, threads=4096, advance=0.1, **given)", ""),
    (
        "e = sw.ensemble(bridge, truck, samples=100_000, advance=2.0, approach=0.0, beta=0.25, "
        "quantities=['moment'], "
        "**given); e.to_npz(PATH)",
        None,
    ),
]


def asked(start: Any, what: str, limit: str, path: Path) -> str:
    program = FRAME.format(what=what.replace("PATH", repr(str(path))), limit=limit, size=LIMIT)
    done = start(program).wait()
    assert done.returncode == 0, (done.returncode, done.stderr[-2000:])
    told: str = done.stdout
    return told


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits are Linux's")
@pytest.mark.parametrize(("what", "refusal"), ASKED)
def test_within_a_limit_nothing_aborts(
    what: str, refusal: str | None, start: Any, tmp_path: Path
) -> None:
    told = asked(start, what, "RLIMIT_AS", tmp_path / "all.npz")
    if refusal is None:
        # Some systems have more room left than others.
        assert told.startswith(("came through", "InputError", "MemoryError")), told
    else:
        assert told.startswith(refusal or "came through"), told


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits are Linux's")
def test_the_limit_of_data_counts_too(start: Any, tmp_path: Path) -> None:
    what, refusal = ASKED[0]
    assert refusal
    assert asked(start, what, "RLIMIT_DATA", tmp_path).startswith(refusal)
