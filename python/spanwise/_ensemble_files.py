"""An ensemble as a NumPy archive, and its main figures as plain values."""

from __future__ import annotations

import errno
import json
import stat
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO, Final
from zipfile import ZIP_STORED, BadZipFile, ZipFile

import numpy as np

from spanwise import _core
from spanwise._build import Maker
from spanwise._files import write_files
from spanwise._plain import plain
from spanwise._plan import Plan
from spanwise._plan_of_arguments import Asked, plan_of
from spanwise._rows import Rows
from spanwise.damping import in_words
from spanwise.ensembles import Ensemble
from spanwise.errors import InputError
from spanwise.quantities import parts
from spanwise.roads import Road
from spanwise.schema import Reading, bridge_of, event_table, events_of
from spanwise.traffic import plain_drive

#: Percentiles of the plain values.
PERCENTILES: Final = (1, 5, 25, 50, 75, 95, 99)

#: What an archive is called by that is written as here.
FORMAT: Final = 1

#: What of the rows is neither an array nor a name of one.
LAYOUT: Final = ("columns", "widths", "failures", "shares", "isa", "threads", "elapsed")

#: Columns that have an array for each quantity, and names of others.
BY_QUANTITY: Final = ("responses", "axle_loads", "statics", "times", "positions")
NAMES: Final = {"accelerations": "body_accelerations_max", "vibrations": "body_accelerations_rms"}


def arrays(ensemble: Ensemble) -> Iterator[tuple[str, Any]]:
    """All by name, one after the other: times and positions are many, and not kept."""
    rows = ensemble._rows
    yield "sections", ensemble.sections
    yield "supports", ensemble.supports
    yield "frequencies", ensemble.frequencies
    yield "numbers", ensemble.first + np.arange(ensemble.samples, dtype=np.uint64)
    yield "digests", ensemble.digests
    yield "damping", np.array(in_words(ensemble.settings["damping"], ensemble.frequencies))
    yield "hash", np.array(ensemble.hash)
    yield "failures", np.array([each.sample for each in ensemble.failures], dtype=np.uint64)
    yield "lift_offs", ensemble.contact_loss.count
    for key, (low, high) in rows.columns.items():
        if key not in BY_QUANTITY and high > low:
            yield NAMES.get(key, key), rows.block(key)
    for name in [name for name, of in parts().items() if ensemble._looks_at(of)]:
        extremes = ensemble._extremes(name)
        for side in ("max", "min"):
            for suffix in ("", "_time", "_position"):
                yield f"{name}_{side}{suffix}", getattr(extremes, f"{side}{suffix}")
            yield f"{name}_static_{side}", getattr(extremes, f"static_{side}")
    yield "settings", np.array(json.dumps(settings(ensemble), allow_nan=False))
    # What the ensemble is made again of, beside all these.
    yield "instants", rows.instants
    yield "marches", rows.marches
    yield "at_rest", rows.at_rest
    yield "omega", rows.omega
    yield "clock", np.frombuffer(rows.clock.state, dtype=np.uint8)
    yield (
        "layout",
        np.array(json.dumps({"format": FORMAT, **{k: getattr(rows, k) for k in LAYOUT}})),
    )


def write_npz(ensemble: Ensemble, path: Path) -> None:
    """The archive, complete or not at all."""
    write_files([(path, npz_writer(ensemble))])


def npz_writer(ensemble: Ensemble) -> Callable[[BinaryIO], None]:
    """What writes the archive, array by array."""

    def write(stream: BinaryIO) -> None:
        with ZipFile(stream, "w", allowZip64=True) as archive:
            for name, values in arrays(ensemble):
                with archive.open(f"{name}.npy", "w", force_zip64=True) as entry:
                    np.lib.format.write_array(entry, np.asanyarray(values), allow_pickle=False)

    return write


def read_npz(path: Path) -> Ensemble:
    """The ensemble that was written there."""
    if not stat.S_ISREG(path.stat().st_mode):
        raise OSError(errno.EINVAL, "is not a regular file; an ensemble is one", str(path))
    try:
        with ZipFile(path) as members:
            # What expands could be larger than any memory.
            if any(each.compress_type != ZIP_STORED for each in members.infolist()):
                raise ValueError("is compressed, as no archive of an ensemble is")
        with np.load(path, allow_pickle=False) as archive:
            return _read(archive)
    except KeyError as error:
        raise InputError(
            path, None, f"is not the archive of an ensemble: {error.args[0]}"
        ) from error
    except (ValueError, TypeError, EOFError, BadZipFile, MemoryError) as error:
        raise InputError(path, None, f"is not the archive of an ensemble: {error}") from error


