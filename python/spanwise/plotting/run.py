"""Figures of a crossing: envelopes, impact factors, histories, the motion of the vehicle."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import number
from spanwise.plotting.bridge import draw_bridge
from spanwise.plotting.envelope import BY_SECTION, draw_bars, draw_curves
from spanwise.plotting.factors import FACTORS, mask_note, plot_masked
from spanwise.plotting.history import Side, column, front_axle_on_top, histories
from spanwise.plotting.style import (
    DYNAMIC,
    GREY,
    LINES,
    STATIC,
    along,
    axes_for,
    figure_for,
    legend_above,
    measure_of,
    measure_on,
    styled,
    whole,
    zero_line,
)
from spanwise.plotting.vehicle import draw_vehicle, overhang

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from spanwise.run import Quantity, Run

Array: TypeAlias = NDArray[np.float64]


class RunPlot:
    """Figures of a run, reached as ``run.plot``."""

    def __init__(self, run: Run) -> None:
        self._run = run

    @styled
    def model(self, front_axle: float | None = None, *, ax: Axes | None = None) -> Figure:
        """The vehicle on the bridge, to scale along the bridge.

        Parameters
        ----------
        front_axle : float, optional
            Where the front axle stands [m]; by default where the static axle loads bend the bridge
            most.
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure.

        Returns
        -------
        matplotlib.figure.Figure
        """
        run = self._run
        stands = _worst_position(run) if front_axle is None else number("front_axle", front_axle)
        centre = stands - run.truck.axle_positions[0]
        ax = axes_for(ax, height=2.1)
        draw_bridge(ax, run.bridge, run.bridge.supports, above=70.0)
        at, beyond = centre + run.truck.axle_positions, overhang(run.truck)
        left, right = ax.get_xlim()
        arrow = 0.08 * run.bridge.length
        ax.set_xlim(min(left, at[-1] - 1.2 * beyond), max(right, at[0] + beyond + arrow))
        for ends in ((ax.get_xlim()[0], 0.0), (run.bridge.length, ax.get_xlim()[1])):
            ax.plot(ends, (0.0, 0.0), color=GREY, linewidth=0.8, zorder=1.0)
        draw_vehicle(ax, run.truck, centre, scale=0.55)
        return whole(ax)

    @styled
    def envelope(self, quantity: Quantity = "moment", *, ax: Axes | None = None) -> Figure:
        """Largest and smallest values along the bridge, dynamic and static.

        Deflections and sagging moments are drawn downward. Of reactions, clamp moments and axle
        loads there is a bar for each, from the smallest to the largest value.

        Parameters
        ----------
        quantity : {"deflection", "moment", "shear", "reactions", "clamp_moments", "axle_loads"}
            The quantity.
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure.

        Returns
        -------
        matplotlib.figure.Figure
        """
        run, measure = self._run, measure_of(quantity)
        ax = axes_for(ax)
        zero_line(ax)
        draw = draw_curves if quantity in BY_SECTION else draw_bars
        draw(ax, run, quantity, measure)
        measure_on(ax, measure)
        return whole(ax)

    @styled
    def impact_factors(self, *, figure: Figure | SubFigure | None = None) -> Figure:
        """Impact factors along the bridge, blank where masked.

        Parameters
        ----------
        figure : matplotlib.figure.Figure or SubFigure, optional
            Where to draw; by default a new figure.

        Returns
        -------
        matplotlib.figure.Figure
        """
        run, factors = self._run, self._run.impact_factors
        figure = figure_for(figure, 4.3)
        panels = figure.subplots(2, 2, sharex=True)
        for ax, (factor, name) in zip(panels.flat, FACTORS.items(), strict=True):
            zero_line(ax, at=1.0)
            plot_masked(ax, factors.sections, getattr(factors, factor), **LINES[0])
            along(ax, run.bridge, label=False)
            ax.set_title(name, fontsize=9.0, pad=13.0)
        figure.supylabel("Impact factor [-]", fontsize=9.0)
        figure.supxlabel(
            "Distance from the left end, x [m]\n" + mask_note(factors.mask), fontsize=9.0
        )
        return whole(figure)

    @styled
    def history(
        self,
        quantity: Quantity = "moment",
        at: float | None = None,
        *,
        side: Side | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """A quantity against time, dynamic and static, with the position of the front axle on top.

        Parameters
        ----------
        quantity : {"deflection", "moment", "shear", "reactions", "clamp_moments", "axle_loads"}
            The quantity.
        at : float, optional
            The section, support or clamp [m], or the number of the axle from 1; by default the one
            with the largest static value.
        side : {"left", "right"}, optional
            Side of the section at which the shear is taken; by default the right one, but at the
            right end of the bridge the left one.
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure.

        Returns
        -------
        matplotlib.figure.Figure
        """
        run, measure = self._run, measure_of(quantity)
        index, where, side = column(run, quantity, at, side)
        dynamic, static = histories(run, quantity, index, side)
        ax = axes_for(ax)
        zero_line(ax)
        ax.plot(run.time, measure.factor * dynamic, label="dynamic", **DYNAMIC)
        ax.plot(run.time, measure.factor * static, label="static", **STATIC)
        ax.set_xlabel("Time [s]")
        ax.set_title(where, loc="right", fontsize=8.0)
        front_axle_on_top(ax, run)
        legend_above(ax, clear=4.2)
        measure_on(ax, measure)
        return whole(ax)

    @styled
    def vehicle(self, *, figure: Figure | SubFigure | None = None) -> Figure:
        """Heave, pitch, axle loads and speed of the vehicle against time.

        Parameters
        ----------
        figure : matplotlib.figure.Figure or SubFigure, optional
            Where to draw; by default a new figure.

        Returns
        -------
        matplotlib.figure.Figure
        """
        run, motion = self._run, self._run.vehicle
        axles = len(run.static_axle_loads)
        pitches, together = axles > 1, axles <= 2
        count = 2 + pitches + (1 if together else axles)
        figure = figure_for(figure, 1.0 + 1.05 * count)
        panels = list(figure.subplots(count, 1, sharex=True))
        heave, speed = panels[0], panels[-1]
        _single(heave, run.time, 1e3 * motion.heave, "Heave,\ndown [mm]", downward=True)
        if pitches:
            _single(
                panels[1], run.time, 1e3 * motion.pitch, "Pitch, nose\ndown [mrad]", downward=True
            )
        loads = panels[1 + pitches : -1]
        for k, static in enumerate(1e-3 * run.static_axle_loads):
            ax, line = (loads[0], LINES[k]) if together else (loads[k], LINES[0])
            zero_line(ax, at=static)
            ax.plot(run.time, 1e-3 * run.axle_loads[:, k], label=f"axle {k + 1}", **line)
            ax.set_ylabel("Axle load\n[kN]" if together else f"Axle {k + 1}\n[kN]")
        if pitches and together:
            legend_above(loads[0], columns=2, clear=0.1)
        _single(speed, run.time, motion.speed, "Speed\n[m/s]")
        _not_narrower(speed, 1e-3 * float(motion.speed[0]))
        speed.set_xlabel("Time [s]")
        front_axle_on_top(heave, run)
        figure.align_ylabels(panels)
        return whole(figure)


def _worst_position(run: Run) -> float:
    envelope = run.envelope("moment")
    each = (envelope.static_max, envelope.static_min)
    worst = max(each, key=lambda extremes: float(np.abs(extremes.value).max()))
    return float(worst.position[np.abs(worst.value).argmax()])


def _single(ax: Axes, time: Array, values: Array, label: str, *, downward: bool = False) -> None:
    ax.plot(time, values, **LINES[0])
    ax.set_ylabel(label)
    if downward:
        zero_line(ax)
        ax.yaxis.set_inverted(True)


def _not_narrower(ax: Axes, range_: float) -> None:
    """Let the axis show at least this range, so that a constant does not look like noise."""
    low, high = ax.get_ylim()
    if high - low < range_:
        middle = 0.5 * (low + high)
        ax.set_ylim(middle - 0.5 * range_, middle + 0.5 * range_)
