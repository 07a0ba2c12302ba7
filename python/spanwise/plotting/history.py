"""Histories: which column of a run is asked for, and the axis of the front axle's position."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise._checks import choice, finite
from spanwise.errors import InputError
from spanwise.plotting.envelope import envelope_of
from spanwise.plotting.style import LIFTED, metres

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from spanwise.quantities import Response
    from spanwise.runs import Run

Array: TypeAlias = NDArray[np.float64]
Side: TypeAlias = Literal["left", "right"]


def column(run: Run, of: Response, at: float | None, side: Side | None) -> tuple[str, Array, Array]:
    """Which column of the histories is asked for, in words, and it, dynamic and static."""
    envelope = envelope_of(run, of)
    if side is not None:
        choice("side", side, get_args(Side))
    if at is None:
        at_rest, dynamic = (
            np.maximum(np.abs(upper.value), np.abs(lower.value))
            for upper, lower in (
                (envelope.static_max, envelope.static_min),
                (envelope.max, envelope.min),
            )
        )
        # Deck motion has no static value.
        index = int((at_rest if at_rest.any() else dynamic).argmax())
    else:
        at = finite("at", at)
        index = int(np.abs(envelope.x - at).argmin())
        nearest = envelope.x[index]
        if not abs(nearest - at) <= 1e-6 * run.bridge.length:
            hint = "; cross(..., sections=[...]) chooses others" if of.axis == "section" else ""
            raise InputError(
                "at",
                f"{at!r}",
                f"the run has no {of.name} there, the nearest is at {nearest:g}{hint}",
            )
    if of.axis == "axle":
        loads: Array = getattr(run, of.name)[:, index]
        return run.axle_names[index], loads, np.full_like(loads, run.static_axle_loads[index])
    x = float(envelope.x[index])
    name, where = of.name, f"at x = {metres(x)}"
    if of.sided:
        side = side or ("left" if x >= run.bridge.length else "right")
        name, where = of.parts[side == "right"], f"just {side} of x = {metres(x)}"
    return where, getattr(run, name)[:, index], getattr(run.static, name)[:, index]


def front_axle_on_top(ax: Axes, run: Run, vehicle: int = 1) -> None:
    """A second axis: where the front axle of a vehicle, counted from 1, is at that time."""
    motion = run.vehicles[vehicle - 1]
    to = 1.0 if run.passages[vehicle - 1].direction == "right" else -1.0
    time, front = run.time, to * motion.axle_positions[:, 0]
    ax.set_xlim(time[0], time[-1])
    # Ticks just outside the axis are looked up too, so both go on far beyond their ends.
    beyond = 1e3 * (time[-1] - time[0])
    speeds = motion.speed[[0, -1]]
    t = np.concatenate([[time[0] - beyond], time, [time[-1] + beyond]])
    x = np.concatenate([[front[0] - speeds[0] * beyond], front, [front[-1] + speeds[1] * beyond]])
    # One that stands creeps on, so that there is a time to every place.
    x = np.maximum.accumulate(x) + 1e-9 * (t - t[0])

    def position(when: ArrayLike) -> Array:
        found: Array = np.interp(np.asarray(when, dtype=np.float64), t, x)
        return to * found

    def instant(where: ArrayLike) -> Array:
        found: Array = np.interp(to * np.asarray(where, dtype=np.float64), x, t)
        return found

    top = ax.secondary_xaxis("top", functions=(position, instant))
    which = "" if len(run.passages) == 1 else f" of vehicle {vehicle}"
    top.set_xlabel(f"Front axle{which} at x [m]", fontsize=8.0)


def mark_lift_offs(ax: Axes, run: Run, axle: int, *, label: bool = True) -> None:
    """Bands over the times during which an axle, counted from 0, is off the road."""
    for k, each in enumerate(each for each in run.lift_offs if each.axle == axle + 1):
        name = "off the road" if label and k == 0 else None
        ax.axvspan(each.start, each.end, color=LIFTED, linewidth=0.0, zorder=0.4, label=name)
