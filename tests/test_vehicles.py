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


def test_every_preset_is_a_vehicle_or_a_train() -> None:
    assert "kishan-1973" in sw.vehicles.PRESETS
    for name, make in sw.vehicles.PRESETS.items():
        assert isinstance(make(), sw.Vehicle | sw.ForceTrain), name
        assert make().static_loads().min() > 0.0, name


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
