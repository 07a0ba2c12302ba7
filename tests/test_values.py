"""Inputs and results pickle, copy, compare by value, and have texts that can be read."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import pytest

import spanwise as sw
from spanwise._value import brief, key, same

CASE = """
[bridge]
spans = [20.0]
EI = 2e9
mass = 6000.0
[vehicle]
preset = "kishan-1973"
[crossing]
speed = 20.0
damping = 0.02
"""


def beam(**other: Any) -> sw.Bridge:
    given: dict[str, Any] = {"spans": [20.0], "EI": 3e9, "mass": 9e3, "stations_per_span": 6}
    return sw.Bridge(**(given | other))


def given_modes() -> sw.Bridge:
    bridge = beam()
    path, at = np.linspace(0.0, 20.0, 21), [5.0, 10.0]
    return sw.Bridge.from_modes(
        path=path.tolist(),
        frequencies=bridge.modes(3).frequencies.tolist(),
        shapes=bridge.mode_shapes(3, path),
        sections=at,
        influence={"deflection": [bridge.influence_line("deflection", x, path) for x in at]},
    )


def axle(**other: Any) -> sw.Axle:
    return sw.Axle(
        **({"position": 0.0, "tyre_stiffness": 1e6, "suspension_stiffness": 4e5} | other)
    )


#: Inputs, each with what makes it, and what makes something else.
INPUTS: dict[str, tuple[Callable[[], Any], Callable[[], Any]]] = {
    "Bridge": (beam, lambda: beam(EI=3.1e9)),
    "Bridge of tables": (
        lambda: beam(EI={"at": [0.0, 20.0], "values": [2e9, 3e9]}),
        lambda: beam(EI={"at": [0.0, 20.0], "values": [2e9, 4e9]}),
    ),
    "Bridge.from_modes": (given_modes, beam),
    "Along": (
        lambda: sw.Along(at=np.array([0.0, 20.0]), values=[2e9]),  # type: ignore[arg-type]
        lambda: sw.Along(at=[0.0, 21.0], values=[2e9]),
    ),
    "Support": (lambda: sw.Support(at=3.0, vertical=1e8), lambda: sw.Support(at=3.0)),
    "Rayleigh": (lambda: sw.Rayleigh(0.1, 1e-4), lambda: sw.Rayleigh(0.1, 2e-4)),
    "Axle": (axle, lambda: axle(mass=500.0)),
    "Body": (
        lambda: sw.Body(mass=1e4, axles=[axle()] * 12),
        lambda: sw.Body(mass=1e4, axles=[axle()] * 11),
    ),
    "Vehicle": (sw.vehicles.kishan_1973, sw.vehicles.half_car),
    "ForceTrain": (
        lambda: sw.ForceTrain(loads=[1e5] * 80, spacings=[3.0] * 79),
        lambda: sw.ForceTrain(loads=[1e5] * 80, spacings=[3.1] * 79),
    ),
    "MovingMasses": (
        lambda: sw.MovingMasses(masses=[1e4] * 80, spacings=[3.0] * 79),
        lambda: sw.MovingMasses(masses=[2e4] * 80, spacings=[3.0] * 79),
    ),
    "Passage": (
        lambda: sw.Passage(vehicle=sw.vehicles.half_car(), speed=20.0, road=sw.ISO8608("B")),
        lambda: sw.Passage(vehicle=sw.vehicles.half_car(), speed=21.0, road=sw.ISO8608("B")),
    ),
    "Speeds": (
        lambda: sw.Speeds(times=np.arange(500.0), speeds=np.ones(500)),  # type: ignore[arg-type]
        lambda: sw.Speeds(times=[0.0], speeds=[1.0]),
    ),
    "Braking": (lambda: sw.Braking(deceleration=4.0), lambda: sw.Braking(deceleration=5.0)),
    "Acceleration": (
        lambda: sw.Acceleration(acceleration=1.0),
        lambda: sw.Acceleration(acceleration=-1.0),
    ),
    "ISO8608": (lambda: sw.ISO8608("B", seed=3), lambda: sw.ISO8608("B", seed=4)),
    "Profile": (
        lambda: sw.Profile(np.arange(200.0), np.zeros(200)),
        lambda: sw.Profile(np.arange(200.0), np.ones(200)),
    ),
    "Sum": (
        lambda: sum((sw.Bump(float(k), 0.5, 0.01) for k in range(50)), sw.Smooth()),
        lambda: sw.ISO8608("A") + sw.Bump(1.0, 0.5, 0.01),
    ),
    "Case": (
        lambda: sw.Case.parse(CASE, source="one"),
        lambda: sw.Case.parse(CASE.replace("20.0", "21.0")),
    ),
}


@pytest.fixture(scope="module")
def run() -> sw.Run:
    return sw.cross(beam(), sw.vehicles.half_car(), speed=25.0, damping=0.02, road=sw.ISO8608("C"))


#: Results of a crossing and of a bridge.
RESULTS: dict[str, Callable[[sw.Run], Any]] = {
    "Run": lambda run: run,
    "static": lambda run: run.static,
    "Envelope": lambda run: run.envelope("moment"),
    "Extremes": lambda run: run.envelope("moment").max,
    "ImpactFactors": lambda run: run.impact_factors,
    "ContactLoss": lambda run: run.contact_loss,
    "VehicleMotion": lambda run: run.vehicle,
    "BodyMotion": lambda run: run.vehicle.bodies[0],
    "Motion": lambda run: run.vehicle.hops[0],
    "ModalMotion": lambda run: run.modal,
    "Modes": lambda run: run.bridge.modes(3),
    "Settlement": lambda run: run.bridge.settlement([0.0, 0.01]),
    "IsoClass": lambda run: run.road.iso_class(0.0, 1000.0),
    "IriSegments": lambda run: run.road.iri(0.0, 100.0, every=20.0),
}


def copies(value: Any) -> list[Any]:
    return [pickle.loads(pickle.dumps(value)), copy.deepcopy(value), copy.copy(value)]


@pytest.mark.parametrize("name", INPUTS)
def test_inputs_are_values(name: str) -> None:
    make, other = INPUTS[name]
    value = make()
    assert value == make()
    assert hash(value) == hash(make())
    assert value != other()
    assert value != "something else"
    for each in copies(value):
        assert each == value
        assert hash(each) == hash(value)


@pytest.mark.parametrize("name", RESULTS)
def test_results_are_values(run: sw.Run, name: str) -> None:
    value = RESULTS[name](run)
    for each in copies(value):
        assert each == value
    again = sw.cross(run.bridge, run.passages, speed=25.0, damping=0.02, road=run.road)
    assert RESULTS[name](again) == value
    assert value != "something else"
    if name not in ("Settlement", "Modes", "IsoClass", "IriSegments"):
        faster = sw.cross(run.bridge, run.passages, speed=26.0, damping=0.02, road=run.road)
        assert RESULTS[name](faster) != value or name == "ContactLoss"


@pytest.mark.parametrize("name", [*INPUTS, *RESULTS])
def test_texts_are_short(run: sw.Run, name: str) -> None:
    value = INPUTS[name][0]() if name in INPUTS else RESULTS[name](run)
    text = repr(value)
    assert text.startswith(type(value).__name__ + "(")
    assert len(text) < 400
    assert text.count("\n") == 0
    assert "array([" not in text
    assert " object at 0x" not in text


def test_what_a_train_and_a_long_list_are_told_by() -> None:
    assert repr(INPUTS["ForceTrain"][0]()) == "ForceTrain(8000 kN, 80 axles, 237 m)"
    assert repr(INPUTS["MovingMasses"][0]()) == "MovingMasses(800 t, 80 axles, 237 m)"
    assert repr(INPUTS["Speeds"][0]()) == (
        "Speeds(times=(0.0, 1.0, ... 500 in all), speeds=(1.0, 1.0, ... 500 in all))"
    )
    assert repr(sw.Rayleigh(0.1, 1e-4)) == "Rayleigh(alpha=0.1, beta=0.0001)"
    assert (
        repr(axle())
        == "Axle(position=0.0, tyre_stiffness=1000000.0, suspension_stiffness=400000.0)"
    )
    assert brief(np.zeros((3, 4))) == "float64 array (3, 4)"
    assert brief((1,)) == "(1,)"
    assert brief([1, 2, 3, 4, 5]) == "[1, 2, ... 5 in all]"
    assert brief({"a": [1, 2]}) == "{'a': [1, 2]}"


def test_what_is_the_same() -> None:
    nan = float("nan")
    assert same(np.array([1.0, nan]), [1.0, nan])
    assert not same(np.array([1.0, nan]), [1.0, 2.0])
    assert not same(np.zeros(3), np.zeros(4))
    assert not same(np.zeros(4), np.zeros((2, 2)))
    assert not same(np.zeros(2), [[1.0], [2.0, 3.0]])
    assert same({"a": nan}, {"a": nan})
    assert not same({"a": 1}, {"b": 1})
    assert not same((1, 2), (1, 2, 3))
    assert key({"a": np.arange(2), "b": nan}) == key({"b": float("nan"), "a": [0, 1]})


def crossed(speed: float) -> sw.Run:
    return sw.cross(beam(), sw.vehicles.half_car(), speed=speed, damping=0.02)


def test_what_many_read_cannot_be_written_to() -> None:
    found = sw.ISO8608("C").iri(0.0, 100.0, every=20.0)
    profile = sw.Profile(np.arange(9.0), np.zeros(9))
    for values in (found.starts, found.ends, found.values, profile.x, crossed(20.0).moment):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0
    assert sw.ISO8608("C").iri(0.0, 100.0, every=25.0) != found


def test_factors_of_samples_are_values() -> None:
    def made(samples: int = 3) -> sw.Ensemble:
        vehicle, road = sw.vehicles.half_car(), sw.ISO8608("C")
        return sw.ensemble(beam(), vehicle, samples=samples, speed=25.0, damping=0.02, road=road)

    ensemble = made()
    for factors in (ensemble.impact_factors, ensemble.ratios(0.5)):
        for each in copies(factors):
            assert each == factors
            assert np.array_equal(each.sagging, factors.sagging, equal_nan=True)
    assert made().impact_factors == ensemble.impact_factors == ensemble.ratios()
    assert ensemble.ratios(0.5) != ensemble.impact_factors
    assert made(4).impact_factors != ensemble.impact_factors
    assert ensemble.impact_factors != "something else"


def test_runs_come_back_from_other_processes() -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        vehicle = sw.vehicles.half_car()
        there = pool.submit(sw.cross, beam(), vehicle, speed=20.0, damping=0.02).result()
    here = crossed(20.0)
    assert there == here
    for name in ("time", "axle_loads", "deflection", "moment", "shear_left", "reactions"):
        assert np.array_equal(getattr(there, name), getattr(here, name))
    assert np.array_equal(there.static.moment, here.static.moment)
    assert there.envelope("shear") == here.envelope("shear")
    assert there.ratios("at-static-extreme") == here.ratios("at-static-extreme")
    assert there.vehicle == here.vehicle
    assert there.modal == here.modal
    assert there.summary() == here.summary()
    assert there.to_dict() == here.to_dict()


def test_runs_with_a_matrix_of_several_vehicles_travel() -> None:
    bridge = beam()
    stations = len(bridge.stations)
    passages = sw.convoy([sw.vehicles.half_car(), sw.vehicles.kishan_1973()], headway=1.0)
    run = sw.cross(
        bridge,
        passages,
        speed=20.0,
        damping=1e3 * np.eye(stations),
        sections=[5.0, 10.0],
        recovery="force-summation-by-rates",
    )
    there = pickle.loads(pickle.dumps(run))
    assert there == run
    assert np.array_equal(there.moment, run.moment)
    assert there.vehicles == run.vehicles


def test_what_travels_is_not_what_was_worked_out() -> None:
    run = crossed(20.0)
    before = len(pickle.dumps(run))
    assert run.moment.size > 0
    assert run.vehicle.travel.size > 0
    assert run.contact_loss.count.size > 0
    assert len(pickle.dumps(run)) == before


def test_runs_of_another_version_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = pickle.dumps(crossed(20.0))
    monkeypatch.setattr("spanwise._computed.__version__", "9.9")
    with pytest.raises(ValueError, match=r"version = .*: the run was kept by another version"):
        pickle.loads(kept)
