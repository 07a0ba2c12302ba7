"""A step that passes over waves of the road is warned of; one that does not is not."""

from __future__ import annotations

import functools
import warnings
from typing import Any

import numpy as np
import pytest

import spanwise as sw

BRIDGE = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)
TRUCK = sw.vehicles.half_car()
GIVEN: dict[str, Any] = {"speed": 20.0, "damping": 0.02, "approach": 20.0, "beta": 0.25}
SHARP = sw.ISO8608("A", contact_patch=0.0)
USUAL = sw.ISO8608("A")
X = np.arange(-30.0, 40.0, 0.1)
POINTS = sw.Profile(X, 1e-3 * np.sin(3.0 * X), contact_patch=0.0)
MOVING = sw.Passage(vehicle=TRUCK, entry=0.1)


def many(vehicle: Any, **given: Any) -> sw.Ensemble:
    return sw.ensemble(BRIDGE, vehicle, samples=2, **{**GIVEN, **given})


def one(**given: Any) -> sw.Run:
    return sw.cross(BRIDGE, TRUCK, **{**GIVEN, **given})


#: What passes over waves, the longest of its steps or ways that do not, and the argument.
LONG: list[tuple[Any, dict[str, Any], dict[str, Any], str]] = [
    (one, {"road": SHARP, "step": 0.01}, {"step": 0.006}, "step"),
    (one, {"road": POINTS, "step": 0.006}, {"step": 0.0045}, "step"),
    (one, {"road": USUAL + SHARP, "step": 0.01}, {"step": 0.006}, "step"),
    (one, {"road": USUAL, "step": 0.02}, {"step": 0.01}, "step"),
    (functools.partial(many, TRUCK), {"road": SHARP, "advance": 0.2}, {"advance": 0.1}, "advance"),
    (functools.partial(many, TRUCK), {"road": USUAL, "advance": 0.3}, {"advance": 0.2}, "advance"),
    (functools.partial(many, MOVING), {"road": SHARP, "step": 0.01}, {"step": 0.006}, "step"),
]


@pytest.mark.parametrize(("cross", "given", "short", "key"), LONG)
def test_long_steps_are_warned_of(
    cross: Any, given: dict[str, Any], short: dict[str, Any], key: str
) -> None:
    with pytest.warns(sw.PlausibilityWarning, match=rf"^{key} = .* passes over"):
        cross(**given)
    cross(**{**given, **short})


def test_no_step_no_warning() -> None:
    for road in (SHARP, USUAL, POINTS, sw.Bump(5.0, 0.3, 0.01)):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            one(road=road)
            many(TRUCK, road=road)
            # Side by side a step is no longer than the default anyway.
            many(TRUCK, road=road, step=0.01)


def test_of_step_and_advance_the_shorter_counts() -> None:
    for given in ({"advance": 0.2, "step": 0.004}, {"advance": 0.1, "step": 0.02}):
        many(TRUCK, road=SHARP, **given)
    for given, key in (
        ({"advance": 0.2, "step": 0.02}, "advance = 0.2 m"),
        ({"advance": 0.2, "step": 0.008}, "step = 0.008 s"),
    ):
        with pytest.warns(sw.PlausibilityWarning, match=f"^{key}: .* passes over"):
            many(TRUCK, road=SHARP, **given)
