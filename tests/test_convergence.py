"""What `Run.check` tells of a crossing: errors by step, modes and stations, as they are."""

from __future__ import annotations

import pickle
import re
import warnings
from functools import cache
from typing import Any, Final

import numpy as np
import pytest

import spanwise as sw
from spanwise.convergence import Convergence

TRUCK = sw.vehicles.kishan_1973()
SPANS: Final = [18.288, 18.288]
#: Responses of which many places along the bridge are looked at.
FORCES: Final = ("deflection", "moment", "shear", "reactions")


def bridge(stations: int = 6) -> sw.Bridge:
    return sw.Bridge(spans=SPANS, EI=1.94148e9, mass=6037.7, stations_per_span=stations)


def crossed(beam: sw.Bridge | None = None, vehicle: Any = TRUCK, **given: Any) -> sw.Run:
    given = {"speed": 22.86, "modes": 3, "damping": 0.02, **given}
    return sw.cross(beam or bridge(), vehicle, **given)


@cache
def usual() -> tuple[sw.Run, Convergence]:
    run = crossed(vehicle=sw.vehicles.half_car(), road=sw.ISO8608("B", seed=2), approach=20.0)
    return run, run.check()


def off(coarse: sw.Run, fine: sw.Run, name: str) -> float:
    """Largest difference of the extremes along the bridge, in parts of the largest value."""
    both = (run.envelope(name) for run in (coarse, fine))
    a, b = (np.concatenate([each.max.value, each.min.value]) for each in both)
    return float(np.abs(a - b).max() / np.abs(b).max())


def test_errors_are_those_against_far_finer_ones() -> None:
    run, found = usual()
    given: dict[str, Any] = {
        **{"vehicle": run.truck, "road": run.road, "approach": 20.0},
        **{"sections": run.sections, "tail": run.tail},
    }
    step: Any = run.settings["step"]
    for source, finer, coarse in (
        ("step", crossed(**given, step=step / 8.0), run),
        ("modes", crossed(**given, modes=12, step=step / 4.0), crossed(**given, step=step / 4.0)),
        ("stations", crossed(bridge(48), **given, step=step), run),
    ):
        estimated = getattr(found, source)
        assert {*estimated} == {each.name for each in run.responses if each.axis != "clamp"}
        # A peak of one axle between the ends of steps of either length is not seen.
        for name, least in (*((each, 0.7) for each in FORCES), ("axle_loads", 0.3)):
            true = off(coarse, finer, name)
            assert least * true - 1e-5 <= estimated[name] <= 2.0 * true, (source, name, true)


def test_the_default_step_keeps_the_promise_and_a_long_one_breaks_it() -> None:
    run, found = usual()
    assert found.kept
    assert found.accuracy == run.settings["accuracy"] == 1e-3
    assert max(found.step[name] for name in FORCES) <= 1e-3
    long = crossed(step=0.03).check(modes=False, stations=False)
    assert not long.kept
    assert max(long.step[name] for name in FORCES) > 1e-2
    assert long.sources["moment"] == "step"
    assert "the step does not keep the accuracy, 1e-3" in long.summary()
    # What is promised is what was asked for.
    assert crossed(step=0.03, accuracy=0.1).check(modes=False, stations=False).kept


def test_deck_motion_has_no_part_in_the_promise() -> None:
    _, found = usual()
    assert found.step["acceleration"] > found.accuracy
    assert found.kept


def test_modes_matter_to_shears_by_superposition_and_hardly_by_force_summation() -> None:
    summed = crossed().check(stations=False)
    superposed = crossed(recovery="superposition").check(stations=False)
    assert superposed.modes["shear"] > 0.1
    assert summed.modes["shear"] < 0.1 * superposed.modes["shear"]
    assert superposed.sources["shear"] == "modes"


def test_errors_add_up_to_those_of_what_makes_most_of_them() -> None:
    _, found = usual()
    for name, error in found.errors.items():
        each = {source: getattr(found, source)[name] for source in ("step", "modes", "stations")}
        assert error == pytest.approx(sum(each.values()))
        assert each[found.sources[name]] == max(each.values())


def test_what_makes_no_error_has_no_source() -> None:
    found = crossed(vehicle=sw.vehicles.hs20()).check()
    assert found.sources["axle_loads"] == ""
    assert found.errors["axle_loads"] == pytest.approx(0.0, abs=1e-12)


def given_by_modes() -> sw.Bridge:
    beam = bridge()
    path, middle = beam.nodes.tolist(), [beam.stations[2]]
    return sw.Bridge.from_modes(
        path=path,
        frequencies=beam.modes(5).frequencies.tolist(),
        shapes=beam.mode_shapes(5, path),
        sections=middle,
        influence={"deflection": beam.deflections(path, middle).T},
    )


