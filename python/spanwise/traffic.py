"""Vehicles on their way: how each is driven, where and when it enters, in which lane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Final, Literal, TypeAlias, cast, get_args

from spanwise._build import Maker, Place, build_kind
from spanwise._checks import (
    finite,
    items,
    not_negative,
    numbers,
    of_kind,
    one_of,
    positive,
    whole_from,
)
from spanwise._toml import table_of
from spanwise._value import Brief
from spanwise._wheels import Wheels
from spanwise.errors import InputError, refused
from spanwise.roads import Road
from spanwise.roads.base import A_ROAD
from spanwise.vehicles import AnyVehicle

Direction: TypeAlias = Literal["right", "left"]
Plain: TypeAlias = Literal["constant-speed", "constant-traction"]

#: Highest number of a lane.
MOST_LANE: Final = 2**31 - 1


@dataclass(frozen=True, kw_only=True)
class Acceleration:
    """Driving with constant acceleration from the start of the approach; the motion is exact.

    The inertia forces of the bodies act at their heights: the vehicle dips or squats.

    Parameters
    ----------
    acceleration : float
        Acceleration [m/s2]. If negative the vehicle comes to a stop, and if it is then still on the
        bridge, it stays.

    Notes
    -----
    The speed at the start must be greater than 0. A start from rest is given by `Speeds`, such as
    ``Speeds(times=[0, 10], speeds=[0, 15])``.
    """

    kind: ClassVar[str] = "acceleration"
    acceleration: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "acceleration", finite("acceleration", self.acceleration))


@dataclass(frozen=True, kw_only=True, repr=False)
class Speeds(Brief):
    """Driving at speeds given in time, linear between them and constant outside.

    Parameters
    ----------
    times : sequence of float
        Times after the entry of the vehicle [s], ascending.
    speeds : sequence of float
        Speeds then [m/s], 0 or more.
    """

    kind: ClassVar[str] = "speeds"
    times: Sequence[float]
    speeds: Sequence[float]

    def __post_init__(self) -> None:
        times, speeds = numbers("times", self.times), numbers("speeds", self.speeds)
        if not times or len(times) != len(speeds):
            raise InputError(
                "speeds",
                f"{len(times)} times and {len(speeds)} speeds",
                "give as many speeds as times, one or more",
            )
        for i, (time, speed) in enumerate(zip(times, speeds, strict=True)):
            finite(f"times[{i}]", time)
            not_negative(f"speeds[{i}]", speed)
            if i == 0 and time < 0.0:
                raise InputError("times[0]", f"{time:g} s", "must be 0 or more")
            if i > 0 and time <= times[i - 1]:
                raise InputError(
                    f"times[{i}]",
                    f"{time:g} s",
                    f"must be greater than the time before it, {times[i - 1]:g} s",
                )
        object.__setattr__(self, "times", tuple(times))
        object.__setattr__(self, "speeds", tuple(speeds))


@dataclass(frozen=True, kw_only=True)
class Braking:
    """Rolling as at constant traction until the brakes come on.

    Every wheel brakes with its share of the static load, growing linearly during the ramp, but with
    no more than the friction between tyre and road gives at its load at the moment. A vehicle that
    comes to rest on the bridge stays there, and rocks on its tyres.

    Parameters
    ----------
    deceleration : float
        Deceleration that the driver asks for [m/s2].
    start : float, optional
        Where the front axle is when the brakes come on [m], from the end of the bridge at which the
        vehicle enters.
    ramp : float, optional
        Time in which the brake forces grow [s]; 0.3 to 0.6 s is usual.
    friction : float, optional
        Coefficient of friction between tyre and road.

    References
    ----------
    R. K. Gupta and R. W. Traill-Nash, "Vehicle braking on highway bridges", Journal of the
    Engineering Mechanics Division ASCE 106 (1980).
    """

    kind: ClassVar[str] = "braking"
    deceleration: float
    start: float = 0.0
    ramp: float = 0.4
    friction: float = 0.7

    def __post_init__(self) -> None:
        checks = {"deceleration": positive, "start": finite, "ramp": not_negative}
        for each in fields(self):
            key, value = each.name, getattr(self, each.name)
            check = checks.get(key, positive)
            object.__setattr__(self, key, check(f"braking {key}", value))


Drive: TypeAlias = Plain | Acceleration | Speeds | Braking

#: Drives that need more than a name, by kind.
KINDS: Final[dict[str, tuple[Maker[Acceleration | Speeds | Braking]]]] = {
    each.kind: (Maker(each),) for each in (Acceleration, Speeds, Braking)
}
DRIVE: Final = Place("drive")


def drive_of(value: object, place: Place = DRIVE) -> Drive:
    """A drive from a word, a drive, or the table of a case file, which says its ``kind``."""
    if isinstance(value, Acceleration | Speeds | Braking):
        return value
    if isinstance(value, Mapping):
        return build_kind(KINDS, value, place)
    steady = get_args(Plain)
    if not isinstance(value, str) or value not in steady:
        allowed = f"{' or '.join(steady)}; or a drive of its own: {', '.join(KINDS)}"
        raise place.wrong(value, allowed)
    return cast("Plain", value)


def plain_drive(drive: Drive) -> str | dict[str, Any]:
    """As a case file writes it."""
    return drive if isinstance(drive, str) else table_of(drive)


@dataclass(frozen=True, kw_only=True, repr=False)
class Passage:
    """A vehicle among others on a bridge.

    Parameters
    ----------
    vehicle : Vehicle, ForceTrain or MovingMasses
        The vehicle.
    speed : float, optional
        Speed at the start [m/s]; by default that of the crossing. Not beside `Speeds`.
    drive : str, Acceleration, Speeds or Braking, optional
        How it is driven; by default as the crossing says.
    direction : {"right", "left"}, optional
        Where it goes; one that goes to the left enters at the right end.
    entry : float, optional
        When its front axle is at the start of the approach [s]. Before that it comes nearer on
        level road; with ``ramp=0`` on the road as it is, which must then reach back to where its
        last axle is at the beginning.
    lane : int, optional
        Vehicles of the same lane must not overlap. By default 0 for travel to the right, 1 for
        travel to the left.
    road : Road, optional
        The road under it; by default that of the crossing.
    """

    vehicle: AnyVehicle
    speed: float | None = None
    drive: Drive | None = None
    direction: Direction = "right"
    entry: float = 0.0
    lane: int | None = None
    road: Road | None = None

    def __post_init__(self) -> None:
        of_kind("vehicle", self.vehicle, Wheels, "a Vehicle or a train")
        if self.road is not None:
            of_kind("road", self.road, Road, A_ROAD)
        if self.speed is not None:
            object.__setattr__(self, "speed", positive("speed", self.speed))
        if self.drive is not None:
            object.__setattr__(self, "drive", drive_of(self.drive))
        if self.speed is not None and isinstance(self.drive, Speeds):
            raise InputError("speed", f"{self.speed:g}", "not used with speeds in time")
        object.__setattr__(self, "entry", not_negative("entry", self.entry))
        one_of("direction", self.direction, get_args(Direction))
        if self.lane is not None:
            lane = whole_from("lane", self.lane, -MOST_LANE, MOST_LANE)
            object.__setattr__(self, "lane", lane)

    @property
    def lane_number(self) -> int:
        """The lane, also where it follows from the direction."""
        return int(self.direction == "left") if self.lane is None else self.lane

    def __repr__(self) -> str:
        given = [f"{self.vehicle!r} to the {self.direction}"]
        given += [f"entry={self.entry:g}"] if self.entry else []
        for key in ("speed", "drive", "lane", "road"):
            value = getattr(self, key)
            given += [] if value is None else [f"{key}={value!r}"]
        return f"Passage({', '.join(given)})"


def is_alone(passages: Sequence[Passage]) -> bool:
    """Whether it is one vehicle that does what the crossing says."""
    return len(passages) == 1 and passages[0] == Passage(vehicle=passages[0].vehicle)


def convoy(
    vehicles: Sequence[AnyVehicle],
    *,
    headway: float | Sequence[float],
    direction: Direction = "right",
    entry: float = 0.0,
    **common: Any,
) -> list[Passage]:
    """Vehicles one behind the other in one lane.

    Parameters
    ----------
    vehicles : sequence of Vehicle, ForceTrain or MovingMasses
        The vehicles, the leading one first.
    headway : float or sequence of float
        Time from front axle to front axle [s], one for all or one for each gap.
    direction : {"right", "left"}, optional
        Where they go.
    entry : float, optional
        When the front axle of the first is at the start of the approach [s].
    **common
        Further arguments of `Passage`, the same for all.

    Returns
    -------
    list of Passage
    """
    vehicles = items("vehicles", vehicles, "a list of vehicles")
    gaps = numbers("headway", headway)
    if len(gaps) == 1:
        gaps *= max(len(vehicles) - 1, 1)
    if len(vehicles) > 1 and len(gaps) != len(vehicles) - 1:
        raise refused(
            "headway", headway, f"give one, or one for each of the {len(vehicles) - 1} gaps"
        )
    for i, gap in enumerate(gaps):
        if not 0.0 < gap < float("inf"):
            raise InputError(f"headway[{i}]", f"{gap:g} s", "must be finite and greater than 0")
    passages, at = [], not_negative("entry", entry)
    for i, (vehicle, gap) in enumerate(zip(vehicles, [0.0, *gaps], strict=False)):
        of_kind(f"vehicles[{i}]", vehicle, Wheels, "a Vehicle or a train")
        at += gap
        if at == float("inf"):
            raise InputError(f"headway[{i - 1}]", f"{gap:g} s", "is too large")
        passages.append(
            Passage(vehicle=cast("AnyVehicle", vehicle), direction=direction, entry=at, **common)
        )
    return passages
