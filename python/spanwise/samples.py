"""What is told of every sample beside its extremes: impact factors, ride, failures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import named
from spanwise._renamed import renamed
from spanwise._value import Value
from spanwise.columns import Array, Sense

if TYPE_CHECKING:
    from spanwise.population import Ensemble

Factor: TypeAlias = Literal["deflection", "sagging", "hogging", "shear", "reactions", "axle_loads"]

#: What extremes are kept of, if it was looked at.
Looked: TypeAlias = Literal[
    "deflection",
    "moment",
    "shear",
    "shear_left",
    "shear_right",
    "reactions",
    "clamp_moments",
    "axle_loads",
]

#: Quantity and sense of every impact factor, as for a single crossing.
FACTORS: dict[Factor, tuple[Looked, Sense]] = {
    "deflection": ("deflection", "positive"),
    "sagging": ("moment", "positive"),
    "hogging": ("moment", "negative"),
    "shear": ("shear", "either"),
    "reactions": ("reactions", "either"),
    "axle_loads": ("axle_loads", "positive"),
}


@dataclass(frozen=True)
class Failure:
    """A sample that has no result; its rows are NaN.

    Attributes
    ----------
    sample : int
        Its number: `Ensemble.first` plus its row.
    row : int
        Its row, from 0.
    step : int or None
        The time step in which it failed, if it came so far.
    cause : str
        Why.
    """

    sample: int
    step: int | None
    cause: str
    row: int


@dataclass(frozen=True, eq=False, repr=False)
class BodyAccelerations(Value):
    """Vertical accelerations of the bodies of the first vehicle and those behind it.

    Attributes
    ----------
    max : ndarray, shape (sample, body)
        Largest magnitude until the last axle has left the bridge, on the approach too [m/s2].
    rms : ndarray, shape (sample, body)
        Root mean square from the vehicle's first axle on the bridge to its last off it [m/s2].
    """

    max: Array
    rms: Array


@dataclass(frozen=True, eq=False, repr=False)
class OffRoads(Value):
    """How often and how long wheels were off the road, sample by sample.

    The longest time of a sample is ``ensemble.run(row).off_road.longest``.

    Attributes
    ----------
    count : ndarray of int, shape (sample, axle)
        How many times.
    total : ndarray, shape (sample, axle)
        How long in all [s].
    """

    count: NDArray[np.int64]
    total: Array


class SampleFactors:
    """Impact factors of every sample, as `ImpactFactors` has them of one crossing.

    Arrays have one row for each sample; NaN where masked, and of samples that failed. They are
    worked out when asked for.

    Attributes
    ----------
    deflection, sagging, hogging, shear : ndarray, shape (sample, section)
        By section.
    reactions : ndarray, shape (sample, support)
        By support.
    axle_loads : ndarray, shape (sample, axle)
        By axle.
    sections, supports : ndarray
        Positions [m].
    mask : float
        Factors are NaN where the static value is at most this fraction of the largest of its kind.
    ratio : str
        ``"extremes"``: dynamic by static extreme, which may occur at different times.

    Raises
    ------
    ValueError
        If a response was not looked at.
    """

    ratio: Final = "extremes"

    def __init__(self, ensemble: Ensemble, mask: float) -> None:
        self._ensemble, self.mask = ensemble, mask

    def __getitem__(self, quantity: Factor) -> Array:
        """Those of one kind by its name."""
        name = named("quantity", quantity, FACTORS)
        of, sense = FACTORS[name]
        if not self._ensemble._looks_at(of):
            what = "" if of == name else f"{of} "
            raise ValueError(f'quantity = "{name}": {what}{self._ensemble._not_looked_at}')
        return self._ensemble.envelope(of).factors(sense, self.mask)

    def __call__(self, quantity: Factor, mask: float | None = None) -> Array:
        """As it was before: a method of the ensemble."""
        found = (self if mask is None else self._ensemble.ratios(mask))[quantity]
        new = "impact_factors" if mask is None else f"ratios(mask={mask})"
        renamed(f'Ensemble.impact_factors("{quantity}")', f"Ensemble.{new}.{quantity}")
        return found

    @property
    def sections(self) -> Array:
        return self._ensemble.sections

    @property
    def supports(self) -> Array:
        return self._ensemble.supports

    @property
    def deflection(self) -> Array:
        return self["deflection"]

    @property
    def sagging(self) -> Array:
        return self["sagging"]

    @property
    def hogging(self) -> Array:
        return self["hogging"]

    @property
    def shear(self) -> Array:
        return self["shear"]

    @property
    def reactions(self) -> Array:
        return self["reactions"]

    @property
    def axle_loads(self) -> Array:
        return self["axle_loads"]

    def __eq__(self, other: object) -> bool:
        """Whether they are the same factors of equal ensembles."""
        if type(other) is not SampleFactors:
            return NotImplemented
        return self.mask == other.mask and self._ensemble == other._ensemble

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"SampleFactors({self._ensemble.samples} samples, {len(self.sections)} sections)"
