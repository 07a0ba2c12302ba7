"""Signs of engineering drawings, upright in points so that they keep their shape at any scale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from spanwise.plotting.style import GREY, metres

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import Transform


def local(ax: Axes, x: float) -> Transform:
    """Coordinates in points from where x [m] meets the base line y = 0."""
    from matplotlib.transforms import Affine2D, ScaledTranslation

    points = Affine2D().scale(1.0 / 72.0) + ax.figure.dpi_scale_trans
    data: Any = ax.transData
    return points + ScaledTranslation(x, 0.0, data)


def level(ax: Axes) -> Transform:
    """Coordinates across in metres, upright in points from the base line y = 0."""
    from matplotlib.transforms import blended_transform_factory

    return blended_transform_factory(ax.transData, local(ax, 0.0))


def stroke(
    ax: Axes,
    transform: Transform,
    points: NDArray[np.float64] | list[tuple[float, float]],
    *,
    color: str = "black",
    width: float = 0.9,
    fill: str | None = None,
    order: float = 3.0,
) -> None:
    """A line through points, or with a fill the polygon they enclose."""
    xy = np.asarray(points, dtype=np.float64)
    if fill is None:
        ax.plot(
            *xy.T,
            color=color,
            linewidth=width,
            transform=transform,
            clip_on=False,
            zorder=order,
            scalex=False,
            scaley=False,
            solid_capstyle="butt",
            in_layout=False,
        )
        return
    from matplotlib.patches import Polygon

    ax.add_artist(
        Polygon(
            xy,
            closed=True,
            facecolor=fill,
            edgecolor=color,
            linewidth=width,
            transform=transform,
            clip_on=False,
            zorder=order,
            in_layout=False,
        )
    )


def write(
    ax: Axes,
    transform: Transform,
    x: float,
    y: float,
    text: str,
    *,
    color: str = "black",
    size: float = 8.0,
    across: str = "center",
    up: str = "center",
) -> None:
    """Text that is never cut off."""
    ax.text(
        x,
        y,
        text,
        transform=transform,
        color=color,
        fontsize=size,
        ha=across,
        va=up,
        clip_on=False,
        linespacing=1.25,
    )


def hatch(ax: Axes, transform: Transform, start: float, stop: float, y: float, step: float) -> None:
    """Ground below a line: short strokes down to the left."""
    for x in np.arange(start + 0.5 * step, stop, step):
        stroke(ax, transform, [(x, y), (x - 3.0, y - 3.5)], width=0.6)


def pin(ax: Axes, x: float, *, roller: bool) -> None:
    """A support that turns freely, below the base line: on hatched ground, or on rollers."""
    here = local(ax, x)
    stroke(ax, here, [(0.0, -1.5), (-5.0, -10.0), (5.0, -10.0)], fill="white")
    ground = -10.0
    if roller:
        ground = -13.4
        turn = np.linspace(0.0, 2.0 * np.pi, 25)
        for middle in (-3.0, 3.0):
            wheel = np.column_stack([middle + 1.6 * np.cos(turn), -11.7 + 1.6 * np.sin(turn)])
            stroke(ax, here, wheel, width=0.7, fill="white")
    stroke(ax, here, [(-8.0, ground), (8.0, ground)])
    hatch(ax, here, -6.0, 9.0, ground, 3.2)


def clamp(ax: Axes, x: float, *, left: bool) -> None:
    """An end built into a wall, which is at its left or at its right."""
    here, side = local(ax, x), -1.0 if left else 1.0
    stroke(ax, here, [(0.0, -11.0), (0.0, 11.0)], width=1.4)
    for y in np.arange(-9.5, 11.5, 3.2):
        stroke(ax, here, [(0.0, y), (side * 4.0, y - 3.5)], width=0.6)


def clamped_pier(ax: Axes, x: float) -> None:
    """A support inside the beam that holds deflection and rotation: a block on hatched ground."""
    here = local(ax, x)
    stroke(ax, here, [(-4.0, -1.5), (4.0, -1.5), (4.0, -10.0), (-4.0, -10.0)], fill="white")
    stroke(ax, here, [(-8.0, -10.0), (8.0, -10.0)])
    hatch(ax, here, -6.0, 9.0, -10.0, 3.2)


def sprung(ax: Axes, x: float, *, turning: bool, held: bool) -> None:
    """A support on an upright spring; with a spring for the rotation, or with rotation held."""
    here = local(ax, x)
    if held:
        stroke(ax, here, [(-5.0, -2.2), (5.0, -2.2)], width=1.6)
    spring(ax, x, 0.0, -14.5, -2.0, 3.2)
    stroke(ax, here, [(-8.0, -14.5), (8.0, -14.5)])
    hatch(ax, here, -6.0, 9.0, -14.5, 3.2)
    if turning:
        spiral(ax, x)


def spiral(ax: Axes, x: float) -> None:
    """A spring that resists rotation, around the base line."""
    turn = np.linspace(0.0, 3.5 * np.pi, 61)
    radius = 2.0 + 5.0 * turn / turn[-1]
    coil = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])
    stroke(ax, local(ax, x), coil, width=0.8, order=6.0)


def open_hinge(ax: Axes, x: float) -> None:
    """An open circle in the beam."""
    turn = np.linspace(0.0, 2.0 * np.pi, 37)
    ring = np.column_stack([3.8 * np.cos(turn), 3.8 * np.sin(turn)])
    stroke(ax, local(ax, x), ring, width=1.2, fill="white", order=5.5)


def spring(ax: Axes, x: float, shift: float, low: float, high: float, half_width: float) -> None:
    """An upright spring between two heights, shifted sideways; all in points but x."""
    lead = 0.16 * (high - low)
    turns = 4
    y = np.linspace(low + lead, high - lead, 2 * turns + 1)
    sides = np.where(np.arange(len(y)) % 2 == 0, -1.0, 1.0) * half_width
    sides[[0, -1]] = 0.0
    coil = np.column_stack([shift + sides, y])
    stroke(ax, local(ax, x), np.vstack([[(shift, low)], coil, [(shift, high)]]))


def friction(ax: Axes, x: float, shift: float, low: float, high: float, half_width: float) -> None:
    """Two plates pressed together, one held below, one above: an element that slips."""
    here, third = local(ax, x), (high - low) / 3.0
    gap = 0.22 * half_width
    stroke(ax, here, [(shift + gap, low), (shift + gap, high - third)], width=1.3)
    stroke(ax, here, [(shift - gap, low + third), (shift - gap, high)], width=1.3)
    middle = 0.5 * (low + high)
    for side in (-1.0, 1.0):
        tip, tail = shift + side * 1.4 * gap, shift + side * (gap + 0.95 * half_width)
        barb = 0.3 * half_width
        stroke(ax, here, [(tail, middle), (tip, middle)], width=0.7)
        head = [
            (tip + side * barb, middle + barb),
            (tip, middle),
            (tip + side * barb, middle - barb),
        ]
        stroke(ax, here, head, width=0.7)


def dashpot(ax: Axes, x: float, shift: float, low: float, high: float, half_width: float) -> None:
    """An upright damper between two heights: a piston from above in a cup."""
    here, third = local(ax, x), (high - low) / 3.0
    inner = 0.7 * half_width
    cup = [
        (shift - half_width, high - third),
        (shift - half_width, low + third),
        (shift + half_width, low + third),
        (shift + half_width, high - third),
    ]
    middle = 0.5 * (low + high)
    stroke(ax, here, cup)
    stroke(ax, here, [(shift, low), (shift, low + third)])
    stroke(ax, here, [(shift - inner, middle), (shift + inner, middle)], width=1.4)
    stroke(ax, here, [(shift, middle), (shift, high)])


def hinge(ax: Axes, x: float, low: float, high: float) -> None:
    """A pin in two brackets that hold one part above another."""
    here, middle = local(ax, x), 0.5 * (low + high)
    for y in (low, high):
        stroke(ax, here, [(-4.0, y), (0.0, middle), (4.0, y)], fill="white", order=3.2)
    turn = np.linspace(0.0, 2.0 * np.pi, 25)
    pin_ = np.column_stack([1.9 * np.cos(turn), middle + 1.9 * np.sin(turn)])
    stroke(ax, here, pin_, fill="white", order=3.4)


def arrow(ax: Axes, x: float, low: float, high: float) -> None:
    """A force downward from one height to another."""
    here = local(ax, x)
    stroke(ax, here, [(0.0, low + 5.0), (0.0, high)], width=1.4)
    stroke(ax, here, [(0.0, low), (-3.0, low + 8.0), (3.0, low + 8.0)], fill="black")


def centre_of_mass(ax: Axes, x: float, y: float, radius: float = 5.0) -> None:
    """The quartered circle, y [points] above the base line."""
    here = local(ax, x)
    turn = np.linspace(0.0, 2.0 * np.pi, 49)
    rim = np.column_stack([radius * np.cos(turn), y + radius * np.sin(turn)])
    stroke(ax, here, rim, width=0.8, fill="white", order=4.0)
    for start in (0.0, np.pi):
        turn = np.linspace(start, start + 0.5 * np.pi, 13)
        quarter = np.column_stack([radius * np.cos(turn), y + radius * np.sin(turn)])
        corner = np.array([[0.0, y]])
        stroke(ax, here, np.vstack([corner, quarter]), width=0.5, fill="black", order=4.1)


def points_per_metre(ax: Axes) -> float:
    """Length of a metre along the bridge on paper [points], rather too small than too large."""
    left, right = ax.get_xlim()
    return 72.0 * ax.bbox.width / ax.figure.dpi / (right - left)


def dimension(ax: Axes, start: float, stop: float, y: float) -> None:
    """A dimension line from start to stop [m], y [points] from the base line.

    Where the text finds no room it loses its unit, and if that does not help it goes below.
    """
    across, room = level(ax), points_per_metre(ax) * (stop - start)
    text = metres(stop - start)
    if 4.6 * len(text) > room:
        text = text.removesuffix(" m")
    for end in (start, stop):
        stroke(ax, across, [(end, y - 3.0), (end, y + 3.0)], color=GREY, width=0.6)
    stroke(ax, across, [(start, y), (stop, y)], color=GREY, width=0.6)
    if room > 16.0:
        for x, side in ((start, 1.0), (stop, -1.0)):
            head = [(0.0, y), (side * 5.0, y + 1.5), (side * 5.0, y - 1.5)]
            stroke(ax, local(ax, x), head, color=GREY, width=0.3, fill=GREY)
    fits = 4.6 * len(text) < room
    write(
        ax,
        across,
        0.5 * (start + stop),
        y + (2.5 if fits else -3.5),
        text,
        color=GREY,
        size=7.5,
        up="bottom" if fits else "top",
    )
