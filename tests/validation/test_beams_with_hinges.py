"""Beams with hinges, a settlement and a haunch: exercises of textbooks, solved in closed form.

The cantilever with a hinge and the four-span beam were asked about by users of finite elements
(issue 77 of github.com/JWock82/Pynite for the latter).
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw


def test_clamped_pinned_with_a_hinge_between() -> None:
    """Clamped at 0, hinge at 5, pinned at 10."""
    bridge = sw.Bridge(
        length=10.0,
        supports=[(0.0, "clamped"), (10.0, "pinned")],
        hinges=[5.0],
        EI=1e8,
        mass=1e3,
        stations_per_span=5,
    )
    x = np.linspace(0.0, 10.0, 41)
    left = x <= 5.0
    assert_allclose(
        bridge.influence_line("reaction", 0.0, x), np.where(left, 1.0, 2.0 - x / 5.0), atol=1e-9
    )
    assert_allclose(
        bridge.influence_line("reaction", 10.0, x), np.where(left, 0.0, (x - 5.0) / 5.0), atol=1e-9
    )
    assert_allclose(
        bridge.influence_line("moment", 0.0, x), np.where(left, -x, x - 10.0), atol=1e-8
    )


def test_a_reaction_beyond_a_hinge() -> None:
    """Pinned at 0, 80 and 140, hinge at 50: at 80, of loads at 50, 25 and 110."""
    bridge = sw.Bridge(
        length=140.0,
        supports=[(0.0, "pinned"), (80.0, "pinned"), (140.0, "pinned")],
        hinges=[50.0],
        EI=1e8,
        mass=1e3,
        stations_per_span=5,
    )
    assert_allclose(bridge.influence_line("reaction", 80.0, [50.0, 25.0, 110.0]), [1.5, 0.75, 0.5])


def test_two_simple_spans_over_a_pier() -> None:
    bridge = sw.Bridge(
        length=40.0,
        supports=[(0.0, "pinned"), (20.0, "pinned"), (40.0, "pinned")],
        hinges=[20.0],
        EI=1e9,
        mass=2e3,
        stations_per_span=20,
    )
    x = [5.0, 10.0, 20.0, 30.0]
    assert_allclose(bridge.influence_line("reaction", 20.0, x), [0.25, 0.5, 1.0, 0.5], atol=1e-9)
    assert_allclose(bridge.influence_line("moment", 20.0, x), 0.0, atol=1e-8)
    alone = 0.5 * np.pi * np.sqrt(1e9 / 2e3) / 20.0**2
    assert_allclose(bridge.modes(2).frequencies, alone, rtol=1e-5)


def test_settlement_of_the_middle_support() -> None:
    """Two spans l of 10 m, 10 mm down in the middle: M = 3 EI d / l2, reactions 3 EI d / l3."""
    bridge = sw.Bridge(spans=[10.0, 10.0], EI=1e8, mass=1e3, stations_per_span=5)
    found = bridge.settlement({10.0: 0.01})
    middle = int(np.argmin(np.abs(found.sections - 10.0)))
    assert found.moment[middle] == pytest.approx(30e3, rel=1e-6)
    assert_allclose(found.reactions, [3e3, -6e3, 3e3], rtol=1e-6)


def test_a_haunched_beam_clamped_at_both_ends() -> None:
    """EI from 3e5 at the clamps to 1.2e5 in the middle; moments at both ends for a load at 4 m.

    By integrals of the flexibility of our own.
    """
    at, values = [0.0, 3.0, 6.0, 9.0, 12.0], [3e5, 1.6e5, 1.2e5, 1.6e5, 3e5]
    bridge = sw.Bridge(
        length=12.0,
        supports=[(0.0, "clamped"), (12.0, "clamped")],
        EI=sw.Along(at, values, pieces=32),
        mass=10.0,
        stations_per_span=5,
    )
    found = [bridge.influence_line("moment", x, [4.0])[0] for x in (0.0, 12.0)]
    assert_allclose(found, [-2.0633, -0.94407], rtol=1e-4)
