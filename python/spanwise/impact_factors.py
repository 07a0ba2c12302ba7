"""Impact factors of a crossing, along the bridge and axle by axle."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import named
from spanwise._door import require
from spanwise._table import Block, Table, html, text
from spanwise._value import Value
from spanwise.quantities import Axis, factors, telling

if TYPE_CHECKING:
    import pandas as pd

Array: TypeAlias = NDArray[np.float64]

#: What is divided by what, in words.
DEFINITIONS: Final = {
    "extremes": "dynamic maximum / static maximum",
    "at-dynamic-extreme": "dynamic maximum / static value at that time",
    "at-static-extreme": "dynamic value at the time of the static maximum / static maximum",
}


class ByName(ABC):
    """Factors as attributes, and by ``[name]``."""

    def __getitem__(self, quantity: str) -> Array:
        """Those of one kind by its name."""
        return self._of(named("quantity", quantity, factors()))

    @abstractmethod
    def _of(self, name: str) -> Array:
        """Those of one kind."""

    def __getattr__(self, name: str) -> Array:
        if name in factors():
            return self._of(name)
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *factors()})


@telling
@dataclass(frozen=True, eq=False, repr=False)
class ImpactFactors(ByName, Value):
    """Impact factors along the bridge, NaN where the static value is too small to divide by.

    Each kind is an attribute, an array by section, support or axle:

    {factors}

    That of the deflection is of the deflection down; sagging and hogging are the positive and the
    negative bending moment; of shears and reactions the larger magnitude counts, on either side of
    a section, up or down; axle loads are the largest by the static ones.

    Attributes
    ----------
    ratio : str
        Which dynamic value is divided by which static one.
    mask : float
        Factors are NaN where the static value is at most this fraction of the largest of its kind.
    sections : ndarray, shape (section,)
        Positions [m].
    supports : ndarray, shape (support,)
        Positions [m].
    values : dict
        The factors by name.
    """

    ratio: str
    mask: float
    sections: Array
    supports: Array
    values: dict[str, Array]

    def _of(self, name: str) -> Array:
        return self.values[name]

    def by_axis(self, axis: Axis) -> dict[str, Array]:
        """Those with a value for each section, support or axle, by name."""
        return {name: self[name] for name, (of, _) in factors().items() if of.axis == axis}

    @property
    def masked(self) -> dict[str, NDArray[np.bool_]]:
        """Where a factor is withheld, by name."""
        return {
            name: np.isnan(self[name]) for name, (of, _) in factors().items() if of.axis != "axle"
        }

    def blocks(self) -> Iterator[Block]:
        """A table for each axis, and what the factors are."""
        for axis, head, x, form in (
            ("section", "x [m]", self.sections, ".3f"),
            ("support", "support [m]", self.supports, ".3f"),
            ("axle", "axle", range(1, len(self.axle_loads) + 1), ">"),
        ):
            columns = {n: f for n, (of, f) in factors().items() if of.axis == axis}
            heads = [head, *(each.noun for each in columns.values())]
            rows = [*zip(x, *(self[name] for name in columns), strict=True)]
            yield Table(heads, rows, [form, *[".3f"] * len(columns)])
        yield [
            f"{DEFINITIONS[self.ratio]}; shear: the larger of both sides; "
            f"-: masked, static value at most {100 * self.mask:g} % of the largest of its kind"
        ]

    def __str__(self) -> str:
        return text(self.blocks())

    def _repr_html_(self) -> str:
        return html(self.blocks())

    def __repr__(self) -> str:
        def span(name: str) -> str:
            there = self[name][~np.isnan(self[name])]
            return f"{name} {there.min():.3f} to {there.max():.3f}" if len(there) else f"{name} -"

        return f"ImpactFactors({len(self.sections)} sections; {', '.join(map(span, factors()))})"

    def to_pandas(self) -> pd.DataFrame:
        """Factors by section as a frame; needs the extra ``spanwise[pandas]``."""
        pandas = require("pandas", extra="pandas")
        index = pandas.Index(self.sections, name="x [m]")
        frame: pd.DataFrame = pandas.DataFrame(self.by_axis("section"), index=index)
        return frame
