"""Damping is a decision: silence is warned of, and every report tells what was decided."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise._ensemble_files import as_dict, npz_writer
from spanwise.cli import main

BRIDGE = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3, stations_per_span=5)
TRUCK = sw.vehicles.kishan_1973()
CASE = """
[bridge]
spans = [20.0]
EI = 3e9
mass = 9e3
stations_per_span = 5
[vehicle]
preset = "kishan-1973"
[crossing]
speed = 20.0
modes = 2
"""
MATRIX = 3e3 * np.eye(5)


def cross(**given: Any) -> sw.Run:
    return sw.cross(BRIDGE, TRUCK, speed=20.0, modes=2, **given)


def ensemble(**given: Any) -> sw.Ensemble:
    return sw.ensemble(BRIDGE, TRUCK, samples=2, speed=20.0, modes=2, **given)


def case(**given: Any) -> sw.Run:
    return sw.Case.parse(CASE).run(**given)


def cases(**given: Any) -> sw.Ensemble:
    return sw.Case.parse(CASE).ensemble(samples=2, **given)


@pytest.mark.parametrize("make", [cross, ensemble, case, cases])
def test_silence_is_warned_of_and_a_decision_is_not(make: Callable[..., Any]) -> None:
    with pytest.warns(sw.DampingWarning, match=r"damping = 0\.02 .*damping = 0 if none is meant"):
        undamped = make()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        meant = make(damping=0)
        for decided in (0.02, [0.01, 0.02], sw.Rayleigh(0.1, 1e-4), MATRIX):
            make(damping=decided)
    one, other = (
        each.envelope("moment").max.value
        if isinstance(each, sw.Run)
        else each.envelope("moment").max
        for each in (undamped, meant)
    )
    assert_array_equal(one, other)
    assert undamped.settings["damping"] == meant.settings["damping"] == 0.0


def test_it_can_be_silenced_by_category_and_is_of_the_caller() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", sw.DampingWarning)
        cross()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        cross()
        ensemble()
    assert [each.filename for each in told] == [__file__] * 2


def test_a_sample_by_itself_has_been_decided() -> None:
    with pytest.warns(sw.DampingWarning):
        found = ensemble()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert found.run(1).settings["damping"] == 0.0


def test_errors_come_first() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError, match="speed: missing"):
            sw.cross(BRIDGE, TRUCK)


@pytest.mark.parametrize(
    ("damping", "words"),
    [
        (0, "none"),
        ([0.0, 0.0], "none"),
        (0.02, "2 % of critical in each mode"),
        ([0.02], "2 % of critical in each mode"),
        ([0.01, 0.025], "1, 2.5 % of critical"),
        (np.array([0.01, 0.025]), "1, 2.5 % of critical"),
        (MATRIX, "by a matrix"),
        (sw.Rayleigh(0.1, 0.0), "Rayleigh alpha 0.1 /s, beta 0 s: "),
        ({"rayleigh": [0.1, 1e-4]}, "Rayleigh alpha 0.1 /s, beta 0.0001 s: "),
    ],
    ids=repr,
)
def test_every_report_tells(damping: Any, words: str) -> None:
    run, many = cross(damping=damping), ensemble(damping=damping)
    assert f"damping {words}" in run.summary()
    assert f"damping {words}" in many.summary()
    assert run.to_dict()["damping"].startswith(words)
    assert as_dict(many)["damping"].startswith(words)
    npz_writer(many)(content := BytesIO())
    content.seek(0)
    with np.load(content) as archive:
        assert str(archive["damping"]).startswith(words)
        assert "damping" in json.loads(str(archive["settings"]))["ensemble"]
    # What is told is a case again.
    again = sw.Case.from_dict(run.to_dict()["settings"]).run()
    assert_array_equal(again.moment, run.moment)


def test_rayleigh_tells_its_ratios() -> None:
    run = cross(damping=sw.Rayleigh(0.3, 2e-4))
    first, second = 100.0 * sw.Rayleigh(0.3, 2e-4).ratios(run.frequencies)
    assert f": {first:.3g}, {second:.3g} % of critical" in run.summary()


@pytest.mark.parametrize("more", [["cross"], ["ensemble", "--samples", "2"]])
def test_command_line(more: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8")
    assert main([more[0], str(path), *more[1:]]) == 0
    out, err = capsys.readouterr()
    assert err.startswith("spanwise: warning: damping: not given")
    assert err.count("\n") == 1
    assert "damping none" in out
    path.write_text(CASE + "damping = 0\n", encoding="utf-8")
    assert main([more[0], str(path), *more[1:]]) == 0
    assert capsys.readouterr().err == ""
