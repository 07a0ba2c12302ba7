"""Annex C of EN 1991-2: the dynamic increment of a simple beam, which one force must not exceed.

phi' = K / (1 - K + K4) with K = v / (2 L n0). One force on an undamped simple beam reaches less at
any speed (L. Fryba, Vibration of Solids and Structures under Moving Loads).
"""

from __future__ import annotations

import numpy as np
import pytest

import spanwise as sw

LENGTH = 20.0
BRIDGE = sw.Bridge(spans=[LENGTH], EI=4e9, mass=1e4, stations_per_span=40)
FORCE = sw.ForceTrain(loads=[1e5], positions=[0.0])

#: K, the factor 1 + phi' and that of one force at mid-span by Fryba's series.
FACTORS = {
    0.1: (1.1111, 1.0965),
    0.2: (1.2495, 1.0653),
    0.3: (1.4237, 1.4105),
    0.5: (1.8889, 1.7054),
}


def increment(K: float) -> float:
    return K / (1.0 - K + K**4)


def factor(K: float) -> float:
    speed = 2.0 * LENGTH * K * BRIDGE.modes(1).frequencies[0]
    run = sw.cross(
        BRIDGE, FORCE, speed=speed, modes=8, damping=0.0, tail=0.0, sections=[LENGTH / 2], step=2e-4
    )
    return float(run.impact_factors.deflection[0])


@pytest.mark.parametrize("K", FACTORS)
def test_one_force_stays_below(K: float) -> None:
    by_code, by_series = FACTORS[K]
    assert 1.0 + increment(K) == pytest.approx(by_code, abs=5e-5)
    assert factor(K) == pytest.approx(by_series, abs=1e-3)
    assert factor(K) < by_code


def test_at_any_speed() -> None:
    """But for a thousandth at K = 0.34, where formula and force almost agree."""
    for K in np.arange(0.02, 0.6, 0.04):
        assert factor(float(K)) < 1.0 + increment(float(K)) + 2e-3
