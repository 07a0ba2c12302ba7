"""Extremes of one quantity, sample by sample, and the impact factors that follow from them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._value import Value, frozen

Array: TypeAlias = NDArray[np.float64]
Sense: TypeAlias = Literal["positive", "negative", "either"]

#: What lies below this part of the largest static value is lost in rounding.
ROUNDING: Final = 1e-9

#: When, and where the front axle is then, for the largest or the smallest values.
Moments: TypeAlias = tuple[Array, Array]


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
        Largest and smallest dynamic values [m, N m or N].
    static_max, static_min : ndarray, shape (section,) or (sample, section)
        Those of the response to the static axle loads; the second where samples differ in them.
    """

    x: Array
    max: Array
    min: Array
    static_max: Array
    static_min: Array
    _moments: Callable[[bool], Moments] = field(compare=False)

    @cached_property
    def _largest(self) -> Moments:
        time, position = self._moments(True)
        return frozen(time), frozen(position)

    @cached_property
    def _smallest(self) -> Moments:
        time, position = self._moments(False)
        return frozen(time), frozen(position)

    def _when(self, largest: bool) -> Moments:
        return self._largest if largest else self._smallest

    def _parts(self) -> Iterator[object]:
        """What is compared: times and positions too."""
        yield from super()._parts()
        yield from (self._largest, self._smallest)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled with its times and positions."""
        own = [getattr(self, each.name) for each in fields(self) if each.compare]
        return SampleExtremes, (*own, Known(self._largest, self._smallest))

    @property
    def max_time(self) -> Array:
        """When the largest values occur [s], shape (sample, section)."""
        return self._when(True)[0]

    @property
    def max_position(self) -> Array:
        """Where the front axle is then [m], shape (sample, section)."""
        return self._when(True)[1]

    @property
    def min_time(self) -> Array:
        """When the smallest values occur [s], shape (sample, section)."""
        return self._when(False)[0]

    @property
    def min_position(self) -> Array:
        """Where the front axle is then [m], shape (sample, section)."""
        return self._when(False)[1]

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
            Merged(self, other),
        )

    def factors(self, sense: Sense, mask: float) -> Array:
        """Dynamic by static extremes of one sense, shape (sample, section), NaN where masked.

        The definition is that of `Run.impact_factors`, to the bit.
        """
        static_max, static_min = np.atleast_2d(self.static_max), np.atleast_2d(self.static_min)
        magnitude = np.nanmax(np.abs(by_magnitude(static_max, static_min)), axis=1, initial=0.0)
        if sense == "either":
            dynamic = np.abs(by_magnitude(self.max, self.min))
            static = np.abs(by_magnitude(static_max, static_min))
        elif sense == "positive":
            dynamic, static = self.max, static_max
        else:
            dynamic, static = -self.min, -static_min
        largest = np.nanmax(static, axis=1, initial=0.0)
        least = np.maximum(mask * largest, ROUNDING * magnitude)[:, None]
        # What is masked is not divided.
        divisible = np.broadcast_to(static > least, dynamic.shape)
        result = np.full(dynamic.shape, np.nan)
        np.divide(dynamic, static, out=result, where=divisible)
        return result


@dataclass(frozen=True)
class Known:
    """Times and positions that are known already."""

    largest: Moments
    smallest: Moments

    def __call__(self, largest: bool) -> Moments:
        return self.largest if largest else self.smallest


@dataclass(frozen=True)
class Merged:
    """Times and positions of the larger or smaller of two."""

    one: SampleExtremes
    other: SampleExtremes

    def __call__(self, largest: bool) -> Moments:
        one, other = self.one, self.other
        pairs = (one.max, other.max) if largest else (other.min, one.min)
        second = pairs[1] > pairs[0]
        mine, others = one._when(largest), other._when(largest)
        return np.where(second, others[0], mine[0]), np.where(second, others[1], mine[1])


def larger(a: Array, b: Array) -> Array:
    """The larger of each pair, the first of two alike."""
    return np.where(b > a, b, a)


def by_magnitude(largest: Array, smallest: Array) -> Array:
    """The one of larger magnitude of each pair."""
    return np.where(np.abs(smallest) > np.abs(largest), smallest, largest)
