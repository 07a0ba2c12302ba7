"""The command ``spanwise road FILE``: how rough the road of a case, or a measured one, is."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from spanwise._command_options import add_json, add_key, add_set
from spanwise._core import __version__
from spanwise._files import write_files
from spanwise._plain import json_lines
from spanwise._shown import warned
from spanwise.case import Case
from spanwise.roads import IriSegments, IsoClass, Road

if TYPE_CHECKING:
    from argparse import _SubParsersAction

Found = TypeVar("Found")

#: Options that were there for keys of a profile, and how many values they take.
OLD: Final[dict[str, dict[str, Any]]] = {
    "columns": {"nargs": "+"},
    "spacing": {},
    "profile-start": {"key": "road.start"},
    "delimiter": {},
    "decimal": {},
    "scale": {"nargs": 2},
    "missing": {},
    "sort": {"nargs": 0, "const": True},
    "duplicates": {},
    "max-gap": {"key": "road.max_gap"},
}


def add_to(commands: _SubParsersAction[Any]) -> None:
    """Add the command and its options."""
    command = commands.add_parser(
        "road",
        allow_abbrev=False,
        help="tell how rough a road is",
        description="Tell how rough the road of a case, or a measured one, is: its international "
        "roughness index, and its class after ISO 8608 by a line fitted to its spectrum.",
    )
    command.add_argument(
        "file",
        type=Path,
        metavar="FILE",
        help="a case with a [road], or a measured profile: a table with x and elevation in its "
        "first two columns, or an ERD file",
    )
    command.add_argument("--start", type=float, metavar="X", help="where the section begins [m]")
    command.add_argument("--end", type=float, metavar="X", help="where it ends [m]")
    command.add_argument(
        "--every", type=float, metavar="L", help="give the index of segments of this length [m] too"
    )
    add_json(command, "the results")
    add_set(command, "road")
    for name, more in OLD.items():
        add_key(command, f"--{name}", **{"key": f"road.{name}", **more})
    command.set_defaults(work=run)


def run(options: argparse.Namespace) -> str:
    """Writes the file asked for, and gives the text to print."""
    with _doubts_kept() as told:
        road, files = Case.read_road(options.file, options.settings)
        start, end = _section(road, options.start, options.end)
        index = _or_reason(lambda: road.iri(start, end))
        found = _or_reason(lambda: road.iso_class(start, end))
        if isinstance(index, str) and isinstance(found, str):
            raise ValueError(index)
        segments = None if options.every is None else road.iri(start, end, every=options.every)
    if options.json is not None:
        table = json_lines(_as_dict(road, (start, end), index, segments, found, told))
        if options.json == "-":
            return table
        write_files([(Path(options.json), [table.encode()])], inputs=files)
    return _text(road, (start, end), index, segments, found, told)


@contextmanager
def _doubts_kept() -> Iterator[list[str]]:
    """Keeps warnings for the text too."""
    kept: list[str] = []
    try:
        with warnings.catch_warnings(record=True) as doubts:
            warnings.simplefilter("always", UserWarning)
            try:
                yield kept
            finally:
                kept += dict.fromkeys(str(doubt.message) for doubt in doubts)
    finally:
        for said in kept:
            warnings.warn(said, stacklevel=2)


def _or_reason(ask: Callable[[], Found]) -> Found | str:
    """What is asked for, or why there is none."""
    try:
        return ask()
    except ValueError as error:
        return str(error)


def _section(road: Road, start: float | None, end: float | None) -> tuple[float, float]:
    """By default all that is known: of a random road a period, of features 100 m from 0 on."""
    first, last = road.ends
    if not np.isfinite(first) or not np.isfinite(last):
        period = road.repeats_after
        first, last = 0.0, period if np.isfinite(period) else 100.0
    return first if start is None else start, last if end is None else end


def _text(
    road: Road,
    section: tuple[float, float],
    index: float | str,
    segments: IriSegments | None,
    found: IsoClass | str,
    told: list[str],
) -> str:
    lines = [
        f"road      {road}",
        f"section   {section[0]:g} to {section[1]:g} m",
        f"IRI       {index if isinstance(index, str) else f'{index:.2f} m/km'}",
    ]
    if isinstance(found, str):
        lines.append(f"ISO 8608  {found}")
    else:
        limits = f"{found.lower:g} to {found.upper:g}"
        lines.append(
            f"ISO 8608  class {found.letter} ({limits} m3), fitted G_d(n0) {found.G:.4g} m3"
        )
        if found.error is not None and found.band is not None:
            band = f"{found.band[0]:.3g} to {found.band[1]:.3g} cycle/m"
            lines.append(f"          standard error {100.0 * found.error:.0f} %, from {band}")
    lines += warned(told)
    if segments is not None:
        settled = f"after a lead-in of {segments.lead_in:g} m" if segments.lead_in else "no lead-in"
        lines += ["", f"IRI by segments, {settled}", str(segments)]
    return "\n".join(lines) + "\n"


def _as_dict(
    road: Road,
    section: tuple[float, float],
    index: float | str,
    segments: IriSegments | None,
    found: IsoClass | str,
    told: list[str],
) -> dict[str, Any]:
    table: dict[str, Any] = {
        "version": __version__,
        "road": str(road),
        "section": list(section),
        "warnings": told,
    }
    if isinstance(index, str):
        table |= {"iri": None, "iri_refused": index}
    else:
        table["iri"] = index
    if segments is not None:
        table["iri_segments"] = {
            "starts": segments.starts.tolist(),
            "ends": segments.ends.tolist(),
            "values": segments.values.tolist(),
            "lead_in": segments.lead_in,
        }
    if isinstance(found, str):
        return table | {"iso_8608": None, "iso_8608_refused": found}
    upper = None if np.isinf(found.upper) else found.upper
    iso = {"class": found.letter, "G": found.G, "lower": found.lower, "upper": upper}
    return table | {"iso_8608": iso | {"error": found.error, "band": found.band}}
