"""The conditions that all crossings of a call have in common, checked and filled in."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Final, Literal, Self, TypeAlias, get_args

from spanwise._checks import count, flag, number, numbers, one_of
from spanwise._value import Value
from spanwise._warnings import DampingWarning, warn
from spanwise._wheels import GRAVITY
from spanwise.bridge import Bridge
from spanwise.damping import Array, Damping, Rayleigh, damping_of, plain_damping, resolved
from spanwise.errors import InputError
from spanwise.traffic import Drive, drive_of

Recovery: TypeAlias = Literal["force-summation", "force-summation-by-rates", "superposition"]

#: Approach on an uneven road unless given [m]: the vehicle reaches the bridge in motion.
APPROACH: Final = 100.0

#: Way on which unevenness fades in at the start of the approach unless given [m].
RAMP: Final = 20.0

#: Newmark's beta of the least error: of an undamped vibration the period is off by the fourth power
#: of the step, not by the second.
FOX_GOODWIN: Final = 1.0 / 12.0

#: What is said where nobody has said how much the bridge is damped.
UNDAMPED: Final = (
    "damping: not given, so the bridge is not damped at all; write damping = 0.02 for 2 % of "
    "critical in each mode, or damping = 0 if none is meant"
)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Settings:
    """How vehicles cross, as it is asked for and checked: what `cross` and `ensemble` share."""

    modes: int | None = None
    drive: Drive = "constant-speed"
    damping: Damping | None = None
    approach: float | None = None
    ramp: float | None = None
    tail: float | None = None
    sections: Sequence[float] | None = None
    recovery: Recovery = "force-summation"
    accuracy: float = 1e-3
    step: float | None = None
    beta: float = FOX_GOODWIN
    gravity: float = GRAVITY
    lift_off: bool = True
    mask: float = 0.05

    #: What checks and understands a value that is not a number.
    checks: ClassVar[Mapping[str, Callable[[str, Any], object]]] = {
        "modes": count,
        "drive": lambda key, value: drive_of(value),
        "damping": lambda key, value: damping_of(value),
        "sections": numbers,
        "recovery": lambda key, value: one_of(key, value, get_args(Recovery)),
        "lift_off": flag,
        "mask": lambda key, value: masked(value),
    }

    @classmethod
    def of(cls, arguments: Mapping[str, Any]) -> Self:
        """Of the arguments of a function by name, some of which may be none of these."""
        names = [each.name for each in fields(cls)]
        return cls(**{name: arguments[name] for name in names if name in arguments})

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            if value is not None or each.default is not None:
                check = self.checks.get(each.name, number)
                object.__setattr__(self, each.name, check(each.name, value))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Crossing(Settings):
    """What `cross` is asked for."""

    speed: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Conditions(Value, Settings):
    """The settings with what is by default, for a bridge and a road; the core reads them.

    Attributes
    ----------
    ratios : list of float
        Damping by ratios to critical, one for all modes or one for each.
    matrix : ndarray or None
        Damping by a matrix, if it is by one.
    """

    modes: int
    damping: Rayleigh | list[float] | Array
    approach: float
    ramp: float
    ratios: list[float]
    matrix: Array | None

    def __post_init__(self) -> None:
        """They are checked already."""

    @classmethod
    def filled(cls, bridge: Bridge, asked: Settings, *, uneven: bool) -> Conditions:
        """Settings filled in; `uneven` tells whether any road is."""
        given = {each.name: getattr(asked, each.name) for each in fields(Settings)}
        if asked.approach is None:
            given["approach"] = APPROACH if uneven else 0.0
        if asked.ramp is None:
            given["ramp"] = min(RAMP, given["approach"]) if uneven else 0.0
        modes = given["modes"] = bridge.default_modes() if asked.modes is None else asked.modes
        if asked.damping is None:
            warn(UNDAMPED, DampingWarning)
        given["damping"] = damping_of(0.0 if asked.damping is None else asked.damping)
        ratios, matrix = resolved(given["damping"], lambda: bridge.modes(modes).frequencies)
        return cls(**given, ratios=ratios, matrix=matrix)

    @property
    def plain(self) -> dict[str, object]:
        """As a case file writes them; modes, drive, step and sections are not among them."""
        apart = ("modes", "drive", "damping", "sections", "step")
        names = [each.name for each in fields(Settings) if each.name not in apart]
        return {
            "damping": plain_damping(self.damping),
            **{name: getattr(self, name) for name in names},
        }


def masked(mask: object) -> float:
    """The part of the largest static value below which there are no impact factors."""
    part = number("mask", mask)
    if not 0.0 <= part < 1.0:
        raise InputError(
            "mask", f"{part:g}", "must be a fraction of the largest static value, from 0 to below 1"
        )
    return part
