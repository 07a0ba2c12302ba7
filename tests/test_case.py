"""Case files: what they may hold, what they make, and what is said of those that cannot be used."""

from __future__ import annotations

import inspect
import json
import os
from pathlib import Path

import numpy as np
import pytest

import spanwise as sw

EXAMPLES = Path(__file__).parent.parent / "examples"
BRIDGE = """
[bridge]
spans = [18.288, 18.288]
EI = 1.9415e9
mass = 6037.6
stations_per_span = 3
"""
VEHICLE = """
[vehicle]
preset = "kishan-1973"
"""
OWN_VEHICLE = """
[vehicle]
mass = 29e3
pitch_inertia = 52e3
cg_height = 1.8

[[vehicle.axles]]
position = 2.1
tyre_stiffness = 7e6
suspension_stiffness = 4e6
friction_limit = 20e3
initial_friction = -5e3

[[vehicle.axles]]
position = -2.1
tyre_stiffness = 7e6
suspension_stiffness = 4e6
friction_limit = inf
"""
CROSSING = """
[crossing]
speed = 22.86
modes = 3
"""


def test_a_case_runs_as_the_same_arguments_do() -> None:
    case = sw.Case.parse(BRIDGE + VEHICLE + CROSSING + 'drive = "constant-traction"\n')
    bridge = sw.Bridge(spans=[18.288, 18.288], EI=1.9415e9, mass=6037.6, stations_per_span=3)
    truck = sw.vehicles.kishan_1973()
    expected = sw.cross(bridge, truck, speed=22.86, modes=3, drive="constant-traction")
    run = case.run()
    np.testing.assert_array_equal(run.moment, expected.moment)
    assert run.settings == expected.settings
    assert case.vehicle == truck
    assert case.crossing == {"speed": 22.86, "modes": 3, "drive": "constant-traction"}


def test_overrides_replace_what_the_file_says() -> None:
    case = sw.Case.parse(BRIDGE + VEHICLE + CROSSING)
    run = case.run(modes=2, sections=[9.0])
    assert len(run.frequencies) == 2
    assert run.sections.tolist() == [9.0]
    assert case.crossing["modes"] == 3


def test_a_vehicle_of_its_own() -> None:
    case = sw.Case.parse(BRIDGE + OWN_VEHICLE + CROSSING)
    front = sw.Axle(
        position=2.1,
        tyre_stiffness=7e6,
        suspension_stiffness=4e6,
        friction_limit=20e3,
        initial_friction=-5e3,
    )
    rear = sw.Axle(
        position=-2.1, tyre_stiffness=7e6, suspension_stiffness=4e6, friction_limit=float("inf")
    )
    expected = sw.Vehicle(mass=29e3, pitch_inertia=52e3, cg_height=1.8, axles=[front, rear])
    assert case.vehicle == expected


def test_a_preset_can_be_changed() -> None:
    changes = "initial_friction = [1000.0, -1000]\nmass = 30e3\n"
    vehicle = sw.Case.parse(BRIDGE + VEHICLE + changes + CROSSING).vehicle
    assert isinstance(vehicle, sw.Vehicle)
    assert [axle.initial_friction for axle in vehicle.axles] == [1000.0, -1000.0]
    assert vehicle.mass == 30e3
    assert vehicle.pitch_inertia == sw.vehicles.kishan_1973().pitch_inertia


def test_supports_and_point_masses_are_lists_of_pairs() -> None:
    bridge = """
    [bridge]
    length = 20
    supports = [[0, "clamped"], [20, "pinned"]]
    EI = [1e9]
    mass = 5e3
    stations = [5, 10, 15]
    point_masses = [[10, 250.0]]
    """
    case = sw.Case.parse(bridge + VEHICLE + CROSSING)
    assert case.bridge.supports == [(0.0, "clamped"), (20.0, "pinned")]
    assert case.bridge.masses.tolist() == [37500.0, 25250.0, 37500.0]


