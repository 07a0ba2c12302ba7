"""What every road can do, and the two that need no data: the smooth one and sums."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Final, TypeAlias, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise._checks import array, not_negative, number
from spanwise._core import Road as CoreRoad
from spanwise._door import view
from spanwise._toml import table_of
from spanwise._value import Brief
from spanwise._warnings import PlausibilityWarning, warn
from spanwise.errors import InputError, refused
from spanwise.roads import roughness
from spanwise.roads.roughness import IriSegments

if TYPE_CHECKING:
    from spanwise.plotting import RoadPlot

Array: TypeAlias = NDArray[np.float64]

#: Usual length of road that a tyre averages [m].
CONTACT_PATCH: Final = 0.24

#: What is to be given as a road.
A_ROAD: Final = 'a Road, such as sw.ISO8608("C")'


@dataclass(frozen=True, repr=False)
class Road(Brief):
    """A road surface: elevation, slope and curvature at any x.

    x [m] runs from the left end of the bridge and is negative on the left approach; elevation [m]
    is positive up. Roads cannot be changed; they add up with ``+`` and ``sum``, and
    ``2 * road`` is twice as rough.

    Each is averaged over the length of road that a tyre touches, its `contact_patch`, before
    anything looks at it. `iri`, `psd` and `iso_class` describe the surface itself, without that.

    Attributes
    ----------
    kind : str
        What kind of road it is, as in a case file.
    """

    kind: ClassVar[str]

    #: Names of the values that are in proportion to the elevation.
    _heights: ClassVar[tuple[str, ...]] = ()

    #: NumPy leaves products to the road, and does not make an array of it.
    __array_ufunc__: ClassVar[None] = None

    if TYPE_CHECKING:

        @property
        def _core(self) -> CoreRoad: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "_core", self._made())
        for doubt in self._doubts:
            warn(doubt, PlausibilityWarning)

    @cached_property
    def _doubts(self) -> tuple[str, ...]:
        """What was warned of."""
        return ()

    def __str__(self) -> str:
        """Kind, places, roughness and contact patch, in words."""
        patch = getattr(self, "contact_patch", None)
        return ", ".join(
            [*self._words(), *([] if patch is None else [f"contact patch {patch:g} m"])]
        )

    def _words(self) -> list[str]:
        """What there is to say of it beside the contact patch."""
        keys = [key for key in ("at", "start", "end") if hasattr(self, key)]
        return [self.kind, *(f"{key} {getattr(self, key):g} m" for key in keys)]

    def _made(self) -> CoreRoad:
        raise TypeError("Road stands for all kinds of roads; make one of them, such as Smooth()")

    def _set(self, **values: object) -> None:
        """Keep values as they were understood."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled as its fields, so that it can go to another process."""
        given = {each.name: getattr(self, each.name) for each in fields(self)}
        return _rebuilt, (type(self), given)

    def __add__(self, other: object) -> Road:
        """Both on top of each other."""
        if not isinstance(other, Road):
            return NotImplemented
        return total([self, other])

    def __radd__(self, other: object) -> Road:
        """The road itself on 0, with which ``sum`` begins."""
        return total([self]) if isinstance(other, int) and other == 0 else NotImplemented

    def __mul__(self, factor: object) -> Road:
        """The road with elevations so many times as high; the factor is not negative."""
        if isinstance(factor, Road):
            return NotImplemented
        times = not_negative("factor", factor)
        try:
            return self._times(times) if times > 0.0 else Smooth()
        except (ValueError, OverflowError):
            # Elevations that overflow, in the words of what they are made of.
            raise InputError(
                "factor", f"{times:g}", "is too large or too small for this road"
            ) from None

    __rmul__ = __mul__

    def _times(self, factor: float) -> Road:
        changes: dict[str, Any] = {key: factor * getattr(self, key) for key in self._heights}
        return replace(self, **changes)

    @property
    def arguments(self) -> dict[str, Any] | list[dict[str, Any]]:
        """Plain values that `from_table` makes this road of: a table, or a list of them for a sum.

        What is None is left out.
        """
        return table_of(self)

    @property
    def _summands(self) -> list[Road]:
        """The roads that it is the sum of, none of them a sum; or itself."""
        return [self]

    @property
    def surface(self) -> Road:
        """The same road without contact patch."""
        if getattr(self, "contact_patch", 0.0) == 0.0:
            return self
        changes: dict[str, Any] = {"contact_patch": 0.0}
        return replace(self, **changes)

    @property
    def is_smooth(self) -> bool:
        """Whether there is no roughness."""
        return self._core.is_smooth

    @property
    def ends(self) -> tuple[float, float]:
        """First and last x at which the road is known [m]; infinite where nothing was measured."""
        return self._core.ends

    @property
    def repeats_after(self) -> float:
        """Period of a random road [m]; ``inf`` for others."""
        return self._core.period

    def elevation(self, x: ArrayLike) -> Array:
        """Elevation, averaged over the contact patch.

        Parameters
        ----------
        x : array_like
            Positions [m], of any shape.

        Returns
        -------
        ndarray
            Elevation, positive up [m], shape of `x`.

        Raises
        ------
        ValueError
            If the road is not known there; a random one is, and repeats after its period.
        """
        return self._at(x, 0)

    def slope(self, x: ArrayLike) -> Array:
        """Slope [-], the derivative of `elevation`, shape of `x` [m]; see there."""
        return self._at(x, 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Curvature [1/m], the derivative of `slope`, shape of `x` [m]; see `elevation`."""
        return self._at(x, 2)

    def _at(self, x: ArrayLike, derivative: int) -> Array:
        places = array("x", x)
        if places.size > 0:
            self._core.check_holds(float(places.min()), float(places.max()))
        return self._core.at(places.ravel())[derivative].reshape(places.shape)

    @overload
    def iri(self, start: float, end: float, *, every: None = None) -> float: ...

    @overload
    def iri(self, start: float, end: float, *, every: float) -> IriSegments: ...

    def iri(self, start: float, end: float, *, every: float | None = None) -> float | IriSegments:
        """International roughness index of the surface from `start` to `end` [m].

        Parameters
        ----------
        start, end : float
            Ends of the section [m], at least 11 m apart.
        every : float, optional
            Length of the segments [m], at least 0.25 m, each of which gets its index; without,
            the section gets one. The last segment is shorter if there is a rest.

        Returns
        -------
        float or IriSegments
            The index [m/km], or those of the segments with their ends.

        Raises
        ------
        ValueError
            If the section is too short or too long, or the road is not known on it, or by points
            more than 1.2 m apart, which do not hold the waves of 2.4 m that the index feels most.

        Warns
        -----
        PlausibilityWarning
            If points are more than 0.3 m apart: the index is too low then, on roads of ISO 8608 by
            about 7 % where they are 0.5 m apart, and by 25 % where they are 1 m.

        Notes
        -----
        The mean rectified slope between body and axle of the golden car (tyre 653 /s2, suspension
        63.3 /s2, axle 0.15 of the body's mass, damping 6 /s) at 80 km/h, over the moving average
        of 250 mm of the profile, starting with the mean slope of the first 11 m.

        A measured profile is the chain of chords between its points, and the average is its
        integral, so that all points count. Points more than 167 mm apart are not averaged: their
        chords are average enough, as in the standard. Where there is an average, the first and the
        last 125 mm of the section have none of their own.

        One car drives through all segments; starting it anew in each would lose 4 % on average
        and up to 17 %. To settle it comes from 50 m before the first, or from as far as the road
        is known, if that is 11 m or more; else it starts there as for a single index.

        References
        ----------
        M. W. Sayers, "On the calculation of International Roughness Index from longitudinal road
        profile", Transportation Research Record 1501 (1995) 1-12. ASTM E1926, Standard practice
        for computing International Roughness Index of roads from longitudinal profile measurements.
        """
        start, end = number("start", start), number("end", end)
        found: float | IriSegments
        if every is None:
            found = 1e3 * self._core.iri(start, end)
        else:
            edges, values, lead_in = self._core.iri_segments(start, end, number("every", every))
            found = IriSegments(edges[:-1], edges[1:], 1e3 * values, lead_in)
        doubt = roughness.doubt_of_index(self._spacing_on(start, end))
        if doubt is not None:
            warn(doubt, PlausibilityWarning)
        return found

    def _spacing_on(self, start: float, end: float) -> float:
        """Distance of the points of a measured road, of the coarsest part of a sum; else 0 [m]."""
        return 0.0

    def psd(
        self,
        start: float,
        end: float,
        *,
        segment: float | None = None,
        spacing: float | None = None,
    ) -> tuple[Array, Array]:
        """Power spectral density of the surface from `start` to `end` [m].

        Parameters
        ----------
        start, end : float
            Ends of the section [m].
        segment : float, optional
            Length of the segments whose periodograms are averaged [m], a quarter of the section
            without; wave numbers are as far apart as one wave per segment.
        spacing : float, optional
            Wave numbers go up to half a wave per spacing [m], if the road is known so far;
            without, as far as it is known, or to 8 cycle/m where it is known exactly.

        Returns
        -------
        wave_numbers : ndarray
            Wave numbers n [cycle/m], without 0, shape (waves,).
        density : ndarray
            One-sided density G_d(n) [m3], shape (waves,), scaled so that its integral over n, its
            sum times the first n, is the variance of all waves that are short of a segment and
            not beyond the last n.

        Raises
        ------
        ValueError
            If the section cannot be divided so, or the road is not known there or too coarsely.

        Notes
        -----
        Welch's method: segments that overlap by half, less their least-squares line, under Hann
        windows, divided by the mean square of the window, which so does not change the variance.
        Its resolution is about two wave numbers, so that the first of them are rough; of waves as
        long as a segment and longer, most of the variance is not in the density.

        A measured road is known up to 0.8 of half a wave per point, a random one up to the end of
        its band; a sum as far as its coarsest measured part. Samples are as close as the finest
        part asks, whatever `spacing` is, and each is the exact mean over its share d of the road;
        the gain of that, sinc(n d), is divided out. So no wave is taken for a longer one.
        """
        return roughness.psd(self._core, start, end, segment, spacing)

    def iso_class(
        self, start: float, end: float, *, band: tuple[float, float] = roughness.ISO_BAND
    ) -> roughness.IsoClass:
        """Class of the surface after ISO 8608 from `start` to `end` [m].

        Parameters
        ----------
        start, end : float
            Ends of the section [m].
        band : tuple of float, optional
            Wave numbers that are looked at [cycle/m], as far as `psd` knows them.

        Returns
        -------
        IsoClass
            The fitted G_d(n0) [m3] with letter and limits of its class, its standard error and
            the band that was left.

        Raises
        ------
        ValueError
            If less than two octaves are left of the band, or nothing of the road; the section must
            hold about twelve of the longest waves that count, so that shorter sections look at
            less of the band.

        Notes
        -----
        Of `psd`, the mean of G_d(n) (n/n0)^2 is taken in every octave of the band, and of these
        the geometric mean: a straight line of slope -2 in logarithmic axes, all octaves alike and
        the last, if it is not whole, by its width. The standard error is that of this mean, from
        the scatter of the octaves; it grows where the road has another slope.
        """
        return roughness.fitted(*self.psd(start, end), band)

    @property
    def plot(self) -> RoadPlot:
        """Figures of the road; needs the extra ``spanwise[plot]``."""
        return view("plotting.RoadPlot")(self)


@dataclass(frozen=True, repr=False)
class Smooth(Road):
    """The road without any roughness."""

    kind: ClassVar[str] = "smooth"

    def _made(self) -> CoreRoad:
        return CoreRoad.sum([])


@dataclass(frozen=True, repr=False)
class Sum(Road):
    """Several roads on top of each other, as ``+`` makes them.

    Parameters
    ----------
    parts : sequence of Road
        What adds up.
    """

    kind: ClassVar[str] = "sum"

    parts: tuple[Road, ...]

    def _made(self) -> CoreRoad:
        if not isinstance(self.parts, list | tuple):
            raise refused("parts", self.parts, "must be a list of roads")
        for k, part in enumerate(self.parts):
            if not isinstance(part, Road):
                raise refused(f"parts[{k}]", part, "must be a road")
        self._set(parts=tuple(self.parts))
        return CoreRoad.sum([part._core for part in self.parts])

    def __str__(self) -> str:
        return " + ".join(map(str, self.parts))

    @property
    def arguments(self) -> list[dict[str, Any]]:
        """The tables of all parts."""
        tables: list[dict[str, Any]] = []
        for part in self.parts:
            found = part.arguments
            tables += found if isinstance(found, list) else [found]
        return tables

    @property
    def _summands(self) -> list[Road]:
        return [each for part in self.parts for each in part._summands]

    def _times(self, factor: float) -> Road:
        return total(part * factor for part in self.parts)

    def _spacing_on(self, start: float, end: float) -> float:
        return max((part._spacing_on(start, end) for part in self.parts), default=0.0)

    @property
    def surface(self) -> Road:
        """The sum of the parts without contact patch."""
        return Sum(tuple(part.surface for part in self.parts))


def total(roads: Iterable[Road]) -> Road:
    """All of them on top of each other: what is smooth adds nothing, and one alone is no sum."""
    parts: list[Road] = []
    for road in roads:
        parts += road.parts if isinstance(road, Sum) else [road]
    rough = tuple(part for part in parts if not part.is_smooth)
    if len(rough) > 1:
        return Sum(rough)
    return rough[0] if rough else Smooth()


def _rebuilt(kind: type[Road], given: dict[str, Any]) -> Road:
    return kind(**given)
