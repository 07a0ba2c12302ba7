"""Measured roads."""

from __future__ import annotations

import csv
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise import _core
from spanwise._checks import as_array, flag, number, numbers, pairs, shown, word
from spanwise._keys import suggestion
from spanwise._warnings import PlausibilityWarning
from spanwise.roads._doubts import doubts
from spanwise.roads.base import CONTACT_PATCH, Road

Array: TypeAlias = NDArray[np.float64]

#: Number or name of a column.
Column: TypeAlias = int | str


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Profile(Road):
    """A measured profile: a cubic spline through points at any spacing.

    Parameters
    ----------
    x : array_like
        Positions [m], at least 4, strictly increasing; shape (points,).
    elevations : array_like
        Elevations [m], positive up; shape (points,).
    detrend : bool, optional
        Whether to take off the least-squares line, such as a gradient or the height above a datum.
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none, where the measurement did so already.
    max_gap : float, optional
        Largest distance of neighbouring points [m]; without, five times the median one.

    Raises
    ------
    ValueError
        If points are out of order, double, too far apart, too few or not finite, naming the first.

    Warns
    -----
    PlausibilityWarning
        If it is so steep that elevations are hardly in metres, or points look like drop-outs.

    Notes
    -----
    Of the curves through the points the spline is the smoothest, with continuous curvature, and it
    keeps waves down to a few points long better than cubics with slopes from neighbouring points,
    which flatten them. Its third derivative is continuous at the second point and the last but one
    ("not a knot"). The road is known from the first point to the last. Where half a contact patch
    reaches beyond, the tangent at the end goes on.

    In a crossing neither the height above the sea nor the grade counts for vertical motion: that is
    counted from the chord of the profile between the start of the approach and the far end of the
    bridge. `detrend` is for what else is made of the elevations.
    """

    kind: ClassVar[str] = "profile"
    _heights: ClassVar[tuple[str, ...]] = ("elevations",)

    x: Array
    elevations: Array
    detrend: bool
    contact_patch: float
    max_gap: float | None

    def __init__(
        self,
        x: ArrayLike,
        elevations: ArrayLike,
        *,
        detrend: bool = False,
        contact_patch: float = CONTACT_PATCH,
        max_gap: float | None = None,
    ) -> None:
        self._set(
            x=_column("x", x),
            elevations=_column("elevations", elevations),
            detrend=flag("detrend", detrend),
            contact_patch=number("contact_patch", contact_patch),
            max_gap=None if max_gap is None else number("max_gap", max_gap),
        )
        self.__post_init__()
        for doubt in doubts(self.x, self.elevations):
            warnings.warn(doubt, PlausibilityWarning, stacklevel=2)

    def _made(self) -> _core.Road:
        return _core.Road.profile(
            x=self.x,
            elevation=self.elevations,
            detrend=self.detrend,
            contact_patch=self.contact_patch,
            max_gap=self.max_gap,
        )

    @classmethod
    def read_csv(
        cls,
        path: str | Path,
        *,
        columns: tuple[Column, Column] = (0, 1),
        delimiter: str = ",",
        scale: tuple[float, float] = (1.0, 1.0),
        sort: bool = False,
        duplicates: Literal["refuse", "mean"] = "refuse",
        detrend: bool = False,
        contact_patch: float = CONTACT_PATCH,
        max_gap: float | None = None,
    ) -> Profile:
        """A profile from a file of separated values.

        Parameters
        ----------
        path : str or Path
            The file, UTF-8 text. Empty lines and lines that begin with ``#`` are passed over, and
            so is the first line if it holds names.
        columns : tuple of int or str, optional
            Numbers, from 0, or names of the columns with x and elevation.
        delimiter : str, optional
            What separates the columns.
        scale : tuple of float, optional
            What x and elevation are multiplied by to give metres, such as ``(1.0, 1e-3)`` for
            elevations in millimetres.
        sort : bool, optional
            Whether to bring the points into the order of x.
        duplicates : {"refuse", "mean"}, optional
            What becomes of neighbouring points with the same x: the mean of their elevations, or
            an error.
        detrend, contact_patch, max_gap
            As for `Profile`.

        Raises
        ------
        OSError
            If the file cannot be read.
        ValueError
            If it holds no profile, naming the line, or a value is not allowed.

        Warns
        -----
        PlausibilityWarning
            As for `Profile`.
        """
        factors = numbers("scale", scale)
        if len(factors) != 2:
            raise ValueError(f"scale = {shown(scale)}: must be two factors, of x and elevation")
        if word("duplicates", duplicates) not in ("refuse", "mean"):
            raise ValueError(f"duplicates = {shown(duplicates)}: must be refuse or mean")
        rows = list(_rows(Path(path), columns, delimiter))
        x, elevations, lines = np.array(rows, dtype=float).reshape(-1, 3).T
        x, elevations = factors[0] * x, factors[1] * elevations
        if flag("sort", sort):
            order = np.argsort(x, kind="stable")
            x, elevations, lines = x[order], elevations[order], lines[order]
        if duplicates == "mean" and len(x):
            first = np.append(True, np.diff(x) != 0.0)
            group = np.cumsum(first) - 1
            elevations = np.bincount(group, elevations) / np.bincount(group)
            x, lines = x[first], lines[first]
        try:
            return cls(x, elevations, detrend=detrend, contact_patch=contact_patch, max_gap=max_gap)
        except ValueError as error:
            raise ValueError(_in_file(str(error), Path(path), x, lines)) from None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Profile):
            return NotImplemented
        return self._identity() == other._identity()

    def __hash__(self) -> int:
        return hash(self._identity())

    def __repr__(self) -> str:
        first, last = self.ends
        return (
            f"Profile({len(self.x)} points from {first:g} m to {last:g} m, detrend={self.detrend}, "
            f"contact_patch={self.contact_patch}, max_gap={self.max_gap})"
        )

    def _identity(self) -> tuple[object, ...]:
        points = (self.x.tobytes(), self.elevations.tobytes())
        return (*points, self.detrend, self.contact_patch, self.max_gap)


