"""The figure of a vehicle: rigid bodies on axles with tyres, suspensions, dampers and friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from spanwise.plotting import symbols
from spanwise.plotting.style import GREY, PALE, axes_for, metres, new_figure, styled, whole
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Spring, Vehicle

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from spanwise.vehicles import AnyVehicle

# Heights above the road in a drawing of full size [points].
AXLE: Final = 36.0
FLOOR: Final = 76.0
ROOF: Final = 104.0
#: Of one body among several, and the gap to the next above it.
DEPTH: Final = 16.0
GAP: Final = 20.0

#: Height of a line of the table of values [in].
LINE: Final = 0.183


class VehiclePlot:
    """Figures of a vehicle, reached as ``vehicle.plot``; each draws into what it is given."""

    def __init__(self, vehicle: AnyVehicle) -> None:
        self._vehicle = vehicle

    @styled
    def model(self, *, ax: Axes | None = None) -> Figure:
        """The bodies on their axles, each a tyre below a suspension that may rub; or the train.

        To scale along the road; heights are schematic. A new figure also lists the values.
        """
        if ax is None:
            columns, notes = _values(self._vehicle)
            drawing = 2.9 + (top(self._vehicle) - ROOF) / 72.0
            table = LINE * (len(columns) + len(notes))
            figure = new_figure(drawing + table)
            ax, below = figure.subplots(2, 1, height_ratios=[drawing, table])
            _write_values(below, columns, notes)
        ax = axes_for(ax)
        _draw_model(ax, self._vehicle)
        return whole(ax)


def overhang(vehicle: AnyVehicle) -> float:
    """Length of the bodies drawn beyond the outer axles [m]."""
    alone = not (isinstance(vehicle, Vehicle) and vehicle.bodies)
    return max(0.2 * vehicle.wheelbase, 0.8) if alone else 0.8


def extent(vehicle: AnyVehicle) -> tuple[float, float]:
    """Rear and front of what is drawn, ahead of the centre of mass [m]."""
    at, beyond = vehicle.axle_positions, overhang(vehicle)
    boxes = _boxes(vehicle) if isinstance(vehicle, Vehicle) else []
    back = min([at[-1] - beyond, *(box.back for box in boxes)])
    return back, max([at[0] + beyond, *(box.front for box in boxes)])


@dataclass(frozen=True)
class _Box:
    """A body in the drawing: ends and centre of mass [m], floor and roof [points]."""

    back: float
    front: float
    centre: float
    floor: float
    roof: float


def _levels(vehicle: Vehicle) -> list[int]:
    """How many bodies each one stands on.

    A body that is held between its own axles is a bogie below; any other lies on what it is
    coupled to.
    """
    levels = [0] * len(vehicle.parts)
    for _ in levels:
        for b, body in enumerate(vehicle.parts):
            at = [axle.position for axle in body.axles]
            for end in body.joints:
                below = len(at) > 0 and (min(at) <= end.own <= max(at) or isinstance(end, Spring))
                low, high = (b, end.to) if below else (end.to, b)
                levels[high] = max(levels[high], levels[low] + 1)
    return levels


def _boxes(vehicle: Vehicle) -> list[_Box]:
    parts, beyond = vehicle.parts, overhang(vehicle)
    if len(parts) == 1:
        at = [axle.position for axle in parts[0].axles]
        centre = vehicle.body_positions[0]
        return [_Box(centre + min(at) - beyond, centre + max(at) + beyond, centre, FLOOR, ROOF)]
    boxes = []
    for b, (body, x, level) in enumerate(
        zip(parts, vehicle.body_positions, _levels(vehicle), strict=True)
    ):
        own = [end.own for end in body.joints]
        theirs = [end.at for other in parts for end in other.joints if end.to == b]
        held = [0.0, *own, *theirs]
        rolling = [axle.position for axle in body.axles]
        back = min([each - 0.4 for each in held] + [each - beyond for each in rolling])
        front = max([each + 0.4 for each in held] + [each + beyond for each in rolling])
        floor = FLOOR + level * (DEPTH + GAP)
        boxes.append(_Box(x + back, x + front, x, floor, floor + DEPTH))
    return boxes


def top(vehicle: AnyVehicle) -> float:
    """Height of all there is above the road [points]."""
    if not isinstance(vehicle, Vehicle):
        return AXLE
    return max(box.roof for box in _boxes(vehicle))


def draw_vehicle(
    ax: Axes, vehicle: AnyVehicle, centre: float, *, scale: float = 1.0, to: float = 1.0
) -> None:
    """The vehicle on the base line, its centre of mass at `centre` [m], heights by this scale.

    It goes to the right, or to the left with `to` = -1.
    """
    at = vehicle.axle_positions
    if isinstance(vehicle, Vehicle):
        boxes = _boxes(vehicle)
        _draw_bodies(ax, vehicle, boxes, centre, scale, to)
        first = max(boxes, key=lambda box: box.front)
        front, middle = first.front, 0.5 * (first.floor + first.roof)
    else:
        _draw_train(ax, vehicle, centre + to * at, scale)
        front, middle = at[0] + (1.0 if isinstance(vehicle, MovingMasses) else 0.3), 0.5 * AXLE
    ahead = symbols.local(ax, centre + to * front)
    middle *= scale
    symbols.stroke(ax, ahead, [(5.0 * to, middle), (20.0 * to, middle)], width=1.2)
    head = [(26.0 * to, middle), (18.0 * to, middle + 3.0), (18.0 * to, middle - 3.0)]
    symbols.stroke(ax, ahead, head, fill="black")


def _draw_bodies(
    ax: Axes, vehicle: Vehicle, boxes: list[_Box], centre: float, scale: float, to: float
) -> None:
    at, across = vehicle.axle_positions, symbols.level(ax)
    gaps = -np.diff(at) * symbols.points_per_metre(ax)
    most = max((len(_suspension(axle)) for axle in vehicle.axles), default=1)
    widest = 6.0 * scale if most < 3 else 4.5 * scale
    half = float(np.clip(0.15 * gaps.min(initial=np.inf), 0.8, widest))
    for box in boxes:
        back, front = centre + to * box.back, centre + to * box.front
        floor, roof = scale * box.floor, scale * box.roof
        outline = [(back, floor), (front, floor), (front, roof), (back, roof)]
        symbols.stroke(ax, across, outline, fill=PALE)
        radius = (5.5 if len(boxes) == 1 else 4.5) * scale
        symbols.centre_of_mass(ax, centre + to * box.centre, 0.5 * (floor + roof), radius=radius)
    for x, axle, (b, _) in zip(centre + to * at, vehicle.axles, vehicle.axle_order, strict=True):
        _draw_axle(ax, x, axle, half, scale)
        if boxes[b].floor > FLOOR:
            bar = [(-2.0 * half, scale * FLOOR), (2.0 * half, scale * FLOOR)]
            symbols.stroke(ax, symbols.local(ax, x), bar)
            for side in (-1.0, 1.0):
                post = [(side * half, scale * FLOOR), (side * half, scale * boxes[b].floor)]
                symbols.stroke(ax, symbols.local(ax, x), post)
    for b, body in enumerate(vehicle.parts):
        for end in body.joints:
            low, high = sorted((boxes[b], boxes[end.to]), key=lambda box: box.floor)
            x = centre + to * (boxes[b].centre + end.own)
            if isinstance(end, Spring):
                drawn = _beside(end.damping, end.friction_limit)
                _draw_row(ax, x, drawn, scale * low.roof, scale * high.floor, 4.0 * scale)
            else:
                symbols.hinge(ax, x, scale * low.roof, scale * high.floor)


def _draw_axle(ax: Axes, x: float, axle: Axle, half: float, scale: float) -> None:
    here, height, floor = symbols.local(ax, x), scale * AXLE, scale * FLOOR
    symbols.stroke(ax, here, [(-half, 0.8), (half, 0.8)], width=2.0)
    _draw_row(ax, x, _beside(axle.tyre_damping, 0.0), 0.0, height, half)
    _draw_row(ax, x, _suspension(axle), height, floor, 0.8 * half, half)
    wide = (2.3 if len(_suspension(axle)) < 3 else 3.4) * half
    if axle.mass > 0.0:
        low, high = height - 3.5 * scale, height + 3.5 * scale
        block = [(-wide, low), (wide, low), (wide, high), (-wide, high)]
        symbols.stroke(ax, here, block, fill=GREY, order=3.3)
    else:
        symbols.stroke(ax, here, [(-wide, height), (wide, height)], width=1.6)


#: Draws one element between two heights.
_Element = Callable[..., None]


def _beside(damping: float, friction_limit: float) -> list[_Element]:
    """A spring and what acts beside it, from left to right."""
    drawn: list[_Element] = [symbols.spring]
    if damping > 0.0:
        drawn.append(symbols.dashpot)
    if friction_limit > 0.0:
        drawn.append(symbols.friction)
    return drawn


def _suspension(axle: Axle) -> list[_Element]:
    return _beside(axle.suspension_damping, axle.friction_limit)


def _draw_row(
    ax: Axes,
    x: float,
    drawn: list[_Element],
    low: float,
    high: float,
    half: float,
    apart: float | None = None,
) -> None:
    """Elements side by side between two heights."""
    step = (half if apart is None else apart) * (3.0 if len(drawn) < 3 else 2.5)
    for k, element in enumerate(drawn):
        shift = (k - 0.5 * (len(drawn) - 1)) * step
        width = 0.7 * half if element is symbols.dashpot else half
        element(ax, x, shift, low, high, width)


def _draw_train(ax: Axes, train: AnyVehicle, at: NDArray[np.float64], scale: float) -> None:
    for x in at:
        if isinstance(train, ForceTrain):
            symbols.arrow(ax, x, 1.0, scale * AXLE)
        else:
            high = 0.6 * scale * AXLE
            block = [(-7.0, 0.0), (7.0, 0.0), (7.0, high), (-7.0, high)]
            symbols.stroke(ax, symbols.local(ax, x), block, fill=PALE)


def _draw_model(ax: Axes, vehicle: AnyVehicle) -> None:
    at, across = vehicle.axle_positions, symbols.level(ax)
    back, front = extent(vehicle)
    boxes = _boxes(vehicle) if isinstance(vehicle, Vehicle) else []
    margin = 0.3 * (front - back)
    ax.set_xlim(back - margin, front + margin)
    ax.set_ylim(-58.0, top(vehicle) + 12.0)
    ax.set_yticks([])
    ax.spines[["left", "top", "right"]].set_visible(False)
    centre = "loads" if isinstance(vehicle, ForceTrain) else "mass"
    ax.set_xlabel(f"Distance ahead of the centre of {centre} [m]")
    road = [(back - margin, 0.0), (front + margin, 0.0)]
    symbols.stroke(ax, across, road, color=GREY, width=1.0, order=1.0)
    marks = sorted(at.tolist())
    if len(boxes) == 1:
        (box,) = boxes
        middle = 0.5 * (FLOOR + ROOF)
        if box.centre not in at:
            plumb = [(0.0, -34.0), (0.0, middle)]
            here = symbols.local(ax, box.centre)
            symbols.stroke(ax, here, plumb, color=GREY, width=0.5, order=3.5)
            marks = sorted([*marks, box.centre])
    draw_vehicle(ax, vehicle, 0.0)
    for axle, x in enumerate(at, 1):
        symbols.write(ax, symbols.local(ax, x), 0.0, -9.0, str(axle), size=9.0)
    for start, stop in pairwise(marks):
        symbols.dimension(ax, start, stop, -30.0)
    if len(marks) > 2:
        symbols.dimension(ax, at[-1], at[0], -50.0)
    if not isinstance(vehicle, Vehicle):
        return
    for box, body in zip(boxes, vehicle.parts, strict=True):
        if len(boxes) == 1 and body.cg_height > 0.0:
            _height(ax, body.cg_height, box.back, 0.5 * (box.floor + box.roof))
    _words(ax, vehicle.axles[0], at[0])


def _height(ax: Axes, cg_height: float, back: float, middle: float) -> None:
    """The height of the centre of mass, dimensioned behind the body."""
    here, x = symbols.local(ax, back), -14.0
    symbols.stroke(ax, here, [(x, 0.0), (x, middle)], color=GREY, width=0.6)
    for y, side in ((0.0, 1.0), (middle, -1.0)):
        head = [(x, y), (x - 1.5, y + 5.0 * side), (x + 1.5, y + 5.0 * side)]
        symbols.stroke(ax, here, head, color=GREY, width=0.3, fill=GREY)
    symbols.stroke(ax, here, [(x - 3.0, middle), (-3.0, middle)], color=GREY, width=0.6)
    text = f"centre\nof mass\n{metres(cg_height)}"
    symbols.write(ax, here, x - 4.0, 0.5 * middle, text, color=GREY, size=7.5, across="right")


def _words(ax: Axes, axle: Axle, x: float) -> None:
    """What the springs stand for, beside the front axle."""
    beside = symbols.local(ax, x)
    acting = ["suspension spring"]
    acting += ["damper"] if axle.suspension_damping > 0.0 else []
    acting += ["friction"] if axle.friction_limit > 0.0 else []
    words = {
        1: "suspension spring",
        2: "suspension spring\nand " + acting[-1],
        3: "suspension spring,\ndamper and friction",
    }[len(acting)]
    symbols.write(ax, beside, 20.0, 0.5 * (AXLE + FLOOR) + 3.0, words, size=7.5, across="left")
    if axle.mass > 0.0:
        symbols.write(ax, beside, 20.0, AXLE, "unsprung mass", size=7.5, across="left")
    tyre = "tyre" + (" and its damping" if axle.tyre_damping > 0.0 else "")
    symbols.write(ax, beside, 20.0, 0.45 * AXLE, tyre, size=7.5, across="left")


def _values(vehicle: AnyVehicle) -> tuple[list[tuple[str, list[str]]], list[str]]:
    """Rows of the table, with a value for each axle, and lines below it about the bodies."""
    kilo = 1e-3
    loads = vehicle.static_loads()
    rows: list[tuple[str, list[str]]] = [
        ("Axle", [str(k) for k in range(1, len(loads) + 1)]),
        ("Static load [kN]", [f"{kilo * load:.1f}" for load in loads]),
    ]
    if not isinstance(vehicle, Vehicle):
        if isinstance(vehicle, MovingMasses):
            rows.append(("Mass [t]", [f"{kilo * mass:.2f}" for mass in vehicle.masses]))
        return rows, [f"{kilo * loads.sum():.1f} kN in all"]
    for name, key, form in (
        ("Tyre stiffness [kN/m]", "tyre_stiffness", ".0f"),
        ("Tyre damping [kN s/m]", "tyre_damping", ".1f"),
        ("Unsprung mass [t]", "mass", ".2f"),
        ("Suspension stiffness [kN/m]", "suspension_stiffness", ".0f"),
        ("Suspension damping [kN s/m]", "suspension_damping", ".1f"),
        ("Friction limit [kN]", "friction_limit", ".2f"),
    ):
        values = [getattr(axle, key) for axle in vehicle.axles]
        if any(values):
            rows.append((name, [_kilo(value, form) for value in values]))
    notes = []
    for b, body in enumerate(vehicle.parts, 1):
        note = f"Body {b if vehicle.bodies else ''} {kilo * body.mass:.2f} t".replace("  ", " ")
        if body.pitch_inertia is not None and f"body {b} pitch" in vehicle.coordinates:
            note += f", pitch inertia {kilo * body.pitch_inertia:.2f} t m²"
        notes.append(note)
    return rows, notes


def _kilo(value: float, form: str) -> str:
    return "∞" if np.isinf(value) else format(1e-3 * value, form)


def _write_values(ax: Axes, rows: list[tuple[str, list[str]]], notes: list[str]) -> None:
    """A table of the axles and lines of text about the bodies."""
    ax.axis("off")
    row = 1.0 / (len(rows) + len(notes))
    column = min(0.12, 0.6 / len(rows[0][1]))
    for i, (name, values) in enumerate(rows):
        y = 1.0 - (i + 0.5) * row
        symbols.write(ax, ax.transAxes, 0.05, y, name, across="left")
        for k, value in enumerate(values):
            symbols.write(ax, ax.transAxes, 0.38 + (k + 1) * column, y, value, across="right")
    for i, note in enumerate(notes):
        y = 1.0 - (len(rows) + i + 0.5) * row
        symbols.write(ax, ax.transAxes, 0.05, y, note, across="left")
    ax.plot([0.05, 0.38 + len(rows[0][1]) * column], [1.0 - row] * 2, color=GREY, linewidth=0.6,
            transform=ax.transAxes, clip_on=False)  # fmt: skip
