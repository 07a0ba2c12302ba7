"""The tables of a case, written and read again: of ensembles, of bridges from outside, as TOML."""

from __future__ import annotations

import json
from dataclasses import fields
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spanwise as sw
from spanwise._case_tables import assignment
from spanwise._conditions import Crossing
from spanwise._ensemble_files import as_dict
from spanwise._plan_of_arguments import Asked
from spanwise._toml import toml, toml_value
from spanwise.cli import main

BRIDGE = sw.Bridge(spans=[20.0], EI=2e9, mass=5e3, stations_per_span=4)
TRUCK = sw.vehicles.kishan_1973()
TEXT = """
[bridge]
spans = [20.0]
EI = 2e9
mass = 5e3
stations_per_span = 4
[vehicle]
preset = "kishan-1973"
[road]
kind = "iso-8608"
class = "C"
"""
ENSEMBLE = """
[ensemble]
samples = 3
seed = 4
speed = [20.0, 21.0, 22.5]
factors = { body_mass = [0.9, 1.0, 1.1] }
quantities = ["moment"]
damping = 0.02
modes = 2
"""


def expected(**changes: Any) -> sw.Ensemble:
    given: dict[str, Any] = {
        "samples": 3,
        "seed": 4,
        "speed": [20.0, 21.0, 22.5],
        "factors": {"body_mass": [0.9, 1.0, 1.1]},
        "quantities": ["moment"],
        "damping": 0.02,
        "modes": 2,
        "road": sw.ISO8608("C"),
    }
    return sw.ensemble(BRIDGE, TRUCK, **{**given, **changes})


def test_an_ensemble_of_a_case() -> None:
    case = sw.Case.parse(TEXT + ENSEMBLE)
    assert case.ensemble().hash == expected().hash
    assert case.ensemble(seed=5).hash == expected(seed=5).hash
    # What the crossing says too, the ensemble has as its own table says.
    both = sw.Case.parse(TEXT + ENSEMBLE + "[crossing]\nspeed = 20.0\nmodes = 3\nbeta = 0.25\n")
    assert both.run().settings["modes"] == 3
    assert both.ensemble().hash == expected(beta=0.25).hash


