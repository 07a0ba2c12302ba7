"""Of a call that is refused for one extreme value, the message names that value and no other."""

from __future__ import annotations

import functools
import re
from typing import Any

import numpy as np
import pytest

import spanwise as sw

# What is extreme is hardly plausible.
pytestmark = pytest.mark.filterwarnings("ignore::spanwise.PlausibilityWarning")

BRIDGE = sw.Bridge(spans=[18.0, 18.0], EI=1.9e9, mass=6e3, stations_per_span=3)
TRUCK = sw.vehicles.half_car()
ROAD = sw.ISO8608("A")
GIVEN: dict[str, Any] = {"speed": 20.0, "damping": 0.02}

EXTREMES: list[tuple[str, dict[str, Any]]] = [
    *(("tail", {"tail": tail}) for tail in (1e9, 1e30, 1e308)),
    *(("step", {"step": step}) for step in (1e-9, 1e-30, 5e-324)),
    *(("approach", {"approach": approach}) for approach in (1e9, 1e30, 1e308)),
    *(("speed", {"speed": speed}) for speed in (1e-9, 1e-30, 5e-324, 1e30, 1e308)),
    *(("gravity", {"gravity": gravity}) for gravity in (1e9, 1e308)),
]


@pytest.mark.parametrize(("key", "extreme"), EXTREMES)
@pytest.mark.parametrize("road", [None, ROAD], ids=["smooth", "rough"])
@pytest.mark.parametrize("many", [False, True], ids=["one", "many"])
def test_an_extreme_value_is_named(
    key: str, extreme: dict[str, Any], road: sw.roads.Road | None, many: bool
) -> None:
    given: dict[str, Any] = {"road": road, **GIVEN, **extreme}
    # On a road that ends or repeats it is the path that is too long.
    named = key if key != "approach" or road is None else "(approach|road = path)"
    drive = functools.partial(sw.ensemble, samples=3) if many else sw.cross
    with pytest.raises(ValueError, match=rf"^{named}\b"):
        drive(BRIDGE, TRUCK, **given)


@pytest.mark.parametrize("advance", [1e-9, 1e-30, 5e-324])
def test_an_advance_too_short_is_named(advance: float) -> None:
    with pytest.raises(ValueError, match=r"^advance = "):
        sw.ensemble(BRIDGE, TRUCK, samples=3, advance=advance, **GIVEN)


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("tyre_stiffness", 1e30),
        ("suspension_stiffness", 1e30),
        ("bridge_stiffness", 1e30),
        ("body_mass", 1e-30),
        ("pitch_inertia", 1e-30),
    ],
)
def test_a_factor_too_far_from_1_is_named(name: str, factor: float) -> None:
    named = rf"^factors\['{name}'\]"
    with pytest.raises(ValueError, match=named):
        sw.ensemble(BRIDGE, TRUCK, samples=3, factors={name: factor}, **GIVEN)
    # Beside others it is that sample's own failure.
    varied = np.array([1.0, factor, 1.0])
    found = sw.ensemble(BRIDGE, TRUCK, samples=3, factors={name: varied}, **GIVEN)
    (failure,) = found.failures
    assert failure.row == 1
    assert re.match(named, failure.cause)


AXLES = [
    {"position": 2.0, "tyre_stiffness": 2e6, "suspension_stiffness": 5e5, "mass": 500.0},
    {"position": -2.0, "tyre_stiffness": 2e6, "suspension_stiffness": 5e5, "mass": 500.0},
]


@pytest.mark.parametrize("value", [1e-300, 1e-30, 1e30, 1e300])
@pytest.mark.parametrize(
    "key", ["mass", "pitch_inertia", "axles[0].tyre_stiffness", "axles[1].suspension_stiffness"]
)
def test_a_value_out_of_proportion_is_named(key: str, value: float) -> None:
    axles = [dict(each) for each in AXLES]
    given: dict[str, Any] = {"mass": 1e4, "pitch_inertia": 4e4}
    if key.startswith("axles"):
        axles[int(key[6])][key.split(".")[1]] = value
    else:
        given[key] = value
    named = key if key.startswith(("axles", "pitch")) else "vehicle mass"
    assert complaint(axles, given).startswith((named, "vehicle = shortest period"))


def complaint(axles: list[dict[str, float]], given: dict[str, Any]) -> str:
    """What is said of a vehicle that is made and driven."""
    try:
        made = sw.Vehicle(axles=[sw.Axle(**each) for each in axles], **given)
        sw.cross(BRIDGE, made, **GIVEN)
    except ValueError as error:
        return str(error)
    return ""


def test_the_sections_of_a_bridge_of_many_stations_are_not_blamed() -> None:
    fine = sw.Bridge(spans=[18.0] * 160, EI=1.9e9, mass=6e3, stations_per_span=4)
    with pytest.raises(ValueError, match=r"^bridge = 2\d\d\d stations"):
        sw.cross(fine, TRUCK, modes=3, **GIVEN)


def steps(**changes: Any) -> int:
    bridge = sw.Bridge(**{"spans": [20.0, 20.0], "EI": 1.9e9, "mass": 6e3, **changes})
    return sw.cross(bridge, TRUCK, modes=3, **GIVEN).steps


@pytest.mark.parametrize(
    "near",
    [
        [(4.98, 1e3)],
        [(0.02, 1e3)],
        [(20.02, 1e3), (19.98, 1e3)],
        [(5.02, 1e3), (5.04, 1e3)],
    ],
)
def test_a_mass_beside_a_station_does_not_shorten_all_steps(
    near: list[tuple[float, float]],
) -> None:
    assert steps(point_masses=near) <= 3 * steps()


def test_a_sliver_changes_no_results() -> None:
    beside, at = (
        sw.Bridge(spans=[20.0], EI=1.9e9, mass=6e3, point_masses=[(x, 1e3)]) for x in (9.0, 9.001)
    )
    runs = [sw.cross(each, TRUCK, modes=3, sections=[10.0], **GIVEN) for each in (beside, at)]
    moments = [float(run.moment.max()) for run in runs]
    assert moments[0] == pytest.approx(moments[1], rel=1e-4)


def test_panels_have_no_say_in_the_step() -> None:
    """A hundredth of the shortest span, however finely its mass is lumped."""
    truck = sw.ForceTrain(loads=[1e4])
    for shares in (1, 7, 40):
        bridge = sw.Bridge(spans=[8.0, 80.0], EI=1.9e11, mass=6e3, stations_per_span=shares)
        run = sw.cross(bridge, truck, modes=1, **GIVEN, tail=0.0)
        assert run.steps == round(88.0 / 0.08)
