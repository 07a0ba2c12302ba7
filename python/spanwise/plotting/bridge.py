"""Figures of a bridge: its model, its basic bridge, its modes and influence lines."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import count as whole_number
from spanwise._checks import finite, named
from spanwise.errors import InputError
from spanwise.plotting import symbols
from spanwise.plotting.style import (
    GREY,
    LINES,
    PALE,
    along,
    axes_for,
    figure_for,
    metres,
    response_on,
    styled,
    support_letters,
    whole,
    zero_line,
)
from spanwise.quantities import RESPONSES, influence_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from spanwise.bridge import Bridge, Settlement, Structure

#: Margin beside the beam in a drawing of the model, as a fraction of its length.
MARGIN: Final = 0.04

#: Masses of a span, on average, above which they are drawn small.
CROWD: Final = 8


class BridgePlot:
    """Figures of a bridge, reached as ``bridge.plot``; each draws into what it is given."""

    def __init__(self, bridge: Bridge) -> None:
        self._bridge = bridge

    @styled
    def model(self, *, ax: Axes | None = None) -> Figure:
        """The lumped-mass beam on its supports, to scale along the bridge.

        Dots are masses, their area in proportion; open circles are hinges. Coils are springs, a
        spiral one for the rotation. Letters name the supports.
        """
        ax = axes_for(ax, height=1.75)
        draw_bridge(ax, self._bridge, self._bridge.supports)
        _dimensions(ax, self._bridge)
        _note(ax, self._bridge, _masses(self._bridge))
        return whole(ax)

    @styled
    def basic_bridge(self, *, ax: Axes | None = None) -> Figure:
        """The bridge without its hinges and intermediate redundant supports.

        These are all supports between the first and the last one. Where they were is drawn as open
        circles: they stay reference stations (Kishan and Traill-Nash 1973, Fig. 3).
        """
        ax = axes_for(ax, height=1.75)
        supports = self._bridge.supports
        outer = [s for s in supports if s in (supports[0], supports[-1])]
        draw_bridge(ax, self._bridge, outer, hinges=False)
        _dimensions(ax, self._bridge)
        if removed := [x for x, _ in supports[1:-1]]:
            ax.plot(
                removed,
                [0.0] * len(removed),
                linestyle="none",
                marker="o",
                markersize=7.0,
                markerfacecolor="white",
                markeredgecolor="black",
                clip_on=False,
                zorder=6.0,
            )
            _note(ax, self._bridge, "open circles: supports taken away, kept as reference stations")
        return whole(ax)

    @styled
    def modes(self, count: int = 3, *, figure: Figure | SubFigure | None = None) -> Figure:
        """The lowest mode shapes, scaled to unit modal mass, with dots at the masses.

        Parameters
        ----------
        count : int, optional
            How many.
        """
        bridge = self._bridge
        count = whole_number("count", count)
        if count == 0:
            raise InputError("count", "0", "must be 1 or more")
        modes = bridge.modes(count)
        x = np.linspace(0.0, bridge.length, 401)
        shapes = bridge.mode_shapes(count, x)
        figure = figure_for(figure, 0.65 + 0.85 * count)
        panels = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        scale = 1e3
        for k, ax in enumerate(panels):
            zero_line(ax)
            ax.plot(x, scale * shapes[:, k], **LINES[0])
            ax.plot(
                modes.stations,
                scale * modes.shapes[:, k],
                "o",
                color="black",
                markersize=2.0 if _crowded(bridge) else 3.5,
                clip_on=False,
            )
            along(ax, bridge, letters=k == 0, label=k == count - 1)
            ax.annotate(
                f"Mode {k + 1}\n{modes.frequencies[k]:.3f} Hz",
                (1.02, 0.5),
                xycoords="axes fraction",
                va="center",
                annotation_clip=False,
            )
        figure.supylabel("Mode shape [$10^{-3}$ kg$^{-1/2}$]", fontsize=9.0)
        return whole(figure)

    @styled
    def influence_line(
        self,
        quantity: str,
        at: float,
        *,
        structure: Structure = "actual",
        ax: Axes | None = None,
    ) -> Figure:
        """Response at one section to a load of 1 kN moving along the bridge.

        Parameters
        ----------
        quantity : str
            The response, as in `Bridge.influence_line`.
        at : float
            The section, or the support for a reaction [m].
        structure : {"actual", "basic"}, optional
            The bridge with or without its hinges and intermediate redundant supports.
        """
        bridge = self._bridge
        at = finite("at", at)
        quantity = named("quantity", quantity, influence_lines())
        of = influence_lines()[quantity]
        x = _with_both_sides(np.linspace(0.0, bridge.length, 401), at)
        line = bridge.influence_line(quantity, at, x, structure)
        scale = 1e3 * of.shown[1]
        ax = axes_for(ax)
        zero_line(ax)
        ax.fill_between(x, scale * line, color=PALE, linewidth=0.0)
        ax.plot(x, scale * line, **LINES[0])
        ax.plot([at], [0.0], "o", color="black", markersize=4.5, clip_on=False, zorder=5.0)
        along(ax, bridge)
        ax.set_xlabel("Position of the load, x [m]")
        response_on(ax, of, quantity.rpartition("-")[2] if of.sided else "", "for 1 kN")
        where = f"at x = {metres(at)}" + (", basic bridge" if structure == "basic" else "")
        ax.set_title(where, loc="right", fontsize=8.0, pad=12.0)
        return whole(ax)


class SettlementPlot:
    """Figure of a settlement, reached as ``settlement.plot``: call it."""

    def __init__(self, settlement: Settlement) -> None:
        self._settlement = settlement

    @styled
    def __call__(self, *, figure: Figure | SubFigure | None = None) -> Figure:
        """Deflection, and below it the bending moment, both drawn downward."""
        found = self._settlement
        figure = figure_for(figure, 4.4)
        above, below = figure.subplots(2, 1, sharex=True)
        for ax, name, values in (
            (above, "deflection", found.deflection),
            (below, "moment", found.moment),
        ):
            zero_line(ax)
            order = np.argsort(found.sections, kind="stable")
            x, y = found.sections[order], RESPONSES[name].shown[1] * values[order]
            ax.fill_between(x, y, color=PALE, linewidth=0.0)
            ax.plot(x, y, **LINES[0])
            along(ax, found.bridge, letters=ax is above, label=ax is below)
            response_on(ax, RESPONSES[name])
        figure.align_ylabels([above, below])
        return whole(figure)


def draw_bridge(
    ax: Axes,
    bridge: Bridge,
    supports: list[tuple[float, str]],
    *,
    above: float = 34.0,
    hinges: bool = True,
) -> None:
    """Beam, masses and these supports of it, with so many points left above the beam."""
    length = bridge.length
    ax.set_xlim(-MARGIN * length, (1.0 + MARGIN) * length)
    ax.set_ylim(-52.0, above)
    ax.set_yticks([])
    ax.spines[["left", "top", "right"]].set_visible(False)
    ax.set_xlabel("Distance from the left end, x [m]")
    symbols.stroke(ax, symbols.level(ax), [(0.0, 0.0), (length, 0.0)], width=2.2)
    held = any(kind == "clamped" for _, kind in supports)
    letters = dict(zip(bridge.supports, support_letters(bridge), strict=True))
    springs = dict(zip(bridge.supports, bridge.springs, strict=True))
    for support in supports:
        x, kind = support
        rotation = springs[support].rotation
        if kind == "clamped" and x in (0.0, length):
            symbols.clamp(ax, x, left=x == 0.0)
        elif kind == "clamped":
            symbols.clamped_pier(ax, x)
        elif np.isfinite(springs[support].vertical):
            symbols.sprung(ax, x, turning=0.0 < rotation < np.inf, held=rotation == np.inf)
        else:
            symbols.pin(ax, x, roller=held)
            held = True
            if rotation > 0.0:
                symbols.spiral(ax, x)
        symbols.write(ax, symbols.local(ax, x), 0.0, -24.5, letters[support], size=9.0)
    if hinges:
        for x in bridge.hinges:
            symbols.open_hinge(ax, x)
    if len(bridge.masses):
        ax.scatter(
            bridge.stations,
            np.zeros_like(bridge.stations),
            s=np.clip(
                (14.0 if _crowded(bridge) else 50.0) * bridge.masses / bridge.masses.max(),
                4.0,
                None,
            ),
            color=GREY if _crowded(bridge) else "black",
            clip_on=False,
            zorder=5.0,
        )


def _crowded(bridge: Bridge) -> bool:
    """Whether there are too many masses to draw them large."""
    return len(bridge.masses) > CROWD * (len(bridge.span_bounds) - 1)


def _dimensions(ax: Axes, bridge: Bridge) -> None:
    """The spans, below the supports."""
    bounds = bridge.span_bounds
    for start, stop in pairwise(bounds):
        symbols.dimension(ax, start, stop, -40.0)


def _note(ax: Axes, bridge: Bridge, text: str) -> None:
    level = symbols.level(ax)
    symbols.write(ax, level, bridge.length, 20.0, text, color=GREY, across="right")


def _masses(bridge: Bridge) -> str:
    """How many masses there are and how heavy."""
    if len(bridge.masses) == 0:
        return f"{bridge.mode_count} modes given"
    tonnes = 1e-3 * bridge.masses
    least, most = f"{tonnes.min():.4g}", f"{tonnes.max():.4g}"
    each = f"{least} t each" if least == most else f"{least} to {most} t"
    return f"{len(tonnes)} masses, {each}"


def _with_both_sides(x: NDArray[np.float64], at: float) -> NDArray[np.float64]:
    """With the section itself and a place just left of it, for what jumps there."""
    return np.unique(np.clip(np.append(x, [at - 1e-9 * x[-1], at]), 0.0, x[-1]))
