"""What a contact cannot follow, or a crossing cannot hold, is refused by name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import spanwise as sw

BEAM = sw.Bridge(spans=[20.0], EI=2e9, mass=5e3)
MASS = sw.MovingMasses(masses=[2e4], positions=[0.0])
#: Undamped but for the tyre.
TYRE = sw.Vehicle(
    mass=15e3,
    pitch_inertia=15e3,
    axles=[
        sw.Axle(
            position=0.0,
            mass=700.0,
            tyre_stiffness=2e6,
            suspension_stiffness=5e5,
            tyre_damping=2e4,
        )
    ],
)


def test_a_hinge_strikes_a_rigid_mass() -> None:
    gerber = sw.Bridge(spans=[20.0, 20.0], EI=2e9, mass=5e3, hinges=[24.0])
    with pytest.raises(ValueError, match="masses in rigid contact on a bridge with hinges"):
        sw.cross(gerber, MASS, speed=20.0)
    sw.cross(gerber, TYRE, speed=20.0)


@pytest.mark.parametrize(
    "road",
    [
        sw.Ramp(2.0, 4.0, 0.02, contact_patch=0.0),
        sw.Camber(2.0, 8.0, 0.02, contact_patch=0.0),
        sw.Step(3.0, 0.01),
    ],
)
def test_a_kink_of_the_road_strikes_a_rigid_mass(road: sw.roads.Road) -> None:
    with pytest.raises(ValueError, match="road = not smooth below masses in rigid contact"):
        sw.cross(BEAM, MASS, speed=20.0, road=road)


@pytest.mark.parametrize("road", [sw.Bump(5.0, 2.0, 0.01), sw.Ramp(2.0, 4.0, 0.02)])
def test_a_rigid_mass_follows_what_is_smooth(road: sw.roads.Road) -> None:
    flat = sw.cross(BEAM, MASS, speed=20.0)
    run = sw.cross(BEAM, MASS, speed=20.0, road=road)
    assert np.ptp(run.axle_loads) > 2.0 * np.ptp(flat.axle_loads)


def test_a_damped_tyre_cannot_follow_a_jump() -> None:
    with pytest.raises(ValueError, match=r"road = jumps below damped tyres.*contact_patch"):
        sw.cross(BEAM, TYRE, speed=20.0, road=sw.Step(3.0, 0.01, contact_patch=0.0))


def test_the_step_resolves_a_short_contact_patch() -> None:
    """Wherever the step of the road lies between two steps of time, the tyre feels it."""
    short = sw.Bridge(spans=[4.0], EI=2e9, mass=5e3)
    settings: Any = {"speed": 20.0, "approach": 0.0, "tail": 0.0, "modes": 1, "sections": [2.0]}
    largest = []
    for shift in (0.0, 0.0011, 0.0023, 0.0034, 0.0046):
        road = sw.Step(1.0 + shift, 0.01, contact_patch=0.005)
        largest.append(sw.cross(short, TYRE, road=road, **settings).axle_loads.max())
    assert np.ptp(largest) < 0.1 * np.mean(largest)


def test_vehicles_of_one_axle_cannot_drive_through_each_other() -> None:
    train = sw.ForceTrain(loads=[1e5], positions=[0.0])
    for speed in (20.0, 20.37):
        there = sw.Passage(vehicle=train, speed=20.0, lane=0)
        back = sw.Passage(vehicle=train, speed=speed, direction="left", lane=0)
        with pytest.raises(ValueError, match=r"vehicles\[1\], lane = 0: they overlap at t"):
            sw.cross(BEAM, [there, back])


def test_too_many_axles() -> None:
    train = sw.ForceTrain(loads=[1e4] * 501, spacings=[2.0] * 500)
    with pytest.raises(ValueError, match="vehicles = 501 axles: at most 500 in all"):
        sw.cross(BEAM, train, speed=20.0)


@pytest.mark.parametrize("speed", [1e155, 1e300])
def test_a_speed_beyond_all_sense(speed: float) -> None:
    with pytest.raises(ValueError, match="speed"):
        sw.cross(BEAM, TYRE, speed=speed)


def test_a_drive_is_refused_for_its_vehicle() -> None:
    own = sw.Braking(deceleration=5.0)
    train = sw.ForceTrain(loads=[1e4])
    passages = [
        sw.Passage(vehicle=TYRE, speed=20.0),
        sw.Passage(vehicle=train, speed=20.0, entry=3.0, drive=own),
    ]
    with pytest.raises(ValueError, match=r"vehicles\[1\]\.drive = \"braking\": forces and masses"):
        sw.cross(BEAM, passages)


def test_springs_too_soft_to_stand_on() -> None:
    soft, soft_end = (sw.Support(at=x, vertical=1e-6) for x in (0.0, 40.0))
    supports: list[Any] = [soft, (10.0, "pinned"), (30.0, "pinned"), soft_end]
    bridge = sw.Bridge(length=40.0, supports=supports, EI=5e9, mass=5e3)
    with pytest.raises(ValueError, match=r"supports\[0\]\.vertical = 1e-6 N/m: must be at least"):
        bridge.modes(3)


def test_weak_dampers_do_not_ring() -> None:
    """After a step of the road the forces differ from those without damper by little, smoothly."""

    def load(damping: float) -> np.ndarray:
        axle = sw.Axle(
            position=0.0,
            tyre_stiffness=2e6,
            suspension_stiffness=5e5,
            suspension_damping=damping,
        )
        car = sw.Vehicle(mass=15e3, pitch_inertia=15e3, axles=[axle])
        road = sw.Step(-10.0, 0.005, contact_patch=0.0)
        run = sw.cross(BEAM, car, speed=20.0, road=road, approach=20.0, step=2e-4)
        return run.axle_loads[:, 0]

    apart = load(10.0) - load(0.0)
    after = apart[np.flatnonzero(apart)[0] + 1 :][:40]
    assert np.abs(np.diff(np.sign(np.diff(after)))).sum() <= 4  # no zigzag
