"""The tail that is not given, and records that end too early."""

from __future__ import annotations

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import spanwise as sw
from spanwise._freevibration import Growth, growths
from spanwise.quantities import Side, of_bridges

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.9415e9, mass=6037.6, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()
SPAN = sw.Bridge(spans=[25.0], EI=8.3e9, mass=2303.0)
FORCE = sw.ForceTrain(loads=[1e5], positions=[0.0])
SIDES = ("max", "min")
QUANTITIES: tuple[str, ...] = ("deflection", "moment", "shear", "reactions")

#: What a tail that ended by itself may have missed of an extreme.
MISSED = 1e-3


def missed(short: sw.Run, long: sw.Run) -> float:
    worst = 0.0
    for quantity in QUANTITIES:
        a, b = short.envelope(quantity), long.envelope(quantity)
        largest = np.abs(b.max.value).max()
        for side in SIDES:
            own, other = getattr(a, side).value, getattr(b, side).value
            there = np.abs(other) > 1e-6 * largest
            part = np.abs(own - other)[there] / np.abs(other)[there]
            worst = max(worst, float(part.max(initial=0.0)))
    return worst


@pytest.mark.filterwarnings("ignore:speed:spanwise.PlausibilityWarning")
@pytest.mark.parametrize("damping", [0.005, 0.02, 0.05])
@pytest.mark.parametrize("speed", [10.0, 22.86, 60.0])
def test_nothing_follows(damping: float, speed: float) -> None:
    run = sw.cross(BRIDGE, TRUCK, speed=speed, modes=3, damping=damping)
    long = sw.cross(BRIDGE, TRUCK, speed=speed, modes=3, damping=damping, tail=40.0 / 2.66)
    assert run.settled
    assert not run.can_grow
    assert run.tail < 10.5 / run.frequencies[0]
    assert missed(run, long) <= MISSED
    assert run.axle_loads.shape == (len(run.time), 2)
    assert (run.envelope("axle_loads").max.value == long.envelope("axle_loads").max.value).all()


def test_a_record_that_ends_too_early_says_so() -> None:
    """Upward the bridge goes only when the force has gone, a thousand times as far as before."""
    none = sw.cross(SPAN, FORCE, speed=30.0, damping=0.02, tail=0.0, sections=[12.5])
    free = sw.cross(SPAN, FORCE, speed=30.0, damping=0.02, sections=[12.5])
    up, before = free.envelope("deflection").min.value[0], none.envelope("deflection").min.value[0]
    assert up < 100.0 * min(before, -1e-12)
    (found,) = (
        each for each in none.can_grow if (each.quantity, each.side) == ("deflection", "min")
    )
    assert found.recorded == before
    assert 1.2 * up < found.reach <= up
    assert "deflection, up" in none.summary()
    assert "can reach more than was recorded" in none.summary()
    assert f"deflection, up: {1e3 * found.reach:.3f} mm at most, at x = 12.500 m" in none.summary()
    assert "until no extreme can follow" in free.summary()
    told = json.loads(json.dumps(none.to_dict()))["tail"]
    assert (told["length"], told["settled"]) == (0.0, False)
    assert {"quantity", "side", "x", "recorded", "reach"} == set(told["can_grow"][0])


@pytest.mark.parametrize(
    ("reach", "told"),
    [
        ([10.19, 2.11], []),
        ([10.21, 2.11], [("max", 0.0, 10.0, 10.21)]),
        ([10.19, 2.13], [("max", 5.0, 2.0, 2.13), ("min", 5.0, -2.0, -2.13)]),
        ([101.11, 2.13], [("max", 0.0, 10.0, 101.11), ("min", 0.0, -100.0, -101.11)]),
    ],
)
def test_what_is_worth_a_word(
    reach: list[float], told: list[tuple[str, float, float, float]]
) -> None:
    """What can grow by 1 % of itself and 0.1 % of the largest of its kind, 100 N down here."""
    envelope = SimpleNamespace(
        x=np.array([0.0, 5.0]),
        max=SimpleNamespace(value=np.array([10.0, 2.0])),
        min=SimpleNamespace(value=np.array([-100.0, -2.0])),
    )
    core = SimpleNamespace(reach=lambda each: np.array(reach) if each == "shear" else None)
    run: Any = SimpleNamespace(_core=core, envelope=lambda _: envelope)
    found = [(each.side, each.x, each.recorded, each.reach) for each in growths(run)]
    assert found == told


