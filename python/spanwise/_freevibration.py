"""What the free vibration after the end of a record can still reach."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from spanwise.quantities import RESPONSES, Sense, Side, of_bridges

if TYPE_CHECKING:
    from spanwise.runs import Run

#: Parts of an extreme, and of the largest of its kind, which to exceed is worth a word.
WORTH: Final = (1e-2, 1e-3)

#: Which values of a response are its largest, and which its smallest.
SENSES: Final[dict[Side, Sense]] = {"max": "positive", "min": "negative"}


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
        The extreme there in SI units.
    reach : float
        What free vibration can reach there: a bound, no value that it must come to.
    """

    quantity: str
    side: Side
    x: float
    recorded: float
    reach: float

    def __str__(self) -> str:
        """What can grow, where, how far, and what there is of it."""
        of = RESPONSES[self.quantity]
        unit, scale = of.shown
        return (
            f"{of.called(SENSES[self.side])}: {self.reach * scale:.3f} {unit} at most, at "
            f"x = {self.x:.3f} m, recorded there {self.recorded * scale + 0.0:.3f}"
        )


def growths(run: Run) -> Iterator[Growth]:
    """Of each quantity and side the one that can grow most, if it can by more than a hundredth.

    And by more than a thousandth of the largest of its kind along the bridge. Slope, velocity and
    acceleration of the deck, for which the tail is not made, are left out.
    """
    for each in (each for each in of_bridges() if each.usual):
        reach = run._core.reach(each.name)
        if reach is None or len(reach) == 0:
            continue
        envelope = run.envelope(each.name)
        largest = np.maximum(np.abs(envelope.max.value), np.abs(envelope.min.value)).max()
        sides: tuple[tuple[Side, float], ...] = (("max", 1.0), ("min", -1.0))
        for side, sign in sides:
            recorded = sign * getattr(envelope, side).value
            excess = reach - recorded
            more = np.where(excess > WORTH[0] * np.abs(recorded) + WORTH[1] * largest, excess, 0.0)
            i = int(np.argmax(more))
            if more[i] > 0.0:
                there = float(sign * recorded[i]), float(sign * reach[i])
                yield Growth(each.name, side, float(envelope.x[i]), *there)
