"""A force that travels over a simple beam: J. M. Biggs, Introduction to Structural Dynamics, 1964.

Pages 315 to 318 work it by hand with one mode; it is example 45 of the verification manual of midas
Gen and A.58 of that of ADINA. The units are inch, pound and second: length 480, E 2.4e11, I
0.083333, mass by length 0.1 (which the manuals call density), so that a force of 8680.6 at mid-span
deflects it by 1 inch; its speed is 600 inch/s. Printed are deflections of mid-span.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw

LENGTH, RIGIDITY, MASS, FORCE, SPEED = 480.0, 2.4e11 * 0.083333, 0.1, 8680.6, 600.0
TIMES = np.array([0.04, 0.08, 0.12])

#: Printed: by hand with one mode, by ADINA, by midas.
PRINTED = {
    "Biggs": [0.0152, 0.1080, 0.3103],
    "ADINA": [0.0160, 0.1071, 0.3053],
    "midas": [0.0147, 0.1091, 0.3152],
}


def series(modes: int) -> np.ndarray:
    """Deflection of mid-span by the closed form of an undamped simple beam, at `TIMES`."""
    n = np.arange(1, modes + 1)[:, None]
    own = (n * np.pi / LENGTH) ** 2 * np.sqrt(RIGIDITY / MASS)
    driven = n * np.pi * SPEED / LENGTH
    q = np.sin(driven * TIMES) - driven / own * np.sin(own * TIMES)
    scale = 2.0 * FORCE / (MASS * LENGTH) / (own**2 - driven**2)
    found: np.ndarray = (scale * q * np.sin(n * np.pi / 2.0)).sum(axis=0)
    return found


def crossing(**given: object) -> sw.Run:
    bridge = sw.Bridge(spans=[LENGTH], EI=RIGIDITY, mass=MASS, stations_per_span=40)
    options = {"modes": 1, "damping": 0.0, "tail": 0.0, "sections": [LENGTH / 2], **given}
    train = sw.ForceTrain(loads=[FORCE], positions=[0.0])
    return sw.cross(bridge, train, speed=SPEED, step=1e-4, **options)  # type: ignore[arg-type]


def at_times(run: sw.Run) -> np.ndarray:
    found: np.ndarray = np.interp(TIMES, run.time, run.deflection[:, 0])
    return found


def test_one_mode_by_superposition() -> None:
    run = crossing(recovery="superposition")
    assert_allclose(run.frequencies, [3.04896], rtol=1e-5)
    found = at_times(run)
    assert_allclose(found, series(1), rtol=2e-4)
    # By hand to about 2e-3 of the static deflection, the programs to 6e-3.
    assert_allclose(found, PRINTED["Biggs"], atol=1e-3)
    assert_allclose(found, PRINTED["ADINA"], atol=5e-3)
    assert_allclose(found, PRINTED["midas"], atol=6e-3)


def test_one_mode_by_force_summation_is_nearer_to_all_modes() -> None:
    exact = series(100)
    assert exact == pytest.approx([0.01046, 0.09933, 0.29941], abs=1e-5)
    summed, direct = (
        at_times(crossing(recovery=each)) for each in ("force-summation", "superposition")
    )
    assert (np.abs(summed - exact) < 0.2 * np.abs(direct - exact)).all()
    assert_allclose(summed[0], 0.0105, atol=6e-4)
    assert_allclose(at_times(crossing(modes=20)), exact, rtol=1e-3)
