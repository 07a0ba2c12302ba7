"""IRI of sinusoids: M. W. Sayers, Transportation Research Record 1501 (1995) 1-12.

The index of a wave is the mean of the rectified response of the golden car, 2/pi of the gain for
slopes times the amplitude of the slope, here for an elevation of 1 mm. The gain follows from the
published constants in closed form, and that of the moving average of 250 mm, sinc(n 0.25 m), which
belongs to the index. The two peaks, at 2.4 and 15 m, are those of the published curve of the gain,
1.65 and 1.5.
"""

from __future__ import annotations

import numpy as np
import pytest

import spanwise as sw

#: Wavelength [m], gain for slopes, index of 1 mm without and with the average [m/km].
WAVES = [
    (1.0, 0.27309, 1.09234, 0.98346),
    (2.0, 1.53354, 3.06708, 2.98885),
    (2.4, 1.66400, 2.77334, 2.72410),
    (5.0, 1.16967, 0.93573, 0.93189),
    (8.0, 1.17814, 0.58907, 0.58812),
    (15.0, 1.52731, 0.40728, 0.40710),
    (20.0, 1.23403, 0.24681, 0.24674),
    (50.0, 0.13659, 0.01093, 0.01093),
]

#: The mean slope over steps of 10 mm takes 3e-4 of waves of 1 m, the start up to 1e-3 of 1500 m.
AGREES = 2e-3


def gain(wavelength: float) -> float:
    """From the slope of the road to that between body and axle."""
    s = 2j * np.pi / wavelength * 80.0 / 3.6
    body = 6.0 * s + 63.3  # damper and spring per mass of the body
    axle = 653.0 / (0.15 * s**2 + body + 653.0 - body**2 / (s**2 + body))
    return abs(axle * (body / (s**2 + body) - 1.0))


@pytest.mark.parametrize(("wavelength", "gained", "bare", "averaged"), WAVES)
def test_index_of_a_wave(wavelength: float, gained: float, bare: float, averaged: float) -> None:
    assert gain(wavelength) == pytest.approx(gained, abs=1e-5)
    assert 4.0 * gain(wavelength) / wavelength == pytest.approx(bare, rel=1e-3)
    # 1500 m of whole waves, long after the start, on points that are no matter.
    length = np.floor(1500.0 / wavelength) * wavelength
    x = np.arange(0.0, 100.0 + length + 0.3, 0.01)
    road = sw.Profile(x, 1e-3 * np.sin(2 * np.pi * x / wavelength))
    segment = road.iri(100.0, 100.25 + length, every=length)
    assert len(segment) == 1
    print(f"{wavelength} m: {segment.values[0]:.5f}, published {averaged}")
    assert segment.values[0] == pytest.approx(averaged, rel=AGREES)
    assert road.iri(0.0, 100.25 + length) == pytest.approx(averaged, rel=0.03)
