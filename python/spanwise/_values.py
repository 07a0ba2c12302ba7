"""The numbers of a run in columns and as plain values, for reports."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import named
from spanwise.responses import QUANTITIES, Quantity
from spanwise.runs import Run

Array: TypeAlias = NDArray[np.float64]

EXTREMES: Final = ("max", "min", "static_max", "static_min")


def quantities(run: Run) -> list[Quantity]:
    """Those that the run has: without a clamp no clamp moments, and all that the bridge knows."""
    named = {"shear": "shear-left", "reactions": "reaction", "clamp_moments": "clamp-moment"}
    missing = run.bridge.missing
    clamped = len(run.bridge.clamps) > 0
    known = [each for each in QUANTITIES if named.get(each, each) not in missing]
    return [each for each in known if clamped or each != "clamp_moments"]


def places(run: Run, quantity: Quantity) -> Array:
    """Sections, supports or clamps [m], or numbers of the axles."""
    return run.envelope(quantity).x


def history(run: Run, quantity: Quantity) -> Array:
    """Shape (time, column); of a shear the left and the right of each section in turn."""
    values: Array = getattr(run, named("quantity", quantity, QUANTITIES))
    return values.reshape(len(values), -1)


def envelope(run: Run, quantity: Quantity) -> dict[str, Array]:
    """Extremes by name, each followed by its time, position and partner."""
    found = run.envelope(quantity)
    columns = {}
    for name in EXTREMES:
        extremes = getattr(found, name)
        columns[name] = extremes.value
        for each in ("time", "position", "partner"):
            columns[f"{name}_{each}"] = getattr(extremes, each)
    return columns


def stop(run: Run, vehicle: int) -> tuple[float, Array] | None:
    """When a vehicle, counted from 0, came to rest, and where its axles stand; or nothing."""
    motion = run.vehicles[vehicle]
    if motion.stopped is None:
        return None
    columns = motion.axle_positions.T
    return motion.stopped, np.array([np.interp(motion.stopped, run.time, x) for x in columns])


def axle_names(run: Run) -> list[str]:
    """What the axles are called: by number, and by vehicle where there are several."""
    if len(run.passages) == 1:
        return [f"axle {axle}" for _, axle in run.axles]
    return [f"vehicle {vehicle} axle {axle}" for vehicle, axle in run.axles]


def plain(value: object) -> Any:
    """The value in lists, dictionaries, numbers and text; NaN as None, infinity as text."""
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, Integral):
        return int(value)
    if not isinstance(value, Real):
        raise TypeError(f"{value!r} has no plain value")
    number = float(value)
    if np.isfinite(number):
        return number
    return None if np.isnan(number) else str(number)
