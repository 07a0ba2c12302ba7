"""Several vehicles, their drives and their roads: what they do, and what is refused."""

from __future__ import annotations

import pickle
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import spanwise as sw

nan, inf = float("nan"), float("inf")

POSITIVE = "greater than 0"

#: Sums of a few rounded terms.
EXACT = 1e-9

BRIDGE = sw.Bridge(spans=[20.0, 20.0], EI=5e9, mass=8e3, stations_per_span=4)
TRUCK = sw.vehicles.kishan_1973()


def passage(**changes: Any) -> sw.Passage:
    return sw.Passage(**{"vehicle": TRUCK, **changes})


def cross(*passages: sw.Passage, **changes: Any) -> sw.Run:
    given = passages or (passage(),)
    return sw.cross(BRIDGE, given, **{"speed": 20.0, "modes": 3, **changes})


# What they do


def test_one_passage_is_the_vehicle_alone() -> None:
    alone = sw.cross(BRIDGE, TRUCK, speed=20.0, modes=3)
    for given in (passage(), [passage()], (passage(speed=20.0),)):
        run = sw.cross(BRIDGE, given, speed=20.0, modes=3)
        assert_array_equal(run.moment, alone.moment)
        assert_array_equal(run.axle_loads, alone.axle_loads)


def test_passages_say_what_the_crossing_does_not() -> None:
    first = passage(speed=15.0, drive="constant-traction")
    second = passage(direction="left", entry=0.5, drive=sw.Acceleration(acceleration=1.0))
    run = cross(first, second)
    assert run.passages == (first, second)
    assert run.axles == [(1, 1), (1, 2), (2, 1), (2, 2)]
    assert run.axle_loads.shape == (len(run.time), 4)
    right, left = run.vehicles
    assert right.speed[0] == 15.0
    # Enters at the right end 0.5 s after the start, and then 20 t + t^2 / 2.
    later = run.time > 0.5
    t = run.time[later] - 0.5
    assert_allclose(left.speed[later], 20.0 + t, rtol=EXACT)
    front = 40.0 - (20.0 * t + 0.5 * t**2)
    # The end is when the last axle leaves, found to about a millionth of a step.
    assert_allclose(left.axle_positions[later, 0], front, rtol=EXACT, atol=1e-6)
    assert_allclose(left.axle_positions[:, 1] - left.axle_positions[:, 0], TRUCK.wheelbase)
    # From the end at which it enters, its centre half the wheelbase behind the front axle.
    travel = 40.0 - left.axle_positions[:, 0] - 0.5 * TRUCK.wheelbase
    assert_allclose(left.travel, travel, rtol=EXACT, atol=1e-9)


def test_mirrored_traffic_mirrors_the_bridge() -> None:
    # The bridge is symmetric. Free ends of lines are the same on both sides.
    right, left = cross(passage()), cross(passage(direction="left"))
    middle = int(np.flatnonzero(right.sections == 20.0)[0])
    largest = np.abs(right.moment).max()
    for x, y in ((right.moment, left.moment), (right.deflection, left.deflection)):
        assert_allclose(y[:, ::-1], x, atol=1e-6 * np.abs(x).max())
    assert np.abs(right.moment[:, middle]).max() < largest


def test_forces_that_cross_together_add_up() -> None:
    # Constant forces do not feel the bridge, which is linear.
    train = sw.ForceTrain(loads=[60e3, 90e3], spacings=[4.0])
    first, second = sw.Passage(vehicle=train), sw.Passage(vehicle=train, direction="left")
    step = {"step": 1e-3, "tail": 0.2}
    both = cross(first, second, **step)
    each = [cross(alone, **step) for alone in (first, second)]
    assert_allclose(both.moment, each[0].moment + each[1].moment, atol=1.0)
    assert_array_equal(both.axle_loads, np.tile([60e3, 90e3, 60e3, 90e3], (len(both.time), 1)))


@pytest.mark.parametrize("headway", [2.0, [2.0, 3.5]])
def test_convoys(headway: Any) -> None:
    train = sw.vehicles.hs20()
    vehicles: list[sw.vehicles.AnyVehicle] = [TRUCK, train, TRUCK]
    convoy = sw.convoy(vehicles, headway=headway, entry=1.0, direction="left", speed=15.0, lane=2)
    gaps = [2.0, 2.0] if headway == 2.0 else headway
    assert [each.entry for each in convoy] == [1.0, 1.0 + gaps[0], 1.0 + sum(gaps)]
    assert [each.vehicle for each in convoy] == vehicles
    assert {(each.direction, each.speed, each.lane) for each in convoy} == {("left", 15.0, 2)}
    assert sw.convoy([TRUCK], headway=2.0) == [passage()]


