"""Rows of the CSV files of a run."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._values import axle_names, envelope, history, places, plain, quantities
from spanwise.motions import Motion, VehicleMotion
from spanwise.responses import Quantity
from spanwise.runs import Run
from spanwise.table import COLUMNS

Array: TypeAlias = NDArray[np.float64]
Row: TypeAlias = Sequence[object]

UNITS: Final = {
    "deflection": "m",
    "moment": "N m",
    "shear": "N",
    "reactions": "N",
    "clamp_moments": "N m",
    "axle_loads": "N",
}
#: Of a coordinate with its rates.
RATES: Final = {"displacement": "", "velocity": "/s", "acceleration": "/s2"}
TRAVEL_UNITS: Final = {
    "travel": "m",
    "speed": "m/s",
    "acceleration": "m/s2",
}
AXLE_UNITS: Final = {
    "axle_positions": "m",
    "elevations": "m",
    "suspension_shortenings": "m",
    "friction": "N",
}

#: Rows of a CSV file that are turned into text at a time.
_CHUNK: Final = 1000


def csv_files(run: Run) -> Iterator[tuple[str, Iterator[bytes]]]:
    """Names and contents of the CSV files, the contents in pieces."""
    yield "impact_factors.csv", _csv(_impact_factor_rows(run))
    for quantity in quantities(run):
        yield f"envelope_{quantity}.csv", _csv(_envelope_rows(run, quantity))
    for quantity in quantities(run):
        rows = _history_rows(run, _labels(run, quantity), history(run, quantity))
        yield f"history_{quantity}.csv", _csv(rows)
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
    factors = run.impact_factors
    names = (*COLUMNS, "reaction", "axle load")
    yield ["of", "x [m]", "axle", *(f"{name} [-]" for name in names)]
    by_section = [plain(getattr(factors, name)) for name in COLUMNS]
    for x, *row in zip(plain(factors.sections), *by_section, strict=True):
        yield ["section", x, None, *row, None, None]
    none = [None] * len(COLUMNS)
    for x, factor in zip(plain(factors.supports), plain(factors.reactions), strict=True):
        yield ["support", x, None, *none, factor, None]
    for k, factor in enumerate(plain(factors.axle_loads), 1):
        yield ["axle", None, k, *none, None, factor]


def _envelope_rows(run: Run, quantity: Quantity) -> Iterator[Row]:
    columns = envelope(run, quantity)
    units = {"time": "s", "position": "m"}
    axles = quantity == "axle_loads"
    at = [int(x) if axles else float(x) for x in places(run, quantity)]
    yield [
        "axle" if axles else "x [m]",
        *(f"{name} [{units.get(name.rpartition('_')[2], UNITS[quantity])}]" for name in columns),
    ]
    yield from zip(at, *map(plain, columns.values()), strict=True)


def _labels(run: Run, quantity: Quantity) -> list[str]:
    """Column heads of a history."""
    unit = UNITS[quantity]
    if quantity == "axle_loads":
        return [f"load of {name} [{unit}]" for name in axle_names(run)]
    name = {"reactions": "reaction", "clamp_moments": "clamp moment"}.get(quantity, quantity)
    sides = (" left of", " right of") if quantity == "shear" else (" at",)
    at = places(run, quantity).tolist()
    return [f"{name}{side} {x!r} m [{unit}]" for x in at for side in sides]


def _history_rows(run: Run, labels: list[str], values: Array) -> Iterator[Row]:
    yield ["time [s]", *labels]
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
    for name, unit in TRAVEL_UNITS.items():
        found[f"{name} [{unit}]"] = getattr(motion, name)
    for name, unit in AXLE_UNITS.items():
        text = name.replace("_", " ").removeprefix("axle ").removesuffix("s")
        columns = getattr(motion, name).T
        if name == "elevations" and not columns.any():
            continue
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
