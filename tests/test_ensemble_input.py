"""What an ensemble refuses, by name and with what is allowed."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import spanwise as sw

BRIDGE = sw.Bridge(spans=[20.0], EI=2e9, mass=5e3)
TRUCK = sw.vehicles.kishan_1973()
HALF = sw.vehicles.half_car()
TRAIN = sw.vehicles.hs20()
CLASS_B = sw.ISO8608("B")
PASSAGE = sw.Passage(vehicle=TRUCK)
LEFT = sw.Passage(vehicle=TRUCK, direction="left")

REFUSED: list[tuple[Any, dict[str, Any], type[Exception], str]] = [
    (TRUCK, {"samples": -1}, ValueError, "samples = -1: must be from 1 to 4294967295"),
    (TRUCK, {"samples": 2.5}, ValueError, "samples = 2.5: must be a whole number"),
    (TRUCK, {"samples": 10**8}, ValueError, "samples = 100000000: results would take"),
    (TRUCK, {"samples": 2**32}, ValueError, "samples = 4294967296: must be from 1 to 4294967295"),
    (TRUCK, {"seed": -1}, ValueError, "seed = -1: must not be negative"),
    (TRUCK, {"first": 1.5}, ValueError, "first = 1.5: must be a whole number"),
    (TRUCK, {"speed": None}, ValueError, "speed: missing"),
    (TRUCK, {"speed": [20.0]}, ValueError, "speed = shape (1,): must be a number or of shape (3,)"),
    (TRUCK, {"speed": [20.0, -1.0, 0.0]}, ValueError, "speed[1] = -1: must be finite and greater"),
    (TRUCK, {"speed": [20.0, np.nan, 1.0]}, ValueError, "speed[1] = nan: must be finite"),
    ([PASSAGE, LEFT], {"speed": [[9, 8], [9, -8], [9, 8]]}, ValueError, "speed[1, 1] = -8: must"),
    (TRUCK, {"speed": "fast"}, ValueError, "speed = 'fast': must be a number or an array"),
    (TRUCK, {"speed": 0.0}, ValueError, "must be finite and greater than 0"),
    (
        [PASSAGE, LEFT],
        {"speed": np.ones((3, 3))},
        ValueError,
        "speed = shape (3, 3): must be a number or of shape (3,) or (3, 2)",
    ),
    (TRUCK, {"road": "B"}, TypeError, "road = 'B': must be a Road"),
    (TRUCK, {"road": CLASS_B + sw.ISO8608("C")}, ValueError, "has 2 random parts, of which one"),
    (
        [PASSAGE, sw.Passage(vehicle=TRUCK, direction="left", road=CLASS_B)],
        {},
        ValueError,
        "vehicles[1].road = ISO8608(",
    ),
    (TRUCK, {"road": sw.ISO8608("B", period=100.0)}, ValueError, "repeats after its period"),
    (TRUCK, {"kind": [0, 1, 0]}, ValueError, "kind[1] = 1: must be from 0 to 0"),
    ([TRUCK, HALF], {}, ValueError, "kind: missing; give for each of the 3 samples which of the 2"),
    ([TRUCK, HALF], {"kind": [0, 2, 0]}, ValueError, "kind[1] = 2: must be from 0 to 1"),
    ([TRUCK, HALF], {"kind": [0, -1, 0]}, ValueError, "kind[1] = -1: must be from 0 to 1"),
    ([TRUCK, HALF], {"kind": [0.5, 1, 0]}, ValueError, "must be whole numbers"),
    ([TRUCK, HALF], {"kind": [0, 1]}, ValueError, "kind = shape (2,): must be one number for each"),
    ([TRUCK, PASSAGE], {}, TypeError, "vehicle[1] = Passage(Vehicle(29.07 t, 2 axles, 4.267 m)"),
    ([TRUCK, "car"], {}, TypeError, "vehicle[1] = 'car': must be a vehicle, a train, or a list of"),
    ([[PASSAGE], [TRUCK]], {}, TypeError, "vehicle[1]"),
    ([], {}, TypeError, "vehicle = []: must be a Vehicle, a train, a Passage"),
    ("car", {}, TypeError, "vehicle = 'car': must be a Vehicle"),
    (TRUCK, {"factors": [1.0]}, ValueError, "factors = [1.0]: must be a mapping"),
    (
        TRUCK,
        {"factors": {"tire_stiffness": 1.0}},
        ValueError,
        "factors: unknown parameter 'tire_stiffness' (did you mean 'tyre_stiffness'?); allowed: ",
    ),
    (
        TRUCK,
        {"factors": {"body_mass": [1.0, 2.0]}},
        ValueError,
        "factors['body_mass'] = shape (2,)",
    ),
    (
        TRUCK,
        {"factors": {"body_mass": np.ones((3, 2))}},
        ValueError,
        "factors['body_mass'] = 2 factors a sample: must be one for each sample, for the event "
        "has one body",
    ),
    (
        TRUCK,
        {"factors": {"body_mass": -1.0}},
        ValueError,
        "factors['body_mass'] = -1: must be finite",
    ),
    (TRUCK, {"factors": {"body_mass": [1, 0, 1]}}, ValueError, "factors['body_mass'][1] = 0: must"),
    (
        TRUCK,
        {"factors": {"tyre_stiffness": [[1, 1], [1, 0], [1, 1]]}},
        ValueError,
        "factors['tyre_stiffness'][1, 1] = 0: must be finite and greater than 0",
    ),
    (
        TRUCK,
        {"factors": {"body_mass": "heavy"}},
        ValueError,
        "factors['body_mass'] = 'heavy': must",
    ),
    (TRUCK, {"factors": {"initial_friction": 1.5}}, ValueError, "must be from -1 to 1"),
    (
        TRAIN,
        {"factors": {"tyre_stiffness": 1.1}},
        ValueError,
        "a train of forces has no such thing",
    ),
    (TRAIN, {"values": {"tyre_stiffness": 1.1}}, ValueError, "a train of forces has no such thing"),
    (
        TRUCK,
        {"values": {"bridge_stiffness": 1e9}},
        ValueError,
        "values['bridge_stiffness']: a bridge",
    ),
    (
        TRUCK,
        {"values": {"body_mass": 1.0}, "factors": {"body_mass": 1.0}},
        ValueError,
        "values: body_mass is among the factors too",
    ),
    (TRUCK, {"values": {"tyre_damping": 1e3}}, ValueError, "axle 1 has no tyre_damping"),
    (
        HALF,
        {"values": {"initial_friction": 1e3}},
        ValueError,
        "axle 1 has no friction_limit, so that initial_friction cannot be set by values",
    ),
    (
        TRUCK,
        {"values": {"body_mass": -5.0}},
        ValueError,
        "values['body_mass'] = -5: must be finite",
    ),
    (TRUCK, {"values": {"tyre_damping": -5.0}}, ValueError, "tyre_damping'] = -5: must be finite"),
    (
        TRUCK,
        {"values": {"tyre_stiffness": np.ones((3, 3))}},
        ValueError,
        "values['tyre_stiffness'] = 3 values a sample: must be one for each sample, or one "
        "for each of the 2 axles of the event",
    ),
    (
        [TRUCK, sw.vehicles.hs20_44()],
        {"values": {"tyre_stiffness": 1e6}, "kind": [0, 1, 0]},
        ValueError,
        "the kinds of event have different numbers of parts, 2, 3; give factors",
    ),
    (
        [PASSAGE, sw.Passage(vehicle=TRAIN, direction="left")],
        {"factors": {"body_mass": np.ones((3, 4))}},
        ValueError,
        "factors['body_mass'] = 4 factors a sample: vehicles and trains in one event have no",
    ),
    (
        [PASSAGE, sw.Passage(vehicle=TRAIN, direction="left")],
        {"values": {"body_mass": 1e4}},
        ValueError,
        "values['body_mass'] = 1 values a sample: vehicles and trains in one event have no",
    ),
    (
        TRUCK,
        {"quantities": []},
        ValueError,
        "quantities = []: must be a list of deflection, moment",
    ),
    (TRUCK, {"quantities": "moment"}, ValueError, "quantities = 'moment': must be a list"),
    (
        TRUCK,
        {"quantities": ["momentum"]},
        ValueError,
        "quantities[0] = 'momentum': must be one of deflection, moment, shear, reactions, "
        "clamp_moments, slope, velocity, acceleration (did you mean 'moment'?)",
    ),
    (TRUCK, {"quantities": ["clamp_moments"]}, ValueError, "no support of this bridge holds"),
    (TRUCK, {"advance": 0.0}, ValueError, "advance = 0: must be finite and greater than 0"),
    (LEFT, {"advance": 0.1}, ValueError, "advance = 0.1 m: only for vehicles that cross alone"),
    (TRUCK, {"step": -1.0}, ValueError, "step = -1"),
    (TRUCK, {"threads": 0}, ValueError, "threads = 0: must be 1 or more"),
    (TRUCK, {"threads": 1.5}, ValueError, "threads = 1.5: must be a whole number"),
    (TRUCK, {"threads": 10**6}, ValueError, "threads = 1000000: must be at most 4096"),
    (TRUCK, {"progress": 5}, ValueError, "progress = 5: must be callable, or True"),
    (TRUCK, {"mask": 1.0}, ValueError, "mask = 1: must be a fraction"),
    (TRUCK, {"recovery": "none"}, ValueError, "recovery = 'none': must be force-summation"),
    (TRUCK, {"own_roads": 1}, ValueError, "own_roads = 1: must be true or false"),
    (TRUCK, {"modes": 0}, ValueError, "modes = 0"),
    (TRUCK, {"ramp": 5.0}, ValueError, "ramp = 5 m: must not be longer than the approach"),
    (TRUCK, {"sections": [30.0]}, ValueError, "sections[0] = 30 m: must lie on the beam"),
    (TRUCK, {"drive": "fly"}, ValueError, "drive = 'fly': must be constant-speed"),
    (
        TRUCK,
        {"drive": sw.Speeds(times=[0, 1], speeds=[5, 9])},
        ValueError,
        "speed = 20: not used with speeds in time",
    ),
    (TRUCK, {"tail": 1e9}, ValueError, "would take more than"),
]


@pytest.mark.parametrize(("vehicle", "given", "kind", "says"), REFUSED)
def test_refused(vehicle: Any, given: dict[str, Any], kind: type[Exception], says: str) -> None:
    with pytest.raises(kind, match=re.escape(says)):
        sw.ensemble(BRIDGE, vehicle, **{"samples": 3, "speed": 20.0, **given})


def test_a_bridge_is_needed() -> None:
    with pytest.raises(TypeError, match="bridge = 'B': must be a Bridge"):
        sw.ensemble("B", TRUCK, samples=1, speed=20.0)  # type: ignore[arg-type]


def test_results_refuse_what_they_do_not_have() -> None:
    found = sw.ensemble(BRIDGE, TRUCK, samples=2, speed=20.0, quantities=["moment"])
    with pytest.raises(ValueError, match=r'"deflection": was not looked at; .* has moment'):
        found.envelope("deflection")
    with pytest.raises(ValueError, match='quantity = "shear": was not looked at'):
        _ = found.impact_factors.shear
    with pytest.raises(ValueError, match="quantity = 'moment': must be one of deflection, sagging"):
        _ = found.impact_factors["moment"]
    with pytest.raises(ValueError, match="mask = 2: must be a fraction"):
        found.ratios(mask=2.0)
    with pytest.raises(IndexError, match="row 2: must be from 0 to below 2"):
        found.run(2)
    with pytest.raises(IndexError, match="row -1: must be from 0 to below 2"):
        found.run(-1)


def test_roads_that_stand_may_be_random_in_any_part() -> None:
    road = CLASS_B + sw.ISO8608("A", seed=4)
    found = sw.ensemble(BRIDGE, TRUCK, samples=2, speed=20.0, road=road, own_roads=False)
    assert found.digests[0] == found.digests[1]
    both = [PASSAGE, sw.Passage(vehicle=TRUCK, direction="left", road=CLASS_B)]
    found = sw.ensemble(BRIDGE, both, samples=2, speed=20.0, own_roads=False)
    assert found.digests[0] == found.digests[1]