def test_speeds_in_time() -> None:
    # 10 m/s, from 1 s to 2 s growing to 20 m/s: 10, then 10 + 15 m, then 20 m/s.
    drive = sw.Speeds(times=[1.0, 2.0], speeds=[10.0, 20.0])
    run = sw.cross(BRIDGE, TRUCK, drive=drive, modes=2, step=1e-3)
    assert "speed" not in run.settings
    front = run.vehicle.axle_positions[:, 0]
    for t, x, v in ((0.5, 5.0, 10.0), (1.0, 10.0, 10.0), (2.0, 25.0, 20.0), (2.5, 35.0, 20.0)):
        assert np.interp(t, run.time, front) == pytest.approx(x, abs=1e-4)
        # A step across a kink is not split.
        assert np.interp(t, run.time, run.vehicle.speed) == pytest.approx(v, abs=0.01)


def test_a_vehicle_that_comes_to_a_stop_stays() -> None:
    # v^2 / 2 a = 12^2 / 8 = 18 m after 3 s.
    run = cross(drive=sw.Acceleration(acceleration=-4.0), speed=12.0, tail=1.0)
    assert run.vehicle.stopped == pytest.approx(3.0, rel=EXACT)
    assert run.time[-1] == pytest.approx(4.0, rel=EXACT)
    after = run.time >= 3.0
    assert_allclose(run.vehicle.axle_positions[after, 0], 18.0, rtol=EXACT)
    assert run.final_speed == 0.0
    assert "the vehicle stops on the bridge at t = 3.000 s, x = 18.000 m" in run.summary()
    assert run.to_dict()["vehicles"][0]["stopped"]["time"] == pytest.approx(3.0)
    assert cross().vehicle.stopped is None
    assert "stops" not in cross().summary()


def test_braking_stops_where_energy_says() -> None:
    # v^2 / 2 d beyond where the brakes are on fully, and v t - d t^2 / 6 during the ramp of t, in
    # which v drops by d t / 2; the slope of the bridge adds little.
    v, d, t, start = 12.0, 3.0, 0.4, 2.0
    run = cross(drive=sw.Braking(deceleration=d, start=start, ramp=t), speed=v, tail=1.0)
    stops = start + v * t - d * t**2 / 6 + (v - d * t / 2) ** 2 / (2 * d)
    assert run.vehicle.axle_positions[-1, 0] == pytest.approx(stops, abs=0.05)
    assert run.vehicle.stopped == pytest.approx(start / v + t / 2 + v / d, abs=0.01)
    # The front axle takes m d h / wheelbase more.
    assert TRUCK.mass is not None
    more = TRUCK.mass * d * TRUCK.cg_height / TRUCK.wheelbase
    braked = (run.time > 1.0) & (run.time < 3.0)
    difference = 0.5 * (run.axle_loads[braked, 0] - run.axle_loads[braked, 1]).mean()
    assert difference == pytest.approx(more, rel=0.05)
    assert "braking by 3 m/s2 from 2 m after its end of the bridge, friction 0.7" in run.summary()


def test_brakes_that_never_come_on() -> None:
    said = "the brakes never come on: its front axle never comes to start = 80 m"
    with pytest.warns(UserWarning, match=said):
        run = cross(drive=sw.Braking(deceleration=3.0, start=80.0))
    assert said in run.summary()


@pytest.mark.parametrize("direction", ["right", "left"])
def test_a_vehicle_that_stops_before_the_bridge(direction: Any) -> None:
    said = "stops before it reaches the bridge"
    drive = sw.Braking(deceleration=3.0, start=-35.0)
    given = sw.Passage(vehicle=TRUCK, drive=drive, speed=8.0, direction=direction)
    with pytest.warns(UserWarning, match=said):
        run = sw.cross(BRIDGE, given, modes=2, approach=40.0)
    assert said in run.summary()


