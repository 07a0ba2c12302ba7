"""What a file of measured points holds: rows of cells, and what its head says of the columns."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import chain, islice
from typing import Final, TypeAlias

from spanwise._checks import shown
from spanwise.errors import InputError
from spanwise.roads import erd
from spanwise.roads.sniffing import DELIMITERS, decimal_of, delimiter_of, rows_of, value_of

#: Number or name of a column.
Column: TypeAlias = int | str
#: Number and cells of a line.
Row: TypeAlias = tuple[int, list[str]]

#: Lines from which delimiter and decimal mark are found.
_SEEN: Final = 200

#: Metres in the units that headings name.
METRES: Final = {
    "m": 1.0,
    "metre": 1.0,
    "metres": 1.0,
    "meter": 1.0,
    "meters": 1.0,
    "dm": 0.1,
    "cm": 1e-2,
    "mm": 1e-3,
    "µm": 1e-6,
    "μm": 1e-6,
    "um": 1e-6,
    "km": 1e3,
    "yd": 0.9144,
    "yard": 0.9144,
    "yards": 0.9144,
    "ft": 0.3048,
    "foot": 0.3048,
    "feet": 0.3048,
    "in": 0.0254,
    "inch": 0.0254,
    "inches": 0.0254,
    "mil": 2.54e-5,
    "mils": 2.54e-5,
}

#: Units that a name has, in brackets or after a stroke, and its last word, which may be one.
_TOLD: Final = re.compile(r"\[([^\]]*)\]|\(([^)]*)\)|\s/\s*([^\s/]+)$")
_ENDING: Final = re.compile(r"[\s_/,]([^\s_/,]+)$")
#: A name and its unit in brackets or after a stroke.
_WITH_UNIT: Final = re.compile(r"(.*?\S)\s*(?:\[[^\]]*\]|\([^)]*\)|\s/\s*[^\s/]+)")
#: A name between blanks with its units, or a unit alone.
_WORD: Final = re.compile(r"\[[^\]]*\]|\([^)]*\)|\S+(?: \[[^\]]*\]| \([^)]*\)| / ?\S+)*")


@dataclass
class Sheet:
    """Rows of a file with what its head says of the columns.

    Attributes
    ----------
    rows : iterator of (int, list of str)
        Line number and cells of each.
    names, units : list of str
        Of the columns; empty if they have none.
    decimal : str
        Decimal mark.
    along : tuple of (float, float, str) or None
        Place of the first row, distance of the rows and their unit, where no column has x.
    expected : int
        Number of rows that there should be; less than 1 if it is not known.
    is_strict : bool
        Whether what is said in place of units is meant to be one, and not any words in brackets.
    head : int
        Number of the line that has the units; 0 if it is not known.
    """

    rows: Iterator[Row]
    names: list[str] = field(default_factory=list)
    units: list[str] = field(default_factory=list)
    decimal: str = "."
    along: tuple[float, float, str] | None = None
    expected: int = 0
    is_strict: bool = False
    head: int = 0

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
    lines: Callable[[], Iterator[str]],
    columns: tuple[Column, ...],
    delimiter: str | None,
    decimal: str | None,
) -> Sheet:
    """Rows of separated values, with a head of titles, names and units or without."""
    least, places = len(columns), [each for each in columns if isinstance(each, int)]
    seen = [line for line in islice(lines(), _SEEN) if not line.lstrip().startswith("#")]
    if delimiter is None:
        delimiter = delimiter_of(seen, least, decimal)
    if decimal is None:
        decimal = decimal_of((cells for _, cells in rows_of(seen, delimiter)), least)
    rows = rows_of(lines(), delimiter)
    lead: list[tuple[Row, int]] = []
    first: list[Row] = []
    for row in rows:
        held = [k for k, cell in enumerate(row[1]) if value_of(cell, decimal) is not None]
        if (len(held) >= least and set(places).issubset(held)) or len(lead) == _SEEN:
            first = [row]
            break
        lead.append((row, len(held)))
    # The head ends with its last line without any number; what follows is meant to be points.
    head = max((k for k, (_, numbers) in enumerate(lead, 1) if numbers == 0), default=0)
    if lead and head == len(lead) and not first:
        (line, cells), _ = lead[-1]
        other = next((each for each in DELIMITERS if any(each in cell for cell in cells)), None)
        hint = "" if other is None else f"; is the delimiter {other!r}?"
        raise InputError(
            f"line {line}",
            None,
            f"no numbers in {shown(delimiter.join(cells))}, the last line{hint}",
        )
    points = chain((row for row, _ in lead[head:]), first, rows)
    titles = [row for row, numbers in lead[:head] if numbers == 0]
    width = len((first or [row for row, _ in lead[head:]] or [(0, [])])[0][1])
    if not titles:
        titles = [*_remarks(lines(), delimiter, width, columns)]
    line, names, units = _head(titles, delimiter, width, columns)
    # Square brackets are for units; where one is known, all others are meant to be.
    is_strict = any(map(_is_unit, units)) or any("[" in name for name in names)
    return Sheet(points, names, units, decimal, is_strict=is_strict, head=line)


def _remarks(
    lines: Iterator[str], delimiter: str, width: int, columns: tuple[Column, ...]
) -> Iterator[Row]:
    """Comments before the points that have as many cells, and name units or columns asked for."""
    words = {each for each in columns if isinstance(each, str)}
    for number, line in enumerate(islice(lines, _SEEN), 1):
        text = line.lstrip()
        if not text.startswith("#"):
            if text:
                return
            continue
        for _, cells in rows_of([text.lstrip("# ")], delimiter):
            found = _joined(cells, width) if delimiter == " " else cells
            names = {*found, *map(without_unit, found)}
            told = any(_is_unit(_unit_in(cell)) or _is_unit(_unit(cell)) for cell in found)
            if len(found) == width and (told or (words and words <= names)):
                yield number, cells


def _head(
    rows: list[Row], delimiter: str, width: int, columns: tuple[Column, ...]
) -> tuple[int, list[str], list[str]]:
    """Names and units of the columns, and the line of the units."""
    titles = [(line, _joined(cells, width) if delimiter == " " else cells) for line, cells in rows]
    units: list[str] = []
    line = 0
    # A line of units may have some of what is not read.
    held = [_is_unit(_unit(cell)) for cell in titles[-1][1] if cell] if titles else []
    if any(held) and 2 * sum(held) >= len(held):
        line, cells = titles.pop()
        units = [_unit(cell) for cell in cells]
    words = {each for each in columns if isinstance(each, str)}
    named = [row for row in titles if words and words <= {*row[1], *map(without_unit, row[1])}]
    at, names = (named or titles or [(0, [])])[-1]
    return line or at, names, units or [_unit_in(name) for name in names]


def without_unit(name: str) -> str:
    """The name of a column before the unit that it ends with."""
    found = _WITH_UNIT.fullmatch(name)
    if found is not None:
        return found[1]
    ending = _ENDING.search(name)
    if ending is None or not _is_unit(_unit(ending[1])):
        return name
    return name[: ending.start()].removesuffix(" in")


def _unit_in(name: str) -> str:
    """The last unit that a name has: one that is known, or else what stands in place of one."""
    told = [_unit("".join(groups)) for groups in _TOLD.findall(name)]
    ending = _ENDING.search(name)
    words = [*told, *([] if ending is None else [_unit(ending[1])])]
    return next((each for each in reversed(words) if _is_unit(each)), (told or [""])[-1])


def _unit(text: str) -> str:
    return text.strip("[](). ")


def _is_unit(text: str) -> bool:
    return text.lower() in METRES


def _joined(cells: list[str], width: int) -> list[str]:
    """Words between blanks, a unit in brackets or after a stroke with the word before.

    And a bare one, where words are more than the columns.
    """
    words: list[str] = _WORD.findall(" ".join(cells))
    if len(words) <= width:
        return words
    joined: list[str] = []
    for word in words:
        if joined and _is_unit(word):
            joined[-1] += f" {word}"
        else:
            joined.append(word)
    return joined if len(joined) == width else words


def erd_of(lines: Callable[[], Iterator[str]]) -> Sheet:
    """Samples of an ERD file, which may run over several lines."""
    header = erd.header_of(list(islice(lines(), erd.LONGEST)))
    along = (header.start, header.step, header.unit or "m") if header.step > 0.0 else None

    def rows() -> Iterator[Row]:
        number, pending = header.lines, []
        for number, line in enumerate(islice(lines(), header.lines, None), header.lines + 1):
            pending += line.replace(",", " ").split()
            whole = len(pending) - len(pending) % header.channels
            for k in range(0, whole, header.channels):
                yield number, pending[k : k + header.channels]
            pending = pending[whole:]
        if pending:
            held = f"{len(pending)} of {header.channels} channels"
            raise InputError(f"line {number}", None, f"the last sample has {held}")

    return Sheet(
        rows(), header.names, header.units, along=along, expected=header.samples, is_strict=True
    )
