"""The default step keeps what `accuracy` promises: extremes against steps an eighth as long.

docs/theory.md, "Time step", has the table of all cases, which take minutes; these are some of them.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pytest

import spanwise as sw
from spanwise.roads import Road

#: Responses and axle loads, each judged by its largest value along the bridge.
LOOKED_AT: Final = ("deflection", "moment", "shear", "reactions", "axle_loads")

BRIDGES: Final = {
    "two spans of 1973": (
        sw.Bridge(spans=[18.288] * 2, EI=1.941464e9, mass=6037.7, stations_per_span=3),
        3,
    ),
    "simple beam of 25 m": (sw.Bridge(spans=[25.0], EI=8.4e9, mass=9e3, stations_per_span=11), 3),
}

VEHICLES: Final[dict[str, sw.Vehicle | sw.ForceTrain]] = {
    "half-car": sw.vehicles.half_car(),
    "hs20-44": sw.vehicles.hs20_44(),
    "cl-625": sw.vehicles.cl_625(),
}

ROADS: Final[dict[str, Road | None]] = {
    "smooth": None,
    "A": sw.ISO8608("A", seed=3),
    "C": sw.ISO8608("C", seed=4),
    "bump": sw.Bump(at=-2.0, length=0.5, height=0.02),
}


def crossed(bridge: str, vehicle: str, road: str, **settings: Any) -> sw.Run:
    beam, modes = BRIDGES[bridge]
    rough = {} if road == "smooth" else {"approach": 40.0, "ramp": 10.0}
    settings = {"speed": 22.0, "modes": modes, "damping": 0.02, **rough, **settings}
    return sw.cross(beam, VEHICLES[vehicle], road=ROADS[road], **settings)


def step_of(run: sw.Run) -> float:
    """The time step [s]."""
    return float(run.time[1])


def errors(coarse: sw.Run, fine: sw.Run) -> dict[str, float]:
    """Largest difference of the extremes of each quantity, in parts of its largest value."""
    found = {}
    for name in LOOKED_AT:
        both = [run.envelope(name) for run in (coarse, fine)]
        a, b = (np.concatenate([each.max.value, each.min.value], axis=None) for each in both)
        found[name] = float(np.abs(a - b).max() / np.abs(b).max())
    return found


@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("vehicle", VEHICLES)
@pytest.mark.parametrize("bridge", BRIDGES)
def test_extremes_are_as_accurate_as_promised(bridge: str, vehicle: str, road: str) -> None:
    run = crossed(bridge, vehicle, road)
    fine = crossed(bridge, vehicle, road, step=step_of(run) / 8.0)
    found = errors(run, fine)
    assert max(found.values()) <= 1e-3, found


def test_what_is_asked_for_is_what_comes() -> None:
    """A tenth of the error takes the square root of ten times as many steps, but for halvings."""
    usual = crossed("simple beam of 25 m", "half-car", "C")
    better = crossed("simple beam of 25 m", "half-car", "C", accuracy=1e-4)
    fine = crossed("simple beam of 25 m", "half-car", "C", step=step_of(better) / 8.0)
    assert step_of(usual) / 4.0 <= step_of(better) <= step_of(usual) / 2.0
    assert max(errors(better, fine).values()) <= 1e-4
    assert better.settings["accuracy"] == 1e-4


def test_other_beta_takes_shorter_steps_for_the_same() -> None:
    """Periods that come out too long by the square of the step are paid for by more steps."""
    usual = crossed("simple beam of 25 m", "half-car", "C")
    linear = crossed("simple beam of 25 m", "half-car", "C", beta=1.0 / 6.0)
    assert 1.8 <= step_of(usual) / step_of(linear) <= 3.3
    assert max(errors(linear, usual).values()) <= 1e-3


def test_the_rougher_the_road_the_shorter_the_step() -> None:
    beam, _ = BRIDGES["simple beam of 25 m"]
    car = sw.vehicles.quarter_car()

    def way(grade: str) -> float:
        road = sw.ISO8608(grade)
        return 40.0 * step_of(
            sw.cross(beam, car, speed=40.0, damping=0.0, road=road, approach=40.0)
        )

    ways = [way(grade) for grade in "ABCDE"]
    assert ways == pytest.approx([0.060, 0.042, 0.030, 0.021, 0.015], rel=0.03)


@pytest.mark.parametrize("wrong", [0.0, -1e-3, 0.5, float("nan")])
def test_accuracies_that_are_none(wrong: float) -> None:
    with pytest.raises(ValueError, match=r"accuracy = .*1e-8 to 0.1"):
        crossed("simple beam of 25 m", "half-car", "smooth", accuracy=wrong)
