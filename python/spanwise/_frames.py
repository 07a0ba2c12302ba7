"""An ensemble as tables of pandas: one row a sample, or one a sample and section."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import choice
from spanwise._ensemblesummary import by_sense, governing
from spanwise._extras import require
from spanwise._files import write_files
from spanwise.columns import SampleExtremes
from spanwise.population import Ensemble
from spanwise.samples import FACTORS, Factor

if TYPE_CHECKING:
    import pandas as pd

Column: TypeAlias = tuple[str, NDArray[Any]]
By: TypeAlias = Literal["sample", "section", "support", "clamp", "axle"]

#: Rows of a CSV file that are written at a time.
ROWS: Final = 100_000

#: The quantities that have a row for each place of a kind.
PLACES: Final[dict[str, tuple[str, ...]]] = {
    "section": ("deflection", "moment", "shear"),
    "support": ("reactions",),
    "clamp": ("clamp_moments",),
    "axle": ("axle_loads",),
}


def frame(ensemble: Ensemble, by: By) -> pd.DataFrame:
    """The table, as `Ensemble.to_pandas` describes it."""
    pandas = require("pandas", extra="pandas")
    choice("by", by, ("sample", *PLACES))
    if by == "sample":
        numbers = ensemble.first + np.arange(ensemble.samples)
        index = pandas.Index(numbers, name="sample")
        table: pd.DataFrame = pandas.DataFrame(dict(_by_sample(ensemble)), index=index)
        table.attrs["governing"] = {name: x for name, (_, x) in _governing(ensemble).items()}
        return table
    names = [each for each in PLACES[by] if ensemble._looks_at(each)]
    if not names:
        raise ValueError(f'by = "{by}": this ensemble has {", ".join(ensemble.quantities)}')
    x = ensemble.envelope(names[0]).x
    places = pandas.Index(x.astype(np.int64) if by == "axle" else x, name=by)
    numbers = pandas.Index(ensemble.first + np.arange(ensemble.samples), name="sample")
    columns = {name: values.ravel() for name, values in _by_place(ensemble, names)}
    rows = pandas.MultiIndex.from_product([numbers, places])
    by_place: pd.DataFrame = pandas.DataFrame(columns, index=rows)
    return by_place


def write_parquet(ensemble: Ensemble, path: Path, by: By) -> None:
    """The table as a Parquet file, complete or not at all."""
    require("pyarrow", extra="parquet")
    table = frame(ensemble, by)
    write_files([(path, lambda stream: stream.write(table.to_parquet(None, engine="pyarrow")))])


def write_csv(ensemble: Ensemble, path: Path, by: By) -> None:
    """The table as a CSV file, complete or not at all."""
    table = frame(ensemble, by)
    pieces = (
        table.iloc[start : start + ROWS].to_csv(header=start == 0, lineterminator="\n").encode()
        for start in range(0, max(len(table), 1), ROWS)
    )
    write_files([(path, pieces)])


def _by_sample(ensemble: Ensemble) -> Iterator[Column]:
    recipe, count = ensemble._recipe, ensemble.samples
    if len(recipe.events) > 1:
        yield "kind", recipe.kinds.astype(np.int64)
    yield from _spread("speed", recipe.speeds_of_all)
    for each in recipe.factors:
        yield from _spread(each.name, np.broadcast_to(each.values, (count, each.values.shape[1])))
    failed = np.zeros(count, dtype=np.bool_)
    failed[[each.row for each in ensemble.failures]] = True
    yield "failed", failed
    for name in (*ensemble.quantities, "axle_loads"):
        extremes: SampleExtremes = ensemble.envelope(name)
        yield f"{name}_max", _most(extremes.max)
        yield f"{name}_min", -_most(-extremes.min)
    for name, (where, _) in _governing(ensemble).items():
        yield f"impact_factor_{name}", ensemble.impact_factors[name][:, where]
    yield from _numbered("load_coefficient", ensemble.load_coefficients)
    yield from _numbered("lift_offs", ensemble.off_road.count)
    yield from _numbered("time_off_road", ensemble.off_road.total)
    for side in ("max", "rms"):
        values = getattr(ensemble.body_accelerations, side)
        yield from _numbered(f"body_acceleration_{side}", values)


def _by_place(ensemble: Ensemble, names: list[str]) -> Iterator[Column]:
    for name in names:
        extremes: SampleExtremes = ensemble.envelope(name)
        for side in ("max", "min"):
            for suffix in ("", "_time", "_position"):
                yield f"{name}_{side}{suffix}", getattr(extremes, f"{side}{suffix}")
        for side in ("static_max", "static_min"):
            values = getattr(extremes, side)
            yield f"{name}_{side}", np.broadcast_to(values, extremes.max.shape)
    for factor, (name, _) in FACTORS.items():
        if name in names:
            yield f"impact_factor_{factor}", ensemble.impact_factors[factor]


def _governing(ensemble: Ensemble) -> dict[Factor, tuple[int, float]]:
    """By impact factor, which section, support or axle governs, and where that is."""
    found: dict[Factor, tuple[int, float]] = {}
    for name, (quantity, sense) in FACTORS.items():
        if ensemble._looks_at(quantity):
            extremes: SampleExtremes = ensemble.envelope(quantity)
            where = governing(*by_sense(extremes, sense))
            found[name] = where, float(extremes.x[where])
    return found


def _most(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The largest of each row; NaN where there is none."""
    most: NDArray[np.float64] = np.nanmax(values, axis=1, initial=-np.inf)
    return np.where(np.isfinite(most), most, np.nan)


def _spread(name: str, values: NDArray[Any]) -> Iterator[Column]:
    """One column, or one for each of several parts."""
    return _numbered(name, values) if values.shape[1] > 1 else iter([(name, values[:, 0])])


def _numbered(name: str, values: NDArray[Any]) -> Iterator[Column]:
    """A column for each axle, body or vehicle, from 1."""
    return ((f"{name}_{k}", column) for k, column in enumerate(values.T, 1))
