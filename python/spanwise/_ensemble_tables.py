"""An ensemble as tables of pandas: one row a sample, or one a sample and section."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import choice
from spanwise._door import require
from spanwise._files import write_files
from spanwise.ensembles import By, Ensemble
from spanwise.errors import InputError
from spanwise.extremes import largest_of_each
from spanwise.quantities import Response, factors

if TYPE_CHECKING:
    import pandas as pd

Column: TypeAlias = tuple[str, NDArray[Any]]

#: Rows of a CSV file that are written at a time.
ROWS: Final = 100_000


def frame(ensemble: Ensemble, by: By) -> pd.DataFrame:
    """The table, as `Ensemble.to_pandas` describes it."""
    pandas = require("pandas", extra="pandas")
    choice("by", by, get_args(By))
    if by == "sample":
        numbers = ensemble.first + np.arange(ensemble.samples)
        index = pandas.Index(numbers, name="sample")
        table: pd.DataFrame = pandas.DataFrame(dict(_by_sample(ensemble)), index=index)
        table.attrs["governing"] = {
            name: float(ensemble.envelope(of.name).x[ensemble.impact_factors.governing(name)])
            for name, (of, _) in factors().items()
            if of in ensemble.responses
        }
        return table
    there = [each for each in ensemble.responses if each.axis == by]
    if not there:
        raise InputError("by", f'"{by}"', f"this ensemble has {', '.join(ensemble.quantities)}")
    x = ensemble.envelope(there[0].name).x
    places = pandas.Index(x.astype(np.int64) if by == "axle" else x, name=by)
    numbers = pandas.Index(ensemble.first + np.arange(ensemble.samples), name="sample")
    columns = {name: values.ravel() for name, values in _by_place(ensemble, there)}
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
    write_files([(path, csv_pieces(ensemble, by))])


def csv_pieces(ensemble: Ensemble, by: By) -> Iterator[bytes]:
    """The table as the text of a CSV file, some rows at a time."""
    table = frame(ensemble, by)
    for start in range(0, max(len(table), 1), ROWS):
        some = table.iloc[start : start + ROWS]
        yield some.to_csv(header=start == 0, lineterminator="\n").encode()


def _by_sample(ensemble: Ensemble) -> Iterator[Column]:
    plan, count = ensemble._plan, ensemble.samples
    if len(plan.events) > 1:
        yield "kind", plan.kinds.astype(np.int64)
    varied = {"speed": plan.speeds_driven, **{each.name: each.values for each in plan.factors}}
    for name, values in varied.items():
        yield from _spread(name, np.broadcast_to(values, (count, values.shape[1])))
    failed = np.zeros(count, dtype=np.bool_)
    failed[[each.row for each in ensemble.failures]] = True
    yield "failed", failed
    for of in ensemble.responses:
        extremes = ensemble.envelope(of.name)
        yield f"{of.name}_max", largest_of_each(extremes.max)
        yield f"{of.name}_min", -largest_of_each(-extremes.min)
    for name in ensemble.impact_factors.names:
        governing = ensemble.impact_factors.governing(name)
        yield f"impact_factor_{name}", ensemble.impact_factors[name][:, governing]
    yield from _numbered("load_coefficient", ensemble.dynamic_load_coefficients)
    yield from _numbered("lift_offs", ensemble.contact_loss.count)
    yield from _numbered("time_off_road", ensemble.contact_loss.total)
    for side in ("max", "rms"):
        values = getattr(ensemble.body_accelerations, side)
        yield from _numbered(f"body_acceleration_{side}", values)


def _by_place(ensemble: Ensemble, responses: list[Response]) -> Iterator[Column]:
    for of in responses:
        extremes = ensemble.envelope(of.name)
        for side in ("max", "min"):
            for suffix in ("", "_time", "_position"):
                yield f"{of.name}_{side}{suffix}", getattr(extremes, f"{side}{suffix}")
        for side in ("static_max", "static_min"):
            values = getattr(extremes, side)
            yield f"{of.name}_{side}", np.broadcast_to(values, extremes.max.shape)
    for name in [each.name for of in responses for each in of.factors]:
        yield f"impact_factor_{name}", ensemble.impact_factors[name]


def _spread(name: str, values: NDArray[Any]) -> Iterator[Column]:
    """One column, or one for each of several parts."""
    return _numbered(name, values) if values.shape[1] > 1 else iter([(name, values[:, 0])])


def _numbered(name: str, values: NDArray[Any]) -> Iterator[Column]:
    """A column for each axle, body or vehicle, from 1."""
    return ((f"{name}_{k}", column) for k, column in enumerate(values.T, 1))
