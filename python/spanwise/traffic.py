"""Vehicles on their way: how each is driven, where and when it enters, in which lane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, ClassVar, Final, Literal, TypeAlias, get_args

from spanwise._checks import number, numbers, shown, word
from spanwise._keys import Keys, suggestion
from spanwise._wheels import Wheels
from spanwise.roads import Road
from spanwise.vehicles import AnyVehicle

Direction: TypeAlias = Literal["right", "left"]
Plain: TypeAlias = Literal["constant-speed", "constant-traction"]

#: What the core takes for a drive: its name and numbers.
CoreDrive: TypeAlias = tuple[str, list[float], list[float]]


@dataclass(frozen=True, kw_only=True)
class Acceleration:
    """Driving with constant acceleration from the start of the approach; the motion is exact.

    The inertia forces of the bodies act at their heights: the vehicle dips or squats.

    Parameters
    ----------
    acceleration : float
        Acceleration [m/s2]. If negative the vehicle comes to a stop, and if it is then still on the
        bridge, it stays.
    """

    kind: ClassVar[str] = "acceleration"
    acceleration: float

    def _core(self) -> CoreDrive:
        return self.kind, [number("acceleration", self.acceleration)], []


@dataclass(frozen=True, kw_only=True)
class Speeds:
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

    def _core(self) -> CoreDrive:
        return self.kind, numbers("times", self.times), numbers("speeds", self.speeds)


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

    def _core(self) -> CoreDrive:
        named = asdict(self)
        return self.kind, [number(f"braking {key}", value) for key, value in named.items()], []


Drive: TypeAlias = Plain | Acceleration | Speeds | Braking

#: Drives that need more than a name, by kind.
KINDS: Final = {each.kind: each for each in (Acceleration, Speeds, Braking)}


def drive_of(value: object) -> Drive:
    """A drive from a word, a drive, or the table of a case file, which says its ``kind``."""
    if isinstance(value, Acceleration | Speeds | Braking):
        return value
    if isinstance(value, Mapping):
        kind = value.get("kind")
        if kind not in [*KINDS]:
            near = suggestion(kind, KINDS) if isinstance(kind, str) else ""
            raise ValueError(f"drive kind = {shown(kind)}: must be one of {', '.join(KINDS)}{near}")
        table = {key: each for key, each in value.items() if key != "kind"}
        keys = Keys.of(KINDS[kind])
        try:
            keys.check_known(table, lambda _: "")
            keys.check_complete(table)
        except ValueError as error:
            raise ValueError(f"drive of kind {kind}: {error}") from None
        return KINDS[kind](**table)
    try:
        return word("drive", value, *get_args(Plain))  # type: ignore[return-value]
    except ValueError as error:
        raise ValueError(f"{error}; or a drive of its own: {', '.join(KINDS)}") from None


def core_drive(drive: Drive) -> CoreDrive:
    """As the core takes it."""
    return (drive, [], []) if isinstance(drive, str) else drive._core()


def plain_drive(drive: Drive) -> str | dict[str, Any]:
    """As a case file writes it."""
    return drive if isinstance(drive, str) else {"kind": drive.kind, **asdict(drive)}


@dataclass(frozen=True, kw_only=True)
class Passage:
    """A vehicle among others on a bridge.

    Parameters
    ----------
    vehicle : Vehicle, ForceTrain or MovingMasses
        The vehicle.
    speed : float, optional
        Speed at the start [m/s]; by default that of the crossing.
    drive : str, Acceleration, Speeds or Braking, optional
        How it is driven; by default as the crossing says.
    direction : {"right", "left"}, optional
        Where it goes; one that goes to the left enters at the right end.
    entry : float, optional
        When its front axle is at the start of the approach [s]. Before that it is on level road.
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
        if not isinstance(self.vehicle, Wheels):
            raise TypeError(f"vehicle = {shown(self.vehicle)}: must be a Vehicle or a train")
        if self.road is not None and not isinstance(self.road, Road):
            raise TypeError(f"road = {shown(self.road)}: must be a Road")
        if self.speed is not None:
            object.__setattr__(self, "speed", number("speed", self.speed))
        if self.drive is not None:
            object.__setattr__(self, "drive", drive_of(self.drive))
        object.__setattr__(self, "entry", number("entry", self.entry))
        word("direction", self.direction, *get_args(Direction))
        if self.lane is not None and (
            isinstance(self.lane, bool) or not isinstance(self.lane, int)
        ):
            raise ValueError(f"lane = {shown(self.lane)}: must be a whole number")


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
    gaps = numbers("headway", headway)
    if len(gaps) == 1:
        gaps *= max(len(vehicles) - 1, 1)
    if len(vehicles) > 1 and len(gaps) != len(vehicles) - 1:
        raise ValueError(
            f"headway = {shown(headway)}: give one, or one for each of the {len(vehicles) - 1} gaps"
        )
    for i, gap in enumerate(gaps):
        if not gap > 0.0:
            raise ValueError(f"headway[{i}] = {gap:g} s: must be greater than 0")
    passages, at = [], number("entry", entry)
    for vehicle, gap in zip(vehicles, [0.0, *gaps], strict=False):
        at += gap
        passages.append(Passage(vehicle=vehicle, direction=direction, entry=at, **common))
    return passages