def test_every_argument_is_a_key() -> None:
    # The settings of a run with every argument of `cross`, as the signature lists them.
    given = {
        "speed": "20.0",
        "modes": "2",
        "drive": '"constant-traction"',
        "damping": "[0.01, 0.02]",
        "approach": "5.0",
        "ramp": "2.0",
        "tail": "0.1",
        "sections": "[9.0, 18.0]",
        "recovery": '"superposition"',
        "accuracy": "1e-4",
        "step": "0.001",
        "beta": "0.25",
        "gravity": "9.8",
        "lift_off": "false",
        "mask": "0.1",
    }
    arguments = list(inspect.signature(sw.cross).parameters)[2:]
    arguments.remove("road")  # has a table of its own
    assert list(given) == arguments
    text = "[crossing]\n" + "\n".join(f"{key} = {value}" for key, value in given.items())
    run = sw.Case.parse(BRIDGE + VEHICLE + text).run()
    assert run.settings["mask"] == 0.1
    assert run.settings["damping"] == [0.01, 0.02]
    assert run.sections.tolist() == [9.0, 18.0]


TRAFFIC = """
[[traffic]]
vehicle = { preset = "half-car", cg_height = 1.2 }
speed = 15.0
drive = { kind = "acceleration", acceleration = 0.5 }

[[traffic]]
direction = "left"
entry = 0.5
lane = 3
road = { kind = "bump", at = 10.0, length = 2.0, height = 0.01 }

[traffic.vehicle]
loads = [60e3, 90e3]
spacings = [4.0]
"""
ROAD = """
[road]
kind = "iso-8608"
class = "B"
seed = 7
"""


def test_traffic_on_a_road() -> None:
    case = sw.Case.parse(BRIDGE + TRAFFIC + ROAD + CROSSING)
    drive = sw.Acceleration(acceleration=0.5)
    expected = (
        sw.Passage(vehicle=sw.vehicles.half_car(cg_height=1.2), speed=15.0, drive=drive),
        sw.Passage(
            vehicle=sw.ForceTrain(loads=[60e3, 90e3], spacings=[4.0]),
            direction="left",
            entry=0.5,
            lane=3,
            road=sw.Bump(10.0, 2.0, 0.01),
        ),
    )
    assert case.passages == expected
    assert case.road == sw.ISO8608("B", seed=7)
    run = case.run()
    same = sw.cross(case.bridge, expected, speed=22.86, modes=3, road=case.road)
    np.testing.assert_array_equal(run.moment, same.moment)
    assert run.road == case.road
    assert case.run(road=sw.Smooth()).road == sw.Smooth()


def test_a_road_of_several_parts() -> None:
    step = '[[road]]\nkind = "step"\nat = 0.0\nheight = 0.005\n'
    case = sw.Case.parse(BRIDGE + VEHICLE + ROAD.replace("[road]", "[[road]]") + step + CROSSING)
    assert case.road == sw.ISO8608("B", seed=7) + sw.Step(0.0, 0.005)


@pytest.mark.parametrize(
    ("drive", "expected"),
    [
        (
            '{ kind = "braking", deceleration = 4.0, start = 5.0 }',
            sw.Braking(deceleration=4.0, start=5.0),
        ),
        (
            '{ kind = "speeds", times = [0.0, 2.0], speeds = [20.0, 15.0] }',
            sw.Speeds(times=[0.0, 2.0], speeds=[20.0, 15.0]),
        ),
        ('{ kind = "acceleration", acceleration = -1 }', sw.Acceleration(acceleration=-1.0)),
    ],
)
def test_drives_with_numbers(drive: str, expected: sw.Braking | sw.Speeds) -> None:
    timed = isinstance(expected, sw.Speeds)
    crossing = CROSSING.replace("speed = 22.86\n", "") if timed else CROSSING
    run = sw.Case.parse(BRIDGE + VEHICLE + crossing + f"drive = {drive}\n").run()
    speed = None if timed else 22.86
    same = sw.cross(run.bridge, run.truck, speed=speed, modes=3, drive=expected)
    np.testing.assert_array_equal(run.moment, same.moment)


