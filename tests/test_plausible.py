"""Implausible input is noticed and never refused; what is unusual on purpose is not."""

from __future__ import annotations

import pickle
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

import spanwise as sw
from spanwise import _plausible
from spanwise._ensemble_files import as_dict
from spanwise.cli import main

EI, MASS = 4e9, 9e3
ROAD: Final = sw.ISO8608("A", seed=3)


def bridge(span: float = 20.0, **given: Any) -> sw.Bridge:
    return sw.Bridge(**{"spans": [span], "EI": EI, "mass": MASS, "stations_per_span": 5, **given})


def car(**given: Any) -> sw.Vehicle:
    axles = [
        sw.Axle(
            position=x,
            tyre_stiffness=given.pop("tyre", 2e6),
            suspension_stiffness=given.pop("suspension", 1e6),
        )
        for x in (2.0, -2.0)
    ]
    return sw.Vehicle(**{"mass": 16e3, "pitch_inertia": 4e4, "axles": axles, **given})


def soft(key: str) -> sw.Vehicle:
    stiffness = {"tyre_stiffness": 2e6, "suspension_stiffness": 1e6}
    stiffness[key] /= 1e3
    axles = [sw.Axle(position=x, **stiffness) for x in (2.0, -2.0)]
    return sw.Vehicle(mass=16e3, pitch_inertia=4e4, axles=axles)


def forces(*loads: float, spacing: float = 3.0) -> sw.ForceTrain:
    return sw.ForceTrain(loads=list(loads), spacings=[spacing] * (len(loads) - 1))


def cross(of: sw.Bridge, vehicle: Any, speed: float | None = 20.0, **given: Any) -> object:
    return sw.cross(of, vehicle, speed=speed, **{"modes": 2, "damping": 0.01, **given})


def ensemble(of: sw.Bridge, vehicle: Any, speed: Any = 20.0, **given: Any) -> object:
    options = {"samples": 2, "modes": 2, "damping": 0.01, **given}
    return sw.ensemble(of, vehicle, speed=speed, **options)


def profile(spacing: float, x: float = 1.0, z: float = 1.0) -> sw.Profile:
    at = np.arange(-130.0, 170.0, spacing)
    return sw.Profile(x * at, z * ROAD.elevation(at), max_gap=1e3)


DOUBTED: Final[list[tuple[Callable[[Any], object], str]]] = [
    (lambda go: go(bridge(EI=EI / 1e3), car()), r"^EI, mass: .*kN m2"),
    (
        lambda go: go(bridge(span=2e4), car(), 1e4, step=0.05, beta=0.25, lift_off=False),
        r"^spans: the longest is 20000 m.*in mm instead of m",
    ),
    (lambda go: go(bridge(EI=EI / 1e6), car(), lift_off=False), r"^EI, mass: .*MPa"),
    (lambda go: go(bridge(EI=EI * 1e6), car(), accuracy=0.1), r"^EI, mass: .*N mm2"),
    (lambda go: go(bridge(mass=MASS / 1e3), car()), r"^EI, mass: .*t/m"),
    (lambda go: go(bridge(mass=MASS * 200.0), car()), r"^EI, mass: .*instead of kg/m"),
    (lambda go: go(bridge(), forces(1e8, 1e8)), r"^loads, EI: .*by about .* m; are loads in N"),
    (lambda go: go(bridge(), forces(90.0, 90.0)), r"^loads: .*90 N.*kN"),
    (lambda go: go(bridge(), forces(250.0, 225.0)), r"^loads: .*250 N.*kN"),
    (lambda go: go(bridge(), forces(100.0, 100.0)), r"^loads: .*100 N.*kN"),
    (lambda go: go(bridge(), forces(10.0)), r"^loads: .*10 N.*kN"),
    (
        lambda go: go(bridge(), car(), damping=0.2),
        r"^damping = 0\.2: is 20 % of critical.*it is a ratio, 0\.02 for 2 %$",
    ),
    (lambda go: go(bridge(), car(), damping=[0.02, 0.15]), r"^damping = 0\.15: is 15 %"),
    (
        lambda go: go(bridge(), car(), damping=sw.Rayleigh.from_ratios((1.0, 0.3), (9.0, 0.3))),
        r"^damping = 0\.\d+: is \d",
    ),
    (lambda go: go(bridge(), car(mass=16.0, pitch_inertia=40.0)), r"^loads: .*masses in t"),
    (lambda go: go(bridge(), soft("tyre_stiffness")), r"^tyre_stiffness: .*kN/m"),
    (lambda go: go(bridge(), soft("suspension_stiffness")), r"^suspension_stiffness: .*kN/m"),
    (lambda go: go(bridge(), car(), 80.0), r"^speed = 80: .*288 km/h; if 80 km/h .* write 22\.22"),
    (lambda go: go(bridge(), forces(9e4, 9e4), 90.0), r"^speed = 90: .*write 25$"),
    (lambda go: go(bridge(), forces(*[2e5] * 16), 300.0), r"^speed = 300: .*write 83\.33"),
    (lambda go: go(bridge(), forces(*[2.25e5] * 16), 100.0), r"^speed = 100: .*write 27\.78"),
    (
        lambda go: go(bridge(), sw.Passage(vehicle=car(), speed=100.0), None),
        r"^speed = 100: .*write 27\.78",
    ),
    (
        lambda go: go(
            bridge(),
            car(cg_height=1.2),
            None,
            drive=sw.Speeds(times=[0.0, 9.0], speeds=[30.0, 80.0]),
        ),
        r"^speed = 80: .*write 22\.22",
    ),
    (lambda go: go(bridge(), car(), road=profile(5.0)), r"^road: .*5 m apart.*10 m.*2 Hz"),
    (
        lambda go: go(bridge(), sw.Passage(vehicle=car(), road=profile(5.0))),
        r"^road: .*5 m apart",
    ),
]


