"""Single features of a road: steps, ramps, bumps, potholes, joints, camber."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, fields
from functools import cached_property
from typing import ClassVar

from spanwise import _core
from spanwise._checks import finite, number, positive
from spanwise.roads._doubts import FLAT, HIGH, LONG, STEEPEST, WIDE, doubts_of_metres
from spanwise.roads.base import CONTACT_PATCH, Road


class _Feature(Road):
    """A road whose arguments all are numbers.

    Warns
    -----
    PlausibilityWarning
        If a height, a depth or a gap is so large that it is hardly in metres.
    """

    def __post_init__(self) -> None:
        for each in fields(self):
            self._set(**{each.name: number(each.name, getattr(self, each.name))})
        super().__post_init__()

    @property
    def _largest(self) -> dict[str, float]:
        """Up to which values the arguments are not doubted [m]."""
        return dict.fromkeys(self._heights, HIGH)

    @cached_property
    def _doubts(self) -> tuple[str, ...]:
        return tuple(doubts_of_metres(self, self._largest))


@dataclass(frozen=True, repr=False)
class Step(_Feature):
    """A road that is higher from some place on.

    Without contact patch it jumps, and its slope is 0 on both sides: a damped tyre would not
    notice, and needs a patch. With one it is a ramp of the patch's length.

    Parameters
    ----------
    at : float
        Where it rises [m].
    height : float
        By how much, negative for a drop [m].
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    """

    kind: ClassVar[str] = "step"
    _heights: ClassVar[tuple[str, ...]] = ("height",)

    at: float
    height: float
    _: KW_ONLY
    contact_patch: float = CONTACT_PATCH

    def _made(self) -> _core.Road:
        return _core.Road.step(self.at, self.height, self.contact_patch)


@dataclass(frozen=True, repr=False)
class Ramp(_Feature):
    """A straight rise, after which the road stays as high.

    Parameters
    ----------
    start, end : float
        Where it begins and ends [m]. The slope jumps there, unless there is a contact patch.
    height : float
        By how much it rises, negative for a fall [m].
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    """

    kind: ClassVar[str] = "ramp"
    _heights: ClassVar[tuple[str, ...]] = ("height",)

    start: float
    end: float
    height: float
    _: KW_ONLY
    contact_patch: float = CONTACT_PATCH

    def _made(self) -> _core.Road:
        return _core.Road.ramp(self.start, self.end, self.height, self.contact_patch)

    @property
    def _largest(self) -> dict[str, float]:
        return {"height": max(HIGH, STEEPEST * (self.end - self.start))}


@dataclass(frozen=True, repr=False)
class Bump(_Feature):
    """A bump of one cosine wave, height (1 - cos 2 pi s) / 2 with s from 0 to 1.

    Its slope is continuous.

    Parameters
    ----------
    at : float
        Its middle [m].
    length : float
        Its length [m].
    height : float
        Its height in the middle, negative for a dip [m].
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    """

    kind: ClassVar[str] = "bump"
    _heights: ClassVar[tuple[str, ...]] = ("height",)

    at: float
    length: float
    height: float
    _: KW_ONLY
    contact_patch: float = CONTACT_PATCH

    def _made(self) -> _core.Road:
        edge = 0.5 * self.length
        return _core.Road.plateau(self.at, self.length, self.height, edge, self.contact_patch)

    @property
    def _largest(self) -> dict[str, float]:
        # A long one is a sag or a crest of the road.
        return {"height": max(HIGH, FLAT * min(self.length, LONG))}


@dataclass(frozen=True, repr=False)
class Pothole(_Feature):
    """A hole with a flat bottom and vertical sides, or sides of half a cosine wave.

    Parameters
    ----------
    at : float
        Its middle [m].
    length : float
        Its length, sides included [m].
    depth : float
        Depth of the bottom [m].
    edge : float, optional
        Length of either side [m], up to half the length; 0 for vertical sides, which are for
        tyres with a contact patch (see `Step`).
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    """

    kind: ClassVar[str] = "pothole"
    _heights: ClassVar[tuple[str, ...]] = ("depth",)

    at: float
    length: float
    depth: float
    _: KW_ONLY
    edge: float = 0.0
    contact_patch: float = CONTACT_PATCH

    def _made(self) -> _core.Road:
        depth = finite("depth", self.depth)
        return _core.Road.plateau(self.at, self.length, -depth, self.edge, self.contact_patch)


@dataclass(frozen=True, repr=False)
class Joint(_Feature):
    """The gap of an expansion joint, with vertical sides.

    A tyre feels it by its contact patch alone, as a dip of depth times gap over patch. It is
    assumed to reach the bottom of the gap; a tyre that bridges it feels less. For a difference in
    level, add a `Step`.

    Parameters
    ----------
    at : float
        Its middle [m].
    gap : float
        Its width [m].
    depth : float
        Depth to which the tyre reaches [m].
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    """

    kind: ClassVar[str] = "joint"
    _heights: ClassVar[tuple[str, ...]] = ("depth",)

    at: float
    gap: float
    depth: float
    _: KW_ONLY
    contact_patch: float = CONTACT_PATCH

    def _made(self) -> _core.Road:
        positive("gap", self.gap)
        depth = finite("depth", self.depth)
        return _core.Road.plateau(self.at, self.gap, -depth, 0.0, self.contact_patch)

    @property
    def _largest(self) -> dict[str, float]:
        return {**super()._largest, "gap": WIDE}


@dataclass(frozen=True, repr=False)
class Camber(_Feature):
    """A parabola from one place to another, 4 rise s (1 - s) with s from 0 to 1.

    The curvature between is constant. At both ends, where the bridge meets the approach, the
    slope jumps by 4 rise / length, as it does there in fact; a contact patch rounds that off.

    Parameters
    ----------
    start, end : float
        Where it begins and ends [m].
    rise : float
        Elevation halfway, negative for a sag [m].
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    """

    kind: ClassVar[str] = "camber"
    _heights: ClassVar[tuple[str, ...]] = ("rise",)

    start: float
    end: float
    rise: float
    _: KW_ONLY
    contact_patch: float = CONTACT_PATCH

    def _made(self) -> _core.Road:
        return _core.Road.camber(self.start, self.end, self.rise, self.contact_patch)

    @property
    def _largest(self) -> dict[str, float]:
        return {"rise": max(HIGH, STEEPEST * (self.end - self.start))}
