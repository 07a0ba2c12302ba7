"""Springs, hinges, EI along the beam and settlements through Python."""

from __future__ import annotations

import json
import math
import pickle
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import spanwise as sw

#: A few roundings, relative to the scale of the quantity.
EXACT = 1e-11

SPRINGS: dict[str, Any] = {
    "length": 46.0,
    "supports": [
        (0.0, "clamped"),
        sw.Support(at=15.0, vertical=3e8, rotation=4e8),
        {"at": 32.0, "rotation": math.inf},
        sw.Support(at=46.0, vertical=2e8, rotation=math.inf),
    ],
    "hinges": [24.0],
    "EI": sw.Along([0.0, 15.0, 46.0], [2e9, 4e9, 1e9], pieces=4),
    "mass": {"at": [0.0, 15.0, 46.0], "values": [6e3, 9e3]},
    "stations_per_span": 3,
}


def test_layout() -> None:
    bridge = sw.Bridge(**SPRINGS)
    kinds = [(0.0, "clamped"), (15.0, "elastic"), (32.0, "clamped"), (46.0, "elastic")]
    assert bridge.supports == kinds
    assert_array_equal(bridge.clamps, [0.0, 15.0, 32.0, 46.0])
    assert_array_equal(bridge.hinges, [24.0])
    assert len(bridge.EI) == 8
    assert bridge.EI_bounds[4] == 15.0
    assert_allclose(bridge.masses.sum(), 15 * 6e3 + 31 * 9e3)
    assert set(bridge.default_sections()) >= {15.0, 24.0, 46.0}
    assert "hinge at 24 m" in repr(bridge)
    # The mass on the sprung right end moves; it has none here, those on rigid supports would not.
    assert bridge.mode_count == len(bridge.stations) == 9


def test_copies_and_reports_make_the_same_bridge() -> None:
    bridge = sw.Bridge(**SPRINGS)
    run = sw.cross(bridge, sw.vehicles.kishan_1973(), speed=20.0, modes=3)
    written = json.loads(json.dumps(run.to_dict()))["settings"]["bridge"]
    for again in (pickle.loads(pickle.dumps(bridge)), sw.Bridge(**written)):
        assert again.springs == bridge.springs
        for name in ("EI", "EI_bounds", "hinges", "stations", "masses"):
            assert_array_equal(getattr(again, name), getattr(bridge, name))
        assert_array_equal(again.modes(4).frequencies, bridge.modes(4).frequencies)
    clamps = run.envelope("clamp_moments")
    assert_array_equal(clamps.x, bridge.clamps)
    assert run.clamp_moments.shape == (len(run.time), 4)
    assert "elastic at 15 m (3e+08 N/m, 4e+08 N m/rad), clamped at 32 m, elastic" in run.summary()
    assert "hinge at 24 m" in run.summary()
    # As it was given, not the slices of the taper.
    assert "EI 2e+09, 4e+09, 1e+09 N m2 at 0, 15, 46 m; " in run.summary()


def test_case_file() -> None:
    case = sw.Case.parse("""
    [bridge]
    length = 46.0
    hinges = [24.0]
    EI = { at = [0, 15, 46], values = [2e9, 4e9, 1e9], pieces = 4 }
    mass = { at = [0, 15, 46], values = [6e3, 9e3] }
    stations_per_span = 3
    supports = [
        [0, "clamped"],
        { at = 15, vertical = 3e8, rotation = 4e8 },
        { at = 32, rotation = inf },
        { at = 46, vertical = 2e8, rotation = inf },
    ]
    [vehicle]
    preset = "kishan-1973"
    [crossing]
    speed = 20.0
    damping = { rayleigh = [0.1, 1e-4] }
    """)
    expected = sw.Bridge(**SPRINGS)
    assert_array_equal(case.bridge.modes(4).frequencies, expected.modes(4).frequencies)
    run = case.run(modes=2, step=5e-3)
    assert run.settings["damping"] == {"rayleigh": [0.1, 1e-4]}


