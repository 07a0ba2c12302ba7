"""The train of class A of IRC:6 on a simple span of 50 m: a published design sheet.

27, 27, 114, 114 and four of 68 kN, 1.1, 3.2, 1.2, 4.3, 3, 3 and 3 m apart. The sheet prints 5526.15
kN m at mid-span. Its values at other places are not those of this train; the ones below are by a
search of our own.
"""

from __future__ import annotations

import numpy as np
import pytest

import spanwise as sw

LOADS = np.array([27.0, 27.0, 114.0, 114.0, 68.0, 68.0, 68.0, 68.0])
AT = np.concatenate([[0.0], np.cumsum([1.1, 3.2, 1.2, 4.3, 3.0, 3.0, 3.0])])
SPAN = 50.0

#: Largest moment by place in eighths of the span [kN m].
MOMENTS = {
    1: 2361.10,
    2: 4068.08,
    3: 5120.92,
    4: 5526.15,
    5: 5342.02,
    6: 4327.67,
    7: 2495.40,
}


@pytest.mark.parametrize("eighth", MOMENTS)
def test_moments(eighth: int) -> None:
    x = SPAN * eighth / 8.0
    bridge = sw.Bridge(spans=[SPAN], EI=1e9, mass=1e3, stations_per_span=1)
    wheels = x + AT[:, None] - AT
    on = (wheels >= 0.0) & (wheels <= SPAN)
    line = bridge.influence_line("moment", x, np.where(on, wheels, 0.0).ravel())
    found = (LOADS * on * line.reshape(wheels.shape)).sum(axis=1).max()
    assert found == pytest.approx(MOMENTS[eighth], abs=6e-3)
