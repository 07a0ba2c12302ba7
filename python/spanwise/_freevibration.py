"""What the free vibration after the end of a record can still reach."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from spanwise.responses import Quantity
    from spanwise.runs import Run

Side: TypeAlias = Literal["max", "min"]

#: Parts of an extreme, and of the largest of its kind, which to exceed is worth a word.
WORTH: Final = (1e-2, 1e-3)

#: What the two sides of a quantity are called, with unit and scale.
SIDES: Final[dict[tuple[Quantity, Side], tuple[str, str, float]]] = {
    ("deflection", "max"): ("deflection, down", "mm", 1e3),
    ("deflection", "min"): ("deflection, up", "mm", 1e3),
    ("moment", "max"): ("moment, sagging", "kN m", 1e-3),
    ("moment", "min"): ("moment, hogging", "kN m", 1e-3),
    ("shear", "max"): ("shear, positive", "kN", 1e-3),
    ("shear", "min"): ("shear, negative", "kN", 1e-3),
    ("reactions", "max"): ("reaction, up", "kN", 1e-3),
    ("reactions", "min"): ("reaction, uplift", "kN", 1e-3),
    ("clamp_moments", "max"): ("clamp moment, positive", "kN m", 1e-3),
    ("clamp_moments", "min"): ("clamp moment, negative", "kN m", 1e-3),
}


@dataclass(frozen=True)
class Growth:
    """An extreme that free vibration after the end of the record can exceed.

    Attributes
    ----------
    quantity : str
        Of what.
    side : {"max", "min"}
        The largest or the smallest value.
    x : float
        The section, support or clamp where it can grow most [m].
    recorded : float
        The extreme there [m, N m or N].
    reach : float
        What free vibration can reach there: a bound, no value that it must come to.
    """

    quantity: Quantity
    side: Side
    x: float
    recorded: float
    reach: float


def growths(run: Run) -> Iterator[Growth]:
    """Of each quantity and side the one that can grow most, if it can by more than a hundredth.

    And by more than a thousandth of the largest of its kind along the bridge.
    """
    for quantity, side in SIDES:
        reach = run._core.reach(quantity)
        if reach is None or len(reach) == 0:
            continue
        envelope = run.envelope(quantity)
        largest = np.maximum(np.abs(envelope.max.value), np.abs(envelope.min.value)).max()
        sign = 1.0 if side == "max" else -1.0
        recorded = sign * getattr(envelope, side).value
        excess = reach - recorded
        more = np.where(excess > WORTH[0] * np.abs(recorded) + WORTH[1] * largest, excess, 0.0)
        i = int(np.argmax(more))
        if more[i] > 0.0:
            yield Growth(
                quantity,
                side,
                float(envelope.x[i]),
                float(sign * recorded[i]),
                float(sign * reach[i]),
            )


def growth_in_words(growth: Growth) -> str:
    """What can grow, where, how far, and what there is of it."""
    name, unit, scale = SIDES[growth.quantity, growth.side]
    return (
        f"{name}: {growth.reach * scale:.3f} {unit} at most, at x = {growth.x:.3f} m, "
        f"recorded there {growth.recorded * scale + 0.0:.3f}"
    )


def tail_in_words(run: Run) -> str:
    """How long the tail is, and why."""
    length = f"tail {run.tail:.4g} s"
    if run._core.reach("deflection") is None:
        length += ", a vehicle standing on the bridge"
    if run.settings["tail"] is not None:
        return length
    if run.settled:
        return f"{length}, until no extreme can follow"
    return f"{length}, the longest kept: ten periods of the slowest mode"
