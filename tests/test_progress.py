"""How far a computation is: over itself on a terminal, a line a minute in a file or a pipe."""

from __future__ import annotations

import io
import sys
import time
from collections.abc import Iterator

import pytest

import spanwise as sw
from spanwise._progress import Bar

BRIDGE = sw.Bridge(spans=[10.0], EI=1e9, mass=5e3, stations_per_span=4)
TRUCK = sw.vehicles.kishan_1973()
GIVEN = {"samples": 100, "speed": 20.0, "modes": 2, "damping": 0.02}


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def minutes(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """A clock that is set by hand [s]."""
    clock = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    return clock  # type: ignore[return-value]


def test_a_line_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    sw.ensemble(BRIDGE, TRUCK, progress=True, **GIVEN)  # type: ignore[arg-type]
    told = terminal.getvalue()
    assert told.count("\n") == 1
    assert "] 100 of 100, " in told
    assert max(map(len, told.rstrip("\n").split("\r"))) < 80
    sw.ensemble(BRIDGE, TRUCK, progress=False, **GIVEN)  # type: ignore[arg-type]
    assert terminal.getvalue() == told


def test_a_line_a_minute_in_a_pipe(minutes: list[float]) -> None:
    pipe = io.StringIO()
    bar = Bar(pipe)
    # Ten times a second for two minutes and a half.
    for tenth in range(1501):
        minutes[0] = tenth / 10.0
        bar(tenth, 1500)
    bar.close()
    lines = pipe.getvalue().splitlines()
    assert [line.split("] ")[1].split(",")[0] for line in lines] == [
        "600 of 1500",
        "1200 of 1500",
        "1500 of 1500",
    ]
    assert "\r" not in pipe.getvalue()


def test_nothing_in_a_pipe_of_what_is_soon_over(capsys: pytest.CaptureFixture[str]) -> None:
    sw.ensemble(BRIDGE, TRUCK, progress=True, **GIVEN)  # type: ignore[arg-type]
    assert capsys.readouterr().err == ""


def test_a_reader_that_has_gone_ends_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    class Broken(Terminal):
        def write(self, text: str) -> int:
            raise BrokenPipeError

    for stream in (Broken(), None):
        monkeypatch.setattr(sys, "stderr", stream)
        found = sw.ensemble(BRIDGE, TRUCK, progress=True, **GIVEN)  # type: ignore[arg-type]
        assert found.samples == 100
    closed = Terminal()
    bar = Bar(closed)
    closed.close()
    bar(1, 2)
    bar.close()