def given_by_flexibility() -> sw.Bridge:
    beam = sw.Bridge(spans=[20.0], EI=2e9, mass=5e3, stations_per_span=5)
    at, flexibility = beam.flexibility()
    return sw.Bridge.from_flexibility(
        length=20.0,
        supports=[(0.0, "pinned"), (20.0, "pinned")],
        stations=at.tolist(),
        masses=beam.masses.tolist(),
        flexibility=flexibility,
    )


LUMPED = sw.Bridge(spans=[20.0], EI=2e9, mass=5e3, stations=[4.0, 9.0, 12.0, 17.0])


@pytest.mark.parametrize(
    ("beam", "given", "why"),
    [
        (given_by_modes(), {}, "stations  not compared: the bridge was given by its"),
        (given_by_flexibility(), {}, "stations  not compared: the bridge was given by its"),
        (LUMPED, {}, "stations  not compared: the masses of the bridge were placed one by one"),
        (bridge(3), {"damping": 4e4 * np.eye(6)}, "stations  not compared: the damping matrix"),
        (bridge(3), {"modes": 6}, "modes     not compared: all 6 that the bridge has"),
        (
            bridge(),
            {"damping": sw.Rayleigh(0.0, 0.015)},
            r"modes     not compared: damping = .* of critical in mode 5",
        ),
    ],
)
def test_what_cannot_be_finer_is_told(beam: sw.Bridge, given: dict[str, Any], why: str) -> None:
    found = crossed(beam, **given).check()
    source = why.split()[0]
    assert getattr(found, source) == {}
    other = "modes" if source == "stations" else "stations"
    assert getattr(found, other)
    (told,) = (each for each in found.compared if each.startswith(source))
    assert re.match(why, told)
    assert source not in found.sources.values()


def test_not_asked_for() -> None:
    found = crossed().check(modes=False, stations=False)
    assert (found.modes, found.stations, len(found.compared)) == ({}, {}, 1)
    assert found.errors == found.step
    run = usual()[0]
    with pytest.raises(ValueError, match="modes = 6: must be true or false"):
        run.check(modes=6)  # type: ignore[arg-type]


FASTER = sw.Speeds(times=[0.0, 9.0], speeds=[20.0, 25.0])
STOPS = sw.Braking(deceleration=4.0, start=2.0)
TRAFFIC = [
    sw.Passage(vehicle=sw.vehicles.half_car(), speed=20.0, road=sw.ISO8608("A", seed=1)),
    sw.Passage(vehicle=TRUCK, direction="left", lane=2, entry=0.3),
]


@pytest.mark.parametrize(
    ("vehicle", "given"),
    [
        (TRAFFIC, {"damping": [0.02, 0.02, 0.03]}),
        (TRUCK, {"drive": STOPS, "speed": 12.0}),
        (TRUCK, {"drive": "constant-traction", "tail": 0.7, "sections": [9.144]}),
        # Of more modes this step would not be stable.
        (TRUCK, {"step": 0.02, "road": sw.Bump(5.0, 1.0, 0.02), "approach": 5.0}),
        (sw.MovingMasses(masses=[8e3, 9e3], spacings=[4.0]), {"beta": 0.25}),
        (sw.vehicles.hs20(), {"drive": FASTER, "speed": None}),
    ],
)
def test_all_kinds_of_crossings(vehicle: Any, given: dict[str, Any]) -> None:
    """Without a warning: what there is to say was said of the run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = crossed(vehicle=vehicle, **given)
    found = run.check()
    assert min(map(len, (found.step, found.modes, found.stations))) >= 8
    assert all(np.isfinite(each) for each in found.errors.values())
    assert len(found.compared) == 3
    # Modes that have no ratio are damped, and all see the same bridge.
    assert max(found.modes[name] for name in ("deflection", "axle_loads")) < 0.1


def test_a_sample_of_an_ensemble_and_a_run_from_elsewhere() -> None:
    many = sw.ensemble(
        bridge(3), TRUCK, samples=2, speed=20.0, damping=0.02, road=sw.ISO8608("B"), approach=20.0
    )
    run = many.run(1)
    found = run.check()
    assert found.kept
    assert pickle.loads(pickle.dumps(run)).check() == found
    assert pickle.loads(pickle.dumps(found)) == found


def test_it_is_shown() -> None:
    run, found = usual()
    lines = found.summary().splitlines()
    step: Any = run.settings["step"]
    assert lines[0] == f"step      {step:.4g} s, against half of it"
    assert lines[1:3] == ["modes     3, against 6", "stations  12, against 24"]
    (shear,) = (each.split() for each in lines if each.startswith("shear"))
    numbers = (found.step, found.modes, found.stations, found.errors)
    assert shear[1:5] == [f"{1e3 * each['shear']:.3f}" for each in numbers]
    assert shear[5] == found.sources["shear"]
    assert "the step keeps the accuracy, 1e-3" in lines[-1]
    assert "<td>shear</td>" in found._repr_html_()
    assert repr(found).startswith("Convergence(acceleration off by ")
    assert "accuracy 0.001 kept by the step" in repr(found)
