"""A run as plain values, as JSON and CSV files, and as a pandas frame."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import file_path
from spanwise._core import __version__
from spanwise._door import require
from spanwise._files import write_files
from spanwise._plain import json_lines, plain
from spanwise.damping import in_words
from spanwise.motions import Motion, VehicleMotion
from spanwise.quantities import Response, factors, response
from spanwise.runs import Run
from spanwise.schema import event_table

if TYPE_CHECKING:
    import pandas as pd

Array: TypeAlias = NDArray[np.float64]
Row: TypeAlias = Sequence[object]

#: Of a coordinate with its rates.
RATES: Final = {"displacement": "", "velocity": "/s", "acceleration": "/s2"}

#: Columns of the motion of a vehicle and of its axles, by attribute.
TRAVEL: Final = {
    "travel": "travel [m]",
    "speed": "speed [m/s]",
    "acceleration": "acceleration [m/s2]",
}
BY_AXLE: Final = {
    "axle_positions": ("position", "m"),
    "elevations": ("elevation", "m"),
    "suspension_travel": ("suspension shortening", "m"),
    "friction": ("friction", "N"),
}

#: Rows of a CSV file that are turned into text at a time.
_CHUNK: Final = 1000


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
        "impact_factors": {
            "ratio": run.impact_factors.ratio,
            "mask": run.impact_factors.mask,
            **run.impact_factors.values,
            "masked": run.impact_factors.masked,
        },
        **{each.name: run.envelope(each.name).table() for each in run.responses},
    }
    return {key: plain(value) for key, value in result.items()}


def json_text(run: Run) -> str:
    """`as_dict` as JSON, with a line for each key."""
    return json_lines(as_dict(run))


def write_json(run: Run, path: str | Path) -> None:
    """The file, complete or not at all."""
    write_files([(file_path("path", path), [json_text(run).encode()])])


def write_csv(run: Run, directory: str | Path) -> None:
    """The files, all or none."""
    folder = file_path("directory", directory)
    files = [(folder / name, content) for name, content in csv_files(run)]
    write_files(files, folders=[folder])


def as_frame(run: Run, quantity: str) -> pd.DataFrame:
    """History of a response as a frame, see `Run.to_pandas`."""
    pandas = require("pandas", extra="pandas")
    of = response(quantity)
    values, places = _history(run, of), run.places(of.axis)
    name = {"section": "x [m]", "axle": "axle"}.get(of.axis, f"{of.axis} [m]")
    if of.sided:
        columns = pandas.MultiIndex.from_product([places, ["left", "right"]], names=[name, "side"])
    elif of.axis == "axle":
        columns = pandas.RangeIndex(1, len(places) + 1, name=name)
    else:
        columns = pandas.Index(places, name=name)
    index = pandas.Index(run.time, name="time [s]")
    frame: pd.DataFrame = pandas.DataFrame(values, index=index, columns=columns)
    return frame


def csv_files(run: Run) -> Iterator[tuple[str, Iterator[bytes]]]:
    """Names and contents of the CSV files, the contents in pieces."""
    yield "impact_factors.csv", _csv(_impact_factor_rows(run))
    for each in run.responses:
        yield f"envelope_{each.name}.csv", _csv(_envelope_rows(run, each))
    for each in run.responses:
        rows = _history_rows(run, _heads(run, each), _history(run, each))
        yield f"history_{each.name}.csv", _csv(rows)
    alone = len(run.passages) == 1
    for number, motion in enumerate(run.vehicles, 1):
        name = "history_vehicle.csv" if alone else f"history_vehicle_{number}.csv"
        yield name, _csv(_history_rows(run, *_motion(motion)))
    yield "lift_offs.csv", _csv(_lift_off_rows(run))


def _csv(rows: Iterable[Row]) -> Iterator[bytes]:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    for n, row in enumerate(rows, 1):
        writer.writerow(row)
        if n % _CHUNK == 0:
            yield buffer.getvalue().encode()
            buffer.seek(0)
            buffer.truncate()
    yield buffer.getvalue().encode()


def _impact_factor_rows(run: Run) -> Iterator[Row]:
    heads = [f"{each.noun} [-]" for _, each in factors().values()]
    yield ["of", "x [m]", "axle", *heads]
    for axis in ("section", "support", "axle"):
        by_name = {name: each for name, (each, _) in factors().items()}
        columns = [
            plain(run.impact_factors[name]) if each.axis == axis else None
            for name, each in by_name.items()
        ]
        for i, place in enumerate(run.places(axis)):
            at = [None, i + 1] if axis == "axle" else [float(place), None]
            yield [axis, *at, *(None if each is None else each[i] for each in columns)]


def _envelope_rows(run: Run, of: Response) -> Iterator[Row]:
    columns = run.envelope(of.name).table()
    units = {"time": "s", "position": "m"}
    axles = of.axis == "axle"
    yield [
        "axle" if axles else "x [m]",
        *(f"{name} [{units.get(name.rpartition('_')[2], of.unit)}]" for name in columns),
    ]
    at = (int(x) if axles else float(x) for x in run.places(of.axis))
    yield from zip(at, *map(plain, columns.values()), strict=True)


def _history(run: Run, of: Response) -> Array:
    """Shape (time, column); of a shear the left and the right of each section in turn."""
    values: Array = getattr(run, of.name)
    return values.reshape(len(run.time), values.size // len(run.time))


def _heads(run: Run, of: Response) -> list[str]:
    """Column heads of a history."""
    if of.axis == "axle":
        return [f"{of.noun.removeprefix('axle ')} of {name} [{of.unit}]" for name in run.axle_names]
    sides = (" left of", " right of") if of.sided else (" at",)
    places = run.places(of.axis).tolist()
    return [f"{of.noun}{side} {x!r} m [{of.unit}]" for x in places for side in sides]


def _history_rows(run: Run, heads: list[str], values: Array) -> Iterator[Row]:
    yield ["time [s]", *heads]
    for time, row in zip(run.time, values, strict=True):
        yield [float(time), *row.tolist()]


def _motion(motion: VehicleMotion) -> tuple[list[str], Array]:
    """Column heads and values of the motion of a vehicle."""
    found: dict[str, Array] = {}
    for number, body in enumerate(motion.bodies, 1):
        of = f" of body {number}" if len(motion.bodies) > 1 else ""
        found |= _rates(body.heave, "heave", of, "m") | _rates(body.pitch, "pitch", of, "rad")
    for number, hop in enumerate(motion.hops, 1):
        if hop.displacement.any() or hop.acceleration.any():
            found |= _rates(hop, "hop", f" of axle {number}", "m")
    found |= {head: getattr(motion, name) for name, head in TRAVEL.items()}
    for name, (text, unit) in BY_AXLE.items():
        columns = getattr(motion, name).T
        if name != "elevations" or columns.any():
            found |= {f"{text} of axle {k} [{unit}]": each for k, each in enumerate(columns, 1)}
    return list(found), np.column_stack(list(found.values()))


def _rates(motion: Motion, name: str, of: str, unit: str) -> dict[str, Array]:
    """Columns of a coordinate and its rates by head."""
    return {
        f"{name}{'' if rate == 'displacement' else f' {rate}'}{of} [{unit}{per}]": getattr(
            motion, rate
        )
        for rate, per in RATES.items()
    }


def _lift_off_rows(run: Run) -> Iterator[Row]:
    yield ["axle", "vehicle", "axle of the vehicle", "start [s]", "end [s]", "duration [s]"]
    for each in run.lift_offs:
        times = (each.start, each.end, each.duration)
        yield [each.axle, *run.axles[each.axle - 1], *times]


def _traffic(run: Run) -> dict[str, Any]:
    """The tables of the vehicles: one alone, or several."""
    table = event_table(run.passages)
    return {"traffic": table} if isinstance(table, list) else table


def _vehicle(run: Run, vehicle: int) -> dict[str, object]:
    own = [k for k, (number, _) in enumerate(run.axles) if number == vehicle + 1]
    stopped = run.stop(vehicle)
    return {
        "static_axle_loads": run.static_axle_loads[own],
        "load_coefficients": run.dynamic_load_coefficients[own],
        "final_speed": run.vehicles[vehicle].speed[-1],
        "stopped": stopped and {"time": stopped[0], "axle_positions": stopped[1]},
        "off_road": {
            name: getattr(run.contact_loss, name)[own] for name in ("count", "total", "longest")
        },
    }
