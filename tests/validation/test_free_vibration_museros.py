"""What is left on a simple beam after one force has gone, and where nothing is left.

P. Museros, E. Moliner and M. D. Martinez-Rodrigo, "Free vibrations of simply-supported beam bridges
under moving loads: Maximum resonance, cancellation and resonant vertical acceleration", J. Sound
Vib. 332 (2013) 326-345. Undamped, in mode 1, with alpha = v / (2 f1 L), the amplitude over the
static one, 2 P L3 / (pi4 EI), is R = 2 alpha / (1 - alpha2) |cos(pi / (2 alpha))|: nothing at
alpha = 1/3, 1/5, 1/7 and so on. A train of forces d apart resonates at v = f1 d / i, but not where
that is a speed of cancellation too.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw

LENGTH, RIGIDITY, MASS, FORCE = 20.0, 4e9, 1e4, 1e5
BRIDGE = sw.Bridge(spans=[LENGTH], EI=RIGIDITY, mass=MASS, stations_per_span=20)
STATIC = 2.0 * FORCE * LENGTH**3 / (np.pi**4 * RIGIDITY)
FIRST = 2.0 * np.pi * BRIDGE.modes(1).frequencies[0]  # rad/s

#: alpha and R, worked out by another hand.
LEFT = {
    0.05: 0.100251,
    1 / 8: 0.253968,
    1 / 6: 0.342857,
    0.25: 0.533333,
    0.4: 0.673435,
    0.5: 1.333333,
    0.7: 1.711541,
}


def closed(alpha: float) -> float:
    return float(2.0 * alpha / (1.0 - alpha**2) * abs(np.cos(np.pi / (2.0 * alpha))))


def left(alpha: float, train: sw.ForceTrain) -> float:
    """Amplitude of mode 1 in the tail, over the static one of a single force."""
    run = sw.cross(
        BRIDGE,
        train,
        speed=alpha * FIRST / np.pi * LENGTH,
        modes=1,
        damping=0.0,
        tail=0.5,
        step=2e-4,
    )
    amplitude = np.hypot(run.modal.coordinates[:, 0], run.modal.velocities[:, 0] / FIRST)
    tail = amplitude[run.time > run.time[-1] - 0.4]
    assert_allclose(tail, tail[-1], atol=2e-4 * np.ptp(amplitude))
    # A mode of unit modal mass has the largest ordinate sqrt(2 / (m L)).
    return float(tail[-1] * np.sqrt(2.0 / (MASS * LENGTH)) / STATIC)


def single() -> sw.ForceTrain:
    return sw.ForceTrain(loads=[FORCE], positions=[0.0])


@pytest.mark.parametrize("alpha", LEFT)
def test_one_force(alpha: float) -> None:
    assert closed(alpha) == pytest.approx(LEFT[alpha], abs=1e-6)
    assert left(alpha, single()) == pytest.approx(closed(alpha), abs=1e-3)


@pytest.mark.parametrize("odd", [3, 5, 7, 9])
def test_cancellation(odd: int) -> None:
    assert left(1.0 / odd, single()) < 1e-3


def test_a_train_at_its_resonance_grows_but_for_cancellation() -> None:
    """Ten forces at v = f1 d: tenfold at alpha 0.4, of which d = 2 alpha L; nothing at 1/3."""
    for alpha, expected in ((0.4, 10.0 * closed(0.4)), (1.0 / 3.0, 0.0)):
        train = sw.ForceTrain(loads=[FORCE] * 10, spacings=[2.0 * alpha * LENGTH] * 9)
        assert left(alpha, train) == pytest.approx(expected, abs=1e-2)