def test_a_speed_is_used_beside_speeds_in_time_by_another() -> None:
    timed = passage(drive=sw.Speeds(times=[0.0], speeds=[15.0]), direction="left")
    run = cross(passage(), timed)
    assert run.settings["speed"] == 20.0
    assert [motion.speed[0] for motion in run.vehicles] == [20.0, 15.0]


LEVEL = "centres of mass at road level: no load transfer from braking or accelerating"


@pytest.mark.parametrize(
    "drive",
    [
        sw.Braking(deceleration=3.0),
        sw.Acceleration(acceleration=1.0),
        sw.Speeds(times=[0.0, 1.0], speeds=[12.0, 14.0]),
    ],
    ids=lambda drive: drive.kind,
)
def test_a_vehicle_without_heights_shifts_no_load(drive: Any) -> None:
    speed = None if isinstance(drive, sw.Speeds) else 12.0
    level, high = (sw.vehicles.half_car(cg_height=height) for height in (0.0, 1.5))
    with pytest.warns(UserWarning, match=f"^{LEVEL}$"):
        run = sw.cross(BRIDGE, level, speed=speed, modes=2, drive=drive)
    assert LEVEL in run.summary()
    both = [
        sw.Passage(vehicle=TRUCK, speed=12.0),
        sw.Passage(vehicle=level, drive=drive, speed=speed, direction="left"),
    ]
    with pytest.warns(UserWarning, match=re.escape(f"vehicles[1]: {LEVEL}")):
        sw.cross(BRIDGE, both, modes=2)
    # Neither where there is a height, nor where nothing is accelerated or there is one axle.
    assert LEVEL not in sw.cross(BRIDGE, high, speed=speed, modes=2, drive=drive).summary()
    assert LEVEL not in sw.cross(BRIDGE, level, speed=12.0, modes=2).summary()
    alone = sw.vehicles.quarter_car()
    assert LEVEL not in sw.cross(BRIDGE, alone, speed=speed, modes=2, drive=drive).summary()


def test_friction_bounds_the_brakes() -> None:
    hard = sw.Braking(deceleration=9.0, friction=0.3)
    run = cross(drive=hard, speed=12.0)
    # The loads under the wheels, and the slope of the bridge, vary about those at rest.
    assert run.vehicle.acceleration.min() == pytest.approx(-0.3 * 9.80665, rel=0.1)


def test_wheels_leave_a_bad_road() -> None:
    road = sw.ISO8608("D", seed=1)
    run = sw.cross(BRIDGE, sw.vehicles.hs20_44(), speed=25.0, road=road)
    off = run.contact_loss
    assert len(run.lift_offs) == off.count.sum() > 0
    longest = max(run.lift_offs, key=lambda each: each.duration)
    assert off.longest.max() == longest.duration == off.longest[longest.axle - 1]
    for axle in range(3):
        spans = [each for each in run.lift_offs if each.axle == axle + 1]
        assert off.count[axle] == len(spans)
        assert off.total[axle] == pytest.approx(sum(each.duration for each in spans))
        lifted = np.zeros(len(run.time), dtype=bool)
        for each in spans:
            lifted |= (run.time >= each.start) & (run.time < each.end)
        # Until the last axle has left.
        there = run.time < run.time[-1] - run.tail
        assert_array_equal((run.axle_loads[:, axle] == 0.0)[there], lifted[there])
        assert not lifted[~there].any()
    assert f"wheels    leave the road {off.count.sum()} times" in run.summary()
    assert len(run.to_dict()["lift_offs"]) == len(run.lift_offs)
    held = sw.cross(BRIDGE, sw.vehicles.hs20_44(), speed=25.0, road=road, lift_off=False)
    assert held.lift_offs == ()
    assert held.axle_loads.min() < 0.0
    assert "wheels    held to the road" in held.summary()
    assert "wheels    never leave the road" in cross().summary()


def test_elevations_are_those_of_the_road_beyond_the_ramp() -> None:
    road, own = sw.ISO8608("B", seed=3) + sw.Bump(5.0, 2.0, 0.01), sw.ISO8608("A", seed=5)
    run = cross(passage(), passage(direction="left", road=own), road=road, approach=60.0, ramp=10.0)
    for motion, under, to in zip(run.vehicles, (road, own), (1.0, -1.0), strict=True):
        at = motion.axle_positions
        entered = -50.0 if to > 0.0 else 90.0
        left = 40.0 + TRUCK.wheelbase if to > 0.0 else -TRUCK.wheelbase
        inside = (to * at > to * entered) & (to * at < to * left)
        assert inside.sum() > 1000
        assert_allclose(motion.elevations[inside], under.elevation(at[inside]), atol=1e-12)
        assert_array_equal(motion.elevations[0], 0.0)


