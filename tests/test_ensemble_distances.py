"""A sample alone is the sample among others, to the bit, whatever its distances and factors."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise.vehicles import PRESETS

#: Some factors find nothing to multiply in some vehicles.
pytestmark = pytest.mark.filterwarnings("ignore:.* does nothing:UserWarning")

Same = Callable[[sw.Ensemble, int, sw.Run], None]

BRIDGE = sw.Bridge(spans=[14.0, 11.0], EI=1.6e9, mass=5200.0, stations_per_span=3)
GIVEN: dict[str, Any] = {"approach": 6.0, "modes": 3, "damping": 0.02}

#: Factors of three samples, the first of them one throughout: it is rebuilt like the others.
THREE = {
    name: np.array([1.0, 0.83, 1.21])
    for name in (
        "body_mass",
        "pitch_inertia",
        "tyre_stiffness",
        "tyre_damping",
        "suspension_stiffness",
        "suspension_damping",
        "friction_limit",
    )
}


def check(vehicle: Any, factors: dict[str, Any], same: Same, **given: Any) -> None:
    found = sw.ensemble(
        BRIDGE, vehicle, samples=3, factors=factors, advance=0.1, **{**GIVEN, **given}
    )
    for sample in range(3):
        run = found.run(sample)
        same(found, sample, run)
        # What comes out of a file or another process is made of the same numbers once more.
        truck = pickle.loads(pickle.dumps(run.truck))
        step: Any = run.settings["step"]
        again = sw.cross(BRIDGE, truck, step=step, **{**GIVEN, **given})
        assert_array_equal(again.moment, run.moment)


def factors_of(vehicle: Any) -> dict[str, Any]:
    """All that the vehicle has."""
    if isinstance(vehicle, sw.Vehicle):
        return {**THREE, "initial_friction": np.array([0.0, 0.7, -0.4])}
    return {"body_mass": THREE["body_mass"]}


@pytest.mark.parametrize("name", PRESETS)
def test_the_whole_catalogue(name: str, same: Same) -> None:
    vehicle = PRESETS[name]()
    check(vehicle, factors_of(vehicle), same, speed=20.3)


def test_one_factor_of_one() -> None:
    for vehicle in (sw.vehicles.cl_625(), sw.vehicles.flm3()):
        bridge = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)
        found = sw.ensemble(bridge, vehicle, samples=1, speed=20.0, factors={"body_mass": 1.0})
        plain = sw.ensemble(bridge, vehicle, samples=1, speed=20.0)
        run = found.run(0)
        assert_array_equal(found.envelope("moment").max[0], run.envelope("moment").max.value)
        assert_array_equal(found.envelope("moment").max[0], plain.envelope("moment").max[0])
        assert_array_equal(run.moment, sw.cross(bridge, vehicle, speed=20.0).moment)


@pytest.mark.parametrize("seed", range(6))
def test_trains_of_any_spacing(seed: int, same: Same) -> None:
    random = np.random.default_rng(seed)
    axles = int(random.integers(2, 7))
    gaps = random.uniform(0.9, 6.0, axles - 1)
    positions = random.uniform(-9.0, 9.0) - np.concatenate([[0.0], np.cumsum(gaps)])
    for name, kind in (("loads", sw.ForceTrain), ("masses", sw.MovingMasses)):
        shares = random.uniform(2e3, 9e3, axles)
        # Factors axle by axle move the centre of the train.
        masses = random.uniform(0.6, 1.7, (3, axles))
        for place in ({"positions": positions.tolist()}, {"spacings": gaps.tolist()}):
            train = kind(**{name: shares.tolist()}, **place)
            speed = float(random.uniform(8.0, 40.0))
            check(train, {"body_mass": masses}, same, speed=speed)


@pytest.mark.parametrize("seed", range(4))
def test_bodies_of_any_spacing(seed: int, same: Same) -> None:
    random = np.random.default_rng(seed)

    def axle(position: float) -> sw.Axle:
        return sw.Axle(
            position=position,
            mass=float(random.choice([0.0, 600.0])),
            tyre_stiffness=2e6,
            suspension_stiffness=7e5,
            suspension_damping=6e3,
            friction_limit=4e3,
        )

    pivot, hold = random.uniform(0.5, 2.5), random.uniform(3.0, 5.0)
    tractor = sw.Body(
        mass=5e3,
        pitch_inertia=8e3,
        axles=[axle(random.uniform(0.4, 2.0)), axle(-random.uniform(2.0, 3.0))],
    )
    trailer = sw.Body(
        mass=2e4,
        pitch_inertia=5e4,
        axles=[axle(-random.uniform(1.0, 2.0)), axle(-random.uniform(2.5, 4.0))],
        hinge=sw.Hinge(to=0, at=-pivot, own=hold),
    )
    vehicle = sw.Vehicle(bodies=[tractor, trailer])
    # One for each body: the centre of mass of the whole moves.
    masses = random.uniform(0.7, 1.5, (3, 2))
    factors = {**factors_of(vehicle), "body_mass": masses}
    check(vehicle, factors, same, speed=float(random.uniform(8.0, 40.0)))
