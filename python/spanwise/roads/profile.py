"""Measured roads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise import _core
from spanwise._checks import as_array, choice, file_path, finite, flag, number
from spanwise._keys import suggesting
from spanwise._renamed import renamed
from spanwise.errors import InputError, refused
from spanwise.roads._doubts import doubts
from spanwise.roads.base import CONTACT_PATCH, Road
from spanwise.roads.roughness import HELD

if TYPE_CHECKING:
    from pathlib import Path

Array: TypeAlias = NDArray[np.float64]

#: What may become of points with the same x.
_DUPLICATES: Final = ("refuse", "mean", "first", "last")


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
    counted from the least-squares line of the first 10 m from the start of the approach. `detrend`
    is for what else is made of the elevations.

    Of units that nobody tells, elevations in mm, cm and inches are noticed, by slopes as of class F
    or worse, which a road of class F has in metres too. Not noticed are elevations in feet, or x in
    feet or yards, which looks like a longer road: compare `ends` with the length that was measured.
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

    @cached_property
    def _doubts(self) -> tuple[str, ...]:
        return tuple(doubts(self.x, self.elevations))

    @cached_property
    def spacing(self) -> float:
        """Median distance of neighbouring points [m]."""
        return float(np.median(np.diff(self.x)))

    def _spacing_on(self, start: float, end: float) -> float:
        # The core knows how far they are apart nearly everywhere, as the shortest wave they hold.
        return HELD / self._core.waves(start, end)[0]

    def _words(self) -> list[str]:
        return [self.kind, f"{len(self.x)} points from {self.x[0]:g} to {self.x[-1]:g} m"]

    def _made(self) -> _core.Road:
        return _core.Road.profile(
            x=self.x,
            elevation=self.elevations,
            detrend=self.detrend,
            contact_patch=self.contact_patch,
            max_gap=self.max_gap,
        )

    @classmethod
    @suggesting
    def read(
        cls,
        path: str | PathLike[str],
        *,
        columns: Sequence[int | str] | int | str | None = None,
        spacing: float | None = None,
        start: float | None = None,
        delimiter: str | None = None,
        decimal: Literal[".", ","] | None = None,
        scale: tuple[float, float] | None = None,
        missing: float | None = None,
        sort: bool = False,
        duplicates: Literal["refuse", "mean", "first", "last"] = "refuse",
        detrend: bool = False,
        contact_patch: float = CONTACT_PATCH,
        max_gap: float | None = None,
    ) -> Profile:
        """A profile from a file: a table of numbers as text, or an ERD file.

        Parameters
        ----------
        path : str or Path
            The file, of at most 128 MiB; UTF-8, UTF-16 or Windows-1252. Empty lines and lines that
            begin with ``#`` are passed over, and so is a head of lines without numbers: titles,
            names of the columns, units. Without such a head, lines with ``#`` before the points
            count as one if they have as many columns, and units or the names asked for.
        columns : list of int or str, or one of them, optional
            Numbers, from 0, or names of the columns, with their units or without, that have x and
            elevation, or elevation alone beside `spacing` and in ERD files with a step. Of several
            elevations, such as left and right track, the mean is taken. Without, the first two, if
            there are names of no more, or the only elevation.
        spacing : float, optional
            Distance of the points [m], where no column has x.
        start : float, optional
            x of the first point [m], for a file that counts from elsewhere than the left end of
            the bridge: the first station less the station of that end, -180 for a file from
            1000 m on where the bridge begins at 1180 m. Without, as the file has it, or 0 beside
            `spacing`.
        delimiter : str, optional
            What separates the columns; a blank stands for any number of blanks. Without, what
            the file suggests.
        decimal : {".", ","}, optional
            The decimal mark; without, what the file suggests. Whole numbers may be in groups of
            three, and stations as ``1+234.5`` or ``12+34.5``.
        scale : tuple of float, optional
            What x and elevation are multiplied by to give metres, such as ``(1.0, 1e-3)`` for
            elevations in millimetres. Without, by the units that the file names: those of an ERD
            file, a line of units, or units with the names, as in ``z [mm]``, ``z (mm)``,
            ``z / mm``, ``z in mm``, ``z_mm``, and ``x m  z mm`` between blanks.
        missing : float, optional
            The elevation, as the file writes it and before `scale`, that stands for a point that
            was not measured, such as -9999; ``nan`` for cells that are blank or NaN. Such points
            are left out, and the road goes on between their neighbours, `max_gap` apart at most.
        sort : bool, optional
            Whether to bring the points into the order of x. Where x falls from point to point,
            that is done anyway.
        duplicates : {"refuse", "mean", "first", "last"}, optional
            What becomes of neighbouring points with the same x: an error, the mean of their
            elevations, or that of the first or last in the file.
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

        References
        ----------
        University of Michigan Transportation Research Institute, "The ERD file specification".
        """
        from spanwise.roads.reading import read_points

        kept = choice("duplicates", duplicates, _DUPLICATES)
        offset = None if start is None else finite("start", start)
        is_sorted = flag("sort", sort)
        path = file_path("path", path)
        x, elevations, lines = read_points(
            path, columns, spacing, delimiter, decimal, scale, missing
        )
        steps = np.diff(x)
        if is_sorted or (np.all(steps <= 0.0) and np.any(steps < 0.0)):
            order = np.argsort(x, kind="stable")
            x, elevations, lines = x[order], elevations[order], lines[order]
        if kept != "refuse" and len(x):
            x, elevations, lines = _merged(x, elevations, lines, kept)
        if offset is not None and len(x):
            x = x + (offset - x[0])
        try:
            return cls(x, elevations, detrend=detrend, contact_patch=contact_patch, max_gap=max_gap)
        except InputError as error:
            raise _in_file(error, path, x, elevations, lines) from None

    @classmethod
    def read_csv(cls, path: str | PathLike[str], **options: Any) -> Profile:
        """The name that `read` had when it read tables only."""
        renamed("Profile.read_csv", "Profile.read")
        return cls.read(path, **options)

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
        raise refused(key, value, "must be a list of numbers")
    with np.errstate(over="ignore"):
        values = np.array(given, dtype=np.float64)
    values.setflags(write=False)
    return values


def _merged(x: Array, elevations: Array, lines: Array, kept: str) -> tuple[Array, Array, Array]:
    """One point of all neighbours with the same x; they are in the order of the file."""
    first = np.append(True, np.diff(x) != 0.0)
    firsts = np.flatnonzero(first)
    if kept == "mean":
        group = np.cumsum(first) - 1
        means = np.bincount(group, elevations) / np.bincount(group)
        return x[firsts], means, lines[firsts]
    one = firsts if kept == "first" else np.append(firsts[1:], len(x)) - 1
    return x[one], elevations[one], lines[one]


def _in_file(
    error: InputError, path: Path, x: Array, elevations: Array, lines: Array
) -> InputError:
    """What is wrong with a profile, with the line of the file and what may mend it."""
    name, bracket, place = error.key.partition("[")
    if name not in ("x", "elevations"):
        return error
    if not bracket:
        return error.within(str(path))
    point, cure = int(place.removesuffix("]")), ""
    if name == "elevations" and np.isnan(elevations[point]):
        cure = "; missing = nan leaves such points out"
    if name == "x" and point > 0 and x[point] == x[point - 1]:
        cure = "; duplicates = 'mean' takes the mean there, 'first' or 'last' one elevation"
    if name == "x" and point > 0 and x[point] < x[point - 1]:
        cure = "; sort = true brings the points into the order of x"
    found = InputError(error.key, error.value, error.allowed + cure)
    return found.within(f"{path}, line {lines[point]:.0f}")