def test_bodies_of_an_articulated_vehicle() -> None:
    run = sw.cross(BRIDGE, sw.vehicles.articulated_5_axle(), speed=20.0, road=sw.ISO8608("A"))
    motion = run.vehicle
    assert len(motion.bodies) == 2
    assert len(motion.hops) == 5
    tractor, trailer = motion.bodies
    # The fifth wheel is one point: 2.15 m behind the tractor's centre, 6.15 m ahead of the other.
    there = tractor.heave.displacement - 2.15 * tractor.pitch.displacement
    here = trailer.heave.displacement + 6.15 * trailer.pitch.displacement
    assert_allclose(there, here, atol=1e-12)
    assert_array_equal(motion.heave, tractor.heave.displacement)
    train = sw.cross(BRIDGE, sw.vehicles.hs20(), speed=20.0).vehicle
    assert train.bodies == ()
    with pytest.raises(AttributeError, match="no body"):
        _ = train.heave


# What is refused

ROAD = sw.Profile(np.arange(0.0, 50.0), 0.01 * np.sin(np.arange(50.0)))
HS20 = sw.vehicles.hs20()
#: What is asked for, and what the message must contain: the key, the value, what is allowed.
REFUSED: list[tuple[Callable[[], object], tuple[str, ...]]] = [
    *((lambda bad=bad: cross(speed=bad), ("speed", POSITIVE)) for bad in (-1.0, 0.0, nan, inf)),
    (lambda: cross(speed=None), ("speed: missing; give it here or with every passage",)),
    (lambda: cross(passage(speed=-2.0)), ("speed = -2",)),
    (
        lambda: cross(passage(), passage(entry=3.0, speed=-2.0)),
        ("speed = -2", "greater than 0"),
    ),
    (lambda: passage(speed="fast"), ("speed = 'fast'", "number")),
    (lambda: cross(passage(entry=-1.0)), ("entry = -1", "0 or more")),
    (lambda: passage(entry="now"), ("entry = 'now'", "number")),
    (lambda: passage(lane=1.5), ("lane = 1.5", "whole number")),
    (lambda: passage(lane=True), ("lane = True", "whole number")),
    (lambda: passage(direction=1), ("direction = 1", "right or left")),
    (lambda: passage(direction="west"), ("direction = 'west'", "must be right or left")),
    (lambda: passage(drive="slow"), ("drive = 'slow'", "constant-speed or constant-traction")),
    (lambda: sw.Braking(deceleration=-3.0), ("braking deceleration = -3: must be finite and",)),
    (lambda: sw.Acceleration(acceleration=nan), ("acceleration = NaN: must be a finite number",)),
    (lambda: sw.Speeds(times=[2, 1], speeds=[1, 2]), ("times[1] = 1 s", "before it, 2 s")),
    (lambda: sw.Speeds(times=[-1], speeds=[1]), ("times[0] = -1 s: must be 0 or more",)),
    (
        lambda: cross(drive=sw.Speeds(times=[0], speeds=[9])),
        ("speed = 20: not used with speeds in time",),
    ),
    (
        lambda: passage(speed=9.0, drive=sw.Speeds(times=[0], speeds=[9])),
        ("speed = 9: not used with speeds in time",),
    ),
    (
        lambda: cross(
            passage(), passage(speed=9.0, lane=3), drive=sw.Speeds(times=[0], speeds=[9])
        ),
        ("vehicles[1].speed = 9: not used with speeds in time",),
    ),
    (lambda: cross(drive="braking"), ("drive = 'braking'", "constant-speed or constant-traction")),
    (lambda: cross(drive=3), ("drive = 3", "acceleration, speeds, braking")),
    (lambda: cross(drive={"kind": "brake"}), ("kind = 'brake'", "did you mean 'braking'?")),
    (lambda: cross(drive={}), ("drive: missing kind", "acceleration, speeds, braking")),
    (
        lambda: cross(drive={"kind": "braking", "decelerate": 1}),
        ("drive: unknown key", "'decelerate' (did you mean 'deceleration'?)"),
    ),
    (lambda: cross(drive={"kind": "braking"}), ("drive: missing deceleration",)),
    *(
        (lambda bad=bad: cross(drive=sw.Braking(deceleration=bad)), ("braking deceleration",))
        for bad in (-4.0, 0.0, nan, "4")
    ),
    (
        lambda: cross(drive=sw.Braking(deceleration=4.0, friction=-1.0)),
        ("braking friction = -1", "greater than 0"),
    ),
    (lambda: cross(drive=sw.Braking(deceleration=4.0, ramp=-1.0)), ("braking ramp = -1",)),
    (lambda: cross(drive=sw.Speeds(times=[0, 1], speeds=[1])), ("2 times and 1 speeds",)),
    (lambda: cross(drive=sw.Speeds(times=[0, 0], speeds=[1, 2])), ("times[1] = 0", "greater")),
    (lambda: cross(drive=sw.Speeds(times=[0, 1], speeds=[-1, 2])), ("speeds[0] = -1", "0 or")),
    (
        lambda: cross(sw.Passage(vehicle=HS20), drive=sw.Braking(deceleration=4.0)),
        ('drive = "braking"', "forces and masses without a vehicle move as prescribed"),
    ),
    (
        lambda: cross(passage(), passage()),
        ("vehicles[0] and vehicles[1], lane = 0: they overlap at t = 0.000",),
    ),
    (
        lambda: cross(passage(speed=10.0), passage(speed=30.0, entry=1.0)),
        (
            "vehicles[0] and vehicles[1], lane = 0",
            "enter later, change the speed or use another lane",
        ),
    ),
    (lambda: cross(road=ROAD, approach=10.0), ("path from -10 m", "covers only 0 m to 49 m")),
    (lambda: cross(passage(road=ROAD)), ("path from -100 m", "covers only 0 m to 49 m")),
    (lambda: cross(ramp=-1.0), ("ramp = -1", "0 or more")),
    (lambda: cross(approach=10.0, ramp=20.0, road=sw.ISO8608("A")), ("ramp = 20", "10")),
    (lambda: cross(lift_off=1), ("lift_off = 1", "true or false")),
    (
        lambda: sw.convoy([TRUCK] * 3, headway=[1, 2, 3]),
        ("headway = [1, 2, 3]", "each of the 2 gaps"),
    ),
    (lambda: sw.convoy([TRUCK] * 2, headway=0.0), ("headway[0] = 0 s", "greater than 0")),
]


