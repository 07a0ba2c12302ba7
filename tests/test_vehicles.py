"""Vehicles against hand formulas: static loads, frequencies on rigid ground, the 1973 vehicle."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw

#: Closed forms of a few operations.
EXACT = 1e-12

FOOT, POUND = 0.3048, 4.4482216152605
GRAVITY = 9.80665
HERTZ = 1.0 / (2.0 * np.pi)


def axle(position: float, tyre: float = 2e6, suspension: float = 5e5) -> sw.Axle:
    return sw.Axle(position=position, tyre_stiffness=tyre, suspension_stiffness=suspension)


def vehicle(*axles: sw.Axle, mass: float = 20e3, inertia: float = 60e3) -> sw.Vehicle:
    return sw.Vehicle(mass=mass, pitch_inertia=inertia, axles=axles)


def series(tyre: float, suspension: float) -> float:
    return tyre * suspension / (tyre + suspension)


def test_two_axles_share_the_weight_by_the_lever_rule() -> None:
    # Moments about the other axle: W (distance of the other axle from the c.g.) / wheelbase.
    # The stiffnesses do not matter.
    truck = vehicle(axle(1.5, tyre=3e6), axle(-3.5))
    weight = 20e3 * GRAVITY
    assert_allclose(truck.static_loads(), weight * np.array([3.5, 1.5]) / 5.0, rtol=EXACT)


def test_three_axles_share_the_weight_as_springs() -> None:
    # A rigid body on springs k_i at a_i sinks by (w, theta) with
    # sum k_i (w + a_i theta) = W and sum k_i a_i (w + a_i theta) = 0; friction carries nothing.
    positions, tyres, suspensions = [3.0, -1.0, -2.5], [2e6, 3e6, 2.5e6], [5e5, 8e5, 6e5]
    truck = vehicle(*map(axle, positions, tyres, suspensions))
    a = np.array(positions)
    k = np.array([*map(series, tyres, suspensions)])
    stiffness = np.array([[k.sum(), (k * a).sum()], [(k * a).sum(), (k * a**2).sum()]])
    sink, pitch = np.linalg.solve(stiffness, [20e3 * GRAVITY, 0.0])
    assert_allclose(truck.static_loads(), k * (sink + a * pitch), rtol=1e-10)
    assert truck.static_loads().sum() == pytest.approx(20e3 * GRAVITY, rel=EXACT)
    assert truck.static_loads() @ a == pytest.approx(0.0, abs=20e3 * GRAVITY * EXACT)


def test_static_loads_follow_gravity() -> None:
    truck = vehicle(axle(0.0))
    assert_allclose(truck.static_loads(gravity=1.62), [20e3 * 1.62], rtol=EXACT)


@pytest.mark.parametrize("locked", [True, False])
def test_frequencies_of_a_symmetric_vehicle(locked: bool) -> None:
    # Bounce (2 k / m)^(1/2), pitch (2 k a^2 / I)^(1/2): k is the tyre, or with the suspension in
    # series.
    k = 2e6 if locked else series(2e6, 5e5)
    truck = vehicle(axle(2.0), axle(-2.0))
    expected = np.sqrt([2.0 * k / 20e3, 2.0 * k * 2.0**2 / 60e3]) * HERTZ
    assert_allclose(truck.frequencies(locked=locked), np.sort(expected), rtol=EXACT)


def test_frequencies_of_an_unsymmetric_vehicle() -> None:
    # det(K - omega^2 diag(m, I)) = 0 is a quadratic in omega^2.
    a, k = np.array([1.5, -3.5]), 2e6
    m, inertia = 20e3, 60e3
    k11, k12, k22 = 2.0 * k, k * a.sum(), k * (a**2).sum()
    squares = np.roots([m * inertia, -(k11 * inertia + k22 * m), k11 * k22 - k12**2])
    truck = vehicle(axle(1.5), axle(-3.5))
    expected = np.sort(np.sqrt(squares)) * HERTZ
    assert_allclose(truck.frequencies(locked=True), expected, rtol=1e-10)


def test_one_axle_only_bounces() -> None:
    truck = vehicle(axle(0.0))
    assert_allclose(truck.frequencies(locked=True), [np.sqrt(2e6 / 20e3) * HERTZ], rtol=EXACT)
    assert truck.wheelbase == 0.0


def test_the_vehicle_of_1973() -> None:
    truck = sw.vehicles.kishan_1973()
    # 32 040 lb on each axle, 14 ft apart.
    assert_allclose(truck.static_loads() / POUND, [32_040.0, 32_040.0], rtol=EXACT)
    assert truck.wheelbase / FOOT == pytest.approx(14.0, rel=EXACT)
    # Both axles alike and symmetric, so the formulas above: in lb, ft and slug.
    slugs = 2.0 * 32_040.0 / (GRAVITY / FOOT)
    for locked, k in ((True, 480e3), (False, series(480e3, 270e3))):
        expected = np.sqrt([2.0 * k / slugs, 2.0 * k * 7.0**2 / 38_500.0]) * HERTZ
        assert_allclose(truck.frequencies(locked=locked), expected, rtol=1e-10)
    limits = [each.friction_limit / POUND for each in truck.axles]
    assert_allclose(limits, [4_800.0, 4_800.0], rtol=EXACT)


def test_initial_friction_changes_nothing_else() -> None:
    truck = sw.vehicles.kishan_1973()
    changed = truck.with_initial_friction(100.0, -200.0)
    assert [each.initial_friction for each in changed.axles] == [100.0, -200.0]
    assert [each.initial_friction for each in truck.axles] == [0.0, 0.0]
    assert changed.with_initial_friction(0.0, 0.0) == truck


def test_vehicles_cannot_be_changed() -> None:
    truck = vehicle(axle(2.0), axle(-2.0))
    with pytest.raises(dataclasses.FrozenInstanceError):
        truck.mass = 1.0  # type: ignore[misc]
    assert dataclasses.replace(truck, mass=1e4).static_loads().sum() == pytest.approx(1e4 * GRAVITY)


def test_axles_given_as_a_list_are_kept_as_a_tuple() -> None:
    truck = sw.Vehicle(mass=1e4, pitch_inertia=1e4, axles=[axle(1.0), axle(-1.0)])
    assert truck.axles == (axle(1.0), axle(-1.0))
    assert_allclose(truck.axle_positions, [1.0, -1.0])


def articulated(**hinge: float) -> sw.Vehicle:
    tractor = sw.Body(mass=6e3, pitch_inertia=9e3, axles=[axle(1.0), axle(-2.5)])
    held = sw.Hinge(**{"to": 0, "at": -2.0, "own": 5.0, **hinge})  # type: ignore[arg-type]
    trailer = sw.Body(mass=20e3, pitch_inertia=9e4, axles=[axle(-3.0)], hinge=held)
    return sw.Vehicle(bodies=[tractor, trailer])


def test_a_trailer_rests_on_its_tractor() -> None:
    # Of the trailer 3/8 rest on the hinge, 2 m behind the tractor's centre of mass; lever rule.
    truck = articulated()
    weight = 20e3 * GRAVITY
    hinge = 3.0 / 8.0 * weight
    rear = (1.0 * 6e3 * GRAVITY + 3.0 * hinge) / 3.5
    expected = [6e3 * GRAVITY + hinge - rear, rear, weight - hinge]
    assert_allclose(truck.static_loads(), expected, rtol=EXACT)
    assert_allclose(truck.axle_spacings, [3.5, 7.5], rtol=EXACT)
    assert truck.total_mass == 26e3
    # Along the road the whole balances about its centre of mass.
    assert truck.static_loads() @ truck.axle_positions == pytest.approx(0.0, abs=1e-6)
    assert truck.coordinates == ["body 1 heave", "body 1 pitch", "body 2 pitch"]
    assert [each.position for each in truck.axles] == [1.0, -2.5, -3.0]


def test_one_body_either_way() -> None:
    axles = [axle(2.0), axle(-2.0)]
    alone = sw.Vehicle(bodies=[sw.Body(mass=20e3, pitch_inertia=6e4, axles=axles, cg_height=1.5)])
    assert alone == sw.Vehicle(mass=20e3, pitch_inertia=6e4, axles=axles, cg_height=1.5)
    assert (alone.mass, alone.bodies) == (20e3, ())
    assert alone.parts[0].axles == tuple(axles)


def test_changes_to_a_vehicle_of_several_bodies() -> None:
    truck = articulated()
    rubbing = [dataclasses.replace(each, friction_limit=5e3) for each in truck.bodies[0].axles]
    front = dataclasses.replace(truck.bodies[0], axles=rubbing)
    truck = dataclasses.replace(truck, axles=(), bodies=[front, truck.bodies[1]])
    changed = truck.with_initial_friction(1e3, -2e3, 0.0)
    assert [each.initial_friction for each in changed.axles] == [1e3, -2e3, 0.0]
    assert [each.initial_friction for each in changed.bodies[0].axles] == [1e3, -2e3]
    assert changed.with_initial_friction(0.0, 0.0, 0.0) == truck
    assert dataclasses.replace(truck) == truck


def test_friction_holds_where_there_is_some() -> None:
    # A single unsprung mass: the stick of 20 tyres beside the suspension, or the one given.
    def truck(**more: float) -> sw.Vehicle:
        wheel = sw.Axle(
            position=0.0, tyre_stiffness=2e6, suspension_stiffness=5e5, mass=800.0, **more
        )
        return vehicle(wheel)

    def expected(k: float) -> np.ndarray:
        stiffness = np.array([[k, -k], [-k, k + 2e6]]) / np.array([20e3, 800.0])[:, None]
        return np.sort(np.sqrt(np.linalg.eigvals(stiffness))) * HERTZ

    for more, stick in (
        ({}, 0.0),
        ({"friction_limit": 1e3}, 20 * 2e6),
        ({"friction_limit": 1e3, "stick_stiffness": 7e6}, 7e6),
        ({"friction_limit": 1e3, "leaf_decay": 0.002}, 1e6),
    ):
        rubs = truck(**more)
        assert_allclose(rubs.frequencies(locked=True), expected(5e5 + stick), rtol=1e-10)
        assert_allclose(rubs.frequencies(locked=False), expected(5e5), rtol=1e-10)


def test_trains_have_loads_and_nothing_that_vibrates() -> None:
    forces = sw.ForceTrain(loads=[1e5, 2e5], spacings=[3.0])
    assert forces == sw.ForceTrain(loads=(1e5, 2e5), positions=(0.0, -3.0))
    assert_allclose(forces.static_loads(gravity=1.0), [1e5, 2e5], rtol=0)
    assert_allclose(forces.axle_positions, [2.0, -1.0], rtol=EXACT)
    assert (forces.wheelbase, forces.total_mass, forces.coordinates) == (3.0, 0.0, [])
    masses = sw.MovingMasses(masses=[1e4, 2e4], positions=[7.0, 4.0])
    assert_allclose(masses.static_loads(gravity=2.0), [2e4, 4e4], rtol=EXACT)
    assert_allclose(masses.axle_positions, [2.0, -1.0], rtol=EXACT)
    assert masses.total_mass == 3e4
    for train in (forces, masses):
        assert train.frequencies(locked=True).shape == (0,)
    assert dataclasses.replace(forces, loads=[1.0, 2.0]).positions == forces.positions
    assert sw.ForceTrain(loads=[5.0]).wheelbase == 0.0


def test_frequencies_are_by_default_those_of_sliding_suspensions() -> None:
    truck = sw.vehicles.kishan_1973()
    assert_allclose(truck.frequencies(), truck.frequencies(locked=False), rtol=0)


def test_what_does_not_pitch_needs_no_pitch_inertia() -> None:
    free, given = (
        sw.Vehicle(mass=20e3, pitch_inertia=inertia, axles=[axle(0.0)]) for inertia in (None, 6e4)
    )
    assert free.pitch_inertia is None
    assert_allclose(free.frequencies(), given.frequencies(), rtol=0)
    lower = sw.Body(mass=2e3, axles=[axle(0.0)])
    upper = sw.Body(mass=9e3, springs=[sw.Spring(to=0, at=0.0, own=0.0, stiffness=1e6)])
    assert sw.Vehicle(bodies=[lower, upper]).coordinates == ["body 1 heave", "body 2 heave"]
    with pytest.raises(ValueError, match="pitch_inertia = None: must be a number"):
        sw.Vehicle(mass=20e3, axles=[axle(1.0), axle(-1.0)])
    with pytest.raises(ValueError, match=r"bodies\[0\]\.pitch_inertia = None: must be a number"):
        sw.Vehicle(
            bodies=[
                dataclasses.replace(lower, axles=[axle(1.0), axle(-1.0)]),
                upper,
            ]
        )


def test_vehicles_and_passages_in_short() -> None:
    assert repr(sw.vehicles.kishan_1973()) == "Vehicle(29.07 t, 2 axles, 4.267 m)"
    truck = sw.vehicles.articulated_5_axle()
    assert repr(truck) == "Vehicle(40 t, 2 bodies, 5 axles, 12.8 m)"
    assert repr(sw.vehicles.quarter_car()) == "Vehicle(18 t, 1 axle, 0 m)"
    assert repr(sw.Passage(vehicle=truck)) == f"Passage({truck!r} to the right)"
    full = sw.Passage(
        vehicle=truck, direction="left", entry=2.0, speed=9.0, drive="constant-speed", lane=3
    )
    assert repr(full) == (
        f"Passage({truck!r} to the left, entry=2, speed=9.0, drive='constant-speed', lane=3)"
    )
