"""Envelopes: curves along the bridge, or a bar for each support or axle."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise.errors import InputError
from spanwise.plotting.style import (
    DYNAMIC,
    PALE,
    STATIC,
    along,
    legend_above,
    name_places,
    name_supports,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from spanwise.extremes import Envelope
    from spanwise.quantities import Response
    from spanwise.runs import Run

Array: TypeAlias = NDArray[np.float64]


def envelope_of(run: Run, of: Response) -> Envelope:
    """The envelope, refused if there is nothing in it."""
    envelope = run.envelope(of.name)
    if len(envelope.x) == 0:
        raise InputError("quantity", f"{of.name!r}", "no support of this bridge holds the rotation")
    return envelope


def draw_curves(ax: Axes, run: Run, of: Response) -> None:
    """Largest and smallest values along the bridge, dynamic and static."""
    envelope, (_, scale) = envelope_of(run, of), of.shown
    for extremes, line, label in (
        (envelope.max, DYNAMIC, "dynamic"),
        (envelope.min, DYNAMIC, None),
        (envelope.static_max, STATIC, "static"),
        (envelope.static_min, STATIC, None),
    ):
        x, y = envelope.x, scale * extremes.value
        if of.sided and np.isfinite(y).any():
            both: Array = getattr(run if line is DYNAMIC else run.static, of.name)
            largest = extremes in (envelope.max, envelope.static_max)
            sides = scale * (both.max(axis=0) if largest else both.min(axis=0))
            x, y = branches(x, y, sides, run.supports)
        ax.plot(x, y, label=label, **line)
    along(ax, run.bridge)
    legend_above(ax)


def draw_bars(ax: Axes, run: Run, of: Response) -> None:
    """A bar from the smallest to the largest value for each support or axle."""
    envelope, (_, scale) = envelope_of(run, of), of.shown
    for low, high, shift, dynamic in (
        (envelope.min, envelope.max, -0.19, True),
        (envelope.static_min, envelope.static_max, 0.19, False),
    ):
        ends = scale * low.value, scale * high.value
        _bars(ax, shift, *ends, dynamic=dynamic, downward=of.downward)
    if of.axis == "axle":
        alone = len(run.passages) == 1
        names = [str(axle) if alone else f"{vehicle}.{axle}" for vehicle, axle in run.axles]
        name_places(ax, names, f"Axle [{'' if alone else 'vehicle.'}number, front first]")
    else:
        name_supports(ax, run.bridge, of.axis)
    ax.use_sticky_edges = False
    ax.margins(y=0.12)
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
