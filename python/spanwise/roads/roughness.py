"""How rough a surface is: its power spectral density, class after ISO 8608 and IRI by segments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._checks import number, numbers, shown
from spanwise._door import require
from spanwise._table import Table
from spanwise._value import Value, frozen
from spanwise.errors import InputError, refused

if TYPE_CHECKING:
    import pandas as pd

Array: TypeAlias = NDArray[np.float64]

#: Wave number n0 at which the roughness is stated [cycle/m].
REFERENCE: Final = 0.1

#: Wave numbers for which ISO 8608 states its classes [cycle/m] (as recalled, to be checked).
ISO_BAND: Final = (0.011, 2.83)

#: Spacing of points up to which an index is not too low to speak of [m]: a foot and some rounding.
#: World Bank Technical Paper 46 asks for 0.25 m in its class 1 of profiles, 0.5 m in class 2.
_FINE: Final = 0.31

#: Spacing up to which there is an index [m]: half the wave of 2.4 m that the index feels most.
_COARSEST: Final = 1.2

#: Longest distance of samples that is taken without being asked [m].
_SPACING: Final = 0.05

#: Samples of the shortest wave of the finest part of a road.
_SAMPLES_PER_WAVE: Final = 5.0

#: Waves per sample up to which samples are taken at their word, 0.8 of what they can hold.
HELD: Final = 0.4

#: Most samples of a section.
_MOST: Final = 4_000_000

#: Lowest wave number of a spectrum that is looked at, in waves per segment: below it the window
#: and the removed line distort.
_LOWEST: Final = 3.0

#: Fewest octaves to which a line is fitted: their scatter is its standard error.
_OCTAVES: Final = 2.0


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
    error : float or None
        Relative standard error of a fitted G, 0.1 for 10 %; None of a given one.
    band : tuple of float or None
        Wave numbers to which it was fitted [cycle/m]; None of a given one.
    """

    letter: str
    G: float
    lower: float
    upper: float
    error: float | None = None
    band: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False, repr=False)
class IriSegments(Value):
    """The international roughness index of a section, segment by segment.

    Attributes
    ----------
    starts, ends : ndarray, shape (segment,)
        Ends of each segment [m]; not to be written to, as all arrays here.
    values : ndarray, shape (segment,)
        Index of each [m/km].
    lead_in : float
        Length of road before the first segment on which the reference car has settled [m]; 0
        where less than 11 m are known, so that it starts with their mean slope.
    """

    starts: Array
    ends: Array
    values: Array
    lead_in: float

    def __post_init__(self) -> None:
        for each in (self.starts, self.ends, self.values):
            frozen(each)

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        lowest, mean, highest = self.values.min(), self.values.mean(), self.values.max()
        return (
            f"IriSegments({len(self)} from {self.starts[0]:g} m to {self.ends[-1]:g} m, "
            f"{lowest:.3g} to {highest:.3g} m/km, mean {mean:.3g}, lead-in {self.lead_in:g} m)"
        )

    def __str__(self) -> str:
        return str(self._table)

    def _repr_html_(self) -> str:
        return self._table._repr_html_()

    @property
    def _columns(self) -> dict[str, Array]:
        return {"start [m]": self.starts, "end [m]": self.ends, "IRI [m/km]": self.values}

    @property
    def _table(self) -> Table:
        return Table([*self._columns], [*zip(*self._columns.values(), strict=True)], [".2f"] * 3)

    def to_pandas(self) -> pd.DataFrame:
        """Start, end and index of each segment, a row each; needs ``spanwise[pandas]``."""
        pandas = require("pandas", extra="pandas")
        frame: pd.DataFrame = pandas.DataFrame(self._columns)
        return frame


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
    return _classified(number("G", G))


def _classified(
    G: float, error: float | None = None, band: tuple[float, float] | None = None
) -> IsoClass:
    if not 0.0 < G < np.inf:
        raise refused("G", G, "must be finite and greater than 0")
    lower = 0.0
    for letter, upper in _UPPER.items():
        if upper is None or upper >= G:
            return IsoClass(letter, G, lower, np.inf if upper is None else upper, error, band)
        lower = upper
    raise AssertionError("the last class has no upper limit")


def doubt_of_index(spacing: float) -> str | None:
    """What to say of the index of points so far apart [m], or nothing.

    Raises
    ------
    ValueError
        If they cannot hold it.
    """
    if spacing <= _FINE:
        return None
    apart = f"road: its points are {spacing:.3g} m apart"
    if spacing > _COARSEST * (1 + 1e-12):
        raise ValueError(
            f"{apart}, and cannot hold the waves that the index feels; it needs points at most "
            f"{_COARSEST:g} m apart, and no more than 0.3 m to come out right"
        )
    return (
        f"{apart}, and its index comes out too low: on roads of ISO 8608 by about 7 % where they "
        "are 0.5 m apart and by 25 % where they are 1 m; take points at most 0.3 m apart"
    )


