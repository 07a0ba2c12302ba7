"""High-speed load model A of EN 1991-2 (table 6.3) on a simple beam of 25 m, at eleven speeds.

Fifteen tonnes a metre, EI 30e9 N m2, three modes with 1 % of critical damping, sections 1.25 m
apart, the whole passage and a second after it. Deflections with the statics of the higher modes,
accelerations of the three modes alone: as BeamDyn (A. Andersson, KTH, 2026) prints them, which
shares no code with this program. Its static deflections are low by 0.25 %, because it shares each
axle between the two nodes beside it, 1.25 m apart; with the chords of the influence line they come
out to the last digit.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pytest

import spanwise as sw

SECTIONS: Final = (1.25 * np.arange(1, 20)).tolist()
BRIDGE: Final = sw.Bridge(spans=[25.0], EI=30e9, mass=15e3, stations_per_span=40)

#: Speeds [km/h].
SPEEDS: Final = np.arange(150.0, 401.0, 25.0)

#: Coaches, their length and the distance of the axles of a bogie [m], force of an axle [kN].
TRAINS: Final = {
    "A1": (18, 18.0, 2.0, 170.0),
    "A3": (16, 20.0, 2.0, 180.0),
    "A4": (15, 21.0, 3.0, 190.0),
    "A6": (13, 23.0, 2.0, 180.0),
    "A7": (13, 24.0, 2.0, 190.0),
    "A9": (11, 26.0, 2.0, 210.0),
}

#: Largest deflection by speed [mm].
DEFLECTIONS: Final = {
    "A1": [7.641, 7.322, 7.912, 13.873, 9.168, 9.017, 8.419, 8.974, 9.07, 8.831, 7.641],
    "A3": [8.091, 8.136, 8.377, 10.419, 26.943, 12.22, 8.916, 8.817, 9.112, 8.701, 7.903],
    "A4": [9.015, 8.465, 8.619, 10.191, 15.392, 30.041, 9.724, 9.033, 9.059, 9.006, 8.3],
    "A6": [13.656, 8.666, 8.47, 9.545, 11.434, 20.027, 40.99, 13.444, 10.103, 9.786, 9.109],
    "A7": [11.482, 9.617, 9.041, 10.213, 12.694, 16.844, 47.805, 22.095, 11.173, 8.91, 9.842],
    "A9": [9.53, 12.258, 10.599, 11.237, 13.325, 15.141, 23.141, 57.961, 30.167, 17.0, 13.76],
}

#: Largest acceleration of the deck by speed [m/s2]. The last of A4 is by the exact recurrence of
#: modes under forces linear in time between instants of 20 us; BeamDyn prints 3.129.
ACCELERATIONS: Final = {
    "A1": [1.243, 1.033, 0.944, 3.882, 2.572, 2.118, 2.206, 2.707, 2.603, 2.536, 2.027],
    "A3": [1.3, 1.474, 1.179, 2.069, 10.057, 4.933, 2.942, 2.997, 2.614, 2.545, 2.131],
    "A4": [1.695, 1.821, 1.13, 1.684, 5.283, 12.645, 4.118, 3.225, 2.507, 2.3, 3.1321],
    "A6": [3.442, 1.673, 1.147, 1.723, 3.724, 8.275, 17.727, 5.717, 3.882, 3.351, 3.313],
    "A7": [3.559, 1.951, 1.44, 1.931, 3.344, 6.531, 20.357, 10.64, 5.593, 4.071, 3.998],
    "A9": [1.932, 3.387, 1.808, 1.943, 3.539, 5.309, 9.026, 25.018, 14.922, 7.826, 5.762],
}

#: Largest static deflection, each axle shared between nodes [mm].
STATIC: Final = {"A1": 6.683, "A3": 7.076, "A4": 7.327, "A6": 7.076, "A7": 7.469, "A9": 8.256}

#: Half a unit of the last printed digit, besides a thousandth.
DIGIT: Final = 5e-4


def train(name: str) -> sw.ForceTrain:
    """Power car, end coach, bogies of the coaches, and the same backwards."""
    coaches, length, bogie, force = TRAINS[name]
    half = [0.0, 3.0, 14.0, 17.0, 20.525, 20.525 + bogie]
    middle = 18.7625 + length * np.arange(1, coaches + 2)
    total = 2 * 18.7625 + (coaches + 2) * length
    inner = np.sort(np.concatenate([middle - bogie / 2, middle + bogie / 2]))
    behind = np.concatenate([half, inner, total - np.array(half[::-1])])
    assert len(behind) == 2 * coaches + 14
    return sw.ForceTrain(loads=[1e3 * force] * len(behind), positions=(-behind).tolist())


@pytest.mark.parametrize("name", TRAINS)
def test_deflections_and_accelerations(name: str) -> None:
    found = sw.ensemble(
        BRIDGE,
        train(name),
        samples=len(SPEEDS),
        speed=SPEEDS / 3.6,
        modes=3,
        damping=0.01,
        tail=1.0,
        sections=SECTIONS,
        quantities=["deflection", "acceleration"],
        approach=0.0,
        advance=0.05,
    )
    deflection, acceleration = found.envelope("deflection"), found.envelope("acceleration")
    largest = np.maximum(acceleration.max.max(axis=1), -acceleration.min.min(axis=1))
    for ours, printed in (
        (1e3 * deflection.max.max(axis=1), np.array(DEFLECTIONS[name])),
        (largest, np.array(ACCELERATIONS[name])),
    ):
        assert (np.abs(ours - printed) <= 1e-3 * printed + DIGIT).all(), (ours, printed)
    # Between two steps it is larger by up to 2e-6.
    at_rest = 1e3 * deflection.static_max.max()
    assert at_rest == pytest.approx(static(name, chords=False), rel=2e-6)


@pytest.mark.parametrize("name", TRAINS)
def test_static_deflections(name: str) -> None:
    assert static(name, chords=True) == pytest.approx(STATIC[name], abs=DIGIT)


def static(name: str, *, chords: bool) -> float:
    """Largest static deflection of mid-span [mm], by its influence line or chords of it."""

    def line(x: np.ndarray) -> np.ndarray:
        near = np.minimum(x, 25.0 - x).clip(min=0.0)
        found: np.ndarray = near * (3.0 * 25.0**2 - 4.0 * near**2) / (48.0 * 30e9)
        return found

    behind = -np.array(train(name).positions)
    x = np.arange(0.0, 25.0 + behind.max(), 0.01)[:, None] - (behind - behind.min())
    nodes = np.linspace(0.0, 25.0, 21)
    shape = np.interp(x, nodes, line(nodes), left=0.0, right=0.0) if chords else line(x)
    return float(1e6 * TRAINS[name][3] * shape.sum(axis=1).max())
