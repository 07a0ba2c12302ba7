"""Two beams under one force: github.com/bypire/vbi-bridge-sim, note/data.json (June 2026).

(a) 20 m, EI 4.2e9 N m2, 2000 kg/m, 100 kN at 30 m/s, undamped: amplification printed 1.1417436, by
20 elements. (b) 40 m, EI 8.4e10, 12 t/m, 300 kN at 25 m/s, Rayleigh damping of 2 % in modes 1 and
2: printed 1.0799466 by Runge and Kutta, 1.0800199 by Newmark with 4 ms. Both at mid-span by the
largest static deflection there. The closed form below is that of a series of modes.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw


def series(run: sw.Run, mass: float, ratios: np.ndarray, force: float) -> np.ndarray:
    """Deflection of mid-span by the first modes of a simple beam, each in closed form.

    The load on a mode is a sine in time: the response is one too, beside a free vibration.
    """
    length, t = run.bridge.length, run.time
    v = float(run.settings["speed"])  # type: ignore[arg-type]
    n = np.arange(1, len(ratios) + 1)[:, None]
    own = (n * np.pi / length) ** 2 * np.sqrt(run.bridge.EI[0] / mass)
    driven, ratio = n * np.pi * v / length, ratios[:, None]
    steady = 2.0 * force / (mass * length) / (own**2 - driven**2 + 2j * ratio * own * driven)
    forced = (steady * np.exp(1j * driven * t)).imag
    start, rate = -steady.imag, -(1j * driven * steady).imag
    # Some modes are damped beyond critical.
    root = own * np.sqrt(ratio**2 - 1.0 + 0j)
    one, two = -ratio * own + root, -ratio * own - root
    first = (rate - two * start) / (one - two)
    free = (first * np.exp(one * t) + (start - first) * np.exp(two * t)).real
    found: np.ndarray = ((forced + free) * np.sin(n * np.pi / 2.0)).sum(axis=0)
    return found


def crossing(
    length: float, rigidity: float, mass: float, force: float, speed: float, **given: object
) -> sw.Run:
    bridge = sw.Bridge(spans=[length], EI=rigidity, mass=mass, stations_per_span=40)
    train = sw.ForceTrain(loads=[force], positions=[0.0])
    options = {"modes": 10, "tail": 0.0, "sections": [length / 2], "step": 2e-4, **given}
    return sw.cross(bridge, train, speed=speed, **options)  # type: ignore[arg-type]


def undamped(**given: object) -> sw.Run:
    return crossing(20.0, 4.2e9, 2e3, 1e5, 30.0, damping=0.0, **given)


def test_undamped() -> None:
    run = undamped()
    envelope = run.envelope("deflection")
    assert envelope.static_max.value[0] == pytest.approx(3.968254e-3, rel=1e-5)
    assert envelope.max.value[0] == pytest.approx(4.5307057e-3, rel=1e-4)
    assert envelope.max.position[0] == pytest.approx(9.364, abs=0.03)
    assert run.impact_factors.deflection[0] == pytest.approx(1.1417436, rel=1e-4)
    expected = series(run, 2e3, np.zeros(200), 1e5)
    assert_allclose(run.deflection[:, 0], expected, atol=2e-4 * expected.max())


@pytest.mark.parametrize(("modes", "printed"), [(1, 1.15e-2), (2, 1.15e-2), (3, 1.57e-3)])
def test_what_plain_superposition_misses(modes: int, printed: float) -> None:
    direct = undamped(modes=modes, recovery="superposition")
    summed = undamped(modes=modes)
    exact = 4.5307057e-3
    errors = [
        abs(each.envelope("deflection").max.value[0] / exact - 1.0) for each in (direct, summed)
    ]
    assert errors[0] == pytest.approx(printed, abs=3e-4)
    assert errors[1] < 0.25 * printed


def test_rayleigh_damping() -> None:
    damping = sw.Rayleigh(0.5222504, 4.9018634e-4)
    run = crossing(40.0, 8.4e10, 12e3, 3e5, 25.0, damping=damping)
    assert run.frequencies[0] == pytest.approx(2.597460, rel=1e-5)
    assert_allclose(damping.ratios(run.frequencies[:2]), 0.02, rtol=1e-4)
    assert run.impact_factors.deflection[0] == pytest.approx(1.0799584, rel=1e-4)
    for printed in (1.0799466, 1.0800199):
        assert run.impact_factors.deflection[0] == pytest.approx(printed, rel=2e-4)
    own = (np.arange(1, 41) * np.pi / 40.0) ** 2 * np.sqrt(8.4e10 / 12e3) / (2.0 * np.pi)
    expected = series(run, 12e3, damping.ratios(own), 3e5)
    assert_allclose(run.deflection[:, 0], expected, atol=2e-4 * expected.max())