def psd(
    road: _core.Road, start: float, end: float, segment: float | None, spacing: float | None
) -> tuple[Array, Array]:
    """Wave numbers [cycle/m] and one-sided power spectral density [m3] by Welch's method."""
    start, end = number("start", start), number("end", end)
    length = end - start
    if not 0.0 < length < np.inf:
        raise InputError("end", f"{end:g} m", f"must be finite and greater than start, {start:g} m")
    road.check_holds(start, end)
    known, finest = road.waves(start, end)
    if spacing is not None:
        spacing = number("spacing", spacing)
        if not length / _MOST <= spacing <= length / 32:
            allowed = f"{length / _MOST:g} to {length / 32:g} m for this section"
            raise InputError("spacing", f"{spacing:g} m", f"must be {allowed}")
        known = min(known, 0.5 / spacing)
    # As fine as the finest part of the road asks, whatever is asked for, so that no wave is passed
    # over; what is finer still is averaged over each step, whose gain on longer waves is known.
    step = min(spacing or _SPACING, _SPACING, length / 32)
    if finest > 0.0:
        step = min(step, 1.0 / (_SAMPLES_PER_WAVE * finest))
    step = max(step, min(length / _MOST, _SPACING))
    if length > step * _MOST * (1 + 1e-12):
        allowed = f"must be at most {step * _MOST:g} m beyond start, {start:g} m"
        raise InputError("end", f"{end:g} m", allowed)
    known = min(known, HELD / step)
    is_given = segment is not None
    segment = length / 4 if segment is None else number("segment", segment)
    if not 8 * step <= segment <= length:
        allowed = f"must be {8 * step:g} m, eight samples, to {length:g} m, the section"
        raise InputError("segment", f"{segment:g} m", allowed)
    points = int(segment / step * (1 + 1e-12))
    samples = int(length / step * (1 + 1e-12))
    middles: Array = start + step * (np.arange(samples, dtype=np.float64) + 0.5)
    r = road.averaged(step).at(middles)[0]
    # Hann window, periodic: its mean square scales the periodogram to a density.
    window = np.sin(np.pi * np.arange(points) / points) ** 2
    scale = 2.0 * step / np.sum(window**2)
    ramp = np.arange(points) - 0.5 * (points - 1)
    firsts = range(0, len(r) - points + 1, max(points // 2, 1))
    density = np.zeros(points // 2 + 1)
    for first in firsts:
        piece = r[first : first + points]
        piece = piece - piece.mean()
        piece -= (piece @ ramp) / (ramp @ ramp) * ramp
        density += scale * np.abs(np.fft.rfft(window * piece)) ** 2
    wave_numbers = np.arange(len(density)) / (points * step)
    density /= len(firsts) * np.sinc(wave_numbers * step) ** 2
    held = (wave_numbers > 0.0) & (wave_numbers <= known * (1 + 1e-12))
    if not held.any():
        least = 1.0 / known  # the shortest wave that can be told
        if is_given:
            raise InputError("segment", f"{segment:g} m", f"must hold a wave of {least:g} m")
        beyond = f"must lie {4.0 * least:g} m or more beyond start, {start:g} m"
        raise InputError("end", f"{end:g} m", beyond)
    return wave_numbers[held], density[held]


def fitted(wave_numbers: Array, density: Array, band: object) -> IsoClass:
    """The class whose straight line of slope -2 is nearest in the band, octaves all alike."""
    limits = numbers("band", band)
    if len(limits) != 2 or not 0.0 < limits[0] < limits[1] < np.inf:
        allowed = "must be two finite numbers greater than 0, the second the greater"
        raise refused("band", band, allowed)
    # Each wave number stands for the width around it; the first is that of one wave per segment.
    width = float(wave_numbers[0])
    lowest = max(limits[0], _LOWEST * width)
    highest = min(limits[1], float(wave_numbers[-1]) + 0.5 * width)
    if not limits[1] >= limits[0] * 2.0**_OCTAVES * (1 - 1e-12):
        raise refused("band", band, "must span two octaves, a factor of 4")
    if not highest >= lowest * 2.0**_OCTAVES * (1 - 1e-12):
        seen, last = "nothing", float(wave_numbers[-1])
        if last > _LOWEST * width:
            seen = f"only {_LOWEST * width:g} to {last:g} cycle/m"
        blamed = "start, end" if tuple(limits) == ISO_BAND else f"band = {shown(band)}"
        raise InputError(
            blamed,
            None,
            f"this section shows {seen}, and two octaves of {limits[0]:g} to {limits[1]:g} "
            "cycle/m are needed; take a longer section, or points that are closer",
        )
    inside = (wave_numbers >= lowest) & (wave_numbers <= highest)
    n, levels = wave_numbers[inside], density[inside] * (wave_numbers[inside] / REFERENCE) ** 2
    octave = np.floor(np.log2(n / lowest)).astype(int)
    found, first = np.unique(octave, return_index=True)
    means = np.add.reduceat(levels, first) / np.diff(np.append(first, len(n)))
    if not means.min() > 0.0:
        raise InputError("", None, "the road is smooth there: it has no class")
    # A partial octave counts by its width.
    weights = np.minimum(1.0, np.log2(highest / lowest) - found)
    logs = np.log(means)
    mean = np.average(logs, weights=weights)
    scatter = np.average((logs - mean) ** 2, weights=weights)
    independent = weights.sum() ** 2 / (weights**2).sum()
    error = float(np.sqrt(scatter / (independent - 1.0)))
    return _classified(float(np.exp(mean)), error, (lowest, float(n[-1])))
