"""Load coefficients: about the static load, from a vehicle's first axle on to its last off."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw

BRIDGE = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)
TRUCK = sw.vehicles.half_car()


def by_hand(run: sw.Run) -> np.ndarray:
    found: list[float] = []
    for vehicle in run.vehicles:
        x = vehicle.axle_positions
        on = ((x >= -1e-9) & (x <= run.bridge.length + 1e-9)).any(axis=1)
        first, last = np.flatnonzero(on)[[0, -1]]
        own = slice(len(found), len(found) + x.shape[1])
        parts = run.axle_loads[first : last + 1, own] / run.static_axle_loads[own] - 1.0
        found += np.sqrt((parts**2).mean(axis=0)).tolist()
    return np.array(found)


def crossing(speed: float) -> sw.Run:
    return sw.cross(BRIDGE, TRUCK, speed=speed, road=sw.ISO8608("C", seed=3), damping=0.02)


@pytest.mark.parametrize("speed", [10.0, 20.0, 30.0])
def test_about_the_static_load(speed: float) -> None:
    run = crossing(speed)
    assert run.dynamic_load_coefficients == pytest.approx(by_hand(run), rel=1e-12)
    # The mean load of a short crossing is not the static one, and about it there is less.
    x = run.vehicle.axle_positions
    there = (x[:, 0] >= 0.0) & (x[:, -1] <= 20.0)
    about_the_mean = run.axle_loads[there].std(axis=0) / run.static_axle_loads
    assert (run.dynamic_load_coefficients > about_the_mean).any()


def test_several_vehicles_and_all_that_says_it(tmp_path: Path) -> None:
    passages = [
        sw.Passage(vehicle=TRUCK, speed=18.0),
        sw.Passage(vehicle=sw.vehicles.kishan_1973(), speed=22.0, direction="left", entry=0.7),
    ]
    road = sw.ISO8608("B", seed=1)
    run = sw.cross(BRIDGE, passages, road=road, approach=30.0, damping=0.02)
    assert run.dynamic_load_coefficients.shape == (4,)
    assert run.dynamic_load_coefficients == pytest.approx(by_hand(run), rel=1e-12)
    run.to_json(tmp_path / "run.json")
    told = json.loads((tmp_path / "run.json").read_text())["vehicles"]
    assert [
        v for each in told for v in each["load_coefficients"]
    ] == run.dynamic_load_coefficients.tolist()
    assert "from their static values" in run.summary()
    with pytest.raises(ValueError, match="read-only"):
        run.dynamic_load_coefficients[0] = 0.0
    given = {"road": road, "approach": 30.0, "damping": 0.02, "samples": 2}
    found = sw.ensemble(BRIDGE, passages, **given)  # type: ignore[arg-type]
    assert_array_equal(found.dynamic_load_coefficients[0], found.run(0).dynamic_load_coefficients)


@pytest.mark.parametrize("entry", [4.0, 9.0])
@pytest.mark.parametrize("direction", ["right", "left"])
def test_nobody_else_counts(entry: float, direction: Any) -> None:
    """A vehicle that comes long after another does not lengthen the time of the first."""
    first = sw.Passage(vehicle=TRUCK)
    other = sw.Passage(vehicle=sw.ForceTrain(loads=[1.0]), direction=direction, entry=entry)
    given = {"speed": 20.0, "road": sw.ISO8608("C", seed=3), "step": 2e-3, "approach": 30.0}
    alone, both = (sw.cross(BRIDGE, e, **given) for e in (first, [first, other]))  # type: ignore[arg-type]
    # A vehicle alone takes steps that end with it: it meets the road at other instants.
    alike = 1e-2
    assert both.dynamic_load_coefficients == pytest.approx(
        [*alone.dynamic_load_coefficients, 0.0], rel=alike
    )
    one, two = (
        sw.ensemble(BRIDGE, [event], samples=2, **given)  # type: ignore[arg-type]
        for event in ([first], [first, other])
    )
    assert two.body_accelerations.rms == pytest.approx(one.body_accelerations.rms, rel=alike)
    assert two.dynamic_load_coefficients[:, :2] == pytest.approx(
        one.dynamic_load_coefficients, rel=alike
    )


def test_constant_forces_do_not_vary() -> None:
    run = sw.cross(BRIDGE, sw.vehicles.flm3(), speed=20.0)
    assert_array_equal(run.dynamic_load_coefficients, np.zeros(4))
    assert "from their static values" not in run.summary()