def test_moment_jumps_at_an_integral_pier() -> None:
    bridge = sw.Bridge(**SPRINGS)
    x = np.linspace(0.0, 46.0, 60)
    for at in (15.0, 32.0):
        left = bridge.influence_line("moment", at, x)
        right = bridge.influence_line("moment", at + 1e-7, x)
        rise = bridge.influence_line("clamp-moment", at, x)
        assert_allclose(right - left, rise, atol=1e-6 * np.abs(left).max())
        assert np.abs(rise).max() > 0.1
    assert_array_equal(bridge.influence_line("moment", 24.0, x), 0.0)


def test_derivatives_and_sides() -> None:
    bridge = sw.Bridge(**SPRINGS)
    x, step = np.array([3.0, 20.0, 24.0, 40.0]), 1e-4
    sides: tuple[tuple[Any, float], ...] = (("right", 1.0), ("left", -1.0))
    for side, sign in sides:
        slope = bridge.mode_shapes(3, x, derivative=True, side=side)
        away = bridge.mode_shapes(3, x + sign * step) - bridge.mode_shapes(3, x)
        assert_allclose(sign * away / step, slope, atol=1e-3 * np.abs(slope).max())
    kink = bridge.mode_shapes(3, [24.0], derivative=True) - bridge.mode_shapes(
        3, [24.0], derivative=True, side="left"
    )
    assert np.abs(kink).max() > 1e-5
    jump = [
        bridge.influence_line("shear-left", 20.0, 20.0, side=side) for side in ("left", "right")
    ]
    assert_allclose(jump[1] - jump[0], 1.0, atol=EXACT)
    f = bridge.deflections(x, x.tolist())
    assert_allclose(f, f.T, atol=EXACT * np.abs(f).max())
    basic = bridge.deflections(x, x.tolist(), "basic")
    assert np.abs(basic - f).max() > 1e-3 * np.abs(f).max()
    up: Any = "up"
    with pytest.raises(ValueError, match="side = 'up': must be left or right"):
        bridge.mode_shapes(3, x, side=up)


def test_settlement() -> None:
    length, ei, delta = 15.0, 3e9, 0.02
    bridge = sw.Bridge(spans=[length, length], EI=ei, mass=5e3)
    moment = 3.0 * ei * delta / length**2
    for settlements in ({15.0: delta}, [0.0, delta, 0.0]):
        found = bridge.settlement(settlements, sections=[7.5, 15.0])
        assert_allclose(found.moment, [0.5 * moment, moment], rtol=EXACT)
        assert_allclose(found.deflection[1], delta, rtol=EXACT)
        assert_allclose(found.reactions, np.array([1, -2, 1]) * moment / length, rtol=EXACT)
        shear = moment / length
        assert_allclose(found.shear, [[shear, shear], [shear, -shear]], rtol=EXACT)
    assert repr(found).startswith("Settlement(2 sections, 3 supports; deflection 0 to 20 mm, mom")
    assert len(repr(found)) < 200
    assert_array_equal(bridge.settlement([0, 0, 0]).sections, bridge.default_sections())
    with pytest.raises(ValueError, match=r"settlements position = 7 m: must be a support, 0, 15"):
        bridge.settlement({7.0: delta})
    with pytest.raises(ValueError, match="settlements = 1 values: give one for each of the 3"):
        bridge.settlement([delta])
    with pytest.raises(ValueError, match=r"settlements\[1\] = NaN"):
        bridge.settlement([0.0, math.nan, 0.0])
    with pytest.raises(ValueError, match=r"sections\[0\] = 31 m"):
        bridge.settlement([0.0, delta, 0.0], sections=[31.0])


def test_a_sprung_end_is_entered_with_a_blow() -> None:
    """As at a free end the wheel comes upon a bridge that gives way; less so on a stiff spring."""
    vehicle = sw.vehicles.kishan_1973()

    def largest(k: float) -> float:
        supports: list[Any] = [sw.Support(at=0.0, vertical=k), (20.0, "pinned")]
        bridge = sw.Bridge(length=20.0, supports=supports, EI=2e9, mass=6e3)
        return float(sw.cross(bridge, vehicle, speed=20.0, modes=3).envelope("moment").max.value[5])

    rigid = largest(math.inf)
    errors = [abs(largest(k) / rigid - 1.0) for k in (1e9, 1e10, 1e11)]
    assert errors[0] > errors[1] > errors[2], errors
    assert errors[2] < 0.02, errors
