"""A run as plain values, as JSON and CSV files, and as a pandas frame."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from spanwise._checks import file_path
from spanwise._core import __version__
from spanwise._csv import csv_files
from spanwise._extras import require
from spanwise._files import write_files
from spanwise._keys import alike
from spanwise._values import envelope, history, places, plain, quantities, stop
from spanwise.damping import in_words
from spanwise.responses import QUANTITIES, Quantity
from spanwise.runs import Run
from spanwise.schema import event_table
from spanwise.table import COLUMNS

if TYPE_CHECKING:
    import pandas as pd


def as_dict(run: Run) -> dict[str, Any]:
    """The results as plain lists and numbers, that JSON can hold.

    Where an impact factor is masked there is ``None``; a locked suspension has the friction limit
    ``"inf"``, for JSON knows no infinity.
    """
    result: dict[str, object] = {
        "version": __version__,
        "settings": {
            "bridge": run.bridge.arguments,
            **_traffic(run),
            "road": run.road.arguments,
            "crossing": {**run.settings, "sections": run.sections},
        },
        "sections": run.sections,
        "supports": run.supports,
        "frequencies": run.frequencies,
        "damping": in_words(run.settings["damping"], run.frequencies),
        "warnings": run.warnings,
        "final_speed": run.final_speed,
        "vehicles": [_vehicle(run, k) for k in range(len(run.passages))],
        "lift_offs": [asdict(each) for each in run.lift_offs],
        "steps": run.steps,
        "tail": {
            "length": run.tail,
            "settled": run.settled,
            "can_grow": [asdict(each) for each in run.can_grow],
        },
        "impact_factors": _impact_factors(run),
        **{quantity: envelope(run, quantity) for quantity in quantities(run)},
    }
    return {key: plain(value) for key, value in result.items()}


def json_text(run: Run) -> str:
    """`as_dict` as JSON, with a line for each key."""
    return json_lines(as_dict(run))


def json_lines(table: Mapping[str, Any]) -> str:
    """A table as JSON, with a line for each key."""
    lines = (
        f"{json.dumps(key)}: {json.dumps(value, allow_nan=False)}" for key, value in table.items()
    )
    return "{\n" + ",\n".join(lines) + "\n}\n"


def write_json(run: Run, path: str | Path) -> None:
    """Write `as_dict` to a JSON file.

    Raises
    ------
    OSError
        If the file cannot be written; then there is none, or the old one.
    """
    write_files([(file_path("path", path), [json_text(run).encode()])])


def write_csv(run: Run, directory: str | Path) -> None:
    """Write impact factors, extremes and histories into a folder, which is made if there is none.

    The files are ``impact_factors.csv``, ``lift_offs.csv``, ``envelope_<quantity>.csv``,
    ``history_<quantity>.csv`` and ``history_vehicle.csv``, or ``history_vehicle_<number>.csv`` for
    each of several vehicles. Axles are numbered through all vehicles. The first row of a file
    names the columns and units; numbers have a decimal point and all their digits.

    Raises
    ------
    OSError
        If the folder or a file cannot be written; then no file has been changed.
    """
    folder = file_path("directory", directory)
    files = [(folder / name, content) for name, content in csv_files(run)]
    write_files(files, folders=[folder])


def as_frame(run: Run, quantity: Quantity) -> pd.DataFrame:
    """History of a quantity as a frame, see `Run.to_pandas`."""
    pandas = require("pandas", extra="pandas")
    values = history(run, quantity)
    quantity = cast("Quantity", alike(quantity, QUANTITIES))
    if quantity == "shear":
        sides = ["left", "right"]
        columns = pandas.MultiIndex.from_product([run.sections, sides], names=["x [m]", "side"])
    elif quantity == "axle_loads":
        columns = pandas.RangeIndex(1, values.shape[1] + 1, name="axle")
    else:
        of = {"reactions": "support [m]", "clamp_moments": "clamp [m]"}.get(quantity, "x [m]")
        columns = pandas.Index(places(run, quantity), name=of)
    index = pandas.Index(run.time, name="time [s]")
    frame: pd.DataFrame = pandas.DataFrame(values, index=index, columns=columns)
    return frame


def _traffic(run: Run) -> dict[str, Any]:
    """The tables of the vehicles: one alone, or several."""
    table = event_table(run.passages)
    return {"traffic": table} if isinstance(table, list) else table


def _vehicle(run: Run, vehicle: int) -> dict[str, object]:
    own = [k for k, (number, _) in enumerate(run.axles) if number == vehicle + 1]
    stopped = stop(run, vehicle)
    return {
        "static_axle_loads": run.static_axle_loads[own],
        "load_coefficients": run.load_coefficients[own],
        "final_speed": run.vehicles[vehicle].speed[-1],
        "stopped": stopped and {"time": stopped[0], "axle_positions": stopped[1]},
        "off_road": {
            name: getattr(run.off_road, name)[own] for name in ("count", "total", "longest")
        },
    }


def _impact_factors(run: Run) -> dict[str, object]:
    factors = run.impact_factors
    names = (*COLUMNS, "reactions", "axle_loads")
    return {
        "ratio": factors.ratio,
        "mask": factors.mask,
        **{name: getattr(factors, name) for name in names},
        "masked": factors.masked,
    }
