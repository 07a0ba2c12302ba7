"""Input that would never end or take all memory is refused by name, before it does either."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

import pytest

import spanwise as sw
from spanwise.cli import main

#: Longest time that a refusal may take [s of the processor]: what has no end is counted to a limit.
SOON: Final = 1.0

#: Memory that may be taken in doing so [MiB].
LITTLE: Final = 120

#: What is refused, and the argument that is to be named.
BOMBS: Final = {
    "sw.Bridge(spans=count(1), EI=1e9, mass=1e3)": "spans",
    "sw.Bridge(spans=range(10**12), EI=1e9, mass=1e3)": "spans",
    "sw.Bridge(spans=[20.0], EI=sw.Along(at=repeat(0.0), values=[1.0]), mass=1e3)": "EI at",
    "sw.Bridge(spans=[20.0], EI=1e9, mass=1e3, point_masses=repeat((1.0, 1.0)))": "point_masses",
    "sw.Bridge(length=20.0, supports=repeat((0.0, 'pinned')), EI=1e9, mass=1e3)": "supports",
    "bridge.deflections(np.broadcast_to(1.0, 10**12), [1.0])": "x",
    "bridge.influence_line('moment', 9.0, range(10**12))": "x",
    "bridge.influence_line('moment', 9.0, [range(10**12)])": "x",
    "sw.Speeds(times=count(), speeds=[1.0])": "times",
    "sw.convoy(repeat(truck), headway=1.0)": "vehicles",
    "sw.convoy([truck, truck], headway=count(1))": "headway",
    "sw.ForceTrain(loads=count(1.0))": "loads",
    "sw.cross(bridge, truck, speed=20.0, damping=0.0, sections=count())": "sections",
    "sw.cross(bridge, truck, speed=20.0, damping=range(10**12))": "damping",
    "sw.cross(bridge, truck, speed=1e-9)": "step",
    "sw.cross(bridge, truck, speed=20.0, step=1e-15)": "step",
    "sw.cross(bridge, truck, speed=20.0, tail=1e12)": "tail",
    "sw.Bridge(spans=[20.0], EI=1e9, mass=1e3, stations_per_span=10**7)": "stations_per_span",
    "sw.Bridge(spans=[20.0], EI=1e9, mass=1e3, stations_per_span=10**18)": "stations_per_span",
    "sw.ensemble(bridge, truck, samples=10**9, speed=np.broadcast_to(20.0, 10**9))": "speed",
    "sw.ensemble(bridge, [truck] * 2, samples=10**9, speed=20.0, kind=range(10**9))": "kind",
    "sw.ensemble(bridge, truck, samples=10**9, speed=20.0,"
    " factors={'body_mass': np.broadcast_to(1.0, 10**9)})": "body_mass",
    "road.elevation(range(10**12))": "x",
    "sw.Profile(range(10**12), range(10**12))": "x",
    "sw.Case.parse('a.' * 40_000 + 'a = 1')": "dotted key",
    "sw.Case.parse('[' + 'a.' * 40_000 + 'a]')": "dotted key",
    "sw.Case.parse('b = { c = { ' + '\"a\" . ' * 40_000 + 'a = 1 } }')": "dotted key",
    "sw.Case.parse('a = ' + '[' * 100_000 + ']' * 100_000)": "brackets",
    "sw.Case.parse('#' * 10_000_000)": "text",
    "sw.Case.from_dict({'bridge': nested(50_000)})": "bridge",
    "sw.Case.read('/dev/zero')": "not a regular file",
    "sw.Case.read('/')": "folder",
}

SCRIPT: Final = """
import json, resource, sys, time
from itertools import count, repeat
import numpy as np
import spanwise as sw

def nested(levels):
    made = 1
    for _ in range(levels):
        made = {"a": made}
    return made

# What no limit catches is not to take the memory of others.
resource.setrlimit(resource.RLIMIT_AS, (8 * 2**30, 8 * 2**30))
bridge = sw.Bridge(spans=[18.0, 18.0], EI=1.9e9, mass=6e3, stations_per_span=3)
truck, road = sw.vehicles.kishan_1973(), sw.ISO8608("A")
sw.cross(bridge, truck, speed=20.0, modes=3, damping=0.0)
found = {}
for call in json.load(sys.stdin):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.process_time()
    try:
        eval(call)
        said = "was taken"
    except (ValueError, TypeError) as error:
        said = str(error)
    except BaseException as error:
        said = repr(error)
    more = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    found[call] = [said, time.process_time() - start, more / 1024]
print(json.dumps(found))
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is told by Linux")
def test_what_has_no_end_is_refused_by_name(tmp_path: Path) -> None:
    huge = tmp_path / "huge.toml"
    with huge.open("wb") as file:
        file.truncate(2**30)
    bombs = {**BOMBS, f"sw.Case.read({str(huge)!r})": "huge.toml"}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", SCRIPT],
        input=json.dumps([*bombs]),
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    found: dict[str, list[Any]] = json.loads(done.stdout)
    for call, key in bombs.items():
        said, seconds, mebibytes = found[call]
        assert key in said, call
        assert len(said) < 600, call
        assert seconds < SOON, call
        assert mebibytes < LITTLE, call


def test_a_dotted_key_of_usual_depth_is_taken() -> None:
    text = "bridge.spans = [18.0]\nbridge.EI = 1e9\nbridge.mass = 1e3\n"
    case = sw.Case.parse(text + 'vehicle.preset = "flm3"\ncrossing.speed = 20.0')
    assert case.bridge.length == 18.0


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize("option", ["--json", "--csv", "--plot"])
def test_a_pipe_is_no_place_for_results(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case, pipe = tmp_path / "case.toml", tmp_path / "pipe"
    case.write_text(
        "[bridge]\nspans = [18.0]\nEI = 1e9\nmass = 1e3\n[vehicle]\n"
        'preset = "flm3"\n[crossing]\nspeed = 20.0\ndamping = 0.0\n'
    )
    os.mkfifo(pipe)
    assert main(["cross", str(case), option, str(pipe)]) == 2
    assert str(pipe) in capsys.readouterr().err
    assert main(["cross", str(pipe)]) == 2
    assert "not a regular file" in capsys.readouterr().err
