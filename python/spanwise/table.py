"""Impact factors as a table."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._extras import require
from spanwise._value import Value

if TYPE_CHECKING:
    import pandas as pd

Array: TypeAlias = NDArray[np.float64]

#: Columns by section, in order.
COLUMNS = ("deflection", "sagging", "hogging", "shear")


@dataclass(frozen=True, eq=False, repr=False)
class ImpactFactors(Value):
    """Impact factors along the bridge, NaN where the static value is too small to divide by.

    Attributes
    ----------
    ratio : str
        Which dynamic value is divided by which static one.
    mask : float
        Factors are NaN where the static value is at most this fraction of the largest of its kind.
    sections : ndarray, shape (section,)
        Positions [m].
    deflection, sagging, hogging, shear : ndarray, shape (section,)
        Of the deflection down, the positive and the negative bending moment, and the shear of
        larger magnitude on either side of the section.
    supports : ndarray, shape (support,)
        Positions [m].
    reactions : ndarray, shape (support,)
        Of the reactions, up or down, whichever is larger.
    axle_loads : ndarray, shape (axle,)
        Largest axle load by static axle load.
    """

    ratio: str
    mask: float
    sections: Array
    deflection: Array
    sagging: Array
    hogging: Array
    shear: Array
    supports: Array
    reactions: Array
    axle_loads: Array

    @property
    def masked(self) -> dict[str, NDArray[np.bool_]]:
        """Where a factor is withheld, by column."""
        return {name: np.isnan(getattr(self, name)) for name in (*COLUMNS, "reactions")}

    def __str__(self) -> str:
        lines = ["  x [m]" + "".join(f"{name:>12}" for name in COLUMNS)]
        for x, *factors in zip(self.sections, *self._columns(), strict=True):
            lines.append(f"{x:7.3f}" + "".join(f"{factor_text(f):>12}" for f in factors))
        lines += ["", "support [m]    reaction"]
        lines += [
            f"{x:11.3f}{factor_text(f):>12}"
            for x, f in zip(self.supports, self.reactions, strict=True)
        ]
        lines += ["", "axle           load"]
        lines += [f"{k:4d}{factor_text(f):>15}" for k, f in enumerate(self.axle_loads, 1)]
        lines += ["", self._note()]
        return "\n".join(lines)

    def __repr__(self) -> str:
        def span(name: str) -> str:
            found = getattr(self, name)
            there = found[~np.isnan(found)]
            return f"{name} {there.min():.3f} to {there.max():.3f}" if len(there) else f"{name} -"

        names = (*COLUMNS, "reactions", "axle_loads")
        return f"ImpactFactors({len(self.sections)} sections; {', '.join(map(span, names))})"

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in ("x [m]", *COLUMNS))
        rows = "".join(
            "<tr>"
            + f"<td>{x:.3f}</td>"
            + "".join(f"<td>{factor_text(f)}</td>" for f in factors)
            + "</tr>"
            for x, *factors in zip(self.sections, *self._columns(), strict=True)
        )
        reactions = "".join(
            f"<tr><td>{x:.3f}</td><td>{factor_text(f)}</td></tr>"
            for x, f in zip(self.supports, self.reactions, strict=True)
        )
        return (
            f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
            "<table><thead><tr><th>support [m]</th><th>reaction</th></tr></thead>"
            f"<tbody>{reactions}</tbody></table><p>{escape(self._note())}</p>"
        )

    def to_pandas(self) -> pd.DataFrame:
        """Factors by section as a frame; needs the extra ``spanwise[pandas]``."""
        pandas = require("pandas", extra="pandas")
        index = pandas.Index(self.sections, name="x [m]")
        frame: pd.DataFrame = pandas.DataFrame(
            {name: getattr(self, name) for name in COLUMNS}, index=index
        )
        return frame

    def _columns(self) -> list[Array]:
        return [getattr(self, name) for name in COLUMNS]

    def _note(self) -> str:
        definition = {
            "extremes": "dynamic maximum / static maximum",
            "at-dynamic-extreme": "dynamic maximum / static value at that time",
            "at-static-extreme": "dynamic value at the time of the static maximum / static maximum",
        }[self.ratio]
        return (
            f"{definition}; shear: the larger of both sides; "
            f"-: masked, static value at most {100 * self.mask:g} % of the largest of its kind"
        )


def factor_text(factor: float) -> str:
    return "-" if np.isnan(factor) else f"{factor:.3f}"
