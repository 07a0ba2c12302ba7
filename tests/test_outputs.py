"""Files are the old ones or the new ones whatever ends the command, and its exit code says why."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spanwise as sw
from spanwise._files import write_files
from spanwise.cli import main

posix = pytest.mark.skipif(sys.platform == "win32", reason="signals and pipes differ")

CASE = """
[bridge]
spans = [20.0]
EI = 2e9
mass = 6000.0
[vehicle]
preset = "kishan-1973"
[crossing]
speed = 20.0
modes = 2
damping = 0.02
"""


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def wait_for(condition: object) -> None:
    """Until a process has come so far, or half a minute."""
    assert callable(condition)
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


#: The command, which writes its archive ever more slowly, and so for minutes.
SLOW_WRITER = """
    import sys, time
    from spanwise import _ensemblecommand
    from spanwise.cli import main

    def slowly(found):
        def write(stream):
            for _ in range(10**4):
                stream.write(b"x" * 10**5)
                time.sleep(0.02)
        return write

    _ensemblecommand.npz_writer = slowly
    sys.exit(main(["ensemble", {case!r}, "--samples", "5", "--out", {out!r}]))
"""


@posix
@pytest.mark.parametrize("number", ["SIGTERM", "SIGHUP", "SIGKILL"])
def test_ended_while_it_writes(case: Path, start: Any, number: str) -> None:
    out = case.parent / "out.npz"
    out.write_bytes(b"before")
    process = start(SLOW_WRITER.format(case=str(case), out=str(out)))
    wait_for(lambda: len(names(case.parent)) == 3)
    os.kill(process.pid, getattr(signal, number))
    done = process.wait()
    assert out.read_bytes() == b"before"
    if number != "SIGKILL":
        assert done.stderr == "spanwise: terminated\n"
        assert done.returncode == 128 + getattr(signal, number)
        assert names(case.parent) == {"case.toml", "out.npz"}


@posix
def test_terminated_while_it_computes(case: Path, start: Any) -> None:
    out = case.parent / "out.npz"
    command = ["ensemble", str(case), "--samples", "5000000", "--out", str(out)]
    process = start(f"""
        import os, signal, sys, threading
        from spanwise.cli import main

        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGTERM)).start()
        sys.exit(main({command!r}))
    """)
    done = process.wait()
    assert (done.stdout, done.stderr) == ("", "spanwise: terminated\n")
    assert done.returncode == 143
    assert names(case.parent) == {"case.toml"}


@posix
def test_a_process_keeps_its_own_way_with_signals(case: Path) -> None:
    before = signal.getsignal(signal.SIGTERM)
    assert main(["cross", str(case)]) == 0
    assert signal.getsignal(signal.SIGTERM) == before


@posix
@pytest.mark.parametrize("limit", [0, 1000, 30000])
def test_no_room(case: Path, limit: int, capsys: pytest.CaptureFixture[str]) -> None:
    import resource

    out = case.parent / "out.npz"
    out.write_bytes(b"before")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
    try:
        code = main(["ensemble", str(case), "--samples", "500", "--out", str(out)])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert capsys.readouterr().err == f"spanwise: error: {out}: File too large\n"
    assert code == 2
    assert out.read_bytes() == b"before"
    assert names(case.parent) == {"case.toml", "out.npz"}


def test_the_archive_is_whole(case: Path) -> None:
    out = case.parent / "out.npz"
    assert main(["ensemble", str(case), "--samples", "20", "--out", str(out)]) == 0
    expected = sw.Case.read(case).ensemble(samples=20)
    with np.load(out) as archive:
        np.testing.assert_array_equal(archive["moment_max"], expected.envelope("moment").max)


@pytest.mark.parametrize(
    ("command", "written"),
    [
        (["cross"], ["--json", "case.toml"]),
        (["cross"], ["--json", "road.csv"]),
        (["cross"], ["--json", "link.toml"]),
        (["ensemble", "--samples", "3"], ["--json", "case.toml"]),
        (["ensemble", "--samples", "3"], ["--json", "road.csv"]),
        (["ensemble", "--samples", "3"], ["--out", "road.npz"]),
    ],
)
def test_what_was_read_is_not_overwritten(
    case: Path, command: list[str], written: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    profile = "".join(f"{x},0.0\n" for x in range(-150, 60))
    name = written[1] if written[1].startswith("road") else "road.csv"
    road = case.parent / name
    road.write_text(profile, encoding="utf-8")
    text = f'{CASE}[road]\nkind = "profile"\nfile = "{name}"\nmax_gap = 2.0\n'
    case.write_text(text, encoding="utf-8")
    if written[1] == "link.toml":
        (case.parent / "link.toml").hardlink_to(case)
    target = case.parent / written[1]
    assert main([command[0], str(case), *command[1:], written[0], str(target)]) == 2
    says = f"spanwise: error: {target}: was read, and is not overwritten\n"
    assert capsys.readouterr() == ("", says)
    assert (road.read_text(encoding="utf-8"), case.read_text(encoding="utf-8")) == (profile, text)


def test_a_place_that_is_not_there_is_told_before_the_work(
    case: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = case.parent / "missing" / "out.npz"
    # Work for an hour.
    assert main(["ensemble", str(case), "--samples", "100000000", "--out", str(out)]) == 2
    assert capsys.readouterr().err == f"spanwise: error: {out.parent}: no such folder\n"


def test_inputs_are_no_outputs(tmp_path: Path) -> None:
    read = tmp_path / "read"
    read.write_bytes(b"old")
    with pytest.raises(FileExistsError, match="was read, and is not overwritten"):
        write_files([(tmp_path / "new", [b"1"]), (read, [b"2"])], inputs=[read])
    assert names(tmp_path) == {"read"}
    assert read.read_bytes() == b"old"


#: Runs commands in copies of one process, which begins as it is started; writes how they end.
COMMANDS = """
import os, sys
from pathlib import Path
from spanwise.cli import main

