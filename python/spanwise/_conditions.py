"""The conditions that all crossings of a call have in common, checked and filled in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal, TypeAlias, get_args

from spanwise._checks import count, flag, number, numbers, word
from spanwise._value import Value
from spanwise._warnings import DampingWarning, warn
from spanwise.bridge import Bridge
from spanwise.damping import Damping, damping_of, plain_damping, resolved

Recovery: TypeAlias = Literal["force-summation", "force-summation-by-rates", "superposition"]

#: Approach on an uneven road unless given [m]: the vehicle reaches the bridge in motion.
APPROACH: Final = 100.0

#: Way on which unevenness fades in at the start of the approach unless given [m].
RAMP: Final = 20.0

#: What is said where nobody has said how much the bridge is damped.
UNDAMPED: Final = (
    "damping: not given, so the bridge is not damped at all; write damping = 0.02 for 2 % of "
    "critical in each mode, or damping = 0 if none is meant"
)


@dataclass(frozen=True, eq=False, repr=False)
class Conditions(Value):
    """How vehicles cross, all but their drive and speed.

    Attributes
    ----------
    core : dict
        As the core takes them.
    settings : dict
        As a case file writes them; modes, step and sections are not among them.
    modes : int
        Number of modes.
    mask : float
        Below which part of the largest static value there are no impact factors.
    """

    core: dict[str, Any]
    settings: dict[str, object]
    modes: int
    mask: float

    @classmethod
    def of(
        cls,
        bridge: Bridge,
        *,
        uneven: bool,
        modes: int | None,
        damping: Damping | None,
        approach: float | None,
        ramp: float | None,
        tail: float | None,
        sections: Sequence[float] | None,
        recovery: Recovery,
        step: float | None,
        beta: float,
        gravity: float,
        lift_off: bool,
        mask: float,
    ) -> Conditions:
        """Arguments of `cross` of the same names; `uneven` tells whether any road is."""
        if approach is None:
            approach = APPROACH if uneven else 0.0
        if ramp is None:
            ramp = min(RAMP, number("approach", approach)) if uneven else 0.0
        modes = count("modes", bridge.default_modes() if modes is None else modes)
        if damping is None:
            warn(UNDAMPED, DampingWarning)
            damping = 0.0
        damped = damping_of(damping)
        ratios, matrix = resolved(damped, lambda: bridge.modes(modes).frequencies)
        beta, gravity, ramp = number("beta", beta), number("gravity", gravity), number("ramp", ramp)
        approach, mask = number("approach", approach), masked(mask)
        tail = None if tail is None else number("tail", tail)
        common = {
            "approach": approach,
            "ramp": ramp,
            "tail": tail,
            "recovery": word("recovery", recovery, *get_args(Recovery)),
            "beta": beta,
            "gravity": gravity,
            "lift_off": flag("lift_off", lift_off),
        }
        core = {
            **common,
            "modes": modes,
            "damping": ratios,
            "damping_matrix": matrix,
            "step": None if step is None else number("step", step),
            "sections": None if sections is None else numbers("sections", sections),
        }
        settings = {"damping": plain_damping(damped), **common, "mask": mask}
        return cls(core, settings, modes, mask)


def masked(mask: object) -> float:
    """The part of the largest static value below which there are no impact factors."""
    part = number("mask", mask)
    if not 0.0 <= part < 1.0:
        raise ValueError(
            f"mask = {part:g}: must be a fraction of the largest static value, from 0 to below 1"
        )
    return part
