"""Rayleigh damping: its ratios, and the same crossing by ratios and by the matrix."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import spanwise as sw

TWO_SPANS: dict[str, Any] = {
    "spans": [18.0, 22.0],
    "EI": 1.9e9,
    "mass": 6e3,
    "stations_per_span": 3,
}


BAD_PAIRS: Any = (1.0, 2.0)


def moments(damping: Any) -> NDArray[np.float64]:
    bridge, vehicle = sw.Bridge(**TWO_SPANS), sw.vehicles.kishan_1973()
    run = sw.cross(bridge, vehicle, speed=20.0, modes=4, step=2e-3, damping=damping, tail=0.0)
    return run.moment


def test_from_two_ratios() -> None:
    rayleigh = sw.Rayleigh.from_ratios((2.0, 0.02), (9.0, 0.03))
    assert_allclose(rayleigh.ratios([2.0, 9.0]), [0.02, 0.03], rtol=1e-12)
    assert_allclose(rayleigh.ratios(5.0), rayleigh.alpha / 20 / np.pi + rayleigh.beta * 5 * np.pi)


def test_it_is_a_set_of_ratios_and_a_matrix() -> None:
    bridge = sw.Bridge(**TWO_SPANS)
    rayleigh = sw.Rayleigh(0.3, 2e-4)
    by_rayleigh = moments(rayleigh)
    assert_allclose(by_rayleigh, moments({"rayleigh": [0.3, 2e-4]}), rtol=0.0, atol=0.0)
    named = moments({"rayleigh": {"alpha": 0.3, "beta": 2e-4}})
    assert_allclose(by_rayleigh, named, rtol=0.0, atol=0.0)
    ratios = rayleigh.ratios(bridge.modes(4).frequencies)
    assert_allclose(by_rayleigh, moments(ratios), rtol=0.0, atol=0.0)
    _, f = bridge.flexibility("actual")
    c = 0.3 * np.diag(bridge.masses) + 2e-4 * np.linalg.inv(f)
    scale = np.abs(by_rayleigh).max()
    assert_allclose(by_rayleigh, moments(0.5 * (c + c.T)), atol=1e-9 * scale)
    assert np.abs(by_rayleigh - moments(0.0)).max() > 1e-3 * scale


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: sw.Rayleigh(-1.0, 0.0), ("alpha", "-1", "0 or more")),
        (lambda: sw.Rayleigh(0.0, float("nan")), ("beta", "NaN", "finite")),
        (lambda: sw.Rayleigh.from_ratios((2.0, 0.02), (2.0, 0.03)), ("frequency", "differ")),
        (lambda: sw.Rayleigh.from_ratios((0.0, 0.02), (2.0, 0.03)), ("first frequency", "0")),
        (lambda: sw.Rayleigh.from_ratios((1.0, 1.5), (2.0, 0.03)), ("first ratio", "1.5")),
        (lambda: sw.Rayleigh.from_ratios((1.0, 0.1), (9.0, 0.001)), ("beta", "negative")),
        (lambda: sw.Rayleigh.from_ratios(*BAD_PAIRS), ("first", "pair")),
        (lambda: moments(sw.Rayleigh(0.0, 0.1)), ("damping", "mode", "below 1")),
        (
            lambda: moments({"rayleigh": 3.0}),
            ("damping rayleigh = 3.0: must be a pair, [alpha, beta] or { alpha = ..., beta",),
        ),
        (lambda: moments({"rayleigh": [1.0]}), ("damping rayleigh = [1.0]: must be a pair",)),
        (
            lambda: moments({"rayleigh": {"alpha": 1.0}}),
            ("damping rayleigh = {'alpha': 1.0}: must be [alpha, beta] or { alpha",),
        ),
        (lambda: moments({"reyleigh": [0.0, 0.0]}), ("damping", "reyleigh", "key rayleigh")),
    ],
)
def test_refusals(make: Callable[[], object], words: tuple[str, ...]) -> None:
    with pytest.raises(ValueError, match=r".") as raised:
        make()
    for each in words:
        assert each in str(raised.value), f"{each!r} not in {raised.value}"