#: What grows to 2 from -1 [m, N m or N], in words.
TOLD: dict[tuple[str, Side], tuple[str, str]] = {
    ("deflection", "max"): ("deflection, down: 2000.000 mm", "-1000.000"),
    ("deflection", "min"): ("deflection, up: 2000.000 mm", "-1000.000"),
    ("moment", "max"): ("moment, sagging: 0.002 kN m", "-0.001"),
    ("moment", "min"): ("moment, hogging: 0.002 kN m", "-0.001"),
    ("shear", "max"): ("shear, positive: 0.002 kN", "-0.001"),
    ("shear", "min"): ("shear, negative: 0.002 kN", "-0.001"),
    ("reactions", "max"): ("reaction, up: 0.002 kN", "-0.001"),
    ("reactions", "min"): ("reaction, uplift: 0.002 kN", "-0.001"),
    ("clamp_moments", "max"): ("clamp moment, positive: 0.002 kN m", "-0.001"),
    ("clamp_moments", "min"): ("clamp moment, negative: 0.002 kN m", "-0.001"),
}


def test_the_representation_says_what_a_given_tail_cuts_off() -> None:
    bridge = sw.Bridge(spans=[20.0], EI=4e9, mass=9e3)
    given: dict[str, Any] = {"speed": 40.0, "modes": 2, "damping": 0.01}
    cut = sw.cross(bridge, sw.vehicles.quarter_car(), tail=0.0, **given)
    assert cut.can_grow
    assert repr(cut).endswith(", tail 0 s after which extremes can grow)")
    assert "tail" not in repr(sw.cross(bridge, sw.vehicles.quarter_car(), **given))


def test_what_can_grow_in_words() -> None:
    assert {quantity for quantity, _ in TOLD} == {each.name for each in of_bridges() if each.usual}
    for (quantity, side), (reach, recorded) in TOLD.items():
        at = f"{reach} at most, at x = 9.500 m, recorded there"
        assert str(Growth(quantity, side, 9.5, -1.0, 2.0)) == f"{at} {recorded}"
        assert str(Growth(quantity, side, 9.5, -0.0, 2.0)) == f"{at} 0.000"


def test_above_the_critical_speed() -> None:
    run = sw.cross(SPAN, FORCE, speed=420.0, damping=0.02, sections=[12.5])
    none = sw.cross(SPAN, FORCE, speed=420.0, damping=0.02, sections=[12.5], tail=0.0)
    assert run.envelope("deflection").max.time[0] > none.time[-1]
    (found,) = (
        each for each in none.can_grow if (each.quantity, each.side) == ("deflection", "max")
    )
    assert found.recorded * 1.2 < run.envelope("deflection").max.value[0] <= found.reach


def test_without_damping_it_ends_in_the_end() -> None:
    run = sw.cross(BRIDGE, TRUCK, speed=22.86, modes=3, damping=0.0)
    assert not run.settled
    assert 0.0 <= run.tail - 10.0 / run.frequencies[0] <= 32.0 * run.time[1]
    assert "ten periods" in run.summary()


def test_settings_run_again(tmp_path: Path) -> None:
    for tail in (None, 0.25):
        run = sw.cross(BRIDGE, TRUCK, speed=22.86, modes=3, damping=0.02, tail=tail)
        path = tmp_path / "run.json"
        run.to_json(path)
        told = json.loads(path.read_text())
        assert told["settings"]["crossing"]["tail"] == tail
        again = sw.Case.from_dict(told["settings"]).run()
        assert again.tail == run.tail == told["tail"]["length"]
        assert tail is None or run.tail == pytest.approx(tail, rel=1e-9)
        assert (again.deflection == run.deflection).all()


def test_a_standing_vehicle() -> None:
    braking = sw.Braking(deceleration=5.0, start=0.0)
    run = sw.cross(BRIDGE, TRUCK, speed=12.0, modes=3, damping=0.05, drive=braking)
    assert run.stopped[0] is not None
    assert not run.settled
    assert not run.can_grow
    assert "standing on the bridge, the longest kept: ten periods" in run.summary()


def test_a_tail_that_is_given_is_told_as_given() -> None:
    run = sw.cross(BRIDGE, TRUCK, speed=22.86, modes=3, damping=0.02, tail=0.25)
    assert "tail 0.25 s" in map(str.strip, run.summary().splitlines())


@pytest.mark.parametrize("quantities", [None, ["moment"]])
def test_each_sample_of_an_ensemble(quantities: list[str] | None) -> None:
    many = sw.ensemble(
        BRIDGE,
        TRUCK,
        samples=9,
        speed=np.linspace(12.0, 40.0, 9),
        road=sw.ISO8608("C"),
        modes=3,
        damping=0.02,
        quantities=quantities,
    )
    assert len(set(many.tail)) > 4
    assert (many.growth == 0.0).all()
    assert "until no extreme can follow" in many.summary()
    for i in (0, 4, 8):
        run = many.run(i)
        assert run.tail == pytest.approx(many.tail[i], abs=1e-9)
        for side in SIDES:
            own = getattr(run.envelope("moment"), side).value
            assert (own == getattr(many.envelope("moment"), side)[i]).all()


