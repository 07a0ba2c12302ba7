"""Largest moments on simple spans under the trains of AS 5100.2: 300LA on rails, M1600 on roads.

300LA is an axle of 360 kN, 2 m before groups of four of 300 kN (1.7, 1.1 and 1.7 m apart) that
follow one another; the code tables moments rounded to 5 kN m. M1600 is four groups of three axles
of 120 kN; 5250 kN m at mid-span of 30 m is a published example. To the digits shown, a search of
our own that knows simple spans only gives the rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import spanwise as sw

#: Positions behind the front axle [m] and loads [kN].
GROUP = (0.0, 1.7, 2.8, 4.5)
LA_AT = np.array([0.0, *(2.0 + 12.0 * k + x for k in range(10) for x in GROUP)])
LA = np.array([360.0] + [300.0] * 40)
M_AT = np.array([0.0, 1.25, 2.5, 6.25, 7.5, 8.75, 15.0, 16.25, 17.5, 22.5, 23.75, 25.0])
M = np.full(12, 120.0)

#: Span [m], moment of the table [kN m], moment found by a search.
TABLE = [
    (5.0, 705.0, 706.8),
    (10.0, 2400.0, 2401.2),
    (20.0, 6300.0, 6297.6),
    (30.0, 12515.0, 12515.1),
    (40.0, 21555.0, 21555.3),
    (50.0, 32560.0, 32558.0),
    (100.0, 126300.0, 126301.5),
]


def largest(span: float, at: np.ndarray, loads: np.ndarray, sections: Sequence[float]) -> float:
    """Largest moment [kN m] at the sections: the lines have one kink, so that an axle is there."""
    bridge = sw.Bridge(spans=[span], EI=1e9, mass=1e3, stations_per_span=1)
    found = 0.0
    for x in sections:
        for behind in (at, at[-1] - at[::-1]):
            weights = loads if behind is at else loads[::-1]
            wheels = x + behind[:, None] - behind
            on = (wheels >= 0.0) & (wheels <= span)
            line = bridge.influence_line("moment", x, np.where(on, wheels, 0.0).ravel())
            sums = (weights * on * line.reshape(wheels.shape)).sum(axis=1)
            found = max(found, float(sums.max()))
    return found


@pytest.mark.parametrize(("span", "table", "searched"), TABLE)
def test_300LA(span: float, table: float, searched: float) -> None:
    found = largest(span, LA_AT, LA, np.linspace(0.4, 0.6, 81) * span)  # type: ignore[arg-type]
    assert found == pytest.approx(searched, rel=5e-5)
    assert found == pytest.approx(table, rel=3e-3)


def test_M1600() -> None:
    assert largest(30.0, M_AT, M, [15.0]) == pytest.approx(5250.0, rel=1e-9)
    assert largest(37.0, M_AT, M, [20.35]) == pytest.approx(7809.3, abs=0.1)
    assert largest(37.0, M_AT, M, [20.227]) == pytest.approx(7809.97, abs=0.1)
