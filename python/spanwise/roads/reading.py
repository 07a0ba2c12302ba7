"""Points of a profile from a file as people have them: a table of text, or an ERD file."""

from __future__ import annotations

import csv
import io
import stat
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import items, number, numbers, positive, shown, text
from spanwise._keys import suggestion
from spanwise.errors import InputError, refused
from spanwise.roads import erd
from spanwise.roads.sheet import Column, Row, Sheet, erd_of, table_of, without_unit
from spanwise.roads.sniffing import encoding_of, is_number, value_of

Array: TypeAlias = NDArray[np.float64]

#: Largest file that is read [bytes].
MAX_BYTES: Final = 2**27

#: Lines that become numbers at a time.
_BLOCK: Final = 100_000

#: What stands for blank cells.
NAN: Final = float("nan")

#: Most columns that are averaged.
MOST_COLUMNS: Final = 100


def read_points(
    path: Path,
    columns: object,
    spacing: object,
    delimiter: object,
    decimal: object,
    scale: object,
    missing: object,
) -> tuple[Array, Array, Array]:
    """x and elevation [m] of each point and the line it is on, as in the file; see `Profile.read`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it holds no such points, naming the line, or a value is not allowed.
    """
    step = None if spacing is None else positive("spacing", spacing)
    wanted = _columns(columns)
    factors = None if scale is None else _factors(scale)
    mark = None if delimiter is None else _delimiter(delimiter)
    gone = None if missing is None else number("missing", missing)
    point = None if decimal is None else text("decimal", decimal)
    if point not in (None, ".", ","):
        raise refused("decimal", decimal, "must be . or ,")
    content = _content(path)
    try:
        encoding = encoding_of(content)

        def lines() -> Iterator[str]:
            return io.TextIOWrapper(io.BytesIO(content), encoding=encoding, newline="")

        if next(lines(), "").startswith(erd.MARK):
            for key, value in (("spacing", spacing), ("delimiter", mark), ("decimal", point)):
                if value is not None:
                    raise refused(key, value, "not used with ERD files")
            sheet = erd_of(lines)
        else:
            _check_columns(wanted, has_x=step is None)
            sheet = table_of(lines, wanted or ((0, 1) if step is None else (0,)), mark, point)
            sheet.along = None if step is None else (0.0, step, "m")
        return _points(sheet, wanted, factors, gone)
    except (csv.Error, UnicodeError) as error:
        raise InputError(path, None, f"not a file of separated values: {error}") from None
    except ValueError as error:
        found = InputError.of(error)
        if found.key.startswith("line "):
            raise InputError(f"{path}, {found.key}", found.value, found.allowed) from None
        raise found.within(str(path)) from None


def _content(path: Path) -> bytes:
    """All of a file that is not too large."""
    status = path.stat()
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "not a regular file"
        raise InputError(path, None, f"is {kind}; a profile is a file of numbers")
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1) if status.st_size <= MAX_BYTES else None
    if content is None or len(content) > MAX_BYTES:
        raise InputError(path, None, f"is too large; a profile has at most {MAX_BYTES} bytes")
    return content


def _points(
    sheet: Sheet,
    wanted: tuple[Column, ...] | None,
    factors: tuple[float, float] | None,
    missing: float | None,
) -> tuple[Array, Array, Array]:
    first = next(sheet.rows, None)
    if first is None:
        if sheet.expected > 0:
            raise ValueError("no numbers after END; save the data of an ERD file as text")
        return np.empty(0), np.empty(0), np.empty(0)
    places = _places(sheet, first, wanted)
    heights = places if sheet.along is not None else places[1:]
    found: list[Array] = [np.empty(0)] * len(places)
    lines: Array = np.empty(0)
    rows = chain([first], sheet.rows)
    while block := list(islice(rows, _BLOCK)):
        columns = _columns_of(block, places, sheet.decimal, heights, missing)
        found = [np.append(column, each) for column, each in zip(found, columns, strict=True)]
        lines = np.append(lines, np.array([line for line, _ in block], dtype=np.float64))
    if 0 < sheet.expected != len(lines):
        raise ValueError(f"has {len(lines)} samples, and its header says {sheet.expected}")
    kept = np.full(len(lines), True)
    if missing is not None:
        for track in found[-len(heights) :]:
            kept &= ~np.isnan(track) if np.isnan(missing) else track != missing
    if factors is None:
        found = [sheet.metres(place) * each for place, each in zip(places, found, strict=True)]
    way = 1.0
    if sheet.along is None:
        x, *tracks = found
    else:
        start, step, _ = sheet.along
        x, tracks = start + step * np.arange(len(lines), dtype=np.float64), found
        way = sheet.metres(None) if factors is None else 1.0
    if factors is not None:
        way, height = factors
        tracks = [height * track for track in tracks]
    elevations = sum(tracks[1:], tracks[0]) / len(tracks)
    return way * x[kept], elevations[kept], lines[kept]


