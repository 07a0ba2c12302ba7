"""The figure of a vehicle: a rigid body on axles with tyres, suspensions and friction."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from spanwise.plotting import symbols
from spanwise.plotting.style import GREY, PALE, metres, new_figure, styled, whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from spanwise.vehicles import Axle, Vehicle

# Heights above the road in a drawing of full size [points].
AXLE: Final = 36.0
FLOOR: Final = 76.0
ROOF: Final = 104.0


class VehiclePlot:
    """Figures of a vehicle, reached as ``vehicle.plot``."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._vehicle = vehicle

    @styled
    def model(self, *, ax: Axes | None = None) -> Figure:
        """The rigid body on its axles, each a tyre in series with a suspension that may rub.

        To scale along the road; heights are schematic. A new figure also lists the values.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure.

        Returns
        -------
        matplotlib.figure.Figure
        """
        if ax is None:
            drawing, table = 2.9, 1.1
            figure = new_figure(drawing + table)
            ax, below = figure.subplots(2, 1, height_ratios=[drawing, table])
            _values(below, self._vehicle)
        _draw_model(ax, self._vehicle)
        return whole(ax)


def overhang(vehicle: Vehicle) -> float:
    """Length of the body drawn beyond the outer axles [m]."""
    return max(0.2 * vehicle.wheelbase, 0.8)


def draw_vehicle(ax: Axes, vehicle: Vehicle, centre: float, *, scale: float = 1.0) -> None:
    """The vehicle on the base line, its centre of mass at `centre` [m], heights by this scale."""
    at, across = vehicle.axle_positions, symbols.level(ax)
    gaps = -np.diff(at) * symbols.points_per_metre(ax)
    half = float(np.clip(0.15 * gaps.min(initial=np.inf), 0.8, 6.0 * scale))
    axle, floor, roof = scale * AXLE, scale * FLOOR, scale * ROOF
    back, front = centre + at[-1] - overhang(vehicle), centre + at[0] + overhang(vehicle)
    symbols.stroke(
        ax, across, [(back, floor), (front, floor), (front, roof), (back, roof)], fill=PALE
    )
    for x, properties in zip(centre + at, vehicle.axles, strict=True):
        here = symbols.local(ax, x)
        symbols.stroke(ax, here, [(-half, 0.8), (half, 0.8)], width=2.0)
        symbols.spring(ax, x, 0.0, 0.0, axle, half)
        symbols.stroke(ax, here, [(-2.3 * half, axle), (2.3 * half, axle)], width=1.6)
        rubs = properties.friction_limit > 0.0
        symbols.spring(ax, x, -1.5 * half if rubs else 0.0, axle, floor, 0.8 * half)
        if rubs:
            symbols.friction(ax, x, 1.5 * half, axle, floor, 0.8 * half)
    middle = 0.5 * (floor + roof)
    symbols.centre_of_mass(ax, centre, middle, radius=5.5 * scale)
    ahead = symbols.local(ax, front)
    symbols.stroke(ax, ahead, [(5.0, middle), (20.0, middle)], width=1.2)
    head = [(26.0, middle), (18.0, middle + 3.0), (18.0, middle - 3.0)]
    symbols.stroke(ax, ahead, head, fill="black")


def _draw_model(ax: Axes, vehicle: Vehicle) -> None:
    at, across = vehicle.axle_positions, symbols.level(ax)
    back, front = at[-1] - overhang(vehicle), at[0] + overhang(vehicle)
    margin = 0.3 * (front - back)
    ax.set_xlim(back - margin, front + margin)
    ax.set_ylim(-58.0, 116.0)
    ax.set_yticks([])
    ax.spines[["left", "top", "right"]].set_visible(False)
    ax.set_xlabel("Distance ahead of the centre of mass [m]")
    road = [(back - margin, 0.0), (front + margin, 0.0)]
    symbols.stroke(ax, across, road, color=GREY, width=1.0, order=1.0)
    middle = 0.5 * (FLOOR + ROOF)
    if 0.0 not in at:
        plumb = [(0.0, -34.0), (0.0, middle)]
        symbols.stroke(ax, symbols.local(ax, 0.0), plumb, color=GREY, width=0.5, order=3.5)
    draw_vehicle(ax, vehicle, 0.0)
    for axle, x in enumerate(at, 1):
        symbols.write(ax, symbols.local(ax, x), 0.0, -9.0, str(axle), size=9.0)
    marks = sorted({*at.tolist(), 0.0})
    for start, stop in pairwise(marks):
        symbols.dimension(ax, start, stop, -30.0)
    if len(marks) > 2:
        symbols.dimension(ax, at[-1], at[0], -50.0)
    if vehicle.cg_height > 0.0:
        _height(ax, vehicle, back, middle)
    _words(ax, vehicle.axles[0])


