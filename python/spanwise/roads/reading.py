"""Points of a profile from a file as people have them: a table of text, or an ERD file."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import items, number, numbers, positive, shown, text
from spanwise._content import content_of
from spanwise._keys import suggestion
from spanwise.errors import InputError, refused
from spanwise.roads.sheet import Column, Row, Sheet, erd_of, table_of, without_unit
from spanwise.roads.sniffing import MARK, encoding_of, is_number, value_of

Array: TypeAlias = NDArray[np.float64]

#: Largest file that is read [bytes].
MAX_BYTES: Final = 2**27

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
    wanted = None if columns is None else _columns(columns)
    factors = None if scale is None else numbers("scale", scale)
    if factors is not None and len(factors) != 2:
        raise refused("scale", scale, "must be two factors, of x and elevation")
    mark = None if delimiter is None else text("delimiter", delimiter).replace(r"\t", "\t")
    if mark is not None and (len(mark) != 1 or mark in '\r\n"'):
        raise refused("delimiter", delimiter, "must be one character, or \\t for a tab")
    gone = None if missing is None else number("missing", missing)
    point = None if decimal is None else text("decimal", decimal)
    if point not in (None, ".", ","):
        raise refused("decimal", decimal, "must be . or ,")
    content = content_of(path, MAX_BYTES, "a profile", "a file of numbers")
    try:
        encoding = encoding_of(content)

        def lines() -> Iterator[str]:
            return io.TextIOWrapper(io.BytesIO(content), encoding=encoding, newline="")

        if next(lines(), "").startswith(MARK):
            for key, value in (("spacing", spacing), ("delimiter", mark), ("decimal", point)):
                if value is not None:
                    raise refused(key, value, "not used with ERD files")
            sheet = erd_of(lines)
        else:
            has_x = step is None
            _check_columns(wanted, has_x=has_x)
            sheet = table_of(lines, wanted or ((0, 1) if has_x else (0,)), mark, point)
            sheet.along = None if step is None else (0.0, step, "m")
        return _points(sheet, wanted, factors, gone)
    except (csv.Error, UnicodeError) as error:
        raise InputError(path, None, f"not a file of separated values: {error}") from None
    except ValueError as error:
        found = InputError.of(error)
        if found.key.startswith("line "):
            raise InputError(f"{path}, {found.key}", found.value, found.allowed) from None
        raise found.within(str(path)) from None


def _points(
    sheet: Sheet,
    wanted: tuple[Column, ...] | None,
    factors: Sequence[float] | None,
    missing: float | None,
) -> tuple[Array, Array, Array]:
    first = next(sheet.rows, None)
    if first is None and sheet.expected > 0:
        raise InputError("", None, "no numbers after END; save the data of an ERD file as text")
    if first is None:
        return np.empty(0), np.empty(0), np.empty(0)
    places = _places(sheet, first, wanted)
    heights = places if sheet.along is not None else places[1:]
    found = _at_once(sheet, first[0], places)
    if found is None:
        found = np.fromiter(
            (
                number
                for row in chain([first], sheet.rows)
                for number in (*_numbers(row, places, sheet.decimal, heights, missing), row[0])
            ),
            np.float64,
        ).reshape(-1, len(places) + 1)
    *columns, lines = found.T
    if 0 < sheet.expected != len(lines):
        said = f"has {len(lines)} samples, and its header says {sheet.expected}"
        raise InputError("", None, said)
    kept = np.full(len(lines), True)
    for track in columns[-len(heights) :] if missing is not None else ():
        kept &= ~np.isnan(track) if missing != missing else track != missing
    if sheet.along is not None:
        start, step, _ = sheet.along
        columns.insert(0, start + step * np.arange(len(lines), dtype=np.float64))
    if factors is None:
        ups = [sheet.metres(place) for place in places]
        way = ups.pop(0) if sheet.along is None else sheet.metres(None)
    else:
        way, ups = factors[0], len(heights) * [factors[1]]
    x, *tracks = (each * column for each, column in zip((way, *ups), columns, strict=True))
    elevations = sum(tracks[1:], tracks[0]) / len(tracks)
    return x[kept], elevations[kept], lines[kept]


def _at_once(sheet: Sheet, first: int, places: list[int]) -> Array | None:
    """Columns from a line on as NumPy reads them, and the lines; or nothing where it cannot."""
    if sheet.lines is None:
        return None
    held = enumerate(islice(sheet.lines(), first - 1, None), first)
    rows = [(number, line) for number, line in held if line.strip() and line.lstrip()[0] != "#"]
    # A point is no decimal mark beside commas, and NumPy is to refuse it.
    marks = str.maketrans({",": ".", ".": "?"} if sheet.decimal == "," else {})
    try:
        found = np.loadtxt(
            (line.translate(marks) for _, line in rows),
            delimiter=None if sheet.delimiter == " " else sheet.delimiter,
            usecols=places,
            comments=None,
            quotechar='"',
            ndmin=2,
        )
    except ValueError:
        return None
    lines = np.array([number for number, _ in rows], dtype=np.float64)
    return np.column_stack([found, lines]) if len(found) == len(lines) else None


def _numbers(
    row: Row, places: list[int], decimal: str, heights: list[int], missing: float | None
) -> Iterator[float]:
    """Numbers of a row; blank elevations are NaN, if these are missing."""
    for place in places:
        blank = place in heights and place < len(row[1]) and row[1][place] == ""
        if blank and missing is not None and np.isnan(missing):
            yield missing
        elif blank:
            leaves = "missing = nan leaves such points out"
            raise InputError(f"line {row[0]}", None, f"column {place} is blank; {leaves}")
        else:
            yield _number(row, place, decimal)


def _places(sheet: Sheet, first: Row, wanted: tuple[Column, ...] | None) -> list[int]:
    """Numbers of the columns."""
    line, cells = first
    where, has_x = f"line {line}", sheet.along is None
    held = sum(cell != "" for cell in cells)
    if wanted is None and has_x and held == 1:
        raise InputError(where, None, "1 column; if it has elevations, give their spacing")
    if wanted is None and held > 1 + has_x and (len(sheet.names) > 2 or not has_x):
        named = f": {', '.join(sheet.names)}" if sheet.names else ""
        of, one = ("", "that of x and one elevation") if has_x else (" of elevations", "one")
        allowed = f"give {one} in columns, or several for their mean"
        raise InputError(where, None, f"{held} columns{of}{named}; {allowed}")
    wanted = wanted or ((0, 1) if has_x else (0,))
    _check_columns(wanted, has_x=has_x)
    found = []
    for k, column in enumerate(wanted):
        place = column if isinstance(column, int) else _place_of(column, sheet.names)
        if place is None:
            allowed = f"must be one of {', '.join(sheet.names)}{suggestion(column, sheet.names)}"
            none = "the file has no line of names; give a number"
            said = allowed if sheet.names else none
            raise refused(f"{where}: columns[{k}]", column, said)
        found.append(place)
    return found


def _place_of(column: str, names: list[str]) -> int | None:
    """Which column has this name, or alone has it without its unit."""
    if column in names:
        return names.index(column)
    found = [place for place, name in enumerate(names) if without_unit(name) == column]
    return found[0] if len(found) == 1 else None


def _number(row: Row, column: int, decimal: str) -> float:
    """One number, or what is wrong with it."""
    line, cells = row
    if column >= len(cells):
        other = next((each for each in ";\t| " if each in cells[0]), None)
        hint = "" if other is None else f"; is the delimiter {other!r}?"
        said = f"{len(cells)} columns, column {column} (from 0) is missing{hint}"
        raise InputError(f"line {line}", None, said)
    cell = cells[column]
    value = value_of(cell, decimal)
    if value is None:
        other = next((each for each in ";\t" if each in cell), None)
        hint = "" if other is None else f"; is the delimiter {other!r}?"
        if is_number(cell):
            hint = f"; is the decimal mark {',' if decimal == '.' else '.'!r}?"
        said = f"{shown(cell)} in column {column} is not a number{hint}"
        raise InputError(f"line {line}", None, said)
    return value


def _columns(columns: object) -> tuple[Column, ...]:
    """Columns that were asked for: of x, if it has one, and of one elevation or more."""
    several = [columns] if isinstance(columns, str | int | np.integer) else columns
    asked = items("columns", several, "names or numbers of columns")
    if not 1 <= len(asked) <= MOST_COLUMNS:
        raise refused("columns", columns, f"must be 1 to {MOST_COLUMNS} columns")
    for k, each in enumerate(asked):
        is_place = isinstance(each, int | np.integer) and not isinstance(each, bool) and each >= 0
        if not (is_place or isinstance(each, str)):
            allowed = "must be a column's name or its number from 0"
            raise refused(f"columns[{k}]", each, allowed)
    return tuple(each if isinstance(each, str) else int(each) for each in asked)


def _check_columns(wanted: tuple[Column, ...] | None, *, has_x: bool) -> None:
    """Refuses x without an elevation."""
    if has_x and wanted is not None and len(wanted) < 2:
        allowed = "must be that of x and one elevation or more"
        other = "or give spacing in place of x"
        raise refused("columns", list(wanted), f"{allowed}; {other}")
