"""Figures of an ensemble: medians and bands along the bridge, with the static values beside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import named
from spanwise.errors import InputError
from spanwise.plotting.envelope import branches
from spanwise.plotting.factors import mask_note, plot_masked
from spanwise.plotting.style import (
    DYNAMIC,
    GREY,
    PALE,
    STATIC,
    along,
    axes_for,
    legend_above,
    limits_on,
    name_places,
    name_supports,
    response_on,
    styled,
    whole,
    zero_line,
)
from spanwise.quantities import factors, response, telling

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.transforms import Transform

    from spanwise.ensembles import Ensemble
    from spanwise.extremes import SampleExtremes
    from spanwise.quantities import Response

#: The band that is drawn.
BAND: Final = (5.0, 95.0)

#: Where an axis of impact factors ends at most, in the largest where the response governs.
CAP: Final = 2.0

#: How far the markers of dynamic and static values stand from their support [pt].
ASIDE: Final = 3.0

Rows: TypeAlias = NDArray[np.float64]


class EnsemblePlot:
    """Figures of an ensemble, reached as ``ensemble.plot``; each draws into what it is given."""

    def __init__(self, ensemble: Ensemble) -> None:
        self._ensemble = ensemble

    @styled
    @telling
    def impact_factors(self, quantity: str = "sagging", ax: Axes | None = None) -> Figure:
        """Impact factors along the bridge: median and the band from 5 to 95 % of the samples.

        Parameters
        ----------
        quantity : str
            Of what, as in `Ensemble.impact_factors`:

            {factors}

        Raises
        ------
        ValueError
            If there are no such factors, no samples, or no static value to divide by.
        """
        ensemble = self._ensemble
        quantity = named("quantity", quantity, factors())
        of, factor = factors()[quantity]
        values = ensemble.impact_factors[quantity]
        if len(ensemble.failures) < ensemble.samples and np.isnan(values).all():
            raise ValueError(
                f"masked everywhere: no static value of {quantity!r} is large enough to divide by"
            )
        low, median, high, largest = _bands(values)
        ax = axes_for(ax)
        by_section = of.axis == "section"
        several = by_section and len(ensemble.sections) > 1
        if several:
            x = ensemble.sections
            _band(ax, x, low, high, _name(ensemble))
            plot_masked(ax, x, median, label="median", **DYNAMIC)
            plot_masked(ax, x, largest, label="largest", color=GREY, linewidth=0.8)
            along(ax, ensemble.bridge)
            notes = [mask_note(ensemble._plan.conditions.mask)]
            notes += self._frame(ax, quantity, low, largest)
            ax.set_xlabel("\n".join([ax.get_xlabel(), *notes]))
        elif by_section:
            x = ensemble.sections
            _whiskers(ax, x, low, median, high, f"median, {_name(ensemble)}")
            ax.plot(x, largest, "_", color=GREY, markersize=10.0, label="largest")
            along(ax, ensemble.bridge, hinges=False)
        else:
            _bars(ax, ensemble, of, low, median, high)
        zero_line(ax, 1.0)
        ax.set_ylabel(f"{factor.title}, dynamic\nby static [-]")
        legend_above(ax, clear=1.6 if by_section else 0.5)
        return whole(ax)

    def _frame(self, ax: Axes, quantity: str, low: Rows, largest: Rows) -> list[str]:
        """Ends of the axis, and a note if a curve runs out of it.

        What grows far beyond the factors where the response governs is large only for lack of a
        static value.
        """
        of, factor = factors()[quantity]
        _, values = self._ensemble.envelope(of.name).of(factor.sense)
        static = np.nanmean(values, axis=0)
        governing = largest[static >= 0.5 * np.nanmax(static)]
        most = float(np.nanmax(largest))
        cap = most
        if np.isfinite(governing).any():
            cap = min(most, CAP * max(1.0, float(np.nanmax(governing))))
        least = min(1.0, float(np.nanmin(low)))
        margin = 0.06 * (max(cap, 1.0) - least) or 0.06
        ax.set_ylim(least - margin, max(cap, 1.0) + margin * (cap == most))
        return [] if cap == most else [f"(cut at {cap:.3g}; the largest is {most:.3g})"]

    @styled
    @telling
    def envelope(
        self,
        quantity: str = "moment",
        ax: Axes | None = None,
        *,
        limit: float | Sequence[float] | None = None,
    ) -> Figure:
        """Largest and smallest values along the bridge: median, band from 5 to 95 %, and static.

        Parameters
        ----------
        quantity : str
            The response:

            {bridge}
        limit : float or list of float, optional
            Where lines are drawn for comparison, in the unit of the response, such as 3.5 for an
            acceleration [m/s2].

        Raises
        ------
        ValueError
            If that was not looked at or is not along the bridge, or there are no samples.
        """
        ensemble, of = self._ensemble, response(quantity)
        if of.axis == "axle":
            raise InputError(
                "quantity",
                f"{of.name!r}",
                "is not drawn along the bridge; Ensemble.envelope has them, and "
                f"plot.impact_factors({of.name!r}) draws their factors",
            )
        if of not in ensemble.responses:
            raise InputError(
                "quantity",
                f"{of.name!r}",
                f"was not looked at; this ensemble has {', '.join(ensemble.quantities)}",
            )
        extremes = ensemble.envelope(of.name)
        ax = axes_for(ax)
        by_section = of.axis == "section"
        several = by_section and len(extremes.x) > 1
        beside = "static, median" if extremes.static_varies else "static"
        for side, first in (("max", True), ("min", False)):
            x, curves = extremes.x, _curves(extremes, side)
            if of.sided and several:
                both = [_curves(each, side) for each in map(ensemble.envelope, of.parts)]
                cut = [
                    branches(extremes.x, curve, np.stack(sides, axis=-1), ensemble.supports)
                    for curve, *sides in zip(curves, *both, strict=True)
                ]
                x, curves = cut[0][0], [curve for _, curve in cut]
            low, median, high, static = (of.shown[1] * each for each in curves)
            if several:
                _band(ax, x, low, high, _name(ensemble) if first else None)
                ax.plot(x, median, label="median" if first else None, **DYNAMIC)
                ax.plot(x, static, label=beside if first else None, **STATIC)
            else:
                at = x if by_section else np.arange(len(median), dtype=np.float64)
                names = (f"median, {_name(ensemble)}", beside) if first else (None, None)
                _points(ax, at, (low, median, high), static, names)
        if by_section:
            along(ax, ensemble.bridge)
        else:
            name_supports(ax, ensemble.bridge, of.axis)
        zero_line(ax)
        limits_on(ax, of, limit)
        response_on(ax, of)
        legend_above(ax, clear=1.6 if by_section else 0.5)
        return whole(ax)


def _curves(extremes: SampleExtremes, side: str) -> list[Rows]:
    """Fifth percentile, median, 95th, and the static value (its median where samples differ)."""
    low, median, high, _ = _bands(getattr(extremes, side))
    static = getattr(extremes, f"static_{side}")
    return [low, median, high, np.nanmedian(static, axis=0) if static.ndim == 2 else static]


def _bands(values: Rows) -> tuple[Rows, Rows, Rows, Rows]:
    """Fifth percentile, median, 95th and largest by column, NaN where no sample has a value."""
    if len(values) == 0 or np.isnan(values).all():
        raise InputError("samples", None, "none has a value to draw")
    there = ~np.isnan(values).all(axis=0)
    found = np.full((4, values.shape[1]), np.nan)
    found[:, there] = np.nanpercentile(values[:, there], [BAND[0], 50.0, BAND[1], 100.0], axis=0)
    low, median, high, largest = found
    return low, median, high, largest


def _name(ensemble: Ensemble) -> str:
    """What the band is, of how many samples."""
    failed = len(ensemble.failures)
    sound = ensemble.samples - failed
    return (
        f"{BAND[0]:g} to {BAND[1]:g} % of {sound} sample{'' if sound == 1 else 's'}"
        f"{f' ({failed} failed)' if failed else ''}"
    )


def _band(ax: Axes, x: Rows, low: Rows, high: Rows, name: str | None) -> None:
    ax.fill_between(x, low, high, color=PALE, linewidth=0.0, label=name)
    # Between two gaps a band has no width; a line stands for it.
    here = np.isfinite(np.concatenate([[np.nan], low, [np.nan]]))
    alone = here[1:-1] & ~here[:-2] & ~here[2:]
    if alone.any():
        ax.vlines(x[alone], low[alone], high[alone], color=PALE, linewidth=4.0)


def _whiskers(
    ax: Axes,
    at: Rows,
    low: Rows,
    median: Rows,
    high: Rows,
    name: str | None,
    aside: float = 0.0,
) -> None:
    """A point with its band at each place, so many points [pt] aside of it."""
    ax.errorbar(
        at,
        median,
        yerr=[median - low, high - median],
        fmt="o",
        markersize=4.0,
        capsize=3.0,
        color=DYNAMIC["color"],
        linewidth=1.0,
        label=name,
        clip_on=False,
        transform=_aside(ax, aside),
    )
    _hold(ax, at, low, high)


def _aside(ax: Axes, points: float) -> Transform:
    """Data coordinates, so many points to the right."""
    from matplotlib.transforms import ScaledTranslation

    return ax.transData + ScaledTranslation(points / 72.0, 0.0, ax.figure.dpi_scale_trans)


def _hold(ax: Axes, at: Rows, *values: Rows) -> None:
    """Let the axes hold what was drawn aside, which matplotlib does not count among their data."""
    ax.update_datalim([(x, y) for each in values for x, y in zip(at, each, strict=True)])
    ax.autoscale_view()


def _points(
    ax: Axes, at: Rows, bands: tuple[Rows, Rows, Rows], static: Rows, names: Sequence[str | None]
) -> None:
    """A point with its band at each place, the static value beside it."""
    _whiskers(ax, at, *bands, names[0], -ASIDE)
    ax.plot(
        at,
        static,
        linestyle="none",
        marker="D",
        markersize=4.5,
        markerfacecolor="white",
        markeredgecolor=STATIC["color"],
        label=names[1],
        clip_on=False,
        transform=_aside(ax, ASIDE),
    )
    _hold(ax, at, static)


def _bars(ax: Axes, ensemble: Ensemble, of: Response, low: Rows, median: Rows, high: Rows) -> None:
    places = np.arange(len(median), dtype=np.float64)
    _whiskers(ax, places, low, median, high, f"median, {_name(ensemble)}")
    if of.axis == "axle":
        name_places(ax, [str(k + 1) for k in range(len(median))], "Axle [number, front first]")
    else:
        name_supports(ax, ensemble.bridge, of.axis)
