"""What a user gets wrong in an ensemble is told at once, by its name and its place."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spanwise as sw
from spanwise._ensemble_files import settings
from spanwise.cli import main

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()
LONG = sw.vehicles.hs20_44()
OWN = sw.Passage(vehicle=TRUCK, speed=20.0)
LEFT = sw.Passage(vehicle=TRUCK, direction="left")
MANY = np.ones(5000)


def with_one(value: float) -> Any:
    values = MANY.copy()
    values[4999] = value
    return values


REFUSED: list[tuple[Any, dict[str, Any], str]] = [
    (OWN, {"speed": [10, 15, 25]}, "speed = shape (3,): not used, for every passage has a speed"),
    (OWN, {"speed": 20.0}, "speed = 20: not used"),
    (
        [OWN, LEFT],
        {"speed": [[10, 9], [15, 9], [25, 9]]},
        "speed[:, 0] = 10 to 25: not used, for vehicles[0] has a speed of its own",
    ),
    (
        TRUCK,
        {"damping": 0.1, "factors": {"bridge_damping": 15}},
        "factors['bridge_damping'] = 15: makes of damping = 0.1 in every sample 1.5 of critical",
    ),
    (
        TRUCK,
        {"damping": [0.01, 0.1, 0.05], "first": 7, "factors": {"bridge_damping": [1, 9, 10]}},
        "factors['bridge_damping'][2] = 10: makes of damping = 0.1 in sample 9 1 of critical",
    ),
    (TRUCK, {"samples": 5000, "speed": with_one(np.nan)}, "speed[4999] = nan: must be finite"),
    (
        TRUCK,
        {"samples": 5000, "factors": {"body_mass": with_one(np.inf)}},
        "factors['body_mass'][4999] = inf: must be finite",
    ),
    (
        TRUCK,
        {"samples": 5000, "values": {"body_mass": with_one(np.nan)}},
        "values['body_mass'][4999] = nan: must be finite",
    ),
    (
        TRUCK,
        {"values": {"tyre_stiffness": [[1e6, 1e6], [1e6, -1], [1, 1]]}},
        "values['tyre_stiffness'][1, 1] = -1: must be finite and greater than 0",
    ),
    (
        TRUCK,
        {"values": {"body_mass": [1e4, 0, 1]}},
        "values['body_mass'][1] = 0: must be finite and greater than 0",
    ),
    (
        TRUCK,
        {"values": {"initial_friction": [0, 0, 1e9]}},
        "values['initial_friction'][2] = 1e+09: must be within the friction limit of axle 1, ",
    ),
    (
        TRUCK,
        {"factors": {"bridge_stiffness": np.ones((3, 2))}},
        "factors['bridge_stiffness'] = 2 factors a sample: must be one for each sample, for there "
        "is one bridge",
    ),
    (
        [TRUCK, LONG],
        {"kind": [0, 1, 0], "factors": {"tyre_stiffness": np.ones((3, 2))}},
        "must be one for each sample, or one for each of the 3 axles of kind 1",
    ),
    (
        TRUCK,
        {"seed": 2**64},
        "seed = 18446744073709551616: is too large, must be at most 9223372036854775807",
    ),
]


def ensemble(vehicle: Any, **given: Any) -> sw.Ensemble:
    every: dict[str, Any] = {"samples": 3, "modes": 3, **given}
    if vehicle is not OWN:
        every.setdefault("speed", 20.0)
    return sw.ensemble(BRIDGE, vehicle, **every)


@pytest.mark.parametrize(("vehicle", "given", "says"), REFUSED)
def test_refused(vehicle: Any, given: dict[str, Any], says: str) -> None:
    with pytest.raises(ValueError, match=re.escape(says)):
        ensemble(vehicle, **given)


def test_values_do_not_offer_what_they_refuse() -> None:
    with pytest.raises(ValueError, match="values: unknown parameter 'foo'; allowed: ") as told:
        ensemble(TRUCK, values={"foo": 1.0})
    assert "bridge" not in str(told.value)


def test_a_road_is_told_how_to_write() -> None:
    with pytest.raises(TypeError, match=re.escape('a Road, such as sw.ISO8608("C")')):
        ensemble(TRUCK, road="C")


def test_settings_tell_the_speeds_driven() -> None:
    fleet = [[OWN], [sw.Passage(vehicle=TRUCK)]]
    for given in (25.0, [10.0, 25.0, 15.0]):
        found = ensemble(fleet, kind=[0, 1, 0], speed=given)
        assert found.settings["speed"].tolist() == [20.0, 25.0, 20.0]
        again = sw.ensemble(BRIDGE, fleet, **found.settings)
        assert again.hash == found.hash
    found = ensemble([OWN, LEFT], speed=[[9, 10], [9, 15], [9, 12]])
    assert found.settings["speed"].tolist() == [[20, 10], [20, 15], [20, 12]]
    (event,) = settings(ensemble(OWN))["events"]
    assert event[0]["speed"] == 20.0


@pytest.mark.parametrize("name", ["bridge_damping", "suspension_damping", "tyre_damping"])
def test_factors_on_nothing_are_told(name: str) -> None:
    says = f"{name}: the {name.removeprefix('bridge_')} is 0, and a factor on it does nothing"
    with pytest.warns(UserWarning, match=says):
        ensemble(TRUCK, factors={name: 1.2})
    ensemble(TRUCK, factors={"bridge_damping": 1.2}, damping=0.01)


def test_a_failed_sample_cannot_be_run() -> None:
    overlapping = [
        sw.Passage(vehicle=TRUCK, speed=5.0),
        sw.Passage(vehicle=TRUCK, entry=2.0),
    ]
    found = ensemble(overlapping, samples=2, first=100, speed=[5.0, 40.0])
    assert [(each.sample, each.row) for each in found.failures] == [(101, 1)]
    with pytest.raises(RuntimeError, match=r"row 1: sample number 101 failed: .*they overlap"):
        found.run(found.failures[0].row)
    found.run(0)


def test_rows_and_numbers() -> None:
    found = ensemble(TRUCK, samples=5, first=1000, quantities=["moment"])
    says = "row 1002: must be from 0 to below 5 (sample number 1002 is row 2)"
    with pytest.raises(IndexError, match=re.escape(says)):
        found.run(1002)
    with pytest.raises(IndexError, match=r"row -1: must be from 0 to below 5$"):
        found.run(-1)
    with pytest.raises(IndexError, match=re.escape(says)):
        found.histories("moment", [0, 1002])
    assert found.histories("moment", 3).shape == found.histories("moment", [3]).shape
    with pytest.raises(ValueError, match=r"samples = 2.5: must be a row or a list of rows"):
        found.histories("moment", 2.5)  # type: ignore[arg-type]
    says = 'quantity = "deflection": was not looked at; this ensemble has moment'
    with pytest.raises(ValueError, match=says):
        _ = found.impact_factors.deflection
    one = ensemble(TRUCK, samples=1, sections=[5.0])
    assert repr(one).startswith("Ensemble(1 sample from 0 of seed 0, 1 section, ")


CASE = """
[bridge]
spans = [20.0]
EI = 2e9
mass = 5e3
[vehicle]
preset = "kishan-1973"
[crossing]
speed = 20.0
"""


@pytest.mark.parametrize(
    "option", ["--samples=-5", "--threads=0", "--seed=-1", "--modes=0", "--first=-1"]
)
def test_options_are_blamed(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: Any
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8")
    assert main(["ensemble", str(path), "--samples=2", option]) == 2
    name, value = option.split("=")
    said = capsys.readouterr().err
    assert f" {name} = {value}: " in said or f" {name[2:]} = {value}: " in said
    assert "--threads" in said or f"{path} with ensemble.samples" in said
    monkeypatch.setenv("SPANWISE_ISA", "foo")
    assert main(["ensemble", str(path), "--samples=2"]) == 2
    assert 'spanwise: error: SPANWISE_ISA = "foo": ' in capsys.readouterr().err


def test_help_tells_of_what_varies(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["ensemble", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    assert "Case.ensemble" in text
    assert "in place of that of [road]" in text


def test_the_speed_of_a_case_may_be_there_for_nobody(tmp_path: Path) -> None:
    text = """
        [bridge]
        spans = [20.0]
        EI = 2e9
        mass = 6000.0

        [crossing]
        speed = 20.0
        modes = 1

        [[traffic]]
        vehicle = { preset = "kishan-1973" }
        speed = 15.0
    """
    path = tmp_path / "case.toml"
    path.write_text(text)
    case = sw.Case.read(path)
    found = case.ensemble(samples=1)
    assert found.run(0).truck == case.run().truck
    with pytest.raises(ValueError, match="not used"):
        case.ensemble(samples=1, speed=20.0)


@pytest.mark.parametrize("who", [TRUCK, LEFT], ids=["shared", "own ways"])
@pytest.mark.parametrize("asked", [{"step": 1e-9}, {"tail": 1e7}], ids=str)
def test_what_no_sample_can_do_is_refused(who: Any, asked: dict[str, Any]) -> None:
    key = next(iter(asked))
    with pytest.raises(ValueError, match=rf"{key} = .*: .*more than|{key} = .*: .*at most"):
        sw.ensemble(BRIDGE, who, samples=3, speed=[20.0, 21.0, 22.0], damping=0.02, **asked)


@pytest.mark.parametrize("who", [TRUCK, LEFT], ids=["shared", "own ways"])
def test_where_one_sample_can_the_others_are_marked(who: Any) -> None:
    # Steps enough for one that is fast, too many for those that creep.
    speeds = [20.0, 1e-5, 1e-5]
    found = sw.ensemble(BRIDGE, who, samples=3, speed=speeds, damping=0.02, step=0.002)
    assert [failure.sample for failure in found.failures] == [1, 2]