def ended(command):
    child = os.fork()
    if child == 0:
        sys.exit(main(command.split()))
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

codes = [str(ended(command)) for command in sys.argv[2:]]
Path(sys.argv[1]).write_text(" ".join(codes), encoding="ascii")
"""


@posix
@pytest.mark.parametrize("stream", ["2>&-", "2>/dev/full", "2>&1 >/dev/null | true"])
def test_standard_error_that_is_closed(
    case: Path, stream: str, capsys: pytest.CaptureFixture[str]
) -> None:
    soft = CASE.replace("2e9", "1e6").replace(
        "20.0\nmodes", '1.0\ndrive = "constant-traction"\nmodes'
    )
    (case.parent / "soft.toml").write_text(soft, encoding="utf-8")
    expected = {
        "cross missing.toml": 2,
        "cross --modes x case.toml": 2,
        "cross case.toml --modes 99": 2,
        "cross soft.toml": 1,
        "vehicles": 0,
    }
    command = shlex.join([sys.executable, "-W", "ignore", "-c", COMMANDS, "codes", *expected])
    # What is buffered is written again as Python ends, which is not to change the code.
    done = subprocess.run(
        ["bash", "-c", f"{command} {stream}; exit ${{PIPESTATUS[0]}}"],
        cwd=case.parent,
        env={**os.environ, "PYTHONUNBUFFERED": ""},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    codes = (case.parent / "codes").read_text(encoding="ascii").split()
    assert dict(zip(expected, map(int, codes), strict=True)) == expected
    assert done.stderr == ""
    # Of these only the last has something to say there.
    assert main(["vehicles"]) == 0
    assert done.stdout == ("" if "null" in stream else capsys.readouterr().out)


@posix
def test_standard_output_without_a_reader(tmp_path: Path) -> None:
    read, write = os.pipe()
    os.close(read)
    codes, asked = tmp_path / "codes", ["--help", "--version", "vehicles", "ensemble --help"]
    command = [sys.executable, "-W", "ignore", "-c", COMMANDS, str(codes), *asked]
    done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert done.stderr == ""
    assert codes.read_text(encoding="ascii") == "0 0 0 0"
