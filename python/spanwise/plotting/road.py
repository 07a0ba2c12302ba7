"""Figures of a road: its profile, and its spectrum among the classes of ISO 8608."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from spanwise._checks import number
from spanwise.errors import InputError
from spanwise.plotting.style import (
    GREY,
    HEIGHT,
    LINES,
    STATIC,
    axes_for,
    figure_for,
    legend_above,
    styled,
    whole,
    zero_line,
)
from spanwise.roads.roughness import CLASSES, REFERENCE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from spanwise.roads import Road

#: Length that is shown of a road without ends or period [m].
SHOWN = 100.0

#: Wave numbers that are shown [cycle/m].
SEEN = (0.01, 4.0)


class RoadPlot:
    """Figures of a road, reached as ``road.plot``; calling that draws both."""

    def __init__(self, road: Road) -> None:
        self._road = road

    @styled
    def __call__(
        self,
        start: float | None = None,
        end: float | None = None,
        *,
        figure: Figure | SubFigure | None = None,
    ) -> Figure:
        """Profile, and below it the spectrum among the classes of ISO 8608.

        Parameters
        ----------
        start, end : float, optional
            Ends of the section [m]; by default all that is known of the road, one period of a
            random one.
        """
        figure = figure_for(figure, 2.0 * HEIGHT + 0.8)
        above, below = figure.subplots(2, 1, height_ratios=(1.0, 1.7))
        self.profile(start, end, ax=above)
        self.psd(start, end, ax=below)
        return whole(figure)

    @styled
    def profile(
        self, start: float | None = None, end: float | None = None, *, ax: Axes | None = None
    ) -> Figure:
        """Elevation along the road: of the surface, and averaged over the contact patch.

        The average is left out of sections longer than 100 m, where both are one line.

        Parameters
        ----------
        start, end : float, optional
            Ends of the section [m]; by default all that is known of the road, one period of a
            random one.
        """
        road, (first, last) = self._road, self._section(start, end)
        ax = axes_for(ax, height=2.2)
        x = np.linspace(first, last, int(np.clip(20.0 * (last - first), 2_000, 40_000)))
        zero_line(ax)
        patched = last - first <= SHOWN and road.surface != road
        name = "surface" if patched else None
        thin = {**LINES[0], "linewidth": 0.8}
        ax.plot(x, 1e3 * road.surface.elevation(x), label=name, **thin)
        if patched:
            line = {**STATIC, "linewidth": 0.8}
            ax.plot(x, 1e3 * road.elevation(x), label="averaged over the contact patch", **line)
            legend_above(ax, clear=0.2)
        ax.set_xlim(first, last)
        ax.set_xlabel("Distance from the left end of the bridge, x [m]")
        ax.set_ylabel("Elevation, up [mm]")
        return whole(ax)

    @styled
    def psd(
        self, start: float | None = None, end: float | None = None, *, ax: Axes | None = None
    ) -> Figure:
        """Power spectral density of the surface among the classes of ISO 8608.

        Parameters
        ----------
        start, end : float, optional
            Ends of the section [m]; by default all that is known of the road, one period of a
            random one.
        """
        road, (first, last) = self._road, self._section(start, end)
        n, density = road.psd(first, last)
        ax = axes_for(ax, height=1.3 * HEIGHT)
        ends = np.array(SEEN)
        # Limits between the classes from their geometric means, which are a factor of 4 apart.
        means = list(CLASSES.values())
        for limit in (2.0 * mean for mean in means[:-1]):
            ax.plot(ends, limit * (ends / REFERENCE) ** -2, color=GREY, linewidth=0.5, zorder=0.6)
        # The window smears the first of them.
        here = (n >= max(SEEN[0], 2.0 * n[0])) & (n <= SEEN[1]) & (density > 0.0)
        ax.plot(n[here], density[here], **{**LINES[0], "linewidth": 0.9})
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlim(*SEEN)
        low, high = means[0] / 8.0, means[-1] * 2.0
        ax.set_ylim(low * (SEEN[1] / REFERENCE) ** -2, high * (0.02 / REFERENCE) ** -2)
        for letter, mean in CLASSES.items():
            _letter(ax, letter, mean, SEEN[1])
        ax.set_xlabel("Wave number n [cycle/m]")
        ax.set_ylabel("Spectral density of the\nsurface, G$_d$(n) [m$^3$]")
        try:
            found = road.iso_class(first, last)
        except ValueError:
            return whole(ax)
        line = {**STATIC, "linewidth": 1.0}
        G = float(f"{1e6 * found.G:.3g}")
        assert found.error is not None
        assert found.band is not None
        spread = f"± {100.0 * found.error:.0f} %"
        name = f"fitted: G$_d$(n$_0$) = {G:g}·10$^{{-6}}$ m$^3$ {spread}, class {found.letter}"
        looked_at = np.array(found.band)
        ax.plot(looked_at, found.G * (looked_at / REFERENCE) ** -2, label=name, **line)
        legend_above(ax, clear=0.2)
        return whole(ax)

    def _section(self, start: float | None, end: float | None) -> tuple[float, float]:
        first, last = self._road.ends
        if not np.isfinite(last - first):
            period = self._road.repeats_after
            first, last = 0.0, period if np.isfinite(period) else SHOWN
        first = first if start is None else number("start", start)
        last = last if end is None else number("end", end)
        if not -np.inf < first < last < np.inf:
            raise InputError(
                "end", f"{last:g} m", f"must be finite and greater than start, {first:g} m"
            )
        return first, last


def _letter(ax: Axes, letter: str, mean: float, at: float) -> None:
    """The letter of a class beside its lines, at the right edge."""
    level = mean * (at / REFERENCE) ** -2
    ax.annotate(
        letter,
        (at, level),
        xytext=(3.0, 0.0),
        textcoords="offset points",
        va="center",
        color=GREY,
        fontsize=8.0,
        annotation_clip=False,
    )