def _read(archive: Any) -> Ensemble:
    layout = json.loads(str(archive["layout"]))
    if layout.pop("format") != FORMAT:
        raise ValueError("is of another version of spanwise")
    columns = {key: (int(low), int(high)) for key, (low, high) in layout.pop("columns").items()}
    plan = _plan(json.loads(str(archive["settings"])))
    width = max(high for _, high in columns.values())
    numbers = np.empty((plan.samples, width))
    axles = (columns["axle_loads"][1] - columns["axle_loads"][0]) // 2
    for name, start, end in _places(columns, layout["widths"], axles):
        numbers[:, start:end] = _of_shape(archive, name, (plan.samples, end - start))
    rows = Rows(
        numbers=numbers,
        instants=_of_shape(archive, "instants", (plan.samples, archive["instants"].shape[-1])),
        digests=_of_shape(archive, "digests", (plan.samples,)),
        marches=_of_shape(archive, "marches", (plan.samples,)),
        at_rest=archive["at_rest"],
        clock=_core.Clock(archive["clock"].tobytes()),
        sections=archive["sections"],
        omega=archive["omega"],
        columns=columns,
        widths={name: int(count) for name, count in layout.pop("widths").items()},
        failures=[(int(row), step, str(cause)) for row, step, cause in layout.pop("failures")],
        **layout,
    )
    if rows.hash != str(archive["hash"]):
        raise InputError("hash", archive["hash"], f"is not that of its samples, {rows.hash}")
    return Ensemble(plan, rows)


def _places(
    columns: Mapping[str, tuple[int, int]], widths: Mapping[str, int], axles: int
) -> Iterator[tuple[str, int, int]]:
    """Which columns of the numbers each array is."""
    loads = {"axle_loads": axles}
    own: dict[str, list[tuple[str, Mapping[str, int]]]] = {
        "responses": [("{}_{}", widths)],
        "axle_loads": [("{}_{}", loads)],
        "statics": [("{}_static_{}", widths)],
        "times": [("{}_{}_time", widths), ("{}_{}_time", loads)],
        "positions": [("{}_{}_position", widths), ("{}_{}_position", loads)],
    }
    for key, (at, end) in columns.items():
        if key not in own and end > at:
            yield NAMES.get(key, key), at, end
        for form, names in own.get(key, []) if end > at else []:
            for side in ("max", "min"):
                for name, width in names.items():
                    yield form.format(name, side), at, at + width
                    at += width


def _of_shape(archive: Any, name: str, shape: tuple[int, ...]) -> Any:
    values = archive[name]
    if values.shape != shape:
        raise InputError(name, f"shape {values.shape}", f"must be {shape}")
    return values


def _plan(tables: Mapping[str, Any]) -> Plan:
    """What `settings` tells, as `ensemble` would understand it."""
    reading = Reading()
    events = events_of(tables["events"], reading.place("events"))
    bridge = bridge_of(tables["bridge"], reading.place("bridge"))
    asked = Maker(Asked).build(tables["ensemble"], reading.place("ensemble"))
    return plan_of(bridge, [*map(list, events)], asked)[0]


def settings(ensemble: Ensemble) -> dict[str, Any]:
    """What the ensemble was made of, in plain values, as a case file has it."""
    plan = ensemble._plan
    given = dict(ensemble.settings)
    road = given["road"]
    assert isinstance(road, Road)
    given["road"] = road.arguments
    given["drive"] = plain_drive(plan.drive)
    table: dict[str, Any] = plain(
        {
            "bridge": plan.bridge.arguments,
            "events": [*map(event_table, plan.events)],
            "ensemble": given,
        }
    )
    return table


def as_dict(ensemble: Ensemble) -> dict[str, Any]:
    """Main figures as plain values: percentiles of impact factors and of extremes."""
    sound = ~np.isnan(ensemble.envelope("axle_loads").max).all(axis=1)
    tails = ensemble.tail[np.isfinite(ensemble.tail)]
    found: dict[str, Any] = {
        "samples": ensemble.samples,
        "seed": ensemble.seed,
        "first": ensemble.first,
        "hash": ensemble.hash,
        "isa": ensemble.isa,
        "threads": ensemble.threads,
        "elapsed": ensemble.elapsed,
        "sections": ensemble.sections,
        "supports": ensemble.supports,
        "damping": in_words(ensemble.settings["damping"], ensemble.frequencies),
        "warnings": ensemble.warnings,
        "failures": [
            {"sample": each.sample, "step": each.step, "cause": each.cause}
            for each in ensemble.failures
        ],
        "tail": {
            "shortest": tails.min() if len(tails) else None,
            "longest": tails.max() if len(tails) else None,
            "samples_that_can_grow": int((ensemble.growth > 0.0).sum()),
        },
        "percentiles": [*PERCENTILES],
        "extremes": {},
        "impact_factors": {},
        "settings": settings(ensemble),
    }
    if sound.any():
        for of in ensemble.responses:
            extremes = ensemble.envelope(of.name)
            found["extremes"][of.name] = {
                side: _percentiles(getattr(extremes, side)) for side in ("max", "min")
            }
        for name in ensemble.impact_factors.names:
            found["impact_factors"][name] = _percentiles(ensemble.impact_factors[name])
    table: dict[str, Any] = plain(found)
    return table


def _percentiles(values: Any) -> Any:
    """By percentile and section, over the samples that have a value there."""
    there = ~np.isnan(values).all(axis=0)
    found = np.full((len(PERCENTILES), values.shape[1]), np.nan)
    if there.any():
        found[:, there] = np.nanpercentile(values[:, there], PERCENTILES, axis=0)
    return found