def test_what_vehicles_do_to_each_other_is_told_of_their_tables() -> None:
    tables = 2 * '[[traffic]]\nvehicle = { preset = "kishan-1973" }\n'
    case = sw.Case.parse(BRIDGE + tables + CROSSING)
    said = r"^case: \[\[traffic\]\] number 1 and \[\[traffic\]\] number 2, lane = 0: they overlap"
    with pytest.raises(ValueError, match=said):
        case.run()


def test_a_measured_road_is_looked_for_beside_the_case(tmp_path: Path) -> None:
    x = np.arange(-40.0, 45.0, 0.5)
    points = "\n".join(f"{a!r},{b!r}" for a, b in zip(x.tolist(), np.sin(x).tolist(), strict=True))
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "profile.csv").write_text(points, encoding="utf-8")
    path = tmp_path / "case.toml"
    road = '[road]\nkind = "profile"\nfile = "data/profile.csv"\nscale = [1.0, 0.01]\n'
    path.write_text(BRIDGE + VEHICLE + road + CROSSING + "approach = 30.0\n", encoding="utf-8")
    case = sw.Case.read(path)
    assert case.road == sw.Profile(x, 0.01 * np.sin(x))
    # The report holds the points: it needs no file.
    settings = json.loads(json.dumps(case.run().to_dict()["settings"]))
    np.testing.assert_array_equal(sw.Case.from_dict(settings).run().moment, case.run().moment)
    assert sw.Case.parse(path.read_text(), folder=tmp_path).road == case.road
    path.write_text(path.read_text().replace("profile.csv", "profil.csv"), encoding="utf-8")
    with pytest.raises(FileNotFoundError, match=r"data.profil\.csv"):
        sw.Case.read(path)


