"""A railway train on a beam of 25 m: the reference case of BeamDyn (A. Andersson, KTH, 2026).

The README of github.com/addeKTH/BeamDyn gives frequencies, static values and the largest deflection
and moment at eleven speeds: simple beam, 15 t/m, EI 30e9 N m2, three modes with 1 % of critical
damping, train D2 of EN 15528 of six wagons of four axles of 22.5 t, without interaction. Moments
of its elements leave out the fixed-end part and read 0.4 to 0.8 % off, so that moments are held
against a closed form of our own, which gives its deflections to 1e-5. Its static deflection is
0.2 % low because it shares each axle between the two nodes beside it, 1.25 m apart, which replaces
the influence line by its chords, and moves the train from node to node.
"""

from __future__ import annotations

from functools import cache
from typing import Any, Final

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw

LENGTH: Final = 25.0
AXLE: Final = 22.5e3 * 9.81  # N
#: From axle to axle within a wagon and to the next [m].
GAPS: Final = (1.8, 7.45, 1.8, 3.0)

BRIDGE: Final = sw.Bridge(spans=[LENGTH], EI=30e9, mass=15e3, stations_per_span=40)
SECTIONS: Final = (1.25 * np.arange(1, 20)).tolist()

#: Largest deflection by speed in km/h, as printed [mm].
DEFLECTIONS: Final = {
    100: 12.3758,
    120: 12.0710,
    140: 13.2381,
    160: 16.5952,
    180: 18.7487,
    200: 13.9657,
    220: 12.0546,
    240: 11.5713,
    260: 11.7285,
    280: 12.1462,
    300: 12.7520,
}
#: Largest acceleration of the deck in three modes by speed in km/h, as printed [m/s2].
ACCELERATIONS: Final = {
    100: 0.8734,
    120: 1.5395,
    140: 1.3140,
    160: 2.9259,
    180: 5.5769,
    200: 2.7283,
    220: 1.3798,
    240: 2.4057,
    260: 1.6164,
    280: 1.6162,
    300: 1.8593,
}
#: Largest moment by closed form, and as BeamDyn prints it [MN m].
MOMENTS: Final = {100: (5.64456, 5.6861), 180: (9.00189, 9.0373), 300: (6.17969, 6.2104)}


def train() -> sw.ForceTrain:
    spacings = (GAPS * 6)[:-1]
    return sw.ForceTrain(loads=[AXLE] * 24, spacings=list(spacings))


@cache
def crossing(speed: float) -> sw.Run:
    # The default accuracy is that of responses; of the deck's acceleration peaks are sharper.
    given: dict[str, Any] = {"modes": 3, "damping": 0.01, "tail": 1.0, "accuracy": 1e-4}
    return sw.cross(BRIDGE, train(), speed=speed / 3.6, sections=SECTIONS, **given)


def line(x: np.ndarray) -> np.ndarray:
    """The influence line of the deflection of mid-span of a simple beam."""
    near = np.minimum(x, LENGTH - x).clip(min=0.0)
    found: np.ndarray = near * (3.0 * LENGTH**2 - 4.0 * near**2) / (48.0 * 30e9)
    return found


def static_deflection(step: float) -> float:
    """Largest of mid-span, the train moved by steps [m]."""
    behind = np.concatenate([[0.0], np.cumsum((GAPS * 6)[:-1])])
    x = np.arange(0.0, LENGTH + behind[-1], step)[:, None] - behind
    return float(AXLE * line(x).sum(axis=1).max())


def static_deflection_by_nodes(width: float) -> float:
    """The same with each axle shared between the nodes beside it, and the train moved by nodes."""
    nodes = np.arange(0.0, LENGTH + 0.5 * width, width)
    behind = np.concatenate([[0.0], np.cumsum((GAPS * 6)[:-1])])
    x = np.arange(0.0, LENGTH + behind[-1], width)[:, None] - behind
    chords = np.interp(x, nodes, line(nodes), left=0.0, right=0.0)
    return float(AXLE * chords.sum(axis=1).max())


def test_frequencies_and_static_values() -> None:
    run = crossing(100.0)
    assert_allclose(run.frequencies, [3.554308, 14.217321, 31.989846], rtol=5e-5)
    deflections = run.envelope("deflection").static_max
    assert deflections.value.max() == pytest.approx(static_deflection(0.01), rel=1e-4)
    assert static_deflection_by_nodes(1.25) == pytest.approx(1.123341e-2, rel=1e-6)
    assert run.envelope("moment").static_max.value.max() == pytest.approx(5.08219e6, rel=1e-4)


@pytest.mark.parametrize("speed", DEFLECTIONS)
def test_extremes(speed: int) -> None:
    run = crossing(float(speed))
    deflection = run.envelope("deflection").max.value.max()
    assert 1e3 * deflection == pytest.approx(DEFLECTIONS[speed], rel=2e-4)
    envelope = run.envelope("acceleration")
    acceleration = max(envelope.max.value.max(), -envelope.min.value.min())
    assert acceleration == pytest.approx(ACCELERATIONS[speed], rel=1e-3)
    if speed in MOMENTS:
        exact, printed = MOMENTS[speed]
        moment = run.envelope("moment").max.value.max() / 1e6
        assert moment == pytest.approx(exact, rel=1e-3)
        assert moment == pytest.approx(printed, rel=8e-3)


def test_it_resonates_where_wagons_keep_time_with_the_beam() -> None:
    resonance = 3.6 * BRIDGE.modes(1).frequencies[0] * sum(GAPS)
    assert resonance == pytest.approx(179.8, abs=0.1)
    assert max(DEFLECTIONS, key=lambda each: DEFLECTIONS[each]) == 180