def test_samples_that_end_too_early() -> None:
    options: dict[str, Any] = {"speed": 22.86, "road": sw.ISO8608("C"), "modes": 3, "damping": 0.02}
    many = sw.ensemble(BRIDGE, TRUCK, samples=5, tail=0.0, **options)
    assert (many.growth > 0.0).all()
    assert (many.tail == 0.0).all()
    assert "in 5 samples free vibration after the end can exceed an extreme" in many.summary()
    assert re.search(r"x = [\d.]+ m,\n +by at most [\d.]+ % of the largest", many.summary())
    run = many.run(0)
    parts = {
        each: abs(each.reach - each.recorded)
        / max(np.abs(getattr(run.envelope(each.quantity), side).value).max() for side in SIDES)
        for each in run.can_grow
    }
    most = max(parts, key=lambda each: parts[each])
    assert many.growth[0] == run.growth == pytest.approx(parts[most], rel=1e-9)
    side = "largest" if most.side == "max" else "smallest"
    assert many._growing(0).startswith(f"{side} {most.quantity}")
    assert many._growing(0).endswith(f"at x = {most.x:.3f} m")


@pytest.mark.parametrize("recovery", ["force-summation", "force-summation-by-rates"])
@pytest.mark.parametrize("apart", [False, True])
def test_samples_whose_bridges_differ(recovery: Any, apart: bool) -> None:
    """What is said of a sample is what a crossing of its own bridge says."""
    who: Any = sw.Passage(vehicle=TRUCK, direction="left") if apart else TRUCK
    factors = {"bridge_stiffness": [0.5, 1.0, 2.0], "bridge_damping": [1.0, 2.0, 1.5]}
    options: dict[str, Any] = {"speed": 22.86, "modes": 3, "damping": 0.02, "recovery": recovery}
    many, free = (
        sw.ensemble(BRIDGE, who, samples=3, factors=factors, tail=tail, **options)
        for tail in (0.0, None)
    )
    for i in range(3):
        assert many.growth[i] == pytest.approx(many.run(i).growth, rel=1e-6)
        assert many.growth[i] > 0.0
        assert free.tail[i] == pytest.approx(free.run(i).tail, rel=1e-9)


def test_histories_of_samples_are_as_long_as_the_longest() -> None:
    many = sw.ensemble(
        BRIDGE, TRUCK, samples=4, speed=22.86, road=sw.ISO8608("C"), modes=3, damping=0.02
    )
    assert len(set(many.tail)) > 1
    found = many.histories("moment", [0, 1, 2, 3])
    longest = int(np.argmax(many.tail))
    assert (found[longest] == many.run(longest).moment).all()
    shortest = many.run(int(np.argmin(many.tail)))
    assert (found[int(np.argmin(many.tail)), : len(shortest.time)] == shortest.moment).all()


def test_the_road_goes_on_in_the_tail() -> None:
    options: dict[str, Any] = {
        "speed": 22.86,
        "modes": 3,
        "damping": 0.02,
        "approach": 10.0,
        "ramp": 5.0,
    }
    run = sw.cross(BRIDGE, TRUCK, road=sw.ISO8608("B", seed=1), tail=1.0, **options)
    assert np.ptp(run.vehicle.elevations[-50:, 0]) > 0.0
    # What was measured goes on at the elevation where it ends.
    x = np.arange(-20.0, 45.0, 0.25)
    road = sw.Profile(x=x, elevations=5e-3 * np.sin(x), contact_patch=0.0)
    for tail in (1.0, None):
        run = sw.cross(BRIDGE, TRUCK, road=road, tail=tail, **options)
        behind = run.vehicle.axle_positions[:, 0] > x[-1] + 0.01
        assert behind.any() or tail is None
        if behind.any():
            # Off the line that motion is told from, that is a straight line.
            place, told = run.vehicle.axle_positions[behind, 0], run.vehicle.elevations[behind, 0]
            line = np.polynomial.Polynomial.fit(place, told, 1)
            assert np.abs(told - line(place)).max() <= 1e-12
            assert abs(line.convert().coef[1]) < 1e-3
    # It must hold the way over the bridge all the same.
    short = sw.Profile(x=x[:200], elevations=0.0 * x[:200])
    with pytest.raises(ValueError, match="give a longer road"):
        sw.cross(BRIDGE, TRUCK, road=short, **options)