def test_read_names_the_file_in_errors(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(BRIDGE.replace("6037.6", "-1") + VEHICLE + CROSSING, encoding="utf-8")
    with pytest.raises(ValueError, match=r"case\.toml, \[bridge\]: mass.* = -1: must be") as caught:
        sw.Case.read(path)
    assert str(path) in str(caught.value)


def test_a_byte_order_mark_does_no_harm(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text("\ufeff" + BRIDGE + VEHICLE + CROSSING, encoding="utf-8")
    assert sw.Case.read(str(path)).crossing["modes"] == 3


def test_a_vehicle_of_several_bodies() -> None:
    def axle(position: float, **more: float) -> sw.Axle:
        return sw.Axle(position=position, tyre_stiffness=3.5e6, suspension_stiffness=1e6, **more)

    tractor = sw.Body(mass=4500, pitch_inertia=4604, axles=[axle(0.5), axle(-2.5, mass=1100)])
    trailer = sw.Body(
        mass=31450,
        pitch_inertia=16302,
        axles=[axle(-2.9)],
        hinge=sw.Hinge(to=0, at=-2.15, own=6.15),
    )
    cab = sw.Body(
        mass=500,
        pitch_inertia=300,
        springs=[sw.Spring(to=0, at=x, own=x, stiffness=2e5, damping=3e3) for x in (0.8, -0.6)],
    )
    expected = sw.Vehicle(bodies=[tractor, trailer, cab])
    assert sw.Case.parse(BRIDGE + SEVERAL + CROSSING).vehicle == expected


def test_trains() -> None:
    forces = "[vehicle]\nloads = [1e5, 2e5]\nspacings = [4]\n"
    masses = "[vehicle]\nmasses = [1e4, 2e4]\npositions = [1, -3]\n"
    assert sw.Case.parse(BRIDGE + forces + CROSSING).vehicle == sw.ForceTrain(
        loads=[1e5, 2e5], spacings=[4.0]
    )
    assert sw.Case.parse(BRIDGE + masses + CROSSING).vehicle == sw.MovingMasses(
        masses=[1e4, 2e4], positions=[1.0, -3.0]
    )
    hs20 = '[vehicle]\npreset = "hs20"\nrear_spacing = 9.0\n'
    expected = sw.vehicles.hs20(rear_spacing=9.0)
    assert sw.Case.parse(BRIDGE + hs20 + CROSSING).vehicle == expected


SEVERAL = """
[[vehicle.bodies]]
mass = 4500
pitch_inertia = 4604
[[vehicle.bodies.axles]]
position = 0.5
tyre_stiffness = 3.5e6
suspension_stiffness = 1e6
[[vehicle.bodies.axles]]
position = -2.5
mass = 1100
tyre_stiffness = 3.5e6
suspension_stiffness = 1e6
[[vehicle.bodies]]
mass = 31450
pitch_inertia = 16302
[[vehicle.bodies.axles]]
position = -2.9
tyre_stiffness = 3.5e6
suspension_stiffness = 1e6
[vehicle.bodies.hinge]
to = 0
at = -2.15
own = 6.15
[[vehicle.bodies]]
mass = 500
pitch_inertia = 300
[[vehicle.bodies.springs]]
to = 0
at = 0.8
own = 0.8
stiffness = 2e5
damping = 3e3
[[vehicle.bodies.springs]]
to = 0
at = -0.6
own = -0.6
stiffness = 2e5
damping = 3e3
"""

KNOWN = r"allowed: bridge, vehicle, road, crossing, ensemble, traffic, events"
REFUSED = [
    # Tables
    ("", r"case: missing \[bridge\], \[vehicle\], \[crossing\]"),
    (BRIDGE + CROSSING, r"case: missing \[vehicle\]"),
    (BRIDGE.replace("bridge", "bridges"), rf"'bridges' \(did you mean 'bridge'\?\); {KNOWN}"),
    ("speed = 20\n" + BRIDGE, rf"'speed' \(belongs in \[crossing\]\); {KNOWN}"),
    ("mass = 20\n" + BRIDGE, rf"'mass' \(belongs in \[bridge\], \[vehicle\]\); {KNOWN}"),
    ("bridge = 3\n", r"bridge = 3: must be a table, \[bridge\]"),
    (BRIDGE.replace("[bridge]", "[[bridge]]"), r"bridge = \[\{'spans'.*: must be a table"),
    # Bridge
    (
        BRIDGE + "ei = 2e9" + VEHICLE + CROSSING,
        r"case, \[bridge\]: unknown key 'ei' \(did you mean 'EI'\?\); allowed: spans, ends, ",
    ),
    (
        BRIDGE.replace("stations_per_span", "stations-per-span") + VEHICLE + CROSSING,
        r"'stations-per-span' \(did you mean 'stations_per_span'\?\)",
    ),
    (BRIDGE + "preset = 1" + VEHICLE + CROSSING, r"'preset' \(belongs in \[vehicle\]\)"),
    (BRIDGE + "xyz = 1" + VEHICLE + CROSSING, r"unknown key 'xyz'; allowed: spans"),
    ("[bridge]\nspans = [9]\n" + VEHICLE + CROSSING, r"\[bridge\]: missing EI, mass"),
    (
        "[bridge]\nEI = 1\nmass = 1\n" + VEHICLE + CROSSING,
        r"\[bridge\]: .* either spans, or length",
    ),
    (BRIDGE.replace("6037.6", "'6037'") + VEHICLE + CROSSING, r"mass = '6037': must be a number"),
    # Vehicle
    (
        BRIDGE + VEHICLE.replace("-1973", "1973") + CROSSING,
        r"\[vehicle\]: preset = 'kishan1973': .* of kishan-1973, .*\(did you mean 'kishan-1973'",
    ),
    (BRIDGE + "[vehicle]\npreset = 3" + CROSSING, r"preset = 3: must be one of kishan-1973"),
    (BRIDGE + "[vehicle]\npreset = []" + CROSSING, r"preset = \[\]: must be one of"),
    (BRIDGE + "[vehicle]\nprest = 'a'" + CROSSING, r"'prest' \(did you mean 'preset'\?\)"),
    (
        BRIDGE + "[vehicle]" + CROSSING,
        r"missing mass, axles; or give preset, bodies, loads, masses",
    ),
    (
        BRIDGE + OWN_VEHICLE.replace("pitch_inertia = 52e3", "") + CROSSING,
        r"\[vehicle\]: pitch_inertia = None: must be a number, for the body pitches",
    ),
    (
        BRIDGE + "[vehicle]\npreset = 'cl-625'\nmass = 2" + CROSSING,
        r"'mass' \(not beside this preset\); allowed: preset",
    ),
    (
        BRIDGE + "[vehicle]\npreset = 'articulated-5-axle'\nmass = 2" + CROSSING,
        r"'mass' \(not beside this preset\); allowed: preset, cg_heights, hinge_height, "
        "initial_friction",
    ),
    (
        BRIDGE + "[vehicle]\npreset = 'hs20'\nrear_spacing = 10.0" + CROSSING,
        r"rear_spacing = 10 m: must be 4\.2672 to 9\.144 m",
    ),
    (
        BRIDGE + "[vehicle]\npreset = 'hs20'\nrearspacing = 5.0" + CROSSING,
        r"'rearspacing' \(did you mean 'rear_spacing'\?\)",
    ),
    (
        BRIDGE + "[vehicle]\nloads = [1e4]\nmass = 1e3" + CROSSING,
        r"mass = 1000\.0: not used with loads; allowed: loads, positions, spacings",
    ),
    (
        BRIDGE + "[vehicle]\nloads = [1e4, 1e4]" + CROSSING,
        r"missing spacings, one less than the 2 loads, or positions",
    ),
    (BRIDGE + "[vehicle]\nbodies = 3" + CROSSING, r"bodies = 3: .*\[\[vehicle\.bodies\]\]"),
    (
        BRIDGE
        + SEVERAL.replace("pitch_inertia = 4604", "pitch_inertia = 4604\nmas = 1")
        + CROSSING,
        r"bodies\[0\]: unknown key 'mas' \(did you mean 'mass'\?\); allowed: mass, pitch_in",
    ),
    (
        BRIDGE + SEVERAL.replace("own = 6.15", "own = 6.15\nhight = 1") + CROSSING,
        r"bodies\[1\]\.hinge: unknown key 'hight' \(did you mean 'height'\?\); allowed: to, at",
    ),
    (
        BRIDGE + SEVERAL.replace("position = -2.5", "positon = -2.5") + CROSSING,
        r"bodies\[0\]\.axles\[1\]: unknown key 'positon' \(did you mean 'position'\?\)",
    ),
    (
        BRIDGE + SEVERAL.replace("to = 0", "to = 1") + CROSSING,
        r"\[vehicle\]: bodies\[1\]\.hinge\.to = 1: must be an earlier body: 0",
    ),
    (
        BRIDGE + SEVERAL.replace("[vehicle.bodies.hinge]", "[[vehicle.bodies.hinge]]") + CROSSING,
        r"bodies\[1\]\.hinge = \[.*must be a table, \[vehicle\.bodies\.hinge\]",
    ),
    (BRIDGE + VEHICLE + "axles = []" + CROSSING, r"'axles' \(not beside this preset\)"),
    (
        BRIDGE + VEHICLE + "initial_friction = [1.0]" + CROSSING,
        r"initial_friction = \(1\.0,\): give one force for each of the 2 axles",
    ),
    (
        BRIDGE + VEHICLE + "initial_friction = [1e9, 0.0]" + CROSSING,
        r"axles\[0\]\.initial_friction = 1000000000 N: must lie within the friction limit",
    ),
    (
        BRIDGE + "[vehicle]\nmass=1\npitch_inertia=1\naxles=[1]" + CROSSING,
        r"axles\[0\] = 1: .*table",
    ),
    (
        BRIDGE + "[vehicle]\nmass=1\npitch_inertia=1\naxles=1" + CROSSING,
        r"axles = 1: .* tables, \[\[",
    ),
    (
        BRIDGE + OWN_VEHICLE.replace("tyre_s", "tire_s") + CROSSING,
        r"axles\[0\]: unknown key 'tire_stiffness' \(did you mean 'tyre_stiffness'\?\); allowed: ",
    ),
    (
        BRIDGE + OWN_VEHICLE.replace("position = -2.1", "") + CROSSING,
        r"\[vehicle\]: axles\[1\]: missing position",
    ),
    (
        BRIDGE + "[vehicle]\nmass = 1\nfriction_limit = 2" + CROSSING,
        r"'friction_limit' \(belongs in each \[\[vehicle\.axles\]\]\)",
    ),
    # Crossing
    (
        BRIDGE + VEHICLE + CROSSING + "sped = 1",
        r"'sped' \(did you mean 'speed'\?\); allowed: modes, drive, ",
    ),
    (BRIDGE + VEHICLE + CROSSING + "DRIVE = 1", r"'DRIVE' \(did you mean 'drive'\?\)"),
    (BRIDGE + VEHICLE + CROSSING + "EI = 1", r"unknown key 'EI' \(belongs in \[bridge\]\)"),
    (
        BRIDGE + VEHICLE + CROSSING + "bridge = 1",
        r"'bridge' \(a table of its own, \[bridge\]\); allowed: modes",
    ),
    # Traffic
    (
        BRIDGE + VEHICLE + TRAFFIC + CROSSING,
        r"\[vehicle\] and \[\[traffic\]\]: give one of the two",
    ),
    (BRIDGE + "[traffic]\nspeed = 1" + CROSSING, r"traffic = .*: must be tables, \[\[traffic\]\]"),
    (
        BRIDGE + "[[traffic]]\nspeed = 1" + CROSSING,
        r"case, \[\[traffic\]\] number 1: missing vehicle",
    ),
    (
        BRIDGE + TRAFFIC.replace("lane", "lanes") + CROSSING,
        r"\[\[traffic\]\] number 2: unknown key 'lanes' \(did you mean 'lane'\?\); allowed: ",
    ),
    (
        BRIDGE + TRAFFIC.replace("acceleration = 0.5", "acceleration = nan") + CROSSING,
        r"case, \[\[traffic\]\] number 1: drive: acceleration = NaN: must be a finite number",
    ),
    (
        BRIDGE + TRAFFIC.replace('direction = "left"', 'direction = "west"') + CROSSING,
        r"case, \[\[traffic\]\] number 2: direction = 'west': must be right or left",
    ),
    (
        BRIDGE + TRAFFIC.replace("lane = 3", "lane = 3.5") + CROSSING,
        r"\[\[traffic\]\] number 2: lane = 3\.5: ",
    ),
    (
        BRIDGE + TRAFFIC.replace("half-car", "half-cart") + CROSSING,
        r"\[\[traffic\]\] number 1: vehicle\.preset = 'half-cart': .*did you mean 'half-car'",
    ),
    (
        BRIDGE
        + TRAFFIC.replace('{ preset = "half-car", cg_height = 1.2 }', '"half-car"')
        + CROSSING,
        r"\[\[traffic\]\] number 1: vehicle = 'half-car': must be a table",
    ),
    (
        BRIDGE + TRAFFIC.replace("length = 2.0", "length = 0.0") + CROSSING,
        r"\[\[traffic\]\] number 2: road: .*length",
    ),
    (
        BRIDGE + TRAFFIC.replace('"acceleration"', '"accelerate"') + CROSSING,
        r"\[\[traffic\]\] number 1: drive\.kind = 'accelerate': .*did you mean 'acceleration'",
    ),
    (
        BRIDGE + TRAFFIC.replace("vehicle = { preset =", "preset = { a =", 1) + CROSSING,
        r"number 1: unknown key 'preset' \(belongs in its vehicle: vehicle = { preset = \.\.\. }\)",
    ),
    (
        BRIDGE + "[vehicle]\nload = [1e4, 1e4]\nspacings = [1.0]" + CROSSING,
        r"unknown key 'load' \(did you mean 'loads'\?\); allowed: loads, positions, spacings$",
    ),
    (BRIDGE + "[vehicle]\nmas = 1e4\naxles = []" + CROSSING, r"'mas' \(did you mean 'mass'\?\)"),
    (BRIDGE + VEHICLE + "lane = 1" + CROSSING, r"'lane' \(belongs in each \[\[traffic\]\]\)"),
    (BRIDGE + VEHICLE + CROSSING + "entry = 1", r"'entry' \(belongs in each \[\[traffic\]\]\)"),
    # Road
    (BRIDGE + VEHICLE + CROSSING + "road = 1", r"'road' \(a table of its own, \[road\]\); allowed"),
    (
        BRIDGE + VEHICLE + CROSSING + ROAD.replace("seed", "sed"),
        r"case, \[road\]: unknown key 'sed' \(did you mean 'seed'\?\); allowed: kind, class, G, ",
    ),
    (
        BRIDGE + VEHICLE + CROSSING + ROAD + "speed = 3",
        r"\[road\]: unknown key 'speed' \(belongs in \[crossing\]\)",
    ),
    (
        BRIDGE + VEHICLE + CROSSING + ROAD.replace('"B"', '"Q"'),
        r"\[road\]: class = 'Q': must be one of A, B",
    ),
    (
        BRIDGE + VEHICLE + CROSSING + ROAD.replace("[road]", "[[road]]") + "[[road]]\nat = 1",
        r"\[road\]: road\[1\]: missing kind; allowed: iso-8608",
    ),
    (BRIDGE + VEHICLE + CROSSING + "contact_patch = 1", r"'contact_patch' \(belongs in \[road\]\)"),
    (BRIDGE + VEHICLE + CROSSING + "deceleration = 1", r"'deceleration' \(belongs in a drive\)"),
    # TOML
    (BRIDGE + "mass = 3", r"case, line 7: is not valid TOML: .*: mass = 3"),
    ("[bridge]\nEI = 3e9 N m2\n", r"case, line 2: is not valid TOML: .*: EI = 3e9 N m2"),
    ("[bridge]\nspans = [18., 18.]", r"line 2: .*digits on both sides of a point: 22\.0"),
    ("[bridge]\nmass = .5", r"line 2: .*digits on both sides of a point: 22\.0"),
    ("a = " + 100_000 * "[", "is not valid TOML"),
    ("a = " + 5_000 * "1", "is not valid TOML"),
    ("a = \x00\x1b[31m", r"line 1: is not valid TOML: .*: a = \?\?\[31m"),
]


@pytest.mark.parametrize(("text", "message"), REFUSED, ids=[message for _, message in REFUSED])
def test_what_cannot_be_used_is_explained(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message) as caught:
        sw.Case.parse(text)
    assert str(caught.value).startswith("case")


def test_speed_and_ranges_are_checked_when_it_runs() -> None:
    # Not before: every passage may have a speed of its own, or the command line gives it.
    case = sw.Case.parse(BRIDGE + VEHICLE + "[crossing]", source="a.toml")
    with pytest.raises(ValueError, match=r"a\.toml, \[crossing\]: speed: missing; give it here or"):
        case.run()
    assert case.run(speed=20.0).settings["speed"] == 20.0
    case = sw.Case.parse(BRIDGE + VEHICLE + CROSSING, source="a.toml")
    with pytest.raises(ValueError, match=r"a\.toml: modes = 7: must be 1 to 6"):
        case.run(modes=7)


def test_no_such_file(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nothing\.toml"):
        sw.Case.read(tmp_path / "nothing.toml")


def test_a_folder_is_no_case(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="is a folder; a case is a TOML file"):
        sw.Case.read(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_is_no_case_and_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ValueError, match="is not a regular file"):
        sw.Case.read(tmp_path / "pipe")


def test_what_is_not_text_is_no_case(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_bytes(b"[bridge]\n\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"case\.toml, line 2: is not UTF-8 text"):
        sw.Case.read(path)


def test_the_largest_case_file(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    text = BRIDGE + VEHICLE + CROSSING
    path.write_text(text + "#" * (2**20 - len(text)), encoding="utf-8")
    assert sw.Case.read(path).crossing["modes"] == 3
    with path.open("a", encoding="utf-8") as file:
        file.write("#")
    with pytest.raises(ValueError, match="is too large; a case has at most 1048576 bytes"):
        sw.Case.read(path)


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_example_files_run(path: Path) -> None:
    run = sw.Case.read(path).run(modes=2)
    assert np.isfinite(run.envelope("moment").max.value).all()
