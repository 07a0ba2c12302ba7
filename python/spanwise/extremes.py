"""Extremes of a response, of one crossing and of many, and the impact factors of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._value import Value, frozen
from spanwise.quantities import Sense

Array: TypeAlias = NDArray[np.float64]

#: What lies below this part of the largest static value is lost in rounding.
ROUNDING: Final = 1e-9

#: When, and where the front axle is then, for the largest or the smallest values.
When: TypeAlias = tuple[Array, Array]


@dataclass(frozen=True, eq=False, repr=False)
class Extremes(Value):
    """Extremes of a response, one for each section (or support, clamp, axle).

    Attributes
    ----------
    value : ndarray
        The extremes in SI units.
    time : ndarray
        When they occur [s].
    position : ndarray
        Where the front axle is then [m].
    partner : ndarray
        The static response then, for dynamic extremes; the dynamic one, for static extremes.
    """

    value: Array
    time: Array
    position: Array
    partner: Array

    def __repr__(self) -> str:
        return f"Extremes({_span(self.value)})"

    def or_larger(self, other: Extremes) -> Extremes:
        """At each place the one of the larger magnitude, of two alike its own."""
        own = np.abs(self.value) >= np.abs(other.value)
        return Extremes(
            *(np.where(own, a, b) for a, b in zip(self._parts(), other._parts(), strict=True))
        )


@dataclass(frozen=True, eq=False, repr=False)
class Envelope(Value):
    """Largest and smallest values of a quantity over the crossing, dynamic and static.

    Attributes
    ----------
    x : ndarray
        Positions of the sections, supports or clamps [m]; for axle loads the axles' numbers from 1.
    max, min : Extremes
        Of the dynamic response.
    static_max, static_min : Extremes
        Of the response to the static axle loads at the same positions.
    """

    x: Array
    max: Extremes
    min: Extremes
    static_max: Extremes
    static_min: Extremes

    def __repr__(self) -> str:
        return f"Envelope(max {_span(self.max.value)}; min {_span(self.min.value)})"

    def of(self, sense: Sense) -> tuple[Extremes, Extremes]:
        """Dynamic and static extremes of one sense."""
        if sense == "either":
            return self.max.or_larger(self.min), self.static_max.or_larger(self.static_min)
        return (self.max, self.static_max) if sense == "positive" else (self.min, self.static_min)

    def table(self) -> dict[str, Array]:
        """All by name, such as ``max`` and ``static_min_time``."""
        return {
            f"{side}{'' if part == 'value' else f'_{part}'}": getattr(getattr(self, side), part)
            for side in ("max", "min", "static_max", "static_min")
            for part in ("value", "time", "position", "partner")
        }


def _span(values: Array) -> str:
    """How many, and the least and the largest, for a short text."""
    there = values[~np.isnan(values)]
    extent = f", {there.min():.4g} to {there.max():.4g}" if len(there) else ""
    return f"{len(values)} values{extent}"


@dataclass(frozen=True, eq=False, repr=False)
class SampleExtremes(Value):
    """Largest and smallest values of a quantity in every sample of an ensemble.

    Arrays have one row for each sample and one column for each section (or support, clamp, axle);
    NaN where a sample failed or has no such axle. They are not to be written to. Times and
    positions are worked out when first asked for.

    Attributes
    ----------
    x : ndarray, shape (section,)
        Positions of the sections, supports or clamps [m]; for axle loads the axles' numbers from 1.
    max, min : ndarray, shape (sample, section)
        Largest and smallest dynamic values in SI units.
    static_max, static_min : ndarray, shape (section,) or (sample, section)
        Those of the response to the static axle loads; the second where samples differ in them.
    """

    x: Array
    max: Array
    min: Array
    static_max: Array
    static_min: Array
    _when_max: Callable[[], When] = field(compare=False)
    _when_min: Callable[[], When] = field(compare=False)

    @cached_property
    def _at_max(self) -> When:
        time, position = self._when_max()
        return frozen(time), frozen(position)

    @cached_property
    def _at_min(self) -> When:
        time, position = self._when_min()
        return frozen(time), frozen(position)

    def _parts(self) -> Iterator[object]:
        """What is compared: times and positions too."""
        yield from (*super()._parts(), self._at_max, self._at_min)

    def __getstate__(self) -> dict[str, Any]:
        """With its times and positions, in place of what finds them."""
        known = {"_at_max": self._at_max, "_at_min": self._at_min}
        return {
            each.name: getattr(self, each.name) for each in fields(self) if each.compare
        } | known

    @property
    def max_time(self) -> Array:
        """When the largest values occur [s], shape (sample, section)."""
        return self._at_max[0]

    @property
    def max_position(self) -> Array:
        """Where the front axle is then [m], shape (sample, section)."""
        return self._at_max[1]

    @property
    def min_time(self) -> Array:
        """When the smallest values occur [s], shape (sample, section)."""
        return self._at_min[0]

    @property
    def min_position(self) -> Array:
        """Where the front axle is then [m], shape (sample, section)."""
        return self._at_min[1]

    def __repr__(self) -> str:
        return f"SampleExtremes({self.max.shape[0]} samples, {self.max.shape[1]} columns)"

    def merged(self, other: SampleExtremes) -> SampleExtremes:
        """The larger of the largest and the smaller of the smallest: a shear on both sides."""
        return SampleExtremes(
            self.x,
            frozen(larger(self.max, other.max)),
            frozen(-larger(-self.min, -other.min)),
            frozen(larger(self.static_max, other.static_max)),
            frozen(-larger(-self.static_min, -other.static_min)),
            lambda: _either(other.max > self.max, other._at_max, self._at_max),
            lambda: _either(self.min > other.min, other._at_min, self._at_min),
        )

    def of(self, sense: Sense) -> tuple[Array, Array]:
        """Dynamic and static values of one sense, larger where they matter.

        Shape (sample, section); one row of static values where all samples share them.
        """
        static_max, static_min = np.atleast_2d(self.static_max), np.atleast_2d(self.static_min)
        if sense == "positive":
            return self.max, static_max
        if sense == "negative":
            return -self.min, -static_min
        either = by_magnitude(self.max, self.min), by_magnitude(static_max, static_min)
        return np.abs(either[0]), np.abs(either[1])

    def factors(self, sense: Sense, mask: float) -> Array:
        """Dynamic by static extremes of one sense, shape (sample, section), NaN where masked.

        The definition is that of `Run.impact_factors`, to the bit.
        """
        dynamic, static = self.of(sense)
        magnitude = largest_of_each(self.of("either")[1], least=0.0)
        least = np.maximum(mask * largest_of_each(static, least=0.0), ROUNDING * magnitude)
        return quotients(dynamic, static, static > least[:, None])

    @property
    def static_varies(self) -> bool:
        """Whether static values differ from sample to sample, by more than rounding."""
        return any(differ(each) for each in (self.static_max, self.static_min))


def _either(where: NDArray[np.bool_], first: When, second: When) -> When:
    """Times and positions of the first there, elsewhere of the second."""
    return np.where(where, first[0], second[0]), np.where(where, first[1], second[1])


def larger(a: Array, b: Array) -> Array:
    """The larger of each pair, the first of two alike."""
    return np.where(b > a, b, a)


def by_magnitude(largest: Array, smallest: Array) -> Array:
    """The one of larger magnitude of each pair."""
    return np.where(np.abs(smallest) > np.abs(largest), smallest, largest)


def largest_of_each(values: Array, least: float = -np.inf) -> Array:
    """The largest along the bridge of each sample, at least so much; NaN where there is none."""
    most: Array = np.nanmax(values, axis=1, initial=least)
    return np.where(np.isfinite(most), most, np.nan)


def quotients(a: Array, b: Array, where: NDArray[np.bool_]) -> Array:
    """a by b; NaN elsewhere, where nothing is divided."""
    found = np.full(a.shape, np.nan)
    np.divide(a, b, out=found, where=np.broadcast_to(where, a.shape))
    return found


def differ(static: Array) -> bool:
    """Whether static values, one row for each sample, differ by more than rounding."""
    if static.ndim < 2 or np.isnan(static).all():
        return False
    there = static[:, ~np.isnan(static).all(axis=0)]
    spread = np.nanmax(there, axis=0) - np.nanmin(there, axis=0)
    return bool(spread.max() > ROUNDING * np.nanmax(np.abs(there)))


def governing(dynamic: Array, static: Array) -> int:
    """The section of the largest static value; of some that are alike, of the largest dynamic one.

    By their medians over the samples. On a symmetric bridge rounding alone tells static values
    apart.
    """
    beside = _medians(static)
    most = beside.max()
    alike = np.flatnonzero(beside >= most - ROUNDING * abs(most))
    return int(alike[np.argmax(_medians(dynamic[:, alike]))]) if len(alike) > 1 else int(alike[0])


def _medians(values: Array) -> Array:
    """By section, over the samples; minus infinity where there is no value."""
    columns = (each[~np.isnan(each)] for each in values.T)
    return np.array([np.median(each) if len(each) else -np.inf for each in columns])