@pytest.mark.parametrize("go", [cross, ensemble])
@pytest.mark.parametrize(("call", "says"), DOUBTED, ids=[says for _, says in DOUBTED])
def test_crossings_are_doubted(
    go: Callable[..., object], call: Callable[[Any], object], says: str
) -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        call(go)
    assert {each.category for each in told} == {sw.PlausibilityWarning}
    assert len([each for each in told if re.search(says, str(each.message))]) == 1


def test_lengths_in_mm_are_doubted_before_all_that_follows_from_them() -> None:
    with (
        pytest.warns(sw.PlausibilityWarning) as told,
        pytest.raises(ValueError, match="road = path"),
    ):
        cross(bridge(span=18288.0), car(), road=sw.ISO8608("C"))
    (doubt,) = told
    assert str(doubt.message).startswith("spans: the longest is 18288 m")


def points(spacing: float = 0.25, scale: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    x = np.arange(0.0, 100.0, spacing)
    return x, scale * ROAD.elevation(x)


def dropped(code: float, at: slice) -> tuple[np.ndarray, np.ndarray]:
    x, z = points()
    z[at] = code
    return x, z


def designed(places: list[float], heights: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """A design of straight grades between some places, and level outside, by points 10 m apart."""
    x = 10.0 * np.arange(41)
    return x, np.interp(x, places, heights)


@pytest.mark.parametrize(
    "design",
    [
        designed([200.0, 400.0], [0.0, -12.0]),
        designed([100.0, 200.0], [0.0, 12.0]),
        designed([100.0, 200.0, 300.0], [0.0, 5.0, 0.0]),
        designed([200.0, 210.0], [0.0, 0.6]),
        designed([0.0, 10.0], [0.6, 0.0]),
        designed([390.0, 400.0], [0.0, 0.6]),
    ],
    ids=["down", "up", "a crest", "one interval", "the first interval", "the last interval"],
)
def test_breaks_of_grade_are_not_doubted(design: tuple[np.ndarray, np.ndarray]) -> None:
    sw.Profile(*design)


@pytest.mark.parametrize(
    ("made", "says"),
    [
        (points(scale=1e3), "in mm"),
        (points(scale=1e2), "in inches, cm or mm"),
        (points(scale=1.0 / 0.0254), "in inches, cm or mm"),
        (points(0.01, 1e2), "in inches, cm or mm"),
        (dropped(-9999.0, slice(7, 8)), r"elevations\[7\] = -9999: .*drop-out"),
        (dropped(-9999.0, slice(70, 90)), r"elevations\[(70|89)\] = -9999: .*drop-out"),
        (dropped(999.9, slice(0, 1)), r"elevations\[0\] = 999.9: .*drop-out"),
        (dropped(999.9, slice(399, 400)), r"elevations\[399\] = 999.9: .*drop-out"),
        (dropped(0.3, slice(50, 51)), r"elevations\[50\] = 0.3: .*drop-out"),
        (dropped(0.5, slice(50, 52)), r"elevations\[5[01]\] = 0.5: .*drop-out"),
        (designed([190.0, 200.0, 210.0], [0.0, 0.5, 0.0]), r"elevations\[20\] = 0.5: .*drop-out"),
    ],
    ids=str,
)
def test_profiles_are_doubted(made: tuple[np.ndarray, np.ndarray], says: str) -> None:
    with pytest.warns(sw.PlausibilityWarning, match=says) as told:
        sw.Profile(*made)
    assert len(told) == 1


#: Roads in other units than metres, and what is said of them.
SLIPS: Final[list[tuple[Callable[[], sw.roads.Road], str]]] = [
    (lambda: sw.ISO8608(G=64.0), r"^G = 64: in m3.*tabulates 1e-6 m3: .*meant, write 6\.4e-05$"),
    (lambda: sw.ISO8608(G=1.0), r"^G = 1: in m3.* write 1e-06$"),
    (
        lambda: sw.Bump(5.0, 1.0, 50.0),
        r"^height = 50: in m, more.*; if mm are meant, write 0\.05$",
    ),
    (lambda: sw.Bump(5e3, 1e3, -50.0), r"^height = -50: .* write -0\.05$"),
    (lambda: sw.Step(0.0, 20.0), r"^height = 20: .* write 0\.02$"),
    (lambda: sw.Pothole(0.0, 0.5, 50.0), r"^depth = 50: .* write 0\.05$"),
    (lambda: sw.Joint(0.0, 0.05, 20.0), r"^depth = 20: .* write 0\.02$"),
    (lambda: sw.Joint(0.0, 50.0, 0.02), r"^gap = 50: .* write 0\.05$"),
    (lambda: sw.Ramp(0.0, 5.0, 20.0), r"^height = 20: .* write 0\.02$"),
    (lambda: sw.Camber(0.0, 30.0, 50.0), r"^rise = 50: .* write 0\.05$"),
]


@pytest.mark.parametrize(("make", "says"), SLIPS, ids=[says for _, says in SLIPS])
def test_roads_in_other_units_are_doubted(make: Callable[[], sw.roads.Road], says: str) -> None:
    with pytest.warns(sw.PlausibilityWarning, match=says) as told:
        road = make()
    assert len(told) == 1
    assert told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sw.PlausibilityWarning)
        runs = cross(bridge(), forces(9e4), road=road), ensemble(bridge(), forces(9e4), road=road)
    said = f"road: {told[0].message}"
    assert all(each.warnings.count(said) == 1 for each in runs)  # type: ignore[attr-defined]


def test_features_of_real_roads_are_not_doubted() -> None:
    for letter in "AH":
        1.5 * sw.ISO8608(letter)
    sw.Bump(0.0, 0.5, 0.12)
    sw.Bump(0.0, 40.0, -1.2)
    sw.Step(0.0, -0.3)
    sw.Pothole(0.0, 1.5, 0.3)
    sw.Joint(0.0, 0.9, 0.4)
    sw.Ramp(-100.0, 0.0, 6.0)
    sw.Camber(0.0, 60.0, 3.0)


def test_rayleigh_may_damp_upper_modes_more_than_bridges_are() -> None:
    cross(bridge(), car(), modes=5, damping=sw.Rayleigh.from_ratios((2.6, 0.02), (10.0, 0.03)))


def test_rough_points_every_millimetre_are_not_doubted() -> None:
    """Texture of a millimetre has slopes of 1 from point to point, and a pothole is deep."""
    chance = np.random.default_rng(1)
    x = np.arange(0.0, 60.0, 1e-3)
    for letter in "ACE":
        z = sw.ISO8608(letter, seed=2).elevation(x) + 1e-3 * chance.standard_normal(len(x))
        sw.Profile(x, z)
    z[20_000:20_400] -= 0.1
    sw.Profile(x, z + 500.0 + 0.15 * x)


@pytest.mark.parametrize("preset", sorted(sw.vehicles.PRESETS))
def test_the_catalogue_is_not_doubted(preset: str) -> None:
    vehicle = sw.Case.from_dict(
        {
            "bridge": {"spans": [20.0], "EI": EI, "mass": MASS},
            "vehicle": {"preset": preset},
            "crossing": {"speed": 20.0, "damping": 0.02},
        }
    ).vehicle
    for span, rigidity, mass in ((8.0, 8e8, 6e3), (20.0, EI, MASS), (60.0, 9e10, 15e3)):
        cross(bridge(span, EI=rigidity, mass=mass), vehicle)


def test_unusual_structures_are_not_doubted() -> None:
    """Models in laboratories, footbridges, a suspension bridge, one force at any speed."""
    small = sw.Axle(position=0.0, tyre_stiffness=4e3, suspension_stiffness=2e3)
    for span, EI_, mass in (
        (1.0, 60.0, 7.9),
        (1.0, 218.0, 3.9),
        (2.0, 900.0, 12.0),
        (5.4, 1.5e5, 140.0),
    ):
        model = bridge(span, EI=EI_, mass=mass)
        cross(model, sw.Vehicle(mass=5.0, axles=[small]), 1.0)
        cross(model, forces(20.0, 20.0, spacing=0.3), 0.5)
    cross(bridge(40.0, EI=2e9, mass=800.0), forces(700.0), 1.5)
    # At 0.32 Hz a span of 20 m would be too slow, a cantilever is not.
    cross(bridge(20.0, EI=4.7e8, ends=("clamped", "free")), forces(2e4, 2e4))
    # Stiffened by cables, which a beam of the same first frequency stands for.
    cross(bridge(1000.0, EI=1e14, mass=2e4), car())
    one = sw.ForceTrain(loads=[1e5], positions=[0.0])
    for speed in (20.0, 150.0, 400.0):
        cross(bridge(), one, speed)
    cross(bridge(), sw.vehicles.quarter_car(), 100.0)
    # A load of reference, and the first harmonic of a pedestrian.
    for loads in ((1.0, 1.0), (280.0,)):
        cross(bridge(25.0, mass=2e3), forces(*loads))


def test_railways_are_not_doubted() -> None:
    wheels = [
        sw.Axle(position=x, mass=1.9e3, tyre_stiffness=1.4e9, suspension_stiffness=7e5)
        for x in (9.0, 6.5, -6.5, -9.0)
    ]
    coach = sw.Vehicle(mass=44e3, pitch_inertia=2.7e6, axles=wheels)
    cross(bridge(25.0, EI=30e9, mass=15e3), coach, 83.3, step=1e-3)
    cross(bridge(25.0, EI=30e9, mass=15e3), forces(*[1.7e5] * 40), 115.0)


def test_of_a_long_train_what_is_on_the_span_bends_it() -> None:
    """40 MN on 1200 m: all at once they would bend the span by 1.7 m."""
    train = sw.Passage(vehicle=forces(*[1e5] * 400))
    assert _plausible._deflection(train, 20.0, MASS * 20.0, 2.6, 9.81) is None
    alone = sw.Passage(vehicle=forces(2e7, 2e7))
    assert _plausible._deflection(alone, 20.0, MASS * 20.0, 2.6, 9.81) is not None


def test_a_slip_of_many_vehicles_is_told_once() -> None:
    kinds = [forces(90.0, 90.0 + k) for k in range(30)]
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        sw.ensemble(bridge(), kinds, samples=30, kind=range(30), speed=20.0, modes=2, damping=0.01)
    assert len(told) == 1
    assert told[0].filename == __file__


#: What is varied of a car, and what is said of it.
VARIED: Final[dict[str, tuple[dict[str, Any], str]]] = {
    "kN/m": ({"values": {"suspension_stiffness": 400.0}}, "^suspension_stiffness: .*kN/m"),
    "N/mm": ({"values": {"tyre_stiffness": [2e6, 2e3]}}, "^tyre_stiffness: .*kN/m"),
    "t": ({"values": {"body_mass": 16.0}}, "^loads: .*masses in t"),
    "of kinds": ({"values": {"body_mass": [16.0, 8e3]}, "kind": [0, 1]}, "^loads: .*masses in t"),
    "g": ({"factors": {"body_mass": [1.0, 1e3]}}, "^loads, EI: .*bend"),
    "of an axle": (
        {"factors": {"suspension_stiffness": [[1.0, 1.0], [1e-3, 1e-3]]}},
        "^suspension_stiffness: .*sags",
    ),
}


@pytest.mark.parametrize("name", VARIED)
def test_varied_vehicles_are_doubted(name: str) -> None:
    given, says = VARIED[name]
    vehicle = [car(), car(mass=8e3)] if "kind" in given else car()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        ensemble(bridge(), vehicle, **given)
    assert any(re.search(says, str(each.message)) for each in told)
    assert {each.category for each in told} == {sw.PlausibilityWarning}


def test_what_varies_within_reason_is_not_doubted() -> None:
    """Of vehicles that are: a light one on soft springs beside a heavy one on stiff springs."""
    spread = np.array([0.03, 1.0, 10.0])
    factors = {"body_mass": spread, "suspension_stiffness": spread, "tyre_stiffness": spread}
    ensemble(bridge(), car(), samples=3, factors=factors)
    # What is no vehicle is among the failures, not in the way.
    one = {"body_mass": [1.0, 1e305]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sw.PlausibilityWarning)
        assert len(ensemble(bridge(), car(), factors=one).failures) <= 1  # type: ignore[attr-defined]


def test_many_kinds_are_looked_at_in_no_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A profile is gone through once, and what was told once is not asked for again."""
    asked: list[str] = []

    def spied_on(module: Any, name: str) -> None:
        plain = getattr(module, name)

        def spy(*given: Any) -> Any:
            asked.append(name)
            return plain(*given)

        monkeypatch.setattr(module, name, spy)

    road = profile(0.25)
    spied_on(np, "median")
    spied_on(_plausible, "_loads")
    spied_on(_plausible, "_springs")
    kinds = [forces(90.0, 90.0 + k) for k in range(30)]
    with pytest.warns(sw.PlausibilityWarning, match="^loads"):
        ensemble(bridge(), kinds, samples=30, kind=range(30), road=road + sw.Step(5.0, 0.01))
    counts = [asked.count(each) for each in ("median", "_loads", "_springs")]
    assert counts == [1, 1, 30]


def test_one_kind_can_be_silenced_by_its_first_word() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "speed", sw.PlausibilityWarning)
        cross(bridge(), car(), 80.0)
        with pytest.raises(sw.PlausibilityWarning, match="loads"):
            cross(bridge(), forces(90.0, 90.0), 80.0)


def test_on_the_command_line(tmp_path: Any, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        "[bridge]\nspans = [20.0]\nEI = 4e9\nmass = 9e3\n"
        '[vehicle]\npreset = "kishan-1973"\n[crossing]\nspeed = 80\ndamping = 0.02\n',
        encoding="utf-8",
    )
    for command in (["cross", str(path)], ["ensemble", str(path), "--samples", "2"]):
        assert main(command) == 0
        out, err = capsys.readouterr()
        assert out.count("warning   speed = 80: m/s, which is 288 km/h") == 1
        assert err.startswith("spanwise: warning: speed = 80: m/s, which is 288 km/h")
        assert err.count("\n") == 1
        assert main([*command, "--json", "-"]) == 0
        err = capsys.readouterr().err
        assert err.startswith("spanwise: warning: speed = 80: m/s, which is 288 km/h")
        assert err.count("\n") == 1


def test_kinds_of_vehicles_have_their_speeds() -> None:
    """A lorry of any kind is doubted above 45 m/s, a car above 60, what runs on rails above 120."""
    light = car(mass=1.5e3, pitch_inertia=2e3, tyre=4e5, suspension=5e4)
    coach = forces(*[1.3e5] * 4, spacing=6.0)
    for fine in ((car(), 44.0), (light, 58.0), (coach, 83.0), (forces(1e5, *[2e4] * 9), 44.0)):
        cross(bridge(EI=4e10, mass=9e3), *fine)
    for slip in (
        *(
            (preset(), 50.0)
            for name, preset in sw.vehicles.PRESETS.items()
            if name != "quarter-car"
        ),
        (light, 65.0),
        (forces(1e5, *[2e4] * 9, spacing=2.0), 70.0),
        (coach, 130.0),
    ):
        with pytest.warns(sw.PlausibilityWarning, match=f"^speed = {slip[1]:g}: "):
            cross(bridge(EI=4e10, mass=9e3), *slip)


def test_the_speeds_of_a_kind_are_its_own() -> None:
    """A train beside lorries does not make these too fast, in any kind and order."""
    train = [sw.Passage(vehicle=forces(*[1.3e5] * 12), speed=90.0)]
    lorry = [sw.Passage(vehicle=sw.vehicles.half_car())]
    kinds = [train, lorry]
    ensemble(bridge(EI=4e10), kinds, speed=20.0, kind=[0, 1])
    with pytest.warns(sw.PlausibilityWarning, match="^speed = 90: "):
        ensemble(bridge(EI=4e10), kinds, speed=np.array([20.0, 90.0]), kind=[0, 1])
    doubted = np.array([[20.0, 20.0], [20.0, 72.0]])
    two = [sw.Passage(vehicle=sw.vehicles.half_car(), direction=way) for way in ("right", "left")]
    with pytest.warns(sw.PlausibilityWarning, match="^speed = 72: "):
        ensemble(bridge(EI=4e10), two, speed=doubted)
    # One of the kinds has fewer vehicles than there are speeds.
    ensemble(bridge(EI=4e10), [two, two[:1]], speed=np.full((2, 2), 20.0), kind=[0, 1])


def test_what_was_warned_of_stays_with_the_results(tmp_path: Path) -> None:
    at = np.arange(-130.0, 170.0, 0.25)
    with pytest.warns(sw.PlausibilityWarning, match="drop-out"):
        measured = sw.Profile(at, np.where(at == -129.0, -9.999, ROAD.elevation(at)))
    brakes = sw.Braking(deceleration=1.0, start=500.0)
    given: dict[str, Any] = {"road": measured, "drive": brakes, "lift_off": False}
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        run = cross(bridge(), car(mass=16.0, pitch_inertia=40.0), 80.0, **given)
        many = ensemble(bridge(), car(), 80.0, factors={"tyre_damping": 2.0})
    assert isinstance(run, sw.Run)
    assert isinstance(many, sw.Ensemble)
    file = tmp_path / "many.npz"
    many.to_npz(file)
    assert run.warnings[0].startswith("road: elevations[4] = -9.999: ")
    assert [*run.warnings[1:], *many.warnings] == [str(each.message) for each in told]
    assert {each.partition(":")[0] for each in run.warnings} >= {"road", "loads", "speed = 80"}
    assert any("the brakes never come on" in each for each in run.warnings)
    assert any(each.startswith("tyre_damping: ") for each in many.warnings)
    assert run.to_dict()["warnings"] == [*run.warnings]
    assert as_dict(many)["warnings"] == [*many.warnings]
    assert sw.Ensemble.read(file).warnings == many.warnings
    for each in (run, many):
        text = " ".join(line[10:] for line in each.summary().split("\n"))
        assert each.warnings
        assert all(said in text for said in each.warnings)
    with pytest.warns(sw.PlausibilityWarning, match="drop-out"):
        assert pickle.loads(pickle.dumps(run)).warnings == run.warnings


def warned_here(call: Callable[[], object]) -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        call()
    assert told
    assert {each.filename for each in told} == {__file__}


def test_warnings_point_to_the_line_of_the_caller(tmp_path: Path) -> None:
    file = tmp_path / "p.csv"
    np.savetxt(file, np.column_stack(points(scale=1e3)), delimiter=",")
    warned_here(lambda: sw.Profile.read(file))
    warned_here(lambda: sw.Profile(*points(scale=1e2)))
    warned_here(lambda: profile(0.5) * 1e3)
    warned_here(lambda: sw.roads.from_table({"kind": "profile", "file": str(file)}))
    warned_here(lambda: profile(0.5).iri(0.0, 100.0))
    case = sw.Case(bridge(), (sw.Passage(vehicle=car()),), {"speed": 80.0, "modes": 2})
    warned_here(case.run)
    warned_here(lambda: case.ensemble(samples=2))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        many = case.ensemble(samples=2)
    warned_here(lambda: many.run(0))
    warned_here(lambda: sw.cross(bridge(), car(), speed=20.0))
