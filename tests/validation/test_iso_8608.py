"""Roads of ISO 8608:2016: variance, class and IRI of the spectrum, from independent integrals.

Classes A to D have G_d(n0) of 16, 64, 256 and 1024e-6 m3; in the band from 0.01 to 4 cycle/m the
standard deviation of class A is 3.995 mm. The index of a Gaussian road is (2/pi)^(1/2) times the
standard deviation of the golden car's response to the spectrum, 2.1726 m/km for A; an index of
2 m/km so belongs to 13.559e-6 m3.
"""

from __future__ import annotations

import numpy as np
import pytest

import spanwise as sw


@pytest.mark.parametrize(
    ("letter", "G"), [("A", 16e-6), ("B", 64e-6), ("C", 256e-6), ("D", 1024e-6)]
)
def test_the_class_of_a_road_of_that_class(letter: str, G: float) -> None:
    found = [sw.ISO8608(letter, seed=1, sample=k).iso_class(0.0, 1024.0) for k in range(8)]
    assert {each.letter for each in found} == {letter}
    assert np.mean([each.G for each in found]) == pytest.approx(G, rel=0.03)


def test_the_variance_of_class_a() -> None:
    road = sw.ISO8608("A", contact_patch=0.0)
    assert 1e3 * road.elevation(np.arange(0.0, 1024.0, 0.01)).std() == pytest.approx(
        3.995, rel=5e-3
    )


def test_the_index_of_class_a() -> None:
    found = [sw.ISO8608("A", seed=1, sample=k).iri(0.0, 1024.0) for k in range(20)]
    assert np.mean(found) == pytest.approx(2.1726, rel=5e-3)
    assert pytest.approx(1.3559e-5, rel=1e-3) == sw.roads.from_iri(2.0).G