def _columns_of(
    block: list[Row], places: list[int], decimal: str, heights: list[int], missing: float | None
) -> list[Array]:
    """Columns of numbers; those that NumPy reads all at once, others one by one.

    Blank elevations are NaN, if these are missing.
    """
    try:
        texts = [[cells[place] for _, cells in block] for place in places]
        if any("_" in "".join(column) for column in texts):
            raise ValueError("NumPy would take 1_000 for a number")
        if decimal == ",":
            # A point is no decimal mark then, and NumPy is to refuse it.
            marks = str.maketrans({",": ".", ".": "?"})
            texts = [[text.translate(marks) for text in column] for column in texts]
        return [np.array(column, dtype=np.float64) for column in texts]
    except (ValueError, IndexError):
        return [
            np.array([_number(row, place, decimal, place in heights, missing) for row in block])
            for place in places
        ]


def _places(sheet: Sheet, first: Row, wanted: tuple[Column, ...] | None) -> list[int]:
    """Numbers of the columns."""
    line, cells = first
    where = f"line {line}"
    if wanted is None:
        held = sum(cell != "" for cell in cells)
        if sheet.along is None:
            if held == 1:
                allowed = "if it has elevations, give their spacing"
                raise InputError(where, None, f"1 column; {allowed}")
            if len(sheet.names) > 2 and held > 2:
                named = f"{held} columns: {', '.join(sheet.names)}"
                allowed = "give that of x and one elevation in columns"
                raise InputError(where, None, f"{named}; {allowed}, or several for their mean")
            wanted = (0, 1)
        elif held == 1:
            wanted = (0,)
        else:
            named = f": {', '.join(sheet.names)}" if sheet.names else ""
            allowed = "give one in columns, or several for their mean"
            raise InputError(where, None, f"{held} columns of elevations{named}; {allowed}")
    _check_columns(wanted, has_x=sheet.along is None)
    found = []
    for k, column in enumerate(wanted):
        key = f"columns[{k}] = {shown(column)}"
        if isinstance(column, int):
            found.append(column)
        elif (place := _place_of(column, sheet.names)) is not None:
            found.append(place)
        elif not sheet.names:
            raise InputError(where, None, f"{key}: the file has no line of names; give a number")
        else:
            allowed = f"must be one of {', '.join(sheet.names)}{suggestion(column, sheet.names)}"
            raise InputError(where, None, f"{key}: {allowed}")
    return found


def _place_of(column: str, names: list[str]) -> int | None:
    """Which column has this name, or alone has it without its unit."""
    if column in names:
        return names.index(column)
    found = [place for place, name in enumerate(names) if without_unit(name) == column]
    return found[0] if len(found) == 1 else None


def _number(row: Row, column: int, decimal: str, is_height: bool, missing: float | None) -> float:
    line, cells = row
    if column >= len(cells):
        other = next((each for each in (";", "\t", "|", " ") if each in cells[0]), None)
        hint = "" if other is None else f"; is the delimiter {other!r}?"
        raise InputError(
            f"line {line}", None, f"{len(cells)} columns, column {column} (from 0) is missing{hint}"
        )
    cell = cells[column]
    if is_height and cell == "":
        if missing is not None and np.isnan(missing):
            return missing
        leaves = "missing = nan leaves such points out"
        raise InputError(f"line {line}", None, f"column {column} is blank; {leaves}")
    value = value_of(cell, decimal)
    if value is None:
        hint = ""
        if is_number(cell):
            hint = f"; is the decimal mark {',' if decimal == '.' else '.'!r}?"
        elif ";" in cell or "\t" in cell:
            hint = f"; is the delimiter {';' if ';' in cell else chr(9)!r}?"
        raise InputError(
            f"line {line}", None, f"{shown(cell)} in column {column} is not a number{hint}"
        )
    return value


def _columns(columns: object) -> tuple[Column, ...] | None:
    """Columns that were asked for: of x, if it has one, and of one elevation or more."""
    if columns is None:
        return None
    several = [columns] if isinstance(columns, str | int | np.integer) else columns
    asked = items("columns", several, "names or numbers of columns")
    if not 1 <= len(asked) <= MOST_COLUMNS:
        raise refused("columns", columns, f"must be 1 to {MOST_COLUMNS} columns")
    found: list[Any] = []
    for k, each in enumerate(asked):
        is_place = isinstance(each, int | np.integer) and not isinstance(each, bool) and each >= 0
        if not (is_place or isinstance(each, str)):
            allowed = "must be a column's name or its number from 0"
            raise refused(f"columns[{k}]", each, allowed)
        found.append(int(each) if is_place else each)
    return tuple(found)


def _check_columns(wanted: tuple[Column, ...] | None, *, has_x: bool) -> None:
    """Refuses x without an elevation."""
    if has_x and wanted is not None and len(wanted) < 2:
        allowed = "must be that of x and one elevation or more"
        other = "or give spacing in place of x"
        raise refused("columns", list(wanted), f"{allowed}; {other}")


def _factors(scale: object) -> tuple[float, float]:
    factors = numbers("scale", scale)
    if len(factors) != 2:
        raise refused("scale", scale, "must be two factors, of x and elevation")
    return factors[0], factors[1]


def _delimiter(delimiter: object) -> str:
    """One character; a tab also as it is written."""
    key = "delimiter"
    found = text(key, delimiter)
    found = "\t" if found == r"\t" else found
    if len(found) != 1 or found in '\r\n"':
        raise refused(key, delimiter, "must be one character, or \\t for a tab")
    return found
