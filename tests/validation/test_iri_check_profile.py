"""IRI of the check profile: M. W. Sayers, T. D. Gillespie, W. D. O. Paterson, World Bank Technical
Paper 46, "Guidelines for conducting and calibrating road roughness measurements" (1986).

A triangle, which rises from 0 at 1 m to 2 mm at 3 m and falls to 0 at 5 m, on 30 m of level road.
The paper's program by chords, written anew, gives 0.2050 m/km on points 0.25 m apart and 0.2051 on
points 0.1 m apart. And roads of ISO 8608, of which index, class and variance follow from the
spectrum.
"""

from __future__ import annotations

import numpy as np
import pytest

import spanwise as sw


@pytest.mark.parametrize(("spacing", "published"), [(0.25, 0.2050), (0.1, 0.2051)])
def test_the_triangle(spacing: float, published: float) -> None:
    x = np.linspace(0.0, 30.0, round(30.0 / spacing) + 1)
    road = sw.Profile(x, np.interp(x, [0.0, 1.0, 3.0, 5.0, 30.0], [0.0, 0.0, 2e-3, 0.0, 0.0]))
    index = road.iri(0.0, 30.0)
    print(f"{spacing} m: {index:.4f} m/km")
    # The mean of what the car feels, and not of what it feels at the points.
    assert index == pytest.approx(published, rel=0.01)
    # Anywhere between the points, too.
    assert road.iri(0.005, 30.0) == pytest.approx(index, rel=0.01)
