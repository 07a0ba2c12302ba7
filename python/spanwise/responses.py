"""Responses of a bridge to a crossing: histories, and their extremes along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._computed import Computed
from spanwise._value import Value

Array: TypeAlias = NDArray[np.float64]
Quantity: TypeAlias = Literal[
    "deflection", "moment", "shear", "reactions", "clamp_moments", "axle_loads"
]

QUANTITIES: tuple[Quantity, ...] = (
    "deflection",
    "moment",
    "shear",
    "reactions",
    "clamp_moments",
    "axle_loads",
)


@dataclass(frozen=True, eq=False, repr=False)
class Extremes(Value):
    """Extremes of a response, one for each section (or support, clamp, axle).

    Attributes
    ----------
    value : ndarray
        The extremes [m, N m or N].
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

    @classmethod
    def _of(cls, columns: Array) -> Extremes:
        return cls(*(np.ascontiguousarray(column) for column in columns.T))

    def __repr__(self) -> str:
        return f"Extremes({_span(self.value)})"


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


def _span(values: Array) -> str:
    """How many, and the least and the largest, for a short text."""
    there = values[~np.isnan(values)]
    extent = f", {there.min():.4g} to {there.max():.4g}" if len(there) else ""
    return f"{len(values)} values{extent}"


class Responses:
    """Responses at every instant, as arrays of shape (time, section) and the like.

    Attributes are ``deflection`` [m], ``moment`` [N m], ``shear`` [N] with a last axis for the left
    and the right side of each section, ``shear_left``, ``shear_right``, ``reactions``
    (time, support) [N] and ``clamp_moments`` (time, clamp) [N m]. Deflections are down, moments
    sagging, shears sums of the upward forces to the left, reactions up. They are computed from the
    states of the crossing when first asked for, kept, and not to be written to: copy them first.
    """

    def __init__(self, computed: Computed, *, static: bool = False) -> None:
        self._computed, self._static = computed, static

    def _histories(self, name: str) -> Array:
        return self._computed.histories(name)[int(self._static)]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        assert isinstance(other, Responses)
        return (self._computed, self._static) == (other._computed, other._static)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        core = self._computed.core
        return f"Responses({len(core.sections)} sections, {core.steps + 1} instants)"

    @property
    def deflection(self) -> Array:
        """Deflections down [m], shape (time, section)."""
        return self._histories("deflection")

    @property
    def moment(self) -> Array:
        """Bending moments, sagging positive [N m], shape (time, section).

        At the steps: the extremes of `Run.envelope` are taken between them too, as axles pass the
        section, and can be a little larger.
        """
        return self._histories("moment")

    @property
    def shear_left(self) -> Array:
        """Shear just left of the sections [N], shape (time, section)."""
        return self._histories("shear_left")

    @property
    def shear_right(self) -> Array:
        """Shear just right of the sections [N], shape (time, section)."""
        return self._histories("shear_right")

    @property
    def shear(self) -> Array:
        """Shear just left and just right of the sections [N], shape (time, section, 2)."""
        return np.stack([self.shear_left, self.shear_right], axis=-1)

    @property
    def reactions(self) -> Array:
        """Support reactions, up [N], shape (time, support)."""
        return self._histories("reactions")

    @property
    def clamp_moments(self) -> Array:
        """Moments of the supports of `Bridge.clamps` [N m], shape (time, clamp)."""
        return self._histories("clamp_moments")
