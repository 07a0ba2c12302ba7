"""Bridges against closed forms: where the mass goes, influence lines, flexibility, reactions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from numpy.typing import NDArray

import spanwise as sw

Array = NDArray[np.float64]

#: The solver works with flexibility coefficients of the order L^3/EI; a few roundings of these.
EXACT = 1e-12

FOOT = 0.3048
L, EI, MASS = 24.0, 3.0e9, 5000.0

#: Loads all along a span of length L, both ends and no special point but the middle.
X = np.linspace(0.0, L, 41)


def simple(**changes: Any) -> sw.Bridge:
    return sw.Bridge(**{"spans": [L], "EI": EI, "mass": MASS, **changes})


def two_spans(**changes: Any) -> sw.Bridge:
    return sw.Bridge(**{"spans": [L, L], "EI": EI, "mass": MASS, **changes})


# Layout


def test_spans_and_supports_describe_the_same_bridge() -> None:
    by_spans = sw.Bridge(
        spans=[10.0, 15.0, 4.0], ends=("clamped", "free"), EI=[1e9, 2e9, 3e9], mass=[1e3, 2e3, 3e3]
    )
    by_supports = sw.Bridge(
        length=29.0,
        supports=[(25.0, "pinned"), (0.0, "clamped"), (10.0, "pinned")],
        EI=[1e9, 2e9, 3e9],
        mass=[1e3, 2e3, 3e3],
    )
    assert by_spans.supports == by_supports.supports
    assert by_spans.supports == [(0.0, "clamped"), (10.0, "pinned"), (25.0, "pinned")]
    for name in ("length", "span_bounds", "EI", "stations", "masses"):
        assert_array_equal(getattr(by_spans, name), getattr(by_supports, name))
    assert_array_equal(by_spans.modes(5).frequencies, by_supports.modes(5).frequencies)


def test_masses_stand_in_the_middle_of_equal_shares() -> None:
    # Kishan and Traill-Nash 1973, Fig. 4: six masses of 2522 slug at 10, 30 and 50 ft of each span.
    slug_per_foot = 4.4482216152605 / FOOT**2
    bridge = sw.Bridge(
        spans=[60.0 * FOOT] * 2, EI=1.9415e9, mass=126.1 * slug_per_foot, stations_per_span=3
    )
    assert_allclose(bridge.stations / FOOT, [10, 30, 50, 70, 90, 110], rtol=EXACT)
    assert_allclose(bridge.masses, 2522.0 * slug_per_foot * FOOT, rtol=EXACT)


@pytest.mark.parametrize("stations_per_span", [1, 4, [2, 7, 3]])
def test_no_mass_is_lost(stations_per_span: int | list[int]) -> None:
    spans, mass = [10.0, 15.0, 4.0], [1e3, 2e3, 3e3]
    bridge = sw.Bridge(spans=spans, EI=1e9, mass=mass, stations_per_span=stations_per_span)
    assert bridge.masses.sum() == pytest.approx(np.dot(spans, mass), rel=EXACT)


def test_chosen_stations_take_the_mass_half_way_to_their_neighbours() -> None:
    # Bounds of the shares on 0..20 m: 0, (4+10)/2 = 7, (10+18)/2 = 14, 20.
    bridge = simple(spans=[20.0], stations=[4.0, 10.0, 18.0])
    assert_array_equal(bridge.stations, [4.0, 10.0, 18.0])
    assert_allclose(bridge.masses, MASS * np.array([7.0, 7.0, 6.0]), rtol=EXACT)


def test_chosen_stations_take_no_mass_from_across_a_support() -> None:
    # From 0 to 10 m there is one station only, so it takes all of it, at whichever place.
    bridge = simple(spans=[10.0, 20.0], stations=[9.0, 12.0, 20.0], mass=[1000.0, 2000.0])
    assert_allclose(bridge.masses, [10_000.0, 2000.0 * 6.0, 2000.0 * 14.0], rtol=EXACT)


def test_mass_over_a_support_does_not_move() -> None:
    # Shares of 0, 5, 15, 20 m: 2.5, 7.5, 7.5, 2.5 m.
    bridge = simple(spans=[20.0], stations=[0.0, 5.0, 15.0, 20.0])
    assert_array_equal(bridge.stations, [5.0, 15.0])
    assert_allclose(bridge.masses, MASS * np.array([7.5, 7.5]), rtol=EXACT)


def test_point_masses_add_to_stations_or_stand_alone() -> None:
    bridge = simple(
        spans=[20.0], stations_per_span=2, point_masses=[(5.0, 300.0), (12.0, 70.0), (20.0, 9.0)]
    )
    assert_array_equal(bridge.stations, [5.0, 12.0, 15.0])
    assert_allclose(bridge.masses, [MASS * 10.0 + 300.0, 70.0, MASS * 10.0], rtol=EXACT)


def test_default_sections_are_stations_supports_and_tenth_points() -> None:
    bridge = sw.Bridge(spans=[10.0, 20.0], EI=EI, mass=MASS, stations_per_span=3)
    tenths = [*np.linspace(0.0, 10.0, 11), *np.linspace(10.0, 30.0, 11)]
    stations = [10 / 6, 5.0, 50 / 6, 10 + 20 / 6, 20.0, 10 + 100 / 6]
    expected = np.unique(np.round([*tenths, *stations], 9))
    assert_allclose(bridge.default_sections(), expected, rtol=0.0, atol=1e-8)


# Simple span, a load at x, a section at a


@pytest.mark.parametrize("a", [0.0, 5.0, 12.0, 20.5, 24.0])
def test_moment_of_a_simple_span(a: float) -> None:
    # M = x (L - a) / L left of a, a (L - x) / L right of it.
    expected = np.where(a >= X, X * (L - a), a * (L - X)) / L
    assert_allclose(simple().influence_line("moment", a, X), expected, atol=L * EXACT)


@pytest.mark.parametrize("a", [5.0, 12.0, 20.5])
def test_shear_of_a_simple_span(a: float) -> None:
    # V = R_A = (L - x) / L while the load is right of a, R_A - 1 = -x / L when it has passed.
    for side in ("shear-left", "shear-right"):
        off = X[a != X]
        expected = np.where(off < a, -off, L - off) / L
        line = simple().influence_line(side, a, off)
        assert_allclose(line, expected, atol=EXACT)


@pytest.mark.parametrize("a", [5.0, 12.0, 20.5])
def test_deflection_of_a_simple_span(a: float) -> None:
    # y(a) = b t (L^2 - b^2 - t^2) / (6 L EI): t is the lesser of a and x, b from the greater to L.
    t, b = np.minimum(a, X), L - np.maximum(a, X)
    expected = b * t * (L**2 - b**2 - t**2) / (6.0 * L * EI)
    assert_allclose(simple().influence_line("deflection", a, X), expected, atol=L**3 / EI * EXACT)
    middle = simple().influence_line("deflection", L / 2, L / 2)
    assert middle == pytest.approx(L**3 / (48.0 * EI), rel=EXACT)


def test_slope_of_a_simple_span() -> None:
    # At the left end b (L^2 - b^2) / (6 L EI), b from the load to the right end.
    b = L - X
    expected = b * (L**2 - b**2) / (6.0 * L * EI)
    assert_allclose(simple().influence_line("slope", 0.0, X), expected, atol=L**2 / EI * EXACT)


def test_reactions_of_a_simple_span() -> None:
    assert_allclose(simple().influence_line("reaction", 0.0, X), (L - X) / L, atol=EXACT)
    assert_allclose(simple().influence_line("reaction", L, X), X / L, atol=EXACT)


# Clamped ends (Roark, Table 8.1)


def test_propped_cantilever() -> None:
    bridge = simple(ends=("clamped", "pinned"))
    # R_B = x^2 (3 L - x) / (2 L^3);  M_A = -x (L - x) (2 L - x) / (2 L^2).
    prop = X**2 * (3.0 * L - X) / (2.0 * L**3)
    assert_allclose(bridge.influence_line("reaction", L, X), prop, atol=EXACT)
    assert_allclose(bridge.influence_line("reaction", 0.0, X), 1.0 - prop, atol=EXACT)
    clamp = -X * (L - X) * (2.0 * L - X) / (2.0 * L**2)
    assert_allclose(bridge.influence_line("moment", 0.0, X), clamp, atol=L * EXACT)
    # Under a load in the middle 7 L^3 / (768 EI).
    middle = bridge.influence_line("deflection", L / 2, L / 2)
    assert middle == pytest.approx(7.0 * L**3 / (768.0 * EI), rel=EXACT)


def test_fixed_ends() -> None:
    bridge = simple(ends=("clamped", "clamped"))
    # R_A = (L - x)^2 (L + 2 x) / L^3;  M_A = -x (L - x)^2 / L^2;  M_B = -x^2 (L - x) / L^2.
    left = (L - X) ** 2 * (L + 2.0 * X) / L**3
    assert_allclose(bridge.influence_line("reaction", 0.0, X), left, atol=EXACT)
    clamp = -X * (L - X) ** 2 / L**2
    assert_allclose(bridge.influence_line("moment", 0.0, X), clamp, atol=L * EXACT)
    clamp = -(X**2) * (L - X) / L**2
    assert_allclose(bridge.influence_line("moment", L, X), clamp, atol=L * EXACT)
    middle = bridge.influence_line("deflection", L / 2, L / 2)
    assert middle == pytest.approx(L**3 / (192.0 * EI), rel=EXACT)


def test_cantilever() -> None:
    bridge = simple(ends=("clamped", "free"))
    # Tip deflection x^2 (3 L - x) / (6 EI), clamp moment -x.
    tip = X**2 * (3.0 * L - X) / (6.0 * EI)
    assert_allclose(bridge.influence_line("deflection", L, X), tip, atol=L**3 / EI * EXACT)
    assert_allclose(bridge.influence_line("moment", 0.0, X), -X, atol=L * EXACT)


def test_overhangs() -> None:
    bridge = sw.Bridge(length=20.0, supports=[(5.0, "pinned"), (15.0, "pinned")], EI=EI, mass=MASS)
    x = np.linspace(0.0, 20.0, 21)
    # The lever rule about the other support; of a load on an overhang the moment over its support.
    assert_allclose(bridge.influence_line("reaction", 5.0, x), (15.0 - x) / 10.0, atol=EXACT)
    expected = -np.maximum(5.0 - x, 0.0)
    assert_allclose(bridge.influence_line("moment", 5.0, x), expected, atol=20.0 * EXACT)


# Two spans


def test_middle_reaction_of_two_equal_spans() -> None:
    # Three moments: M_B = -x (L^2 - x^2) / (4 L^2), so R_B = x (3 L^2 - x^2) / (2 L^3).
    bridge = two_spans()
    reaction = X * (3.0 * L**2 - X**2) / (2.0 * L**3)
    for loads in (X, 2.0 * L - X):
        assert_allclose(bridge.influence_line("reaction", L, loads), reaction, atol=EXACT)
    moment = -X * (L**2 - X**2) / (4.0 * L**2)
    assert_allclose(bridge.influence_line("moment", L, X), moment, atol=L * EXACT)


def test_support_moment_of_two_unequal_spans() -> None:
    # Three moments with EI by span:
    # M_B = -x (L1^2 - x^2) / (L1 EI1) / (2 (L1 / EI1 + L2 / EI2)), the load in span 1.
    lengths, rigidities = (12.0, 20.0), (1e9, 4e9)
    bridge = sw.Bridge(spans=lengths, EI=rigidities, mass=MASS)
    x = np.linspace(0.0, lengths[0], 25)
    flexibilities = [
        length / rigidity for length, rigidity in zip(lengths, rigidities, strict=True)
    ]
    expected = -x * (lengths[0] ** 2 - x**2) / (lengths[0] * rigidities[0])
    expected /= 2.0 * sum(flexibilities)
    assert_allclose(bridge.influence_line("moment", 12.0, x), expected, atol=L * EXACT)


def test_stiffness_of_the_redundant_support_of_two_equal_spans() -> None:
    # Without its middle support it is a simple span of 2 L: K^R = 48 EI / (2 L)^3.
    stiffness = two_spans().redundant_stiffness()
    assert_allclose(stiffness, [[48.0 * EI / (2.0 * L) ** 3]], rtol=EXACT)
    assert simple().redundant_stiffness().shape == (0, 0)


def test_the_basic_bridge_is_the_simple_span_without_the_middle_support() -> None:
    bridge, span = two_spans(), simple(spans=[2.0 * L])
    x = np.linspace(0.0, 2.0 * L, 33)
    for quantity, scale in (("deflection", L**3 / EI), ("moment", L)):
        basic = bridge.influence_line(quantity, 15.0, x, "basic")
        expected = span.influence_line(quantity, 15.0, x)
        assert_allclose(basic, expected, atol=scale * EXACT)


def test_outer_reactions_are_those_of_the_basic_bridge() -> None:
    x, _ = two_spans().flexibility("basic")
    left, right = two_spans().outer_reactions()
    assert left[:2] == (0.0, "force")
    assert right[:2] == (2.0 * L, "force")
    assert_allclose(left[2], 1.0 - x / (2.0 * L), atol=EXACT)
    assert_allclose(right[2], x / (2.0 * L), atol=EXACT)


# Any bridge

BRIDGES = {
    "simple": simple(),
    "two spans": two_spans(),
    "propped": simple(ends=("clamped", "pinned")),
    "fixed": simple(ends=("clamped", "clamped")),
    "cantilever": simple(ends=("clamped", "free")),
    "four spans": sw.Bridge(
        spans=[9.0, 15.0, 12.0, 3.0], ends=("clamped", "free"), EI=[1e9, 2e9, 3e9, 1e9], mass=MASS
    ),
}


@pytest.mark.parametrize("bridge", BRIDGES.values(), ids=BRIDGES.keys())
def test_deflections_are_reciprocal(bridge: sw.Bridge) -> None:
    x = np.linspace(0.0, bridge.length, 9)
    between = np.array([bridge.influence_line("deflection", at, x) for at in x])
    assert_allclose(between, between.T, atol=EXACT * between.max())
    for structure in ("actual", "basic"):
        _, flexibility = bridge.flexibility(structure)
        assert_allclose(flexibility, flexibility.T, atol=EXACT * flexibility.max())


@pytest.mark.parametrize("bridge", BRIDGES.values(), ids=BRIDGES.keys())
def test_the_flexibility_matrix_is_the_influence_lines_at_the_stations(bridge: sw.Bridge) -> None:
    x, flexibility = bridge.flexibility()
    assert_array_equal(x, bridge.stations)
    lines = np.array([bridge.influence_line("deflection", at, x) for at in x])
    assert_allclose(flexibility, lines, atol=EXACT * lines.max())


@pytest.mark.parametrize("bridge", BRIDGES.values(), ids=BRIDGES.keys())
def test_reactions_carry_the_load(bridge: sw.Bridge) -> None:
    x = np.linspace(0.0, bridge.length, 57)
    reactions = [bridge.influence_line("reaction", at, x) for at, _ in bridge.supports]
    assert_allclose(np.sum(reactions, axis=0), 1.0, atol=10.0 * EXACT)


@pytest.mark.parametrize("bridge", BRIDGES.values(), ids=BRIDGES.keys())
def test_supports_hold(bridge: sw.Bridge) -> None:
    x = np.linspace(0.0, bridge.length, 57)
    scale = bridge.length**3 / bridge.EI.min()
    for at, kind in bridge.supports:
        assert_allclose(bridge.influence_line("deflection", at, x), 0.0, atol=EXACT * scale)
        if kind == "clamped":
            assert_allclose(bridge.influence_line("slope", at, x), 0.0, atol=EXACT * scale)


def test_influence_line_keeps_the_shape_of_x() -> None:
    x = X[:40].reshape(4, 10)
    assert simple().influence_line("moment", 5.0, x).shape == (4, 10)
    assert simple().influence_line("moment", 5.0, 3.0).shape == ()


def test_a_load_off_the_bridge_does_nothing() -> None:
    assert_array_equal(simple().influence_line("moment", 5.0, [-1.0, L + 1.0]), 0.0)


# Modes


def test_one_mass_in_the_middle() -> None:
    # omega^2 = 48 EI / (m L^3).
    bridge = simple(mass=0.0, stations=[L / 2], point_masses=[(L / 2, 1000.0)])
    modes = bridge.modes(1)
    assert_allclose(modes.omega, np.sqrt(48.0 * EI / (1000.0 * L**3)), rtol=EXACT)
    assert_allclose(modes.frequencies, modes.omega / (2.0 * np.pi), rtol=EXACT)
    assert_allclose(modes.shapes, [[1.0 / np.sqrt(1000.0)]], rtol=EXACT)


def test_modes_are_orthonormal_and_solve_the_eigenproblem() -> None:
    bridge = BRIDGES["four spans"]
    modes = bridge.modes(8)
    unit = modes.shapes.T @ np.diag(bridge.masses) @ modes.shapes
    assert_allclose(unit, np.eye(8), atol=1e-10)  # the tolerance of the solver's own check
    _, flexibility = bridge.flexibility()
    # F M phi = phi / omega^2
    left = flexibility @ np.diag(bridge.masses) @ modes.shapes
    right = modes.shapes / modes.omega**2
    assert_allclose(left, right, atol=1e-10 * np.abs(right).max())


def test_frequencies_approach_those_of_the_uniform_beam_with_more_stations() -> None:
    # f_n = n^2 pi / (2 L^2) sqrt(EI / m). The error of lumping falls with the fourth power of the
    # distance between masses for the midpoints of equal shares of a simple span.
    exact = np.arange(1, 4) ** 2 * np.pi / (2.0 * L**2) * np.sqrt(EI / MASS)
    errors = np.array(
        [simple(stations_per_span=n).modes(3).frequencies / exact - 1.0 for n in (8, 16, 32)]
    )
    orders = np.log2(np.abs(errors[:-1] / errors[1:]))
    assert np.all(orders > 3.5), orders


def test_mode_shapes_between_stations_pass_through_the_stations() -> None:
    bridge = BRIDGES["four spans"]
    modes = bridge.modes(4)
    assert_allclose(bridge.mode_shapes(4, bridge.stations), modes.shapes, atol=1e-10)
    at_supports = bridge.mode_shapes(4, [x for x, _ in bridge.supports])
    assert_allclose(at_supports, 0.0, atol=1e-10 * np.abs(modes.shapes).max())
