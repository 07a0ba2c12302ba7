"""Envelopes: curves along the bridge, or a bar for each support or axle."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise.plotting.style import (
    DYNAMIC,
    PALE,
    STATIC,
    Measure,
    along,
    legend_above,
    metres,
    support_letters,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from spanwise.responses import Envelope, Quantity
    from spanwise.runs import Run

Array: TypeAlias = NDArray[np.float64]

#: Quantities with a value for each section; the others have one for each support or axle.
BY_SECTION = ("deflection", "moment", "shear")


def envelope_of(run: Run, quantity: Quantity) -> Envelope:
    """The envelope, refused if there is nothing in it."""
    envelope = run.envelope(quantity)
    if len(envelope.x) == 0:
        raise ValueError(f"quantity = {quantity!r}: no support of this bridge holds the rotation")
    return envelope


def draw_curves(ax: Axes, run: Run, quantity: Quantity, measure: Measure) -> None:
    """Largest and smallest values along the bridge, dynamic and static."""
    envelope = envelope_of(run, quantity)
    for extremes, line, label in (
        (envelope.max, DYNAMIC, "dynamic"),
        (envelope.min, DYNAMIC, None),
        (envelope.static_max, STATIC, "static"),
        (envelope.static_min, STATIC, None),
    ):
        x, y = envelope.x, measure.factor * extremes.value
        if quantity == "shear" and np.isfinite(y).any():
            of = run if line is DYNAMIC else run.static
            largest = extremes in (envelope.max, envelope.static_max)
            sides = measure.factor * (of.shear.max(axis=0) if largest else of.shear.min(axis=0))
            x, y = branches(x, y, sides, run.supports)
        ax.plot(x, y, label=label, **line)
    along(ax, run.bridge)
    legend_above(ax)


def draw_bars(ax: Axes, run: Run, quantity: Quantity, measure: Measure) -> None:
    """A bar from the smallest to the largest value for each support or axle."""
    envelope = envelope_of(run, quantity)
    for low, high, shift, dynamic in (
        (envelope.min, envelope.max, -0.19, True),
        (envelope.static_min, envelope.static_max, 0.19, False),
    ):
        ends = measure.factor * low.value, measure.factor * high.value
        _bars(ax, shift, *ends, dynamic=dynamic, downward=measure.downward)
    _name_bars(ax, run, quantity)
    legend_above(ax, clear=0.5)


def branches(x: Array, y: Array, sides: Array, supports: Array) -> tuple[Array, Array]:
    """The curve with a cut at every support between, up to which it goes on either side.

    `sides`, of shape (x, 2), are the values just left and just right.
    """
    for support in supports:
        (found,) = np.nonzero(np.isclose(x, support, rtol=0.0, atol=1e-9))
        if len(found) == 0 or not 0 < (i := int(found[0])) < len(x) - 1:
            continue
        left, right = sides[i]
        x, y = np.insert(x, i, [support, support]), np.insert(y, i, [left, np.nan])
        y[i + 2] = right
        sides = np.insert(sides, i, np.nan, axis=0)
        sides = np.insert(sides, i, np.nan, axis=0)
    return x, y


def _bars(
    ax: Axes, shift: float, low: Array, high: Array, *, dynamic: bool, downward: bool
) -> None:
    """Bars from low to high, their values at both ends."""
    places = np.arange(len(low)) + shift
    ax.bar(
        places,
        high - low,
        width=0.34,
        bottom=low,
        label="dynamic" if dynamic else "static",
        facecolor=PALE if dynamic else "white",
        edgecolor=(DYNAMIC if dynamic else STATIC)["color"],
        linewidth=1.0,
        linestyle="-" if dynamic else (0, (4.0, 1.5)),
    )
    for x, bottom, top in zip(places, low, high, strict=True):
        level = abs(top - bottom) < 1e-6 * max(abs(top), abs(bottom))
        ends = ((top, not downward), (bottom, downward))
        for value, up in ends[: 1 if level else 2]:
            ax.annotate(
                f"{round(value, 1) + 0.0:.1f}".replace("-", "\N{MINUS SIGN}"),
                (x, value),
                xytext=(0.0, 2.0 if up else -2.0),
                textcoords="offset points",
                ha="center",
                va="bottom" if up else "top",
                fontsize=7.0 if len(low) <= 6 else 5.5,
            )


def _name_bars(ax: Axes, run: Run, quantity: str) -> None:
    letters = support_letters(run.bridge)
    supports = list(zip(letters, run.bridge.supports, strict=True))
    if quantity == "axle_loads":
        alone = len(run.passages) == 1
        names = [str(axle) if alone else f"{vehicle}.{axle}" for vehicle, axle in run.axles]
        ax.set_xlabel(f"Axle [{'' if alone else 'vehicle.'}number, front first]")
    else:
        names = [
            f"{letter}\n{metres(x)}"
            for letter, (x, _) in supports
            if quantity == "reactions" or x in run.bridge.clamps
        ]
        ax.set_xlabel("Support [letter, distance from the left end]")
    ax.set_xticks(range(len(names)), names)
    ax.set_xlim(-0.6, len(names) - 0.4)
    ax.use_sticky_edges = False
    ax.margins(y=0.12)