def _column(key: str, value: ArrayLike) -> Array:
    """Numbers in a row that cannot be changed; whether they are finite is checked one by one."""
    given = as_array(key, value)
    if given.dtype.kind not in "iuf" or given.ndim != 1:
        raise ValueError(f"{key} = {shown(value)}: must be a list of numbers")
    with np.errstate(over="ignore"):
        values = np.array(given, dtype=np.float64)
    values.setflags(write=False)
    return values


def _in_file(message: str, path: Path, x: Array, lines: Array) -> str:
    """What is wrong with a profile, with the line of the file and what may mend it."""
    found = re.match(r"(x|elevations)(?:\[(\d+)\])? = ", message)
    if found is None:
        return message
    if found[2] is None:
        return f"{path}: {message}"
    point = int(found[2])
    where = f"{path}, line {lines[point]:.0f}: {message}"
    if found[1] == "x" and point > 0 and x[point] == x[point - 1]:
        return f'{where}; duplicates = "mean" takes the mean of both'
    if found[1] == "x" and point > 0 and x[point] < x[point - 1]:
        return f"{where}; sort = true sorts the points"
    return where


def _rows(path: Path, columns: object, delimiter: object) -> Iterator[tuple[float, float, int]]:
    """x and elevation of each line, and its number."""
    wanted = pairs("columns", [columns])[0]
    text = word("delimiter", delimiter)
    if len(text) != 1:
        raise ValueError(f"delimiter = {shown(delimiter)}: must be one character")
    places: tuple[int, int] | None = None
    with path.open(encoding="utf-8-sig", newline="") as file:
        reader = csv.reader(file, delimiter=text)
        try:
            for row in reader:
                cells = [cell.strip() for cell in row]
                if not any(cells) or cells[0].startswith("#"):
                    continue
                where = f"{path}, line {reader.line_num}"
                if places is None:
                    names = not any(map(_is_number, cells))
                    places = _places(wanted, cells if names else None, where)
                    if names:
                        continue
                x, elevation = (_number(cells, place, where) for place in places)
                yield x, elevation, reader.line_num
        except (csv.Error, UnicodeDecodeError) as error:
            raise ValueError(f"{path}: not a file of separated values: {error}") from None


def _places(wanted: tuple[object, object], names: list[str] | None, where: str) -> tuple[int, int]:
    """Numbers of both columns."""
    found = []
    for k, column in enumerate(wanted):
        key = f"columns[{k}] = {shown(column)}"
        if isinstance(column, str):
            if names is None:
                raise ValueError(f"{where}: {key}: the file has no line of names; give a number")
            if column not in names:
                allowed = f"must be one of {', '.join(names)}{suggestion(column, names)}"
                raise ValueError(f"{where}: {key}: {allowed}")
            found.append(names.index(column))
        elif isinstance(column, int) and not isinstance(column, bool) and column >= 0:
            found.append(column)
        else:
            raise ValueError(f"{key}: must be a column's name or its number from 0")
    return found[0], found[1]


def _number(cells: list[str], column: int, where: str) -> float:
    if column >= len(cells):
        other = next((each for each in (";", "\t", "|", " ") if each in cells[0]), None)
        hint = "" if other is None else f"; is the delimiter {other!r}?"
        raise ValueError(
            f"{where}: {len(cells)} columns, column {column} (from 0) is missing{hint}"
        )
    text = cells[column]
    if not _is_number(text):
        hint = ""
        if _is_number(text.replace(",", ".")):
            hint = "; decimals need a point, not a comma"
        elif ";" in text or "\t" in text:
            hint = (
                f"; is the delimiter {';' if ';' in text else chr(9)!r}, and the decimal a point?"
            )
        raise ValueError(f"{where}: {shown(text)} in column {column} is not a number{hint}")
    return float(text)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
