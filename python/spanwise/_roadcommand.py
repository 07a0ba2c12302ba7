"""The command ``spanwise road FILE``: how rough the road of a case, or a measured one, is."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from spanwise._core import __version__
from spanwise._files import write_files
from spanwise._plain import json_lines
from spanwise._shown import warned
from spanwise._streams import tell
from spanwise.case import Case
from spanwise.roads import IriSegments, IsoClass, Profile, Road
from spanwise.roads._options import written_as

if TYPE_CHECKING:
    from argparse import _SubParsersAction

Found = TypeVar("Found")

#: Options by the arguments of `Profile.read` that they give.
READING: Final = {
    "columns": "--columns",
    "spacing": "--spacing",
    "start": "--profile-start",
    "delimiter": "--delimiter",
    "decimal": "--decimal",
    "scale": "--scale",
    "missing": "--missing",
    "sort": "--sort",
    "duplicates": "--duplicates",
    "max_gap": "--max-gap",
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
    command.add_argument(
        "--json",
        metavar="FILE",
        help="write the results as JSON; - for standard output, in place of the text",
    )
    profile = command.add_argument_group("how to read a profile")
    profile.add_argument(
        "--columns",
        nargs="+",
        metavar="COLUMN",
        help="names, or numbers from 0, of the columns with x and elevation, or with elevation "
        "alone; of several elevations the mean is taken",
    )
    profile.add_argument(
        "--spacing", type=float, metavar="D", help="distance of the points [m], if no column has x"
    )
    profile.add_argument(
        "--profile-start", type=float, metavar="X", help="x of the first point, not that there [m]"
    )
    profile.add_argument(
        "--delimiter",
        metavar="C",
        help=r"what separates the columns, \t for a tab; found without",
    )
    profile.add_argument(
        "--decimal", metavar="C", help="the decimal mark, . or a comma; found without"
    )
    profile.add_argument(
        "--scale",
        nargs=2,
        type=float,
        metavar=("X", "Z"),
        help="what x and elevation are multiplied by to give metres: 1 0.001 for mm; without, by "
        "the units that the file names",
    )
    profile.add_argument(
        "--missing",
        type=float,
        metavar="Z",
        help="leave out points with this elevation, as the file writes it: -9999, or nan for "
        "blank cells",
    )
    profile.add_argument(
        "--sort", action="store_const", const=True, help="bring the points into the order of x"
    )
    profile.add_argument(
        "--duplicates",
        metavar="WHICH",
        help="of points with the same x take the mean, first or last; refused without",
    )
    profile.add_argument(
        "--max-gap", type=float, metavar="D", help="largest distance of neighbouring points [m]"
    )
    command.set_defaults(work=run)


def run(options: argparse.Namespace) -> str:
    """Writes the file asked for, and gives the text to print."""
    with _doubts_kept(told=options.json == "-") as told:
        road, files = _read(options)
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


def _read(options: argparse.Namespace) -> tuple[Road, Sequence[Path]]:
    """The road, and the files that it was read from."""
    given = {}
    for key, option in READING.items():
        value = getattr(options, option.removeprefix("--").replace("-", "_"))
        if value is not None:
            given[key] = value
    if options.file.suffix.lower() == ".toml":
        for key in given:
            raise ValueError(f"{READING[key]}: used with profiles only, not with a case")
        return Case.read_road(options.file)
    if "columns" in given:
        given["columns"] = [int(c) if c.isdecimal() else c for c in given["columns"]]
    with written_as(READING):
        return Profile.read(options.file, **given), [options.file]


@contextmanager
def _doubts_kept(*, told: bool) -> Iterator[list[str]]:
    """Keeps warnings for the text, and tells them if there is none or the road is refused."""
    kept: list[str] = []
    refused = True
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always", UserWarning)
        try:
            yield kept
            refused = False
        finally:
            kept += dict.fromkeys(str(doubt.message) for doubt in doubts)
            for message in kept if told or refused else ():
                tell(f"spanwise: warning: {message}")


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
