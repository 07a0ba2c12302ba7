"""Cooper E80 on a span of 60 ft, by rail, in feet and kips: an exercise of railway textbooks.

20, four of 40, four of 26 kips, twice, at the spacings of AREMA. With wheel 3 at mid-span the
moment there is 2391 ft kips; AREMA tables 2597.8 ft kips as the largest moment on the span.
"""

from __future__ import annotations

import numpy as np
import pytest

import spanwise as sw

SPAN = 60.0
LOADS = np.array([20.0, 40.0, 40.0, 40.0, 40.0, 26.0, 26.0, 26.0, 26.0] * 2)
GAPS = [8.0, 5.0, 5.0, 5.0, 9.0, 5.0, 6.0, 5.0]
AT = np.concatenate([[0.0], np.cumsum([*GAPS, 8.0, *GAPS])])


def moments(x: float) -> np.ndarray:
    """At x with each axle there, the train to either side."""
    bridge = sw.Bridge(spans=[SPAN], EI=1e9, mass=1e3, stations_per_span=1)
    wheels = x + AT[:, None] - AT
    on = (wheels >= 0.0) & (wheels <= SPAN)
    line = bridge.influence_line("moment", x, np.where(on, wheels, 0.0).ravel())
    found: np.ndarray = (LOADS * on * line.reshape(wheels.shape)).sum(axis=1)
    return found


def test_wheel_3_at_mid_span() -> None:
    assert moments(30.0)[2] == pytest.approx(2391.0, abs=0.1)


def test_largest_moment() -> None:
    found = max(moments(x).max() for x in np.linspace(24.0, 36.0, 121))
    assert found == pytest.approx(2597.8, abs=0.2)