@pytest.mark.parametrize(("make", "parts"), REFUSED, ids=[" ".join(each[1]) for each in REFUSED])
def test_the_message_names_key_value_and_what_is_allowed(
    make: Callable[[], object], parts: tuple[str, ...]
) -> None:
    with pytest.raises(ValueError, match=re.escape(parts[0])) as caught:
        make()
    for part in parts:
        assert part in str(caught.value)


def test_wrong_objects() -> None:
    with pytest.raises(TypeError, match=r"vehicle = 'lorry': must be a Vehicle or a train"):
        sw.Passage(vehicle="lorry")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"road = 'B': must be a Road"):
        passage(road="B")
    with pytest.raises(TypeError, match=r"road = 'B': must be a Road"):
        cross(road="B")
    with pytest.raises(TypeError, match=r"vehicle\[1\] = Vehicle\(.*: must be a Passage"):
        sw.cross(BRIDGE, [passage(), TRUCK], speed=20.0)  # type: ignore[list-item]
    with pytest.raises(TypeError, match=r"vehicle = \[\]: must be"):
        sw.cross(BRIDGE, [], speed=20.0)


@pytest.mark.parametrize(
    "drive",
    [
        "constant-traction",
        sw.Acceleration(acceleration=-1.0),
        sw.Speeds(times=[0.0, 1.0], speeds=[1.0, 2.0]),
        sw.Braking(deceleration=3.0),
    ],
    ids=repr,
)
def test_passages_can_be_pickled(drive: Any) -> None:
    given = passage(drive=drive, road=sw.ISO8608("A") + sw.Step(0.0, 0.01), lane=2, entry=1.0)
    assert pickle.loads(pickle.dumps(given)) == given