def _height(ax: Axes, vehicle: Vehicle, back: float, middle: float) -> None:
    """The height of the centre of mass, dimensioned behind the body."""
    here, x = symbols.local(ax, back), -14.0
    symbols.stroke(ax, here, [(x, 0.0), (x, middle)], color=GREY, width=0.6)
    for y, side in ((0.0, 1.0), (middle, -1.0)):
        head = [(x, y), (x - 1.5, y + 5.0 * side), (x + 1.5, y + 5.0 * side)]
        symbols.stroke(ax, here, head, color=GREY, width=0.3, fill=GREY)
    symbols.stroke(ax, here, [(x - 3.0, middle), (-3.0, middle)], color=GREY, width=0.6)
    text = f"centre\nof mass\n{metres(vehicle.cg_height)}"
    symbols.write(ax, here, x - 4.0, 0.5 * middle, text, color=GREY, size=7.5, across="right")


def _words(ax: Axes, axle: Axle) -> None:
    """What the springs stand for, beside the front axle."""
    beside = symbols.local(ax, axle.position)
    parallel = "suspension spring" + ("\nand friction" if axle.friction_limit > 0.0 else "")
    symbols.write(ax, beside, 20.0, 0.5 * (AXLE + FLOOR), parallel, size=7.5, across="left")
    symbols.write(ax, beside, 20.0, 0.5 * AXLE, "tyre", size=7.5, across="left")


def _values(ax: Axes, vehicle: Vehicle) -> None:
    """A table of the body and of the axles."""
    ax.axis("off")
    kilo = 1e-3
    rows: list[tuple[str, list[str]]] = [
        ("Axle", [str(k) for k in range(1, len(vehicle.axles) + 1)]),
        ("Static load [kN]", [f"{kilo * load:.1f}" for load in vehicle.static_loads()]),
        ("Tyre stiffness [kN/m]", [f"{kilo * a.tyre_stiffness:.0f}" for a in vehicle.axles]),
        (
            "Suspension stiffness [kN/m]",
            [f"{kilo * a.suspension_stiffness:.0f}" for a in vehicle.axles],
        ),
        (
            "Friction limit [kN]",
            ["∞" if np.isinf(a.friction_limit) else f"{kilo * a.friction_limit:.2f}"
             for a in vehicle.axles],
        ),
    ]  # fmt: skip
    body = f"Body {kilo * vehicle.mass:.2f} t"
    if len(vehicle.axles) > 1:
        body += f", pitch inertia {kilo * vehicle.pitch_inertia:.2f} t m²"
    row = 1.0 / (len(rows) + 1)
    column = min(0.12, 0.6 / len(vehicle.axles))
    for i, (name, values) in enumerate(rows):
        y = 1.0 - (i + 0.5) * row
        symbols.write(ax, ax.transAxes, 0.05, y, name, across="left")
        for k, value in enumerate(values):
            symbols.write(ax, ax.transAxes, 0.38 + (k + 1) * column, y, value, across="right")
    symbols.write(ax, ax.transAxes, 0.05, 0.5 * row, body, across="left")
    ax.plot([0.05, 0.38 + len(vehicle.axles) * column], [1.0 - row] * 2, color=GREY, linewidth=0.6,
            transform=ax.transAxes, clip_on=False)  # fmt: skip
