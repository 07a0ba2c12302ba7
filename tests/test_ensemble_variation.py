"""Factors on vehicle and bridge against vehicles and bridges built by hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import spanwise as sw

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973().with_initial_friction(4e3, -6e3)
CLASS_B = sw.ISO8608("B", period=160.0)
GIVEN: dict[str, Any] = {
    "speed": 21.0,
    "approach": 20.0,
    "ramp": 5.0,
    "modes": 3,
    "accuracy": 0.02,
    "road": CLASS_B,
}

#: Two bodies with dampers, friction and a spring between: everything that can be varied.
LORRY = sw.Vehicle(
    bodies=[
        sw.Body(
            mass=6e3,
            pitch_inertia=9e3,
            axles=[
                sw.Axle(
                    position=x,
                    mass=400.0,
                    tyre_stiffness=2.2e6,
                    tyre_damping=3e3,
                    suspension_stiffness=6e5,
                    suspension_damping=8e3,
                    friction_limit=6e3,
                    initial_friction=1e3,
                )
                for x in (2.0, -2.0)
            ],
        ),
        sw.Body(
            mass=14e3,
            pitch_inertia=30e3,
            springs=[
                sw.Spring(to=0, at=x, own=x, stiffness=9e5, damping=2e4, friction_limit=3e3)
                for x in (1.5, -1.5)
            ],
        ),
    ]
)

#: What a factor multiplies in an axle.
OF_AXLES = {
    "tyre_stiffness": ("tyre_stiffness",),
    "tyre_damping": ("tyre_damping",),
    "suspension_stiffness": ("suspension_stiffness",),
    "suspension_damping": ("suspension_damping",),
    "friction_limit": ("friction_limit", "initial_friction"),
}
#: And in a spring between bodies.
OF_SPRINGS = {
    "suspension_stiffness": ("stiffness",),
    "suspension_damping": ("damping",),
    "friction_limit": ("friction_limit", "initial_friction"),
}

Same = Callable[[sw.Ensemble, int, sw.Run], None]


def times(part: Any, names: tuple[str, ...], factor: float) -> Any:
    return replace(part, **{name: factor * getattr(part, name) for name in names})


def by_hand(vehicle: sw.Vehicle, name: str, factor: float) -> sw.Vehicle:
    """The vehicle with everything of that name so many times as large."""
    bodies = []
    for body in vehicle.parts:
        if name in ("body_mass", "pitch_inertia"):
            bodies.append(times(body, (name.removeprefix("body_"),), factor))
            continue
        axles = [times(axle, OF_AXLES[name], factor) for axle in body.axles]
        springs = [times(each, OF_SPRINGS.get(name, ()), factor) for each in body.springs]
        bodies.append(replace(body, axles=axles, springs=springs))
    return sw.Vehicle(bodies=bodies)


def check_close(found: sw.Ensemble, sample: int, run: sw.Run, tolerance: float = 1e-9) -> None:
    for name in (*found.quantities, "axle_loads"):
        envelope = run.envelope(name)
        for side in ("max", "min", "static_max", "static_min"):
            values = np.atleast_2d(getattr(found.envelope(name), side))
            own = values[sample if len(values) > 1 else 0]
            expected = getattr(envelope, side).value
            assert_allclose(own, expected, rtol=tolerance, atol=tolerance * np.abs(expected).max())


@pytest.mark.filterwarnings("ignore:.*a factor on it does nothing")
@pytest.mark.parametrize("name", [*OF_AXLES, "body_mass", "pitch_inertia"])
@pytest.mark.parametrize("vehicle", [TRUCK, LORRY], ids=["truck", "lorry"])
def test_one_factor_for_all_parts(vehicle: sw.Vehicle, name: str, same: Same) -> None:
    factors = np.array([1.2, 1.0, 0.7])
    found = sw.ensemble(BRIDGE, vehicle, samples=3, factors={name: factors}, **GIVEN)
    assert found.shares_geometry
    assert found.failures == ()
    plain = sw.ensemble(BRIDGE, vehicle, samples=3, **GIVEN)
    assert_array_equal(found.envelope("moment").max[1], plain.envelope("moment").max[1])
    for sample, factor in enumerate(factors):
        alone = found.run(sample)
        same(found, sample, alone)
        road = sw.ISO8608("B", period=160.0, sample=sample)
        changed = by_hand(vehicle, name, factor)
        given = {**GIVEN, "road": road, "step": alone.settings["step"]}
        check_close(found, sample, sw.cross(BRIDGE, changed, **given))
        assert_allclose(alone.truck.static_loads(), changed.static_loads(), rtol=1e-12)


def test_factors_by_axle_and_body(same: Same) -> None:
    rng = np.random.default_rng(5)
    factors: dict[str, Any] = {
        "tyre_stiffness": rng.uniform(0.8, 1.2, (3, 2)),
        "suspension_stiffness": rng.uniform(0.8, 1.2, (3, 2)),
        "friction_limit": rng.uniform(0.5, 1.5, (3, 2)),
        "initial_friction": rng.uniform(-1.0, 1.0, (3, 2)),
        "body_mass": rng.uniform(0.8, 1.2, (3, 2)),
        "pitch_inertia": rng.uniform(0.8, 1.2, 3),
        "tyre_damping": 1.3,
    }
    found = sw.ensemble(BRIDGE, LORRY, samples=3, factors=factors, **GIVEN)
    for sample in range(3):
        alone = found.run(sample)
        same(found, sample, alone)
        lorry = alone.truck
        assert isinstance(lorry, sw.Vehicle)
        for k, (axle, nominal) in enumerate(zip(lorry.axles, LORRY.axles, strict=True)):
            part = {
                name: np.broadcast_to(v.T, (2, 3))[k, sample]
                for name, v in factors.items()
                if isinstance(v, np.ndarray)
            }
            assert axle.tyre_stiffness == nominal.tyre_stiffness * part["tyre_stiffness"]
            limit = nominal.friction_limit * part["friction_limit"]
            assert axle.friction_limit == limit
            assert axle.initial_friction == part["initial_friction"] * limit
            assert axle.tyre_damping == nominal.tyre_damping * 1.3
        # Factors by axle leave what is between the bodies.
        assert lorry.bodies[1].springs == LORRY.bodies[1].springs


def test_springs_share_out_the_static_loads(same: Same) -> None:
    # Three axles below a rigid body: what each carries depends on their stiffnesses.
    axles = [
        sw.Axle(position=x, tyre_stiffness=3e6, suspension_stiffness=8e5) for x in (3.0, -1.0, -2.4)
    ]
    truck = sw.Vehicle(mass=24e3, pitch_inertia=60e3, axles=axles)
    tyres = np.array([[1.0, 1.0, 1.0], [1.0, 2.0, 0.4]])
    found = sw.ensemble(BRIDGE, truck, samples=2, factors={"tyre_stiffness": tyres}, **GIVEN)
    assert np.abs(np.diff(found.static_axle_loads, axis=0)).max() > 5e3
    assert np.abs(np.diff(found.envelope("moment").static_max, axis=0)).max() > 1e3
    for sample in range(2):
        same(found, sample, found.run(sample))
        assert_array_equal(found.static_axle_loads[sample], found.run(sample).static_axle_loads)


def test_trains_vary_in_their_loads(same: Same) -> None:
    factors = np.array([[1.0, 1.1, 0.9], [0.5, 0.8, 1.3]])
    given = {**GIVEN, "accuracy": 3e-3}
    for train in (sw.vehicles.hs20(), sw.MovingMasses(masses=[4e3, 8e3, 9e3], spacings=[4, 3])):
        found = sw.ensemble(BRIDGE, train, samples=2, factors={"body_mass": factors}, **given)
        for sample in range(2):
            alone = found.run(sample)
            same(found, sample, alone)
            assert_allclose(
                alone.static_axle_loads, factors[sample] * train.static_loads(), rtol=1e-14
            )
        values = factors * (train.loads if isinstance(train, sw.ForceTrain) else train.masses)
        again = sw.ensemble(BRIDGE, train, samples=2, values={"body_mass": values}, **given)
        assert_allclose(again.envelope("moment").max, found.envelope("moment").max, rtol=1e-12)


def test_values_are_factors_of_what_there_is() -> None:
    values: dict[str, Any] = {
        "body_mass": [20e3, 25e3],
        "tyre_stiffness": np.array([[6e6, 7e6], [8e6, 9e6]]),
        "initial_friction": np.array([[1e4, -2e4], [0.0, 5e3]]),
    }
    assert TRUCK.mass is not None
    limits = np.array([axle.friction_limit for axle in TRUCK.axles])
    tyres = np.array([axle.tyre_stiffness for axle in TRUCK.axles])
    factors = {
        "body_mass": np.array([20e3, 25e3]) / TRUCK.mass,
        "tyre_stiffness": np.asarray(values["tyre_stiffness"]) / tyres,
        "initial_friction": np.asarray(values["initial_friction"]) / limits,
    }
    found = sw.ensemble(BRIDGE, TRUCK, samples=2, values=values, **GIVEN)
    assert found.hash == sw.ensemble(BRIDGE, TRUCK, samples=2, factors=factors, **GIVEN).hash
    truck = found.run(1).truck
    assert isinstance(truck, sw.Vehicle)
    assert truck.mass == pytest.approx(25e3, rel=1e-15)
    assert [axle.tyre_stiffness for axle in truck.axles] == pytest.approx([8e6, 9e6], rel=1e-15)
    assert [axle.initial_friction for axle in truck.axles] == pytest.approx([0.0, 5e3], rel=1e-14)
    # One value for all axles holds for each of them, not for the springs between bodies.
    one = sw.ensemble(BRIDGE, LORRY, samples=1, values={"suspension_stiffness": 7e5}, **GIVEN)
    lorry = one.run(0).truck
    assert isinstance(lorry, sw.Vehicle)
    assert {axle.suspension_stiffness for axle in lorry.axles} == {7e5}
    assert lorry.bodies[1].springs[0].stiffness == 9e5
    scalar = sw.ensemble(BRIDGE, LORRY, samples=3, values={"suspension_stiffness": 7e5}, **GIVEN)
    assert scalar.digests[0] == one.digests[0]


@pytest.mark.parametrize("limit", [{"factors": 0.5}, {"values": 12e3}])
def test_initial_friction_in_newtons_whatever_the_limit(limit: dict[str, float]) -> None:
    tables: dict[str, Any] = {"values": {"initial_friction": np.array([[5e3, -6e3], [0.0, 8e3]])}}
    for key, number in limit.items():
        tables.setdefault(key, {})["friction_limit"] = number
    found = sw.ensemble(BRIDGE, TRUCK, samples=2, **tables, **GIVEN)
    for row, expected in enumerate([[5e3, -6e3], [0.0, 8e3]]):
        truck = found.run(row).truck
        assert isinstance(truck, sw.Vehicle)
        initial = [axle.initial_friction for axle in truck.axles]
        assert initial == pytest.approx(expected, rel=1e-14)
        assert found.envelope("axle_loads").max[row] == pytest.approx(
            found.run(row).envelope("axle_loads").max.value
        )
    tables["values"]["initial_friction"] = 13e3
    with pytest.raises(ValueError, match="within the friction limit of axle 1, 1"):
        sw.ensemble(BRIDGE, TRUCK, samples=2, **tables, **GIVEN)


def test_values_of_a_fleet() -> None:
    fleet = [TRUCK, sw.vehicles.half_car()]
    kind = np.array([0, 1, 1, 0])
    mass = np.array([20e3, 15e3, 16e3, 25e3])
    found = sw.ensemble(BRIDGE, fleet, samples=4, kind=kind, values={"body_mass": mass}, **GIVEN)
    for sample in range(4):
        truck = found.run(sample).truck
        assert isinstance(truck, sw.Vehicle)
        assert truck.mass == pytest.approx(mass[sample], rel=1e-15)
    assert found.static_axle_loads.shape == (4, 2)


def test_bridge_stiffness() -> None:
    stiffness = np.array([1.0, 1.3, 0.8])
    supports: list[Any] = [(0.0, "pinned"), sw.Support(at=18.288, vertical=2e8), (36.576, "pinned")]
    for more in ({}, {"damping": 0.03}, {"recovery": "superposition"}):
        for bridge in (
            BRIDGE,
            sw.Bridge(
                length=36.576, supports=supports, EI=1.94148e9, mass=6037.7, stations_per_span=3
            ),
        ):
            given = {**GIVEN, **more}
            found = sw.ensemble(
                bridge, TRUCK, samples=3, factors={"bridge_stiffness": stiffness}, **given
            )
            for sample in range(3):
                check_close(found, sample, found.run(sample))
    EI = 1.3 * 1.94148e9
    stiffer = sw.Bridge(spans=[18.288, 18.288], EI=EI, mass=6037.7, stations_per_span=3)
    found = sw.ensemble(BRIDGE, TRUCK, samples=3, factors={"bridge_stiffness": stiffness}, **GIVEN)
    given = {**GIVEN, "road": sw.ISO8608("B", period=160.0, sample=1)}
    step = found.run(1).settings["step"]
    run = sw.cross(stiffer, TRUCK, **given, step=step)  # type: ignore[arg-type]
    check_close(found, 1, run)
    at = float(BRIDGE.nodes[3])
    modes = sw.Bridge.from_modes(
        path=BRIDGE.nodes.tolist(),
        frequencies=BRIDGE.modes(3).frequencies.tolist(),
        shapes=BRIDGE.mode_shapes(3, BRIDGE.nodes),
        sections=[at],
        influence={"deflection": BRIDGE.deflections(BRIDGE.nodes, [at]).T},
    )
    found = sw.ensemble(modes, TRUCK, samples=3, factors={"bridge_stiffness": stiffness}, **GIVEN)
    with pytest.raises(ValueError, match=r"sample = 1: has a bridge 1\.3 times as stiff"):
        found.run(1)
    found.run(0)


def test_bridge_damping() -> None:
    damping = np.array([1.0, 2.0, 0.5])
    matrix = 2e3 * np.eye(6)
    given: dict[str, Any]
    for more in (
        {"damping": 0.02},
        {"damping": [0.01, 0.02, 0.03], "recovery": "superposition"},
        {"damping": matrix},
        {"damping": sw.Rayleigh(0.3, 1e-4), "recovery": "force-summation-by-rates"},
    ):
        given = {**GIVEN, **more}
        found = sw.ensemble(BRIDGE, TRUCK, samples=3, factors={"bridge_damping": damping}, **given)
        for sample in range(3):
            check_close(found, sample, found.run(sample))
    road = sw.ISO8608("B", period=160.0, sample=1)
    given = {**given, "damping": sw.Rayleigh(0.6, 2e-4), "road": road}
    step = found.run(1).settings["step"]
    run = sw.cross(BRIDGE, TRUCK, **given, step=step)  # type: ignore[arg-type]
    check_close(found, 1, run)


def test_events_of_several_vehicles_vary(same: Same) -> None:
    two = [sw.Passage(vehicle=TRUCK), sw.Passage(vehicle=LORRY, direction="left")]
    factors = {
        "body_mass": np.array([[1.1, 0.9, 1.2], [0.8, 1.0, 1.0]]),
        "tyre_stiffness": np.array([[1.1, 0.9, 1.2, 0.8], [1.0, 1.0, 0.9, 1.1]]),
    }
    found = sw.ensemble(BRIDGE, two, samples=2, factors=factors, **GIVEN)
    for sample in range(2):
        alone = found.run(sample)
        same(found, sample, alone)
        truck, lorry = (passage.vehicle for passage in alone.passages)
        assert isinstance(truck, sw.Vehicle)
        assert isinstance(lorry, sw.Vehicle)
        assert TRUCK.mass is not None
        assert truck.mass == TRUCK.mass * factors["body_mass"][sample, 0]
        assert lorry.bodies[1].mass == 14e3 * factors["body_mass"][sample, 2]
        assert lorry.axles[1].tyre_stiffness == 2.2e6 * factors["tyre_stiffness"][sample, 3]


def test_steps_are_halved_where_a_sample_needs_it(same: Same) -> None:
    stiff = np.array([1.0, 300.0, 1.0])
    given = {**GIVEN, "advance": 0.2}
    found = sw.ensemble(BRIDGE, TRUCK, samples=3, factors={"tyre_stiffness": stiff}, **given)
    steps = [found.run(sample).settings["step"] for sample in range(3)]
    assert isinstance(steps[0], float)
    assert isinstance(steps[1], float)
    assert steps[0] == steps[2]
    halvings = np.log2(steps[0] / steps[1])
    assert halvings >= 1.0
    assert halvings == pytest.approx(round(halvings), abs=1e-9)
    same(found, 1, found.run(1))
    plain = sw.ensemble(BRIDGE, TRUCK, samples=1, **given)
    assert_array_equal(found.envelope("moment").max[0], plain.envelope("moment").max[0])
    # Static extremes are those in the sample's own steps.
    speeds = np.array([4.0, 40.0])
    # On a road of waves that such steps do not pass over.
    road = sw.ISO8608("B", period=160.0, band=(0.01, 1.0))
    given = {**GIVEN, "speed": speeds, "advance": 0.3, "road": road}
    found = sw.ensemble(BRIDGE, TRUCK, samples=2, **given)
    assert found.envelope("moment").static_max.shape == (2, len(found.sections))
    for sample in range(2):
        same(found, sample, found.run(sample))
