"""Neither the height of a measured road above the sea nor its grade counts, and no start is rough.

Vertical motion is counted from the least-squares line of the first 10 m of the profile from the
start of the approach. A vehicle starts at rest on the road under it.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import spanwise as sw
from spanwise.roads import Road
from spanwise.vehicles import AnyVehicle

BRIDGE = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)
X = np.arange(-120.0, 150.0, 0.1)
ROUGH = sw.ISO8608("A", seed=2)
GRAVITY = 9.80665

#: Rounding of elevations of 500 m is 6e-14 m, 1e-11 of what is uneven.
ALIKE = 1e-9


def profile(height: float = 0.0, grade: float = 0.0, seed: int = 2) -> sw.Profile:
    rough = sw.ISO8608("A", seed=seed)
    return sw.Profile(X, rough.elevation(X) + height + grade * X)


def check_alike(one: sw.Run, other: sw.Run) -> None:
    pairs = [(getattr(one, name), getattr(other, name)) for name in ("deflection", "moment")]
    pairs += [(one.shear, other.shear), (one.axle_loads, other.axle_loads)]
    for mine, its in zip(one.vehicles, other.vehicles, strict=True):
        names = ("elevations", "suspension_travel", "friction", "speed")
        pairs += [(getattr(mine, name), getattr(its, name)) for name in names]
        pairs += [
            (a.heave.displacement, b.heave.displacement)
            for a, b in zip(mine.bodies, its.bodies, strict=True)
        ]
    for mine_, its_ in pairs:
        largest = np.abs(mine_).max()
        assert_allclose(its_, mine_, rtol=0.0, atol=ALIKE * largest if largest > 0.0 else 1e-15)


VEHICLES: dict[str, AnyVehicle] = {
    "half-car": sw.vehicles.half_car(),
    "rubbing": sw.vehicles.kishan_1973(),
    "articulated": sw.vehicles.articulated_5_axle(),
    "forces": sw.vehicles.flm3(),
}


@pytest.mark.parametrize("ramp", [None, 0.0])
@pytest.mark.parametrize("vehicle", VEHICLES)
def test_heights_and_grades_do_not_count(vehicle: str, ramp: float | None) -> None:
    def crossing(road: Road) -> sw.Run:
        given: dict[str, Any] = {"speed": 20.0, "damping": 0.02, "ramp": ramp, "step": 5e-3}
        return sw.cross(BRIDGE, VEHICLES[vehicle], road=road, beta=0.25, modes=3, **given)

    plain = crossing(profile())
    for height, grade in [(0.5, 0.0), (2.0, 0.0), (500.0, 0.0), (0.0, 0.03), (300.0, -0.06)]:
        check_alike(plain, crossing(profile(height, grade)))
    largest = plain.axle_loads.max(axis=0) / plain.static_axle_loads
    assert (largest < 1.5).all()


@pytest.mark.parametrize("ramp", [None, 0.0])
@pytest.mark.parametrize("direction", ["right", "left"])
def test_a_vertical_curve_gives_no_jolt_at_the_start(ramp: float | None, direction: Any) -> None:
    """A parabola 10 m deep over 420 m presses a vehicle down by its curvature alone."""
    way = np.arange(-440.0, 50.0, 0.25)
    x, z = way, 10.0 * ((way + 210.0) / 210.0) ** 2
    sag = sw.Profile(x, z) if direction == "right" else sw.Profile(20.0 - x[::-1], z[::-1])
    passage = sw.Passage(vehicle=sw.vehicles.half_car(), direction=direction)
    given: dict[str, Any] = {"speed": 20.0, "damping": 0.02, "ramp": ramp}
    loads = [
        run.axle_loads / run.static_axle_loads
        for run in (
            sw.cross(BRIDGE, [passage], road=sag, approach=a, **given) for a in (60.0, 420.0)
        )
    ]
    pressed = 1.0 + 20.0**2 * 2.0 * 10.0 / 210.0**2 / GRAVITY
    for each in loads:
        assert each[:60].max() < 1.1
    # Long after a start it is the curvature, and the bridge meets the same vehicle.
    assert_allclose(loads[1][-400:-300].mean(), pressed, rtol=0.02)
    assert loads[0].max() == pytest.approx(loads[1].max(), rel=0.03)


def test_masses_that_follow_the_road() -> None:
    x = np.arange(-120.0, 150.0, 0.5)
    waves = 0.004 * np.sin(0.9 * x) + 0.01 * np.cos(0.2 * x)
    masses = sw.MovingMasses(masses=[3e3, 4e3], spacings=[3.7])

    def crossing(height: float, grade: float) -> sw.Run:
        road = sw.Profile(x, waves + height + grade * x)
        return sw.cross(BRIDGE, masses, speed=20.0, road=road, accuracy=0.02)

    for height, grade in [(40.0, 0.0), (0.0, 0.04)]:
        check_alike(crossing(0.0, 0.0), crossing(height, grade))


@pytest.mark.parametrize("ramp", [None, 0.0])
def test_several_vehicles_on_roads_of_their_own(ramp: float | None) -> None:
    def crossing(height: float, grade: float) -> sw.Run:
        truck, lorry = sw.vehicles.half_car(), sw.vehicles.kishan_1973()
        passages = [
            sw.Passage(vehicle=truck),
            sw.Passage(vehicle=lorry, direction="left", road=profile(height, grade, 5), entry=0.4),
            sw.Passage(vehicle=truck, entry=2.0),
        ]
        road = profile(-height, grade) + sw.ISO8608("A", seed=9) + sw.Bump(8.0, 2.0, 0.01)
        given: dict[str, Any] = {"speed": 21.0, "approach": 60.0, "ramp": ramp, "damping": 0.02}
        return sw.cross(BRIDGE, passages, road=road, **given)

    plain = crossing(0.0, 0.0)
    for height, grade in [(500.0, 0.0), (2.0, 0.05)]:
        check_alike(plain, crossing(height, grade))


@pytest.mark.parametrize("ramp", [None, 0.0])
def test_in_ensembles(ramp: float | None) -> None:
    def study(height: float, grade: float) -> sw.Ensemble:
        given: dict[str, Any] = {"speed": 20.0, "samples": 5, "ramp": ramp, "damping": 0.02}
        road = profile(height, grade) + sw.ISO8608("B", seed=7, period=400.0)
        return sw.ensemble(BRIDGE, sw.vehicles.half_car(), road=road, **given)

    plain = study(0.0, 0.0)
    for height, grade in [(500.0, 0.0), (2.0, 0.05)]:
        other = study(height, grade)
        for name in ("moment", "deflection", "axle_loads"):
            one, its = plain.envelope(name), other.envelope(name)
            assert_allclose(its.max, one.max, rtol=0.0, atol=ALIKE * np.abs(one.max).max())
        run = other.run(3)
        assert_array_equal(other.envelope("moment").max[3], run.envelope("moment").max.value)
        assert_array_equal(
            other.envelope("axle_loads").max[3], run.envelope("axle_loads").max.value
        )


@pytest.mark.parametrize("direction", ["right", "left"])
@pytest.mark.parametrize("ramp", [None, 0.0])
def test_a_grade_is_climbed_steadily(ramp: float | None, direction: Any) -> None:
    road = sw.Profile(X, 120.0 + 0.05 * X)
    for vehicle in VEHICLES.values():
        passage = sw.Passage(vehicle=vehicle, direction=direction)
        given: dict[str, Any] = {"speed": 20.0, "ramp": ramp}
        run = sw.cross(BRIDGE, [passage], road=road, approach=60.0, **given)
        level = sw.cross(BRIDGE, vehicle, speed=20.0, approach=60.0)
        on_the_way = run.time < 60.0 / 20.0 - 0.1
        loads = run.axle_loads[on_the_way]
        assert_allclose(loads, np.broadcast_to(run.static_axle_loads, loads.shape), rtol=ALIKE)
        assert run.axle_loads.max(axis=0) == pytest.approx(level.axle_loads.max(axis=0), rel=1e-3)


@pytest.mark.parametrize("feature", [sw.Step(-500.0, 0.3), sw.Ramp(-800.0, -600.0, 4.0)])
def test_what_is_far_in_front_of_the_approach_does_not_count(feature: Road) -> None:
    for ramp in (None, 0.0):
        given: dict[str, Any] = {"speed": 20.0, "damping": 0.02, "ramp": ramp}
        without = sw.cross(BRIDGE, sw.vehicles.half_car(), road=ROUGH, **given)
        beyond = sw.cross(BRIDGE, sw.vehicles.half_car(), road=ROUGH + feature, **given)
        check_alike(without, beyond)


def test_a_grade_slows_what_rolls_freely() -> None:
    grade, way = 0.03, 100.0
    for vehicle in (sw.vehicles.kishan_1973(), sw.vehicles.half_car(cg_height=1.5)):
        for direction, sign in (("right", 1.0), ("left", -1.0)):
            run = sw.cross(
                BRIDGE,
                [sw.Passage(vehicle=vehicle, direction=direction)],  # type: ignore[arg-type]
                speed=20.0,
                approach=way,
                road=sw.Profile(X, 80.0 + grade * X),
                drive="constant-traction",
            )
            motion = run.vehicle
            before = run.time < way / 20.0 - 0.5
            # From the start, without load transfer: weight acts at the centre of mass.
            assert_allclose(motion.acceleration[before], -sign * GRAVITY * grade, rtol=1e-9)
            gone = motion.travel[before] - motion.travel[0]
            squares = 20.0**2 - 2.0 * sign * GRAVITY * grade * gone
            assert_allclose(motion.speed[before], np.sqrt(squares), rtol=1e-9)
            loads = run.axle_loads[before]
            assert_allclose(loads, np.broadcast_to(run.static_axle_loads, loads.shape), rtol=1e-9)


def test_energy_on_a_rough_grade() -> None:
    """Kinetic energy, height and springs together stay what they are while nothing is lost."""
    axles = [
        sw.Axle(position=x, tyre_stiffness=1.6e6, suspension_stiffness=9e5) for x in (2.1, -2.1)
    ]
    truck = sw.Vehicle(mass=18e3, pitch_inertia=6e4, axles=axles, cg_height=1.4)
    grade, x = 0.04, np.arange(-120.0, 150.0, 0.5)
    waves = 0.01 * np.sin(0.5 * x) + 0.006 * np.cos(0.23 * x)
    road = sw.Profile(x, waves + 250.0 + grade * x, contact_patch=0.0)
    # Felt from the line of the first 10 m, told from that of the whole way.
    begins, whole = np.linspace(-100.0, -90.0, 50), np.linspace(-100.0, 20.0, 50)
    datum, told = (float(np.polyfit(x, road.elevation(x), 1)[0]) for x in (begins, whole))
    drifts = []
    for step in (2e-3, 1e-3):
        run = sw.cross(
            BRIDGE,
            truck,
            speed=20.0,
            road=road,
            drive="constant-traction",
            step=step,
        )
        motion, before = run.vehicle, run.time < 4.0
        increments = run.axle_loads - run.static_axle_loads
        soft = 1.6e6 * 9e5 / (1.6e6 + 9e5)
        strain = ((0.5 * increments + run.static_axle_loads) * increments / soft).sum(axis=1)
        rising = motion.heave_velocity + (datum - told) * motion.speed
        kinetic = 0.5 * 18e3 * (motion.speed**2 + rising**2)
        kinetic += 0.5 * 6e4 * motion.pitch_velocity**2
        height = 18e3 * GRAVITY * (told * (motion.travel - motion.travel[0]) - motion.heave)
        total = (kinetic + height + strain)[before]
        drifts.append(np.abs(total - total[0]).max() / strain.max())
        assert abs(kinetic[before][-1] - kinetic[0]) > 10.0 * strain.max()
    assert drifts[0] < 5e-5
    assert drifts[0] / drifts[1] == pytest.approx(4.0, rel=0.3)


# The start without a ramp.


def of_axles(positions: list[float], **given: float) -> sw.Vehicle:
    axle: dict[str, float] = {"tyre_stiffness": 2e6, "suspension_stiffness": 8e5, **given}
    axles = [sw.Axle(position=x, **axle) for x in positions]
    return sw.Vehicle(mass=2e4, pitch_inertia=8e4, axles=axles)


def standing(vehicle: sw.Vehicle, road: Road, **given: Any) -> sw.Run:
    return sw.cross(BRIDGE, vehicle, speed=10.0, road=road, approach=30.0, ramp=0.0, **given)


def test_two_axles_stand_on_any_road_with_their_static_loads() -> None:
    for mass in (0.0, 600.0):
        vehicle = of_axles([2.5, -1.5], mass=mass)
        run = standing(vehicle, ROUGH * 4.0)
        assert_allclose(run.axle_loads[0], run.static_axle_loads, rtol=1e-12)
        motion = run.vehicle
        for each in (*motion.hops, motion.bodies[0].heave, motion.bodies[0].pitch):
            assert abs(each.velocity[0]) == 0.0
            assert abs(each.acceleration[0]) < 1e-9
        # As high as the wheels have it.
        left, right = motion.elevations[0]
        assert motion.heave[0] == pytest.approx(-(1.5 * left + 2.5 * right) / 4.0, rel=1e-9)
        assert motion.pitch[0] == pytest.approx(-(left - right) / 4.0, rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 5e3])
@pytest.mark.parametrize("mass", [0.0, 500.0])
def test_more_axles_share_the_weight_as_springs(friction: float, mass: float) -> None:
    positions = np.array([3.0, -0.5, -2.5])
    given = {"friction_limit": friction, "initial_friction": 0.4 * friction, "mass": mass}
    vehicle = of_axles(positions.tolist(), **given)
    run = standing(vehicle, ROUGH * 3.0)
    spring, tyre = 8e5, 2e6
    soft = spring * tyre / (spring + tyre)
    rows = np.column_stack([np.ones(3), positions])
    r = run.vehicle.elevations[0]
    q = -np.linalg.solve(rows.T @ rows, rows.T @ r)
    expected = soft * (rows @ q + r)
    assert np.abs(expected).max() > 200.0
    assert_allclose(run.axle_loads[0] - run.static_axle_loads, expected, rtol=1e-8, atol=1e-6)
    assert run.vehicle.heave[0] == pytest.approx(q[0], rel=1e-9)
    # The spring alone carries it; friction is what it was.
    assert_allclose(run.vehicle.suspension_travel[0], expected / spring, rtol=1e-7, atol=1e-12)
    assert_allclose(run.vehicle.friction[0], 0.4 * friction)
    # Nothing happens at first: not by a start, only by the road.
    assert abs(run.vehicle.heave_acceleration[0]) < 1e-9
    assert abs(run.vehicle.pitch_acceleration[0]) < 1e-9


def test_a_wheel_over_a_hole_hangs() -> None:
    vehicle = of_axles([3.0, -0.2, -2.8])
    hole = sw.Pothole(-33.2, 0.8, 0.4, edge=0.1)
    free = standing(vehicle, hole)
    # The second axle alone is over a hole; the lever rule gives the others all.
    weight = 2e4 * GRAVITY
    expected = np.array([weight * 2.8 / 5.8, 0.0, weight * 3.0 / 5.8])
    assert_allclose(free.vehicle.elevations[0], [0.0, -0.4, 0.0], atol=1e-12)
    assert_allclose(free.axle_loads[0], expected, atol=1e-6)
    assert abs(free.vehicle.heave_acceleration[0]) < 1e-9
    held = standing(vehicle, hole, lift_off=False)
    assert held.axle_loads[0, 1] < 0.0
    assert held.axle_loads[0].sum() == pytest.approx(weight)


def test_a_wheel_that_stands_on_a_free_end_loads_the_bridge() -> None:
    bridge = sw.Bridge(spans=[20.0], ends=("free", "clamped"), EI=3e9, mass=9e3)
    vehicle = of_axles([3.0, -0.5, -2.5])
    given: dict[str, Any] = {"speed": 10.0, "approach": 0.0, "ramp": 0.0, "modes": 3}
    bump = sw.Bump(0.0, 4.0, 0.02)
    run = sw.cross(bridge, vehicle, road=bump, **given)
    level = sw.cross(bridge, vehicle, **given)
    # The first axle, on the bump, carries more, and the bridge feels it from the first instant on.
    ratio = run.axle_loads[0, 0] / level.axle_loads[0, 0]
    assert ratio > 1.01
    assert_allclose(run.modal.accelerations[0], ratio * level.modal.accelerations[0], rtol=1e-9)


@pytest.mark.parametrize("direction", ["right", "left"])
@pytest.mark.parametrize("grade", [-0.05, 0.03])
def test_brakes_that_hold_on_a_grade_shift_load(grade: float, direction: Any) -> None:
    """By hand: m g grade h by the wheelbase, off the front axle uphill; unsprung masses are low."""
    road = sw.Profile(X, grade * X)
    uphill = grade if direction == "right" else -grade
    drive = sw.Braking(deceleration=4.0, start=-40.0)
    for height in (0.8, 1.5):
        vehicle = sw.vehicles.half_car(cg_height=height)
        passage = sw.Passage(vehicle=vehicle, direction=direction, drive=drive)
        given: dict[str, Any] = {
            "speed": 20.0,
            "approach": 60.0,
            "tail": 30.0,
            "beta": 0.25,
            "step": 5e-3,
        }
        run = sw.cross(BRIDGE, [passage], road=road, modes=1, damping=0.05, **given)
        assert run.vehicle.stopped is not None
        transfer = 16_200.0 * GRAVITY * uphill * height / 4.75
        found = run.axle_loads[-1] - run.static_axle_loads
        assert found == pytest.approx([-transfer, transfer], rel=2e-3)


def test_who_brakes_to_rest_as_prescribed_holds_its_static_loads() -> None:
    """Under prescribed motion what a grade shifts is left out, at rest too."""
    road = sw.Profile(X, -0.05 * X)
    drive = sw.Speeds(times=[0.0, 3.0, 4.0], speeds=[20.0, 18.0, 0.0])
    passage = sw.Passage(vehicle=sw.vehicles.half_car(cg_height=1.5), drive=drive)
    given: dict[str, Any] = {"approach": 58.0, "tail": 40.0, "beta": 0.25, "step": 5e-3, "modes": 1}
    run = sw.cross(BRIDGE, [passage], road=road, damping=0.05, **given)
    assert run.vehicle.stopped is not None
    assert run.axle_loads[-1] == pytest.approx(run.static_axle_loads, rel=1e-4)


@pytest.mark.parametrize("direction", ["right", "left"])
def test_motion_is_told_from_the_line_of_the_whole_way(
    direction: Literal["right", "left"],
) -> None:
    """The line of the first 10 m leads decimetres off a rough road, which is not to be seen."""
    x = np.arange(-320.0, 360.0, 0.1)
    bridge = sw.Bridge(spans=[40.0], EI=4e10, mass=1.2e4)
    profile = sw.Profile(x, sw.ISO8608("C", seed=16).elevation(x) + 300.0 + 0.02 * x)
    run = sw.cross(
        bridge,
        sw.Passage(vehicle=sw.vehicles.half_car(), direction=direction, speed=20.0),
        road=profile,
        approach=200.0,
        damping=0.02,
    )
    motion = run.vehicle
    way = motion.axle_positions if direction == "right" else 40.0 - motion.axle_positions
    over = (way[:, 0] > -150.0) & (way[:, 0] < 40.0)
    assert np.abs(motion.elevations[over]).max() < 0.1
    assert np.abs(motion.heave[over]).max() < 0.1
    # Off a line all the same: what is told differs from the profile by one.
    x_1 = motion.axle_positions[over, 0]
    off = motion.elevations[over, 0] - profile.elevation(x_1)
    line = np.polynomial.Polynomial.fit(x_1, off, 1)
    assert np.abs(off - line(x_1)).max() < 1e-9
    assert line.convert().coef[1] == pytest.approx(-0.02, abs=2e-4)
    # Rates are those of the displacements, and the body stays on its wheels.
    for each in (motion.bodies[0].heave, motion.bodies[0].pitch, *motion.hops):
        rate = np.gradient(each.displacement, run.time)[1:-1]
        assert np.abs(rate - each.velocity[1:-1]).max() < 0.02 * np.abs(each.velocity).max()
    sunk = np.array([hop.displacement for hop in motion.hops]).T + motion.elevations
    assert np.abs(sunk[over]).max() < 0.03
