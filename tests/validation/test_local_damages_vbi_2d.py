"""A bridge with two local damages: E02_Example_withMultipleDamages of VBI-2D (February 2026).

Simple beam of 25 m, EI 3.5e10 N/m2 x 1.3901 m4, 18 358 kg/m; EI is 20 % less from 5.25 to 7.25 m
and 10 % less from 12 to 13 m. Expected are frequencies of 400 finite elements of our own, which
share nothing with this library; those of the intact beam have a closed form.
"""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

import spanwise as sw

LENGTH, RIGIDITY, MASS = 25.0, 3.5e10 * 1.3901, 18358.0
AT = [0.0, 5.25, 7.25, 12.0, 13.0, 25.0]
DAMAGED = [4.033578, 16.058912, 36.319747, 65.353383]  # Hz

#: Hundred masses stand for the distributed one: four modes to 1e-5.
ACCURATE = 2e-5


def frequencies(EI: object) -> np.ndarray:
    bridge = sw.Bridge(spans=[LENGTH], EI=EI, mass=MASS, stations_per_span=100)  # type: ignore[arg-type]
    return bridge.modes(4).frequencies


def test_intact() -> None:
    n = np.arange(1, 5)
    expected = 0.5 * np.pi * n**2 * np.sqrt(RIGIDITY / MASS) / LENGTH**2
    assert_allclose(expected, [4.091516, 16.366063, 36.823641, 65.464251], rtol=1e-6)
    assert_allclose(frequencies(RIGIDITY), expected, rtol=ACCURATE)


def test_damaged() -> None:
    values = [RIGIDITY * each for each in (1.0, 0.8, 1.0, 0.9, 1.0)]
    assert_allclose(frequencies({"at": AT, "values": values}), DAMAGED, rtol=ACCURATE)
