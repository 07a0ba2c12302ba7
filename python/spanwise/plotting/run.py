"""Figures of a crossing: envelopes, impact factors, histories, the motion of the vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import count, finite
from spanwise.errors import InputError
from spanwise.plotting.bridge import draw_bridge
from spanwise.plotting.envelope import draw_bars, draw_curves
from spanwise.plotting.factors import along_bridge, mask_note, plot_masked
from spanwise.plotting.history import Side, column, front_axle_on_top, mark_lift_offs
from spanwise.plotting.style import (
    DYNAMIC,
    GREY,
    HEIGHT,
    LINES,
    PALE,
    STATIC,
    along,
    axes_for,
    figure_for,
    legend_above,
    limits_on,
    new_figure,
    response_on,
    styled,
    whole,
    zero_line,
)
from spanwise.plotting.vehicle import draw_vehicle, extent, top
from spanwise.quantities import response, telling

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from spanwise.runs import Run
    from spanwise.vehicles import AnyVehicle

Array: TypeAlias = NDArray[np.float64]


#: Farthest from the bridge that a vehicle is drawn [m].
FARTHEST: Final = 1e6

#: Of the heights of vehicles on a bridge.
SCALE: Final = 0.55


class RunPlot:
    """Figures of a run, reached as ``run.plot``; each draws into what it is given."""

    def __init__(self, run: Run) -> None:
        self._run = run

    @styled
    def model(
        self,
        front_axle: float | None = None,
        *,
        time: float | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """The vehicles on the bridge, to scale along the bridge; in a new figure lane by lane.

        Parameters
        ----------
        front_axle : float, optional
            Where the front axle stands [m], of a vehicle alone.
        time : float, optional
            When [s], in place of that; by default when the static axle loads bend the bridge most.
        """
        run = self._run
        if front_axle is not None and len(run.passages) > 1:
            raise InputError("front_axle", f"{front_axle!r}", "of several vehicles give the time")
        instant = _worst_time(run) if time is None else finite("time", time)
        stands = [
            np.array([np.interp(instant, run.time, x) for x in motion.axle_positions.T])
            for motion in run.vehicles
        ]
        if front_axle is not None:
            stands[0] += _seen("front_axle", front_axle) - stands[0][0]
        drawn = _drawn(run, stands)
        above = max(70.0, *(SCALE * top(each.vehicle) + 13.0 for each in drawn))
        height = 2.1 + (above - 70.0) / 72.0
        lanes = sorted({each.lane for each in drawn})
        panels: list[tuple[Axes, list[_Drawn]]] = []
        if ax is not None or len(lanes) == 1:
            panels.append((axes_for(ax, height=height), drawn))
        else:
            rows = new_figure(len(lanes) * height).subplots(len(lanes), 1, sharex=True)
            for panel, lane in zip(rows, lanes, strict=True):
                panel.set_title(f"lane {lane}", loc="left", fontsize=8.0)
                panels.append((panel, [each for each in drawn if each.lane == lane]))
        for panel, there in panels:
            draw_bridge(panel, run.bridge, run.bridge.supports, above=above)
            left, right = panel.get_xlim()
            left, right = (
                min([left, *(each.ends[0] for each in drawn)]),
                max([right, *(each.ends[1] for each in drawn)]),
            )
            panel.set_xlim(left, right)
            for road in ((left, 0.0), (run.bridge.length, right)):
                panel.plot(road, (0.0, 0.0), color=GREY, linewidth=0.8, zorder=1.0)
            for each in there:
                draw_vehicle(panel, each.vehicle, each.centre, scale=SCALE, to=each.to)
        for panel, _ in panels[:-1]:
            panel.set_xlabel("")
        return whole(panels[0][0])

    @styled
    @telling
    def envelope(
        self,
        quantity: str = "moment",
        *,
        limit: float | Sequence[float] | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """Largest and smallest values along the bridge, dynamic and static.

        Deflections and sagging moments are drawn downward. Of reactions, clamp moments and axle
        loads there is a bar for each, from the smallest to the largest value.

        Parameters
        ----------
        quantity : str
            The response:

            {responses}
        limit : float or list of float, optional
            Where lines are drawn for comparison, in the unit of the response, such as 3.5 for an
            acceleration [m/s2].
        """
        of = response(quantity)
        ax = axes_for(ax)
        zero_line(ax)
        limits_on(ax, of, limit)
        draw = draw_curves if of.axis == "section" else draw_bars
        draw(ax, self._run, of)
        response_on(ax, of)
        return whole(ax)

    @styled
    def impact_factors(self, *, figure: Figure | SubFigure | None = None) -> Figure:
        """Impact factors along the bridge, blank where masked."""
        run, factors = self._run, self._run.impact_factors
        titles = along_bridge()
        rows = (len(titles) + 1) // 2
        figure = figure_for(figure, 0.7 + 1.8 * rows)
        panels = [*figure.subplots(rows, 2, sharex=True, squeeze=False).flat]
        for ax, above in zip(panels[len(titles) :], panels[len(titles) - 2 :], strict=False):
            ax.remove()
            above.xaxis.set_tick_params(labelbottom=True)
        for ax, (factor, name) in zip(panels, titles.items(), strict=False):
            zero_line(ax, at=1.0)
            values = getattr(factors, factor)
            plot_masked(ax, factors.sections, values, **LINES[0])
            along(ax, run.bridge, label=False, hinges=False)
            if not np.isfinite(values).any():
                ax.set_yticks([1.0])
                note = {"ha": "center", "va": "bottom", "fontsize": 8.0, "color": GREY}
                ax.text(0.5, 0.6, "blank everywhere", transform=ax.transAxes, **note)
            ax.set_title(name, fontsize=9.0, pad=13.0)
        figure.supylabel("Impact factor [-]", fontsize=9.0)
        figure.supxlabel(
            "Distance from the left end, x [m]\n" + mask_note(factors.mask), fontsize=9.0
        )
        return whole(figure)

    @styled
    @telling
    def history(
        self,
        quantity: str = "moment",
        at: float | None = None,
        *,
        side: Side | None = None,
        limit: float | Sequence[float] | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """A quantity against time, dynamic and static, with the position of the front axle on top.

        Parameters
        ----------
        quantity : str
            The response:

            {responses}
        at : float, optional
            The section, support or clamp [m], or the number of the axle from 1; by default the one
            with the largest static value, of deck motion with the largest of all.
        side : {"left", "right"}, optional
            Side of the section at which the shear is taken; by default the right one, but at the
            right end of the bridge the left one.
        limit : float or list of float, optional
            Where lines are drawn for comparison, in the unit of the response, such as 3.5 for an
            acceleration [m/s2].
        """
        run, of = self._run, response(quantity)
        where, dynamic, static = column(run, of, at, side)
        ax = axes_for(ax)
        zero_line(ax)
        ax.plot(run.time, of.shown[1] * dynamic, label="dynamic", **DYNAMIC)
        ax.plot(run.time, of.shown[1] * static, label="static", **STATIC)
        limits_on(ax, of, limit)
        if of.axis == "axle":
            mark_lift_offs(ax, run, run.axle_names.index(where))
        ax.set_xlabel("Time [s]")
        ax.set_title(where, loc="right", fontsize=8.0)
        front_axle_on_top(ax, run)
        legend_above(ax, clear=4.2)
        response_on(ax, of)
        return whole(ax)

    @styled
    def vehicle(self, number: int = 1, *, figure: Figure | SubFigure | None = None) -> Figure:
        """Motion, axle loads, road and speed of a vehicle against time; bands where wheels lift.

        A speed that does not change has no panel.

        Parameters
        ----------
        number : int, optional
            Number of the vehicle, from 1.
        """
        run = self._run
        chosen = count("number", number)
        if not 1 <= chosen <= len(run.passages):
            raise InputError("number", chosen, f"must be 1 to {len(run.passages)}")
        motion = run.vehicles[chosen - 1]
        axles = [k for k, (vehicle, _) in enumerate(run.axles) if vehicle == chosen]
        together = len(axles) <= 2
        heaves = [1e3 * body.heave.displacement for body in motion.bodies]
        pitches = [1e3 * body.pitch.displacement for body in motion.bodies] * (len(axles) > 1)
        uneven = bool(motion.elevations.any())
        steady = float(np.ptp(motion.speed)) <= 1e-9 * float(motion.speed.max())
        rows = (
            bool(heaves) + bool(pitches) + (1 if together else len(axles)) + uneven + (not steady)
        )
        figure = figure_for(figure, 1.0 + 1.05 * rows)
        panels = list(np.atleast_1d(figure.subplots(rows, 1, sharex=True)))
        rest = iter(panels)
        if heaves:
            ax = next(rest)
            _bodies(ax, run.time, heaves, "Heave,\ndown [mm]")
            if len(heaves) > 1:
                legend_above(ax, columns=len(heaves), clear=3.6)
        if pitches:
            _bodies(next(rest), run.time, pitches, "Pitch, nose\ndown [mrad]")
        loads = [next(rest)] * len(axles) if together else [next(rest) for _ in axles]
        for k, (ax, axle) in enumerate(zip(loads, axles, strict=True)):
            zero_line(ax, at=1e-3 * run.static_axle_loads[axle])
            line = LINES[k] if together else LINES[0]
            values = 1e-3 * run.axle_loads[:, axle]
            ax.plot(run.time, values, label=f"axle {k + 1}", **line)
            ax.set_ylabel("Axle load\n[kN]" if together else f"Axle {k + 1}\n[kN]")
            mark_lift_offs(ax, run, axle, label=False)
        if len(axles) > 1 and together:
            legend_above(loads[0], columns=3, clear=0.1 if heaves else 3.6)
        if uneven:
            ax = next(rest)
            _single(ax, run.time, 1e3 * motion.elevations[:, 0], "Road under\naxle 1 [mm]")
            zero_line(ax)
        notes = ["Time [s]"]
        if steady:
            notes.append(f"at {motion.speed[0]:g} m/s throughout")
        else:
            ax = next(rest)
            _single(ax, run.time, motion.speed, "Speed\n[m/s]")
            _not_narrower(ax, 1e-3 * float(motion.speed.max()))
        if any(each.axle - 1 in axles for each in run.lift_offs):
            notes.append("bands: the wheel is off the road")
        panels[-1].set_xlabel("; ".join(notes))
        front_axle_on_top(panels[0], run, chosen)
        figure.align_ylabels(panels)
        return whole(figure)

    @styled
    def road(self, *, figure: Figure | SubFigure | None = None) -> Figure:
        """The road where wheels pass, with the bridge as a band, and the spectrum of all of it."""
        run = self._run
        paths = [motion.axle_positions for motion in run.vehicles]
        first, last = run.road.ends
        start = max(first, min(0.0, *(float(each.min()) for each in paths)))
        end = min(last, max(run.bridge.length, *(float(each.max()) for each in paths)))
        figure = figure_for(figure, 2.0 * HEIGHT + 0.8)
        above, below = figure.subplots(2, 1, height_ratios=(1.0, 1.7))
        run.road.plot.profile(start, end, ax=above)
        above.axvspan(0.0, run.bridge.length, color=PALE, alpha=0.5, linewidth=0.0, zorder=0.4)
        above.set_xlabel(f"{above.get_xlabel()}; the bridge is grey")
        run.road.plot.psd(ax=below)
        return whole(figure)


def _seen(key: str, value: object) -> float:
    """A place that a drawing can show [m]."""
    place = finite(key, value)
    if abs(place) > FARTHEST:
        raise InputError(key, f"{place:g} m", "is too far from the bridge")
    return place


@dataclass(frozen=True)
class _Drawn:
    """A vehicle in a drawing: its lane, centre and direction, and the room that it takes [m]."""

    vehicle: AnyVehicle
    lane: int
    centre: float
    to: float
    ends: tuple[float, float]


def _drawn(run: Run, stands: list[Array]) -> list[_Drawn]:
    """The vehicles that are on the bridge or near, with their axles where they stand; or all."""
    drawn = []
    for passage, at in zip(run.passages, stands, strict=True):
        to = 1.0 if passage.direction == "right" else -1.0
        centre = at[0] - to * passage.vehicle.axle_positions[0]
        back, front = extent(passage.vehicle)
        arrow = 0.08 * run.bridge.length
        ends = sorted([centre + to * (back - 0.2), centre + to * (front + arrow)])
        lane = int(to < 0.0) if passage.lane is None else passage.lane
        drawn.append(_Drawn(passage.vehicle, lane, centre, to, (ends[0], ends[1])))
    near = [each for each in drawn if each.ends[1] > 0.0 and each.ends[0] < run.bridge.length]
    return near or drawn


def _worst_time(run: Run) -> float:
    envelope = run.envelope("moment")
    each = (envelope.static_max, envelope.static_min)
    worst = max(each, key=lambda extremes: float(np.abs(extremes.value).max()))
    return float(worst.time[np.abs(worst.value).argmax()])


def _bodies(ax: Axes, time: Array, values: list[Array], label: str) -> None:
    """A line for each body."""
    for k, each in enumerate(values):
        ax.plot(time, each, label=f"body {k + 1}", **LINES[k % len(LINES)])
    ax.set_ylabel(label)
    zero_line(ax)
    ax.yaxis.set_inverted(True)


def _single(ax: Axes, time: Array, values: Array, label: str) -> None:
    ax.plot(time, values, **LINES[0])
    ax.set_ylabel(label)


def _not_narrower(ax: Axes, range_: float) -> None:
    """Let the axis show at least this range, so that a constant does not look like noise."""
    low, high = ax.get_ylim()
    if high - low < range_:
        middle = 0.5 * (low + high)
        ax.set_ylim(middle - 0.5 * range_, middle + 0.5 * range_)