def test_the_command_takes_samples_and_seed_from_the_case(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(TEXT + ENSEMBLE, encoding="utf-8")
    assert main(["ensemble", str(path)]) == 0
    assert f"hash      {expected().hash}" in capsys.readouterr().out
    assert main(["ensemble", str(path), "--seed", "5"]) == 0
    assert f"hash      {expected(seed=5).hash}" in capsys.readouterr().out


LORRY = sw.Vehicle(
    bodies=[
        sw.Body(
            mass=6e3,
            pitch_inertia=9e3,
            axles=[
                sw.Axle(
                    position=x,
                    tyre_stiffness=2e6,
                    suspension_stiffness=5e5,
                    mass=500,
                    friction_limit=limit,
                )
                for x, limit in ((2.0, float("inf")), (-2.0, 0.0))
            ],
        ),
        sw.Body(
            mass=500,
            pitch_inertia=300,
            springs=[sw.Spring(to=0, at=x, own=x, stiffness=2e5, damping=3e3) for x in (0.8, -0.6)],
        ),
    ]
)
EVENTS = [
    [sw.Passage(vehicle=LORRY, drive=sw.Braking(deceleration=1.0), speed=15.0)],
    [
        sw.Passage(vehicle=TRUCK),
        sw.Passage(
            vehicle=sw.vehicles.hs20(), direction="left", road=sw.Bump(3.0, 1.0, 0.01) + sw.Smooth()
        ),
    ],
    [sw.Passage(vehicle=sw.ForceTrain(loads=[1e4, 2e4], positions=[0.0, -3.0]))],
]


def given_by_modes() -> sw.Bridge:
    path = BRIDGE.nodes
    return sw.Bridge.from_modes(
        path=path.tolist(),
        frequencies=BRIDGE.modes(3).frequencies.tolist(),
        shapes=BRIDGE.mode_shapes(3, path),
        sections=[7.5],
        influence={"deflection": BRIDGE.deflections(path, [7.5]).T},
    )


@pytest.mark.parametrize(
    ("bridge", "given"),
    [
        (BRIDGE, {"damping": {"rayleigh": {"alpha": 0.1, "beta": 1e-4}}, "advance": 0.05}),
        (BRIDGE, {"damping": [0.02, 0.03], "speed": [20.0, 21.0, 22.0, 23.0], "recovery": "super"}),
        (given_by_modes(), {"damping": 0.01, "speed": 20.0, "quantities": ["deflection"]}),
    ],
    ids=["Rayleigh", "rates", "bridge by its modes"],
)
@pytest.mark.parametrize("several", [False, True], ids=["a vehicle", "kinds"])
def test_the_settings_of_an_ensemble_are_a_case(
    bridge: sw.Bridge, given: dict[str, Any], several: bool
) -> None:
    road = sw.ISO8608("B") + sw.Step(2.0, 0.002)
    given = {"speed": 20.0, "modes": 2, "road": road, "accuracy": 0.02, **given}
    if given.get("recovery") == "super":
        given["recovery"] = "superposition"
    if several:
        given.pop("advance", None)
        given["kind"] = [0, 2, 1, 0]
    who: Any = EVENTS if several else TRUCK
    many = sw.ensemble(bridge, who, samples=4, first=2, seed=3, factors={"body_mass": 1.1}, **given)
    settings = json.loads(json.dumps(as_dict(many)["settings"]))
    assert set(settings) == {"bridge", "events", "ensemble"}
    case = sw.Case.from_dict(settings)
    assert case.ensemble().hash == many.hash
    assert len(case.events) == (3 if several else 0)
    again = sw.Case.parse(toml(settings))
    assert again == case
    assert again.ensemble().hash == many.hash
    with pytest.raises(ValueError, match=r"case: is a case of an ensemble; a single crossing"):
        case.run()


def test_a_bridge_from_outside_stands_in_a_case() -> None:
    run = sw.cross(given_by_modes(), TRUCK, speed=20.0, damping=0.02, modes=2)
    settings = json.loads(json.dumps(run.to_dict()["settings"]))
    again = sw.Case.from_dict(settings).run()
    np.testing.assert_array_equal(again.deflection, run.deflection)
    text = toml(settings)
    assert "[bridge.from_modes]" in text
    assert sw.Case.parse(text).bridge == run.bridge


REFUSED = [
    ("[ensemble]\nsamples = 2.5", r"^case, \[ensemble\]: samples = 2\.5: must be a whole number$"),
    ("[ensemble]\nsampels = 2", r"'sampels' \(did you mean 'samples'\?\); allowed: modes, drive"),
    ("[ensemble]\nEI = 2", r"^case, \[ensemble\]: unknown key 'EI' \(belongs in \[bridge\]\)"),
    ("[ensemble]\nthreads = 2", r"^case, \[ensemble\]: unknown key 'threads'; allowed"),
    ("[ensemble]\nspeed = ['a']", r"^case, \[ensemble\]: speed = \['a'\]: must be a number or an"),
    ("[ensemble]\nfactors = 3", r"^case, \[ensemble\]: factors = 3: must be a mapping"),
    (
        "[ensemble]\nfactors = { body_mass = 'a' }",
        r"^case, \[ensemble\]: factors\['body_mass'\] = 'a': must be a number",
    ),
    (
        "[ensemble]\nquantities = ['momentum']",
        r"^case, \[ensemble\]: quantities\[0\] = 'momentum': must be one of .*mean 'moment'",
    ),
    (
        "[ensemble]\nroad = { kind = 'step' }",
        r"^case, \[ensemble\]: unknown key 'road' \(a table of its own, \[road\]\)",
    ),
    ("[ensemble]\nsample = 2", r"unknown key 'sample' \(did you mean 'samples'\?\)"),
    ("[crossing]\nsamples = 2", r"unknown key 'samples' \(belongs in \[ensemble\]\)"),
    ("[crossing]\nspeed = '20'", r"^case, \[crossing\]: speed = '20': must be a number$"),
    ("[crossing]\nmodes = 2.5", r"^case, \[crossing\]: modes = 2\.5: must be a whole number$"),
    ("[crossing]\nlift_off = 1", r"^case, \[crossing\]: lift_off = 1: must be true or false$"),
    ("[crossing]\nsections = [1, 'a']", r"^case, \[crossing\]: sections\[1\] = 'a': must be"),
    (
        "[crossing]\nrecovery = 'forces'",
        r"^case, \[crossing\]: recovery = 'forces': must be force-summation, .* or superposition$",
    ),
    ("[crossing]\ndrive = 'slow'", r"^case, \[crossing\]: drive = 'slow': must be constant-speed"),
    (
        "[crossing]\ndrive = { kind = 'braking' }",
        r"^case, \[crossing\]: drive: missing deceleration$",
    ),
    (
        "[crossing]\ndamping = { rayleigh = [1.0] }",
        r"^case, \[crossing\]: damping rayleigh = \[1\.0\]: must be a pair, ",
    ),
    ("[crossing]\ndamping = 'low'", r"\[crossing\]: damping = 'low': must be a number or a list"),
    ("", r"^case: missing \[crossing\]; a case has .*, and \[crossing\] or \[ensemble\]$"),
    ("[[events]]\n", r"^case: \[vehicle\] and \[\[events\]\]: give one of the two$"),
]


@pytest.mark.parametrize(("text", "message"), REFUSED)
def test_settings_are_checked_when_the_case_is_read(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message) as caught:
        sw.Case.parse(TEXT + text)
    assert type(caught.value) is sw.CaseError


def test_samples_must_be_given_somewhere() -> None:
    case = sw.Case.parse(TEXT + "[ensemble]\nspeed = 20.0")
    with pytest.raises(ValueError, match=r"^case: missing samples; give them here or in \[ensem"):
        case.ensemble()


@pytest.mark.parametrize(
    ("events", "message"),
    [
        (3, r"^case, \[\[events\]\]: events = 3: must be tables, \[\[events\]\]$"),
        ([], r"^case, \[\[events\]\]: events = \[\]: must be tables"),
        ([3], r"^case, \[\[events\]\]: events\[0\] = 3: must be a table"),
        ([{}], r"^case, \[\[events\]\]: events\[0\]: missing vehicle"),
        (
            [[{"vehicle": {"loads": [1e4]}}, {"vehicle": {"load": [1e4]}}]],
            r"events\[0\]\[1\]\.vehicle: unknown key 'load' \(did you mean 'loads'\?\)",
        ),
    ],
)
def test_events_that_are_none(events: object, message: str) -> None:
    tables = {"bridge": BRIDGE.arguments, "events": events, "ensemble": {"samples": 2}}
    with pytest.raises(ValueError, match=message):
        sw.Case.from_dict(tables)


def test_keys_beside_a_bridge_from_outside() -> None:
    tables = {
        "bridge": {"from_modes": {}, "EI": 1e9},
        "vehicle": {"preset": "flm3"},
        "crossing": {"speed": 20.0},
    }
    with pytest.raises(ValueError, match=r"\[bridge\]: unknown key 'EI'.*; allowed: from_modes"):
        sw.Case.from_dict(tables)
    tables["bridge"] = {"from_modes": {}}
    with pytest.raises(ValueError, match=r"\[bridge\]: from_modes: missing path, frequencies"):
        sw.Case.from_dict(tables)


def test_an_advance_in_the_crossing_is_of_the_ensemble() -> None:
    with pytest.warns(DeprecationWarning, match=r"advance in \[crossing\] is now advance in \[ens"):
        case = sw.Case.parse(TEXT + "[crossing]\nspeed = 20.0\nadvance = 0.2\n")
    assert case.run(modes=2) == sw.Case.parse(TEXT + "[crossing]\nspeed = 20.0\n").run(modes=2)
    assert case.sampling == {"advance": 0.2}
    assert case.ensemble(samples=1, modes=2).settings["advance"] == 0.2
    with pytest.raises(ValueError, match="unknown key 'advanced'") as caught:
        sw.Case.parse(TEXT + "[crossing]\nadvanced = 0.2\n")
    assert "advance'" not in str(caught.value)


#: Texts as of a command, the command's table, and key and value.
ASSIGNED = [
    ("crossing.speed=25", "crossing", "crossing.speed", 25),
    (" speed = 2.5e1 ", "crossing", "crossing.speed", 25.0),
    ("speed=[20, 21.5]", "ensemble", "ensemble.speed", [20, 21.5]),
    ("modes=3", "ensemble", "ensemble.modes", 3),
    ("samples=3", "crossing", "ensemble.samples", 3),
    ("EI=2e10", "crossing", "bridge.EI", 2e10),
    ("preset=half-car", "ensemble", "vehicle.preset", "half-car"),
    ("class=C", "crossing", "road.class", "C"),
    ("columns=z [mm]", "road", "road.columns", "z [mm]"),
    ("start=.5", "road", "road.start", 0.5),
    ("lift_off=false", "crossing", "crossing.lift_off", False),
    ("lift_off=True", "crossing", "crossing.lift_off", True),
    ("damping[1]=0.02", "crossing", "crossing.damping[1]", 0.02),
    ("traffic[1].lane=2", "crossing", "traffic[1].lane", 2),
    ("road={ kind = 'smooth' }", "crossing", "road", {"kind": "smooth"}),
    ("vehicle.preset=a=b", "crossing", "vehicle.preset", "a=b"),
    ("factors.body_mass[0]=2", "road", "ensemble.factors.body_mass[0]", 2),
    ("class=C\nG=3", "crossing", "road.class", "C\nG=3"),
]


@pytest.mark.parametrize(("text", "table", "key", "value"), ASSIGNED)
def test_a_value_by_its_key(text: str, table: str, key: str, value: object) -> None:
    found = assignment(text, table)
    assert found == (key, value)
    assert type(found[1]) is type(value)


MIXED = (
    TEXT.replace('[vehicle]\npreset = "kishan-1973"\n', "")
    + """
[[traffic]]
vehicle = { preset = "half-car" }
[[traffic]]
vehicle = { preset = "kishan-1973" }
direction = "left"
[crossing]
speed = 20.0
"""
)


def test_settings_stand_in_place_of_those_of_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(MIXED, encoding="utf-8")
    settings: dict[str, Any] = {
        "crossing.speed": 25,
        "crossing.damping": 0.02,
        "traffic[1].speed": 12.5,
        "traffic[0].vehicle.cg_height": 1.5,
        "bridge.spans[0]": 22.0,
        "road": {"kind": "iso-8608", "class": "A"},
        "road.seed": 4,
    }
    case = sw.Case.read(path, settings)
    assert case.crossing["speed"] == 25.0
    assert [each.speed for each in case.passages] == [None, 12.5]
    assert case.bridge.length == 22.0
    assert case.road == sw.ISO8608("A", seed=4)
    run = case.run(modes=2)
    words = (
        word for key, each in settings.items() for word in ("--set", f"{key}={toml_value(each)}")
    )
    assert main(["cross", str(path), *words, "--modes", "2", "--json", "-"]) == 0
    written = json.loads(capsys.readouterr().out)["settings"]
    assert sw.Case.from_dict(written).run() == run
    assert written["crossing"]["speed"] == 25.0
    assert written["road"]["seed"] == 4
    # The file, and what was given, stay as they are.
    assert settings["road"] == {"kind": "iso-8608", "class": "A"}
    assert sw.Case.read(path).crossing == {"speed": 20.0}


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"crossing.sped": 3}, r"toml with crossing\.sped set, \[crossing\]: .*mean 'speed'"),
        ({"crosing.speed": 3}, r"unknown table or key 'crosing' \(did you mean 'crossing'\?\)"),
        ({"traffic[2].speed": 3}, r"toml: traffic\[2\]\.speed: traffic has 2, counted from 0"),
        ({"traffic.speed": 3}, r"traffic is a list; name one of it, as traffic\[0\]\.speed"),
        ({"crossing.speed.x": 3}, r"crossing\.speed = 20\.0 is no table; give all of crossing\."),
        ({"vehicle.axles[0].mass": 3}, r"vehicle\.axles is not in the case"),
        ({"crossing.speed[0]": 3}, r"crossing\.speed is no list"),
        (
            {"crossing..speed": 3},
            "'crossing..speed': must be table and key, such as crossing.speed",
        ),
        ({3: 3}, "3: must be table and key"),
        (3, "settings = 3: must be a mapping"),
        ({"crossing.speed": "25m/s"}, r"\[crossing\]: speed = '25m/s': must be a number"),
    ],
)
def test_settings_that_are_none(tmp_path: Path, settings: Any, message: str) -> None:
    path = tmp_path / "case.toml"
    path.write_text(MIXED, encoding="utf-8")
    with pytest.raises(sw.CaseError, match=message):
        sw.Case.read(path, settings)


def test_a_speed_that_the_ensemble_has_is_not_set_in_vain(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(TEXT + ENSEMBLE, encoding="utf-8")
    assert main(["ensemble", str(path), "--set", "crossing.modes=3"]) == 2
    assert "crossing.modes: [ensemble] has modes too, which goes before" in capsys.readouterr().err
    assert main(["ensemble", str(path), "--set", "modes=3", "--set", "factors.body_mass[1]=2"]) == 0
    many = expected(modes=3, factors={"body_mass": [0.9, 2, 1.1]})
    assert f"hash      {many.hash}" in capsys.readouterr().out


def test_signatures_have_what_settings_have() -> None:
    for function, settings, others in (
        (sw.cross, Crossing, {"bridge", "vehicle", "road"}),
        (sw.ensemble, Asked, {"bridge", "vehicle", "threads", "progress"}),
    ):
        arguments = signature(function).parameters
        own = {each.name: each.default for each in fields(settings)}
        assert arguments.keys() == own.keys() | others
        for name, default in own.items():
            assert arguments[name].default in (default, Parameter.empty)
