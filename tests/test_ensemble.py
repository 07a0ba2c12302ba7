"""A sample of an ensemble is a crossing, to the bit: every vehicle, road, drive and event."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise.roads.base import total

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()
CLASS_B = sw.ISO8608("B", period=160.0)

#: Rough approaches short enough for quick tests.
SHORT: dict[str, Any] = {"approach": 20.0, "ramp": 5.0, "modes": 3, "accuracy": 0.02}

Same = Callable[[sw.Ensemble, int, sw.Run], None]

X = np.linspace(-60.0, 70.0, 261)
ROADS: dict[str, sw.roads.Road | None] = {
    "smooth": None,
    "iso-8608": CLASS_B,
    "profile": sw.Profile(X, 0.004 * np.sin(0.7 * X) + 0.002 * np.cos(2.9 * X)),
    "features": sw.Bump(3.0, 2.0, 0.01) + sw.Ramp(20.0, 24.0, 0.01) + sw.Pothole(30.0, 0.8, 0.02),
    "sum": CLASS_B
    + sw.Profile(X, 0.003 * np.cos(0.9 * X))
    + sw.Joint(at=0.0, gap=0.05, depth=0.01),
}


def own(road: sw.roads.Road | None, seed: int, sample: int) -> sw.roads.Road | None:
    """The road of a sample, put together by hand."""
    if isinstance(road, sw.ISO8608):
        return sw.ISO8608("B", period=160.0, seed=seed, sample=sample)
    if isinstance(road, sw.roads.Sum):
        parts = (own(part, seed, sample) for part in road.parts)
        return total(part for part in parts if part is not None)
    return road


@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("name", sw.vehicles.PRESETS)
def test_a_sample_of_a_vehicle_is_a_crossing(name: str, road: str, same: Same) -> None:
    vehicle = sw.vehicles.PRESETS[name]()
    given: dict[str, Any] = {**SHORT, "speed": 21.0, "road": ROADS[road]}
    try:
        found = sw.ensemble(BRIDGE, vehicle, samples=10, seed=3, first=5, advance=0.1, **given)
    except ValueError as refused:
        # In the same words.
        with pytest.raises(ValueError, match=re.escape(str(refused))):
            sw.cross(BRIDGE, vehicle, **given)
        return
    assert found.failures == ()
    assert found.shares_geometry
    for sample in (0, 9):
        alone = found.run(sample)
        same(found, sample, alone)
        given["road"] = own(ROADS[road], 3, 5 + sample)
        by_hand = sw.cross(BRIDGE, vehicle, **given, step=alone.settings["step"])  # type: ignore[arg-type]
        same(found, sample, by_hand)
    # Forces do not feel the road.
    differ = road in ("iso-8608", "sum") and not isinstance(vehicle, sw.ForceTrain)
    assert len({*found.digests.tolist()}) == (10 if differ else 1)


def test_moving_masses(same: Same) -> None:
    masses = sw.MovingMasses(masses=[9e3, 12e3], spacings=[4.0])
    for road in (None, CLASS_B):
        found = sw.ensemble(BRIDGE, masses, samples=3, speed=15.0, road=road, **SHORT)
        same(found, 2, found.run(2))


EVENTS: dict[str, tuple[Any, dict[str, Any]]] = {
    "traction": (TRUCK, {"drive": "constant-traction", "speed": 20.0}),
    "braking": (
        TRUCK,
        {"drive": sw.Braking(deceleration=4.0, start=5.0), "speed": 18.0, "tail": 0.3},
    ),
    "acceleration": (TRUCK, {"drive": sw.Acceleration(acceleration=-1.5), "speed": 18.0}),
    "speeds": (TRUCK, {"drive": sw.Speeds(times=[0, 2], speeds=[10, 20])}),
    "to the left": (sw.Passage(vehicle=TRUCK, direction="left"), {"speed": 20.0}),
    "late": (sw.Passage(vehicle=TRUCK, entry=0.5), {"speed": 20.0}),
    "own road": (sw.Passage(vehicle=TRUCK, road=sw.Bump(3.0, 2.0, 0.01)), {"speed": 20.0}),
    "convoy": (sw.convoy([TRUCK, sw.vehicles.t44()], headway=1.0), {"speed": 20.0}),
    "opposing": (
        [
            sw.Passage(vehicle=TRUCK),
            sw.Passage(vehicle=sw.vehicles.half_car(), direction="left", speed=15.0),
        ],
        {"speed": 20.0},
    ),
    "a step in time": (sw.Passage(vehicle=TRUCK, direction="left"), {"speed": 20.0, "step": 2e-3}),
}


@pytest.mark.parametrize("road", [None, CLASS_B])
@pytest.mark.parametrize("event", EVENTS)
def test_any_event_is_a_crossing(event: str, road: sw.roads.Road | None, same: Same) -> None:
    vehicle, given = EVENTS[event]
    given = {**SHORT, **given}
    found = sw.ensemble(BRIDGE, vehicle, samples=3, seed=2, road=road, **given)
    assert not found.shares_geometry
    assert found.failures == ()
    for sample in (0, 2):
        same(found, sample, found.run(sample))
        by_hand = sw.cross(BRIDGE, vehicle, road=own(road, 2, sample), **given)
        same(found, sample, by_hand)


def test_speeds_of_samples_and_vehicles(same: Same) -> None:
    speeds = np.linspace(8.0, 35.0, 9)
    found = sw.ensemble(BRIDGE, TRUCK, samples=9, speed=speeds, road=CLASS_B, **SHORT)
    for sample in range(9):
        alone = found.run(sample)
        assert alone.settings["speed"] == speeds[sample]
        same(found, sample, alone)
    two = [sw.Passage(vehicle=TRUCK), sw.Passage(vehicle=TRUCK, direction="left")]
    table = np.array([[20.0, 15.0], [12.0, 25.0]])
    found = sw.ensemble(BRIDGE, two, samples=2, speed=table, **SHORT)
    for sample in range(2):
        same(found, sample, found.run(sample))
        passages = [
            sw.Passage(vehicle=TRUCK, speed=table[sample, 0]),
            sw.Passage(vehicle=TRUCK, direction="left", speed=table[sample, 1]),
        ]
        same(found, sample, sw.cross(BRIDGE, passages, **SHORT))
    assert_array_equal(found.speed, table)


def test_a_speed_of_a_passage_alone_is_that_of_its_samples(same: Same) -> None:
    passage = sw.Passage(vehicle=TRUCK, speed=17.0)
    found = sw.ensemble(BRIDGE, passage, samples=2, road=CLASS_B, **SHORT)
    assert found.shares_geometry
    assert found.speed is None
    same(found, 1, found.run(1))
    by_number = sw.ensemble(BRIDGE, TRUCK, samples=2, speed=17.0, road=CLASS_B, **SHORT)
    assert by_number.hash == found.hash
    fleet = [[passage], [sw.Passage(vehicle=TRUCK)]]
    mixed = sw.ensemble(BRIDGE, fleet, samples=3, kind=[0, 1, 0], speed=25.0, road=CLASS_B, **SHORT)
    assert mixed.shares_geometry
    assert mixed.digests[0] == found.digests[0]
    assert mixed.run(1).settings["speed"] == 25.0
    assert mixed.run(2).passages[0].speed == 17.0 or mixed.run(2).settings["speed"] == 17.0


def test_kinds(same: Same) -> None:
    fleet: list[sw.vehicles.AnyVehicle] = [
        TRUCK,
        sw.vehicles.articulated_5_axle(),
        sw.vehicles.hs20(),
    ]
    kind = [2, 0, 1, 1, 0, 2, 2]
    given = {**SHORT, "accuracy": 1e-3, "speed": 20.0, "road": CLASS_B}
    found = sw.ensemble(BRIDGE, fleet, samples=7, kind=kind, **given)
    assert found.envelope("axle_loads").max.shape == (7, 5)
    assert found.shares_geometry
    for sample, number in enumerate(kind):
        alone = found.run(sample)
        assert alone.truck == fleet[number]
        same(found, sample, alone)
    lone = sw.ensemble(BRIDGE, fleet[1], samples=1, first=3, **given)
    assert_array_equal(lone.envelope("moment").max[0], found.envelope("moment").max[3])


def test_kinds_of_events(same: Same) -> None:
    towards = sw.Passage(vehicle=TRUCK, direction="left")
    events = [[sw.Passage(vehicle=TRUCK)], [sw.Passage(vehicle=TRUCK), towards]]
    found = sw.ensemble(BRIDGE, events, samples=3, kind=np.array([1, 0, 1]), speed=20.0, **SHORT)
    for sample in range(3):
        same(found, sample, found.run(sample))


@pytest.mark.parametrize(
    "given",
    [
        {"tail": 0.4},
        {"tail": 0.37, "advance": 0.05},
        {"recovery": "superposition"},
        {"recovery": "force-summation-by-rates", "damping": 0.03},
        {"damping": sw.Rayleigh(0.5, 1e-4)},
        {"beta": 0.25, "step": 2e-3},
        {"lift_off": False},
        {"gravity": 3.7},
        {"sections": [0.0, 9.1, 18.288, 30.0]},
        {"quantities": ["moment"]},
        {"quantities": ["reactions", "shear"]},
        {"advance": 0.031},
        {"own_roads": False},
        {"mask": 0.4},
    ],
    ids=str,
)
def test_settings(given: dict[str, Any], same: Same) -> None:
    given = {**SHORT, "speed": 21.0, "road": CLASS_B, **given}
    found = sw.ensemble(BRIDGE, TRUCK, samples=9, **given)
    for sample in (0, 8):
        same(found, sample, found.run(sample))
    if "advance" not in given and "quantities" not in given:
        del given["road"]
        own_roads = given.pop("own_roads", True)
        given["step"] = found.run(8).settings["step"]
        road = CLASS_B if not own_roads else own(CLASS_B, 0, 8)
        same(found, 8, sw.cross(BRIDGE, TRUCK, road=road, **given))
    again = sw.ensemble(BRIDGE, TRUCK, **found.settings)
    assert again.hash == found.hash
    assert again.settings.keys() == found.settings.keys()


def test_defaults_are_those_of_a_crossing(same: Same) -> None:
    found = sw.ensemble(BRIDGE, TRUCK, samples=1, speed=20.0, road=sw.ISO8608("C"), seed=4)
    by_hand = sw.cross(BRIDGE, TRUCK, speed=20.0, road=sw.ISO8608("C", seed=4))
    same(found, 0, by_hand)
    smooth = sw.ensemble(BRIDGE, TRUCK, samples=1, speed=20.0)
    same(smooth, 0, sw.cross(BRIDGE, TRUCK, speed=20.0))


def test_lift_off(same: Same) -> None:
    given: dict[str, Any] = {**SHORT, "speed": 25.0, "road": sw.ISO8608("F", period=160.0)}
    found = sw.ensemble(BRIDGE, sw.vehicles.hs20_44(), samples=4, **given)
    assert found.contact_loss.count.sum() > 0
    for sample in range(4):
        same(found, sample, found.run(sample))


def test_other_bridges(same: Same) -> None:
    clamped = sw.Bridge(
        length=30.0,
        supports=[(0.0, "clamped"), (20.0, "pinned")],
        EI=2e9,
        mass=5e3,
        stations_per_span=4,
    )
    path = np.linspace(0.0, 30.0, 61)
    given = sw.Bridge.from_modes(
        path=path.tolist(),
        frequencies=clamped.modes(3).frequencies.tolist(),
        shapes=clamped.mode_shapes(3, path),
        sections=[10.0, 15.0],
        influence={"deflection": clamped.deflections(path, [10.0, 15.0]).T},
    )
    found = sw.ensemble(clamped, TRUCK, samples=3, speed=20.0, road=CLASS_B, **SHORT)
    assert "clamp_moments" in found.quantities
    same(found, 1, found.run(1))
    found = sw.ensemble(given, TRUCK, samples=3, speed=20.0, road=CLASS_B, **SHORT)
    assert found.quantities == ("deflection",)
    same(found, 1, found.run(1))
    for missing in ("shear", "reactions"):
        with pytest.raises(ValueError, match="without influence lines"):
            sw.ensemble(given, TRUCK, samples=3, speed=20.0, quantities=[missing])


def test_nothing_and_one() -> None:
    with pytest.raises(ValueError, match=r"^samples = 0: must be from 1 to 4294967295$"):
        sw.ensemble(BRIDGE, TRUCK, samples=0, speed=20.0, road=CLASS_B, **SHORT)
    one = sw.ensemble(BRIDGE, TRUCK, samples=1, speed=[20.0], road=CLASS_B, **SHORT)
    assert one.envelope("moment").max.shape == (1, len(one.sections))
    with pytest.raises(IndexError, match="row 1: must be from 0 to below 1"):
        one.run(1)


def test_histories() -> None:
    found = sw.ensemble(BRIDGE, TRUCK, samples=6, speed=20.0, road=CLASS_B, **SHORT)
    moments = found.histories("moment", samples=[4, 1])
    assert_array_equal(moments[0], found.run(4).moment)
    assert_array_equal(moments.max(axis=1)[1] <= found.envelope("moment").max[1], True)
    assert found.histories("axle_loads", samples=[0]).shape[2] == 2
    assert found.histories("axle_loads", samples=[]).shape[0] == 0
    with pytest.raises(ValueError, match="quantity = 'shears': must be one of"):
        found.histories("shears", samples=[0])
    stiff = np.array([1.0, 9.0])
    uneven = sw.ensemble(
        BRIDGE,
        TRUCK,
        samples=2,
        speed=[20.0, 2.0],
        factors={"tyre_stiffness": stiff},
        road=CLASS_B,
        **SHORT,
    )
    with pytest.raises(ValueError, match=r"samples\[1\] = 1: has \d+ instants, not \d+"):
        uneven.histories("moment", samples=[0, 1])
