"""How rough a surface is: its power spectral density and its class after ISO 8608."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise import _core
from spanwise._checks import number, numbers, shown

Array: TypeAlias = NDArray[np.float64]

#: Wave number n0 at which the roughness is stated [cycle/m].
REFERENCE: Final = 0.1

#: Wave numbers for which ISO 8608 states its classes [cycle/m] (as recalled, to be checked).
ISO_BAND: Final = (0.011, 2.83)

#: Most samples of a section.
_MOST = 4_000_000

#: Lowest wave number of a spectrum that is looked at, in waves per segment: below it the window
#: and the removed mean distort.
_LOWEST = 3.0


@dataclass(frozen=True)
class IsoClass:
    """A roughness with its class after ISO 8608.

    Attributes
    ----------
    letter : str
        The class, ``"A"`` to ``"H"``.
    G : float
        The roughness itself, G_d(n0) at n0 = 0.1 cycle/m [m3].
    lower, upper : float
        Limits of the class [m3]; 0 below A, ``inf`` above H.
    """

    letter: str
    G: float
    lower: float
    upper: float


#: Geometric mean of G_d(n0) of each class [m3], by letter.
CLASSES: Final[dict[str, float]] = {letter: mean for letter, mean, _ in _core.road_classes()}

_UPPER: Final = {letter: upper for letter, _, upper in _core.road_classes()}


def classify(G: float) -> IsoClass:
    """The class of a roughness G_d(n0) at n0 = 0.1 cycle/m [m3].

    Raises
    ------
    ValueError
        If it is not a positive finite number.
    """
    G = number("G", G)
    if not 0.0 < G < np.inf:
        raise ValueError(f"G = {shown(G)}: must be finite and greater than 0")
    lower = 0.0
    for letter, upper in _UPPER.items():
        if upper is None or upper >= G:
            return IsoClass(letter, G, lower, np.inf if upper is None else upper)
        lower = upper
    raise AssertionError("the last class has no upper limit")


def psd(
    elevation: Callable[[ArrayLike], Array],
    start: float,
    end: float,
    segment: float | None,
    spacing: float,
) -> tuple[Array, Array]:
    """Wave numbers [cycle/m] and one-sided power spectral density [m3] by Welch's method."""
    start, end, spacing = number("start", start), number("end", end), number("spacing", spacing)
    length = end - start
    if not 0.0 < length < np.inf:
        raise ValueError(f"end = {end:g} m: must be finite and greater than start, {start:g} m")
    if not length / _MOST <= spacing <= length / 32:
        allowed = f"{length / _MOST:g} to {length / 32:g} m for this section"
        raise ValueError(f"spacing = {spacing:g} m: must be {allowed}")
    segment = length / 4 if segment is None else number("segment", segment)
    if not 8 * spacing <= segment <= length:
        allowed = f"must be {8 * spacing:g} m, eight samples, to {length:g} m, the section"
        raise ValueError(f"segment = {segment:g} m: {allowed}")
    points = int(segment / spacing * (1 + 1e-12))
    r = elevation(start + spacing * np.arange(int(length / spacing * (1 + 1e-12))))
    # Hann window, periodic: its mean square scales the periodogram to a density.
    window = np.sin(np.pi * np.arange(points) / points) ** 2
    scale = 2.0 * spacing / np.sum(window**2)
    firsts = range(0, len(r) - points + 1, max(points // 2, 1))
    density = np.zeros(points // 2 + 1)
    for first in firsts:
        piece = r[first : first + points]
        density += scale * np.abs(np.fft.rfft(window * (piece - piece.mean()))) ** 2
    # Of the two sides of an even number of points, the last wave number is one and the same.
    if points % 2 == 0:
        density[-1] /= 2.0
    wave_numbers = np.arange(len(density)) / (points * spacing)
    return wave_numbers[1:], density[1:] / len(firsts)


def fitted(wave_numbers: Array, density: Array, band: object) -> IsoClass:
    """The class whose straight line of slope -2 is nearest in the band."""
    limits = numbers("band", band)
    if len(limits) != 2 or not 0.0 < limits[0] < limits[1] < np.inf:
        allowed = "must be two finite numbers greater than 0, the second the greater"
        raise ValueError(f"band = {shown(band)}: {allowed}")
    lowest = max(limits[0], _LOWEST * float(wave_numbers[0]))
    inside = (wave_numbers >= lowest) & (wave_numbers <= limits[1])
    if not inside.any():
        seen = f"{_LOWEST * wave_numbers[0]:g} to {wave_numbers[-1]:g} cycle/m"
        raise ValueError(f"band = {shown(band)}: this section shows only {seen}")
    n, levels = wave_numbers[inside], density[inside] * (wave_numbers[inside] / REFERENCE) ** 2
    octave = np.floor(np.log2(n / lowest)).astype(int)
    means = [levels[octave == each].mean() for each in np.unique(octave)]
    if not min(means) > 0.0:
        raise ValueError("the road is smooth there: it has no class")
    return classify(float(np.exp(np.mean(np.log(means)))))
