"""What a file of measured points holds: rows of cells, and what its head says of the columns."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain, islice
from typing import Final, TypeAlias

from spanwise._checks import shown
from spanwise.errors import InputError
from spanwise.roads.sniffing import DELIMITERS, decimal_of, delimiter_of, rows_of, value_of

#: Number or name of a column.
Column: TypeAlias = int | str
#: Number and cells of a line.
Row: TypeAlias = tuple[int, list[str]]
#: Reads the lines of a file from the first on.
Lines: TypeAlias = Callable[[], Iterator[str]]

#: Lines from which delimiter and decimal mark are found, and most lines of the header of an ERD.
_SEEN: Final = 200
_LONGEST: Final = 1000

#: Metres in the units that headings name.
METRES: Final = {
    name: metres
    for names, metres in (
        ("m metre metres meter meters", 1.0),
        ("dm", 0.1),
        ("cm", 1e-2),
        ("mm", 1e-3),
        ("µm μm um", 1e-6),
        ("km", 1e3),
        ("yd yard yards", 0.9144),
        ("ft foot feet", 0.3048),
        ("in inch inches", 0.0254),
        ("mil mils", 2.54e-5),
    )
    for name in names.split()
}

#: Units that a name has, in brackets or after a stroke, and its last word, which may be one.
_TOLD: Final = r"\[([^\]]*)\]|\(([^)]*)\)|\s/\s*([^\s/]+)$"
_ENDING: Final = r"[\s_/,]([^\s_/,]+)$"
#: A name and its unit in brackets or after a stroke.
_WITH_UNIT: Final = r"(.*?\S)\s*(?:\[[^\]]*\]|\([^)]*\)|\s/\s*[^\s/]+)"
#: A name between blanks with its units, or a unit alone.
_WORD: Final = r"\[[^\]]*\]|\([^)]*\)|\S+(?: \[[^\]]*\]| \([^)]*\)| / ?\S+)*"


@dataclass
class Sheet:
    """Rows of a file with what its head says of the columns."""

    rows: Iterator[Row]
    #: Of the columns; empty if they have none.
    names: list[str]
    units: list[str]
    #: Number of the line that has the units; 0 if it is not known.
    head: int = 0
    #: Whether what is said in place of units is meant to be one, and not any words in brackets.
    is_strict: bool = True
    decimal: str = "."
    #: Place of the first row, distance of the rows and their unit, where no column has x.
    along: tuple[float, float, str] | None = None
    #: Number of rows that there should be; less than 1 if it is not known.
    expected: int = 0
    #: Of a table its lines and what separates the cells.
    lines: Lines | None = None
    delimiter: str = " "

    def metres(self, place: int | None) -> float:
        """What a column, or x where none has it, is multiplied by; by 1 if it has no unit."""
        if place is None:
            unit, of = ("" if self.along is None else self.along[2]), "the step"
        else:
            unit = self.units[place] if place < len(self.units) else ""
            of = f"column {place} ({self.names[place]})" if place < len(self.names) else "x"
        if self.is_strict and unit and not _is_unit(unit):
            where = f"line {self.head}" if self.head else ""
            raise InputError(where, None, f"unit {unit!r} of {of}: is not known; give scale")
        return METRES.get(unit.lower(), 1.0)


def table_of(
    lines: Lines, columns: tuple[Column, ...], delimiter: str | None, decimal: str | None
) -> Sheet:
    """Rows of separated values, with a head of titles, names and units or without."""
    least, places = len(columns), {each for each in columns if isinstance(each, int)}
    seen = [line for line in islice(lines(), _SEEN) if not line.lstrip().startswith("#")]
    delimiter = delimiter or delimiter_of(seen, least, decimal)
    decimal = decimal or decimal_of((cells for _, cells in rows_of(seen, delimiter)), least)
    rows = rows_of(lines(), delimiter)
    lead: list[tuple[Row, int]] = []
    first: list[Row] = []
    for row in rows:
        held = {k for k, cell in enumerate(row[1]) if value_of(cell, decimal) is not None}
        if (len(held) >= least and places <= held) or len(lead) == _SEEN:
            first = [row]
            break
        lead.append((row, len(held)))
    # The head ends with its last line without any number; what follows is meant to be points.
    head = max((k for k, (_, numbers) in enumerate(lead, 1) if numbers == 0), default=0)
    if lead and head == len(lead) and not first:
        (line, cells), _ = lead[-1]
        other = next((each for each in DELIMITERS if any(each in cell for cell in cells)), None)
        hint = "" if other is None else f"; is the delimiter {other!r}?"
        said = f"no numbers in {shown(delimiter.join(cells))}, the last line{hint}"
        raise InputError(f"line {line}", None, said)
    titles = [row for row, numbers in lead[:head] if numbers == 0]
    points = [row for row, _ in lead[head:]] + first
    width = len(points[0][1]) if points else 0
    if delimiter == " ":
        titles = [(line, _joined(cells, width)) for line, cells in titles]
    wanted = {each for each in columns if isinstance(each, str)}
    titles = titles or [*_remarks(lines(), delimiter, width, wanted)]
    names, units, line = _head(titles, wanted)
    # Square brackets are for units; where one is known, all others are meant to be.
    is_strict = any(map(_is_unit, units)) or any("[" in name for name in names)
    return Sheet(
        chain(points, rows),
        names,
        units,
        line,
        is_strict,
        decimal,
        lines=lines,
        delimiter=delimiter,
    )


def _remarks(lines: Iterator[str], delimiter: str, width: int, wanted: set[str]) -> Iterator[Row]:
    """Comments before the points that have as many cells, and name units or columns asked for."""
    for number, line in enumerate(islice(lines, _SEEN), 1):
        text = line.lstrip()
        if text and not text.startswith("#"):
            return
        for _, cells in rows_of([text.lstrip("# ")], delimiter):
            found = _joined(cells, width) if delimiter == " " else cells
            told = any(_is_unit(_unit_in(cell)) or _is_unit(_unit(cell)) for cell in found)
            if len(found) == width and (told or _names(wanted, found)):
                yield number, found


def _names(wanted: set[str], cells: list[str]) -> bool:
    """Whether columns were asked for by name, and these are among the cells."""
    return bool(wanted) and wanted <= {*cells, *map(without_unit, cells)}


def _head(titles: list[Row], wanted: set[str]) -> tuple[list[str], list[str], int]:
    """Names and units of the columns, and the line of the units."""
    # A line of units may have some of what is not read.
    held = [_is_unit(_unit(cell)) for cell in titles[-1][1] if cell] if titles else []
    line, units = titles.pop() if any(held) and 2 * sum(held) >= len(held) else (0, [])
    named = [row for row in titles if _names(wanted, row[1])]
    at, names = (named or titles or [(0, [])])[-1]
    return names, [*map(_unit, units)] or [*map(_unit_in, names)], line or at


def without_unit(name: str) -> str:
    """The name of a column before the unit that it ends with."""
    found = re.fullmatch(_WITH_UNIT, name)
    if found is not None:
        return found[1]
    ending = re.search(_ENDING, name)
    if ending is None or not _is_unit(_unit(ending[1])):
        return name
    return name[: ending.start()].removesuffix(" in")


def _unit_in(name: str) -> str:
    """The last unit that a name has: one that is known, or else what stands in place of one."""
    told = [_unit("".join(groups)) for groups in re.findall(_TOLD, name)]
    words = [*told, *map(_unit, re.findall(_ENDING, name))]
    return next((each for each in reversed(words) if _is_unit(each)), (told or [""])[-1])


def _unit(text: str) -> str:
    return text.strip("[](). ")


def _is_unit(text: str) -> bool:
    return text.lower() in METRES


def _joined(cells: list[str], width: int) -> list[str]:
    """Words between blanks, a unit in brackets or after a stroke with the word before.

    And a bare one, where words are more than the columns.
    """
    words: list[str] = re.findall(_WORD, " ".join(cells))
    if len(words) <= width:
        return words
    joined: list[str] = []
    for word in words:
        if joined and _is_unit(word):
            joined[-1] += f" {word}"
        else:
            joined.append(word)
    return joined if len(joined) == width else words


def erd_of(lines: Lines) -> Sheet:
    """Samples of an ERD file, which may run over several lines.

    Road profilers and profile viewers exchange data in it (University of Michigan Transportation
    Research Institute, Engineering Research Division): the second line has the numbers of channels,
    samples, records and bytes, the kind of data and the step, 0 if the first channel says where
    samples are; lines that begin with a word of eight letters follow up to ``END``, and then the
    data, here as text.
    """
    head = [*islice(lines(), _LONGEST)]
    end = next((k for k, line in enumerate(head) if line.strip() == "END"), None)
    if end is None:
        raise InputError(f"line {len(head)}", None, "the header has no line END before")
    given = [each.strip() for each in head[1].split(",")]
    try:
        channels, samples, step = int(given[0]), int(given[1]), float(given[5])
    except (IndexError, ValueError):
        allowed = "must be the numbers of channels, samples, records and bytes, the kind, the step"
        raise InputError("line 2", None, f"{head[1].strip()!r}: {allowed}") from None
    if channels < 1 or not step >= 0.0:
        allowed = "must have channels and a step that is not negative"
        raise InputError("line 2", None, f"{head[1].strip()!r}: {allowed}")
    # Of keywords that come again, such as TITLE, the first.
    said = {line[:8].strip().upper(): line[8:].rstrip("\r\n") for line in reversed(head[2:end])}

    def fields(key: str, width: int) -> list[str]:
        text = said.get(key, "")
        found = [text[k : k + width].strip() for k in range(0, len(text), width)]
        return found[:channels] if len(found) >= channels else []

    start = said.get("XSTART", "").strip()
    try:
        along = (float(start or 0.0), step, said.get("XUNITS", "").strip() or "m")
    except ValueError:
        raise InputError(f"XSTART {start!r}", None, "must be a number") from None

    def rows() -> Iterator[Row]:
        number, pending = end + 1, []
        for number, line in enumerate(islice(lines(), end + 1, None), end + 2):
            pending += line.replace(",", " ").split()
            whole = len(pending) - len(pending) % channels
            for k in range(0, whole, channels):
                yield number, pending[k : k + channels]
            pending = pending[whole:]
        if pending:
            held = f"{len(pending)} of {channels} channels"
            raise InputError(f"line {number}", None, f"the last sample has {held}")

    names = fields("LONGNAME", 32) or fields("SHORTNAM", 8)
    units = fields("UNITSNAM", 8)
    return Sheet(rows(), names, units, along=along if step > 0.0 else None, expected=samples)
