"""One word means one thing on a run and on an ensemble, however it is written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise._value import same

BRIDGE = sw.Bridge(
    length=30.0,
    supports=[(0.0, "clamped"), (18.0, "pinned"), (30.0, "pinned")],
    EI=2e9,
    mass=8e3,
    stations_per_span=4,
)
MANY = sw.ensemble(
    BRIDGE,
    sw.vehicles.half_car(),
    samples=4,
    seed=3,
    speed=30.0,
    modes=3,
    damping=0.02,
    road=sw.ISO8608("D"),
)
RUN = MANY.run(2)
QUANTITIES = ("deflection", "moment", "shear", "reactions", "clamp_moments", "axle_loads")
FACTORS = ("deflection", "sagging", "hogging", "shear", "reactions", "axle_loads")


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_envelopes(quantity: Any) -> None:
    many, alone = MANY.envelope(quantity), RUN.envelope(quantity)
    assert_array_equal(many.x, alone.x)
    for side in ("max", "min"):
        assert_array_equal(getattr(many, side)[2], getattr(alone, side).value)
        assert_array_equal(getattr(many, f"{side}_time")[2], getattr(alone, side).time)
    # The names differ in nothing but how they are written.
    for name in (quantity.replace("_", "-"), quantity.removesuffix("s"), quantity.upper()):
        assert MANY.envelope(name) is many
        assert RUN.envelope(name) == alone
        assert len(RUN.to_pandas(name)) == RUN.steps + 1
        assert RUN.plot.envelope(name).axes
    again = sw.ensemble(
        BRIDGE,
        sw.vehicles.half_car(),
        samples=2,
        speed=30.0,
        damping=0.0,
        quantities=["clamp-moment", "moments"],
    )
    assert again.quantities == ("moment", "clamp_moments")


@pytest.mark.parametrize("factor", FACTORS)
def test_impact_factors(factor: Any) -> None:
    many = getattr(MANY.impact_factors, factor)
    assert many.shape[0] == 4
    assert_array_equal(many[2], getattr(RUN.impact_factors, factor))
    assert_array_equal(MANY.impact_factors[factor], many)
    strict = MANY.ratios(mask=0.5)
    assert_array_equal(getattr(strict, factor)[2], getattr(RUN.ratios(mask=0.5), factor))
    assert (strict.mask, MANY.impact_factors.mask) == (0.5, RUN.impact_factors.mask)
    assert_array_equal(MANY.impact_factors.sections, RUN.impact_factors.sections)
    assert_array_equal(MANY.impact_factors.supports, RUN.impact_factors.supports)
    assert MANY.impact_factors.ratio == RUN.impact_factors.ratio


def test_wheels_off_the_road() -> None:
    assert_array_equal(MANY.contact_loss.count[2], RUN.contact_loss.count)
    np.testing.assert_allclose(
        MANY.contact_loss.total[2], RUN.contact_loss.total, rtol=1e-9, atol=1e-12
    )


@pytest.mark.parametrize("quantity", ["momentum", "moment max", 3, None])
def test_what_is_no_quantity(quantity: Any) -> None:
    for each in (MANY, RUN):
        with pytest.raises((ValueError, TypeError)):
            each.envelope(quantity)
    with pytest.raises(ValueError, match=r"quantity = .*: must be one of deflection, moment"):
        MANY.envelope(quantity)


@pytest.mark.parametrize(
    ("name", "as_given"),
    [
        ("reaction", "reactions"),
        ("clamp-moment", "clamp_moments"),
        ("shear-left", "shear_left"),
        ("moment", "Moment"),
    ],
)
def test_influence_lines(name: Any, as_given: Any) -> None:
    at = 0.0 if name in ("reaction", "clamp-moment") else 9.0
    x = np.linspace(0.0, 30.0, 7)
    line = BRIDGE.influence_line(name, at, x)
    assert_array_equal(BRIDGE.influence_line(as_given, at, x), line)
    assert BRIDGE.plot.influence_line(as_given, at).axes


@pytest.mark.parametrize(
    ("old", "new", "use"),
    [
        ("moment", 'envelope("moment")', lambda found: found.moment),
        ("shear_left", 'envelope("shear_left")', lambda found: found.shear_left),
        ("axle_loads", 'envelope("axle_loads")', lambda found: found.axle_loads),
        ("lift_offs", "contact_loss.count", lambda found: found.lift_offs),
        ("time_off_road", "contact_loss.total", lambda found: found.time_off_road),
        ("impact_factors", "impact_factors.sagging", lambda found: found.impact_factors("sagging")),
        (
            "impact_factors",
            "ratios(mask=0.5).sagging",
            lambda found: found.impact_factors("sagging", mask=0.5),
        ),
    ],
)
def test_old_names(old: str, new: str, use: Any) -> None:
    with pytest.warns(DeprecationWarning, match=rf"Ensemble\.{old}.* is now Ensemble\.") as told:
        found = use(MANY)
    (warning,) = told
    assert f"is now Ensemble.{new};" in str(warning.message)
    assert warning.filename == __file__
    expected = eval(f"MANY.{new}", {"MANY": MANY})
    if isinstance(found, np.ndarray):
        assert_array_equal(found, expected)
    else:
        assert found is expected


@pytest.mark.parametrize(
    ("of", "old", "new"),
    [
        (MANY, "off_road", "contact_loss"),
        (MANY, "load_coefficients", "dynamic_load_coefficients"),
        (RUN, "off_road", "contact_loss"),
        (RUN, "load_coefficients", "dynamic_load_coefficients"),
        (RUN.vehicle, "suspension_shortenings", "suspension_travel"),
    ],
)
def test_names_of_the_field(of: Any, old: str, new: str) -> None:
    name = type(of).__name__
    with pytest.warns(DeprecationWarning, match=rf"{name}\.{old} is now {name}\.{new};") as told:
        found = getattr(of, old)
    assert told[0].filename == __file__
    assert same(found, getattr(of, new))


def test_where_the_function_was() -> None:
    with pytest.warns(DeprecationWarning, match=r"is now spanwise\.study\.ensemble"):
        assert getattr(sw.ensembles, "ensemble") is sw.ensemble  # noqa: B009


def test_what_there_never_was() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'momentum'"):
        MANY.momentum  # noqa: B018
    few = sw.ensemble(
        BRIDGE,
        sw.vehicles.half_car(),
        samples=2,
        speed=30.0,
        damping=0.0,
        quantities=["moment"],
    )
    with pytest.raises(ValueError, match='quantity = "shear_left": was not looked at'):
        few.envelope("shear-left")
    with pytest.raises(ValueError, match='quantity = "deflection": was not looked at'):
        few.impact_factors.deflection  # noqa: B018


def test_what_a_module_shows() -> None:
    for module in (sw, sw.roads, sw.vehicles):
        shown = dir(module)
        assert shown == sorted(module.__all__)
        assert all(hasattr(module, name) for name in shown)
    assert {"Bridge", "cross", "ensemble", "concat"} <= {*dir(sw)}
    assert "annotations" not in dir(sw.vehicles)
    assert "FOOT" not in dir(sw.vehicles)
    assert callable(sw.ensemble)


def test_a_function_is_no_module_too() -> None:
    package = Path(sw.__file__).parent
    modules = {path.stem for path in package.glob("*.py")}
    both = {name for name in modules & {*sw.__all__} if callable(getattr(sw, name))}
    assert not both
    assert not hasattr(sw, "run")


def test_slope_is_a_rotation_too() -> None:
    bridge, truck = sw.Bridge(spans=[20.0], EI=2e9, mass=5e3), sw.vehicles.kishan_1973()
    run = sw.cross(bridge, truck, speed=20.0, modes=2, damping=0.0)
    assert run.envelope("rotations") == run.envelope("slope")
    given: Any = {"speed": 20.0, "modes": 2, "damping": 0.0, "quantities": ["rotation"]}
    many = sw.ensemble(bridge, truck, samples=1, **given)
    assert many.quantities == ("slope",)
    assert many.envelope("rotation") == many.envelope("slope")
