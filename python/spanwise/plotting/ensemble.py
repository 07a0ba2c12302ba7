"""Figures of an ensemble: medians and bands along the bridge, with the static values beside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise.plotting.envelope import branches
from spanwise.plotting.factors import FACTORS, mask_note, plot_masked
from spanwise.plotting.style import (
    DYNAMIC,
    GREY,
    PALE,
    STATIC,
    along,
    axes_for,
    legend_above,
    measure_of,
    measure_on,
    styled,
    support_letters,
    whole,
    zero_line,
)
from spanwise.population import FACTORS as FACTORS_OF
from spanwise.population import Factor

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from spanwise.columns import SampleExtremes
    from spanwise.population import Ensemble, Quantity

#: The band that is drawn.
BAND: Final = (5.0, 95.0)

Rows: TypeAlias = NDArray[np.float64]


class EnsemblePlot:
    """Figures of an ensemble, as methods; each takes the axes to draw into, or makes a figure."""

    def __init__(self, ensemble: Ensemble) -> None:
        self._ensemble = ensemble

    @styled
    def impact_factors(self, quantity: Factor = "sagging", ax: Axes | None = None) -> Figure:
        """Impact factors along the bridge: median and the band from 5 to 95 % of the samples.

        Parameters
        ----------
        quantity : {"deflection", "sagging", "hogging", "shear", "reactions", "axle_loads"}
            Of what, as in `Ensemble.impact_factors`.
        ax : Axes, optional
            Where to draw; a new figure by default.

        Returns
        -------
        Figure

        Raises
        ------
        ValueError
            If there are no such factors, or no samples.
        """
        ensemble = self._ensemble
        low, median, high, largest = _bands(ensemble.impact_factors(quantity))
        ax = axes_for(ax)
        if quantity in FACTORS:
            x = ensemble.sections
            _band(ax, x, low, high)
            plot_masked(ax, x, median, label="median", **DYNAMIC)
            plot_masked(ax, x, largest, label="largest", color=GREY, linewidth=0.8)
            along(ax, ensemble.bridge)
            ax.set_xlabel(f"{ax.get_xlabel()}\n{mask_note(ensemble._recipe.conditions.mask)}")
            ax.set_ylim(0.0, self._top(quantity, largest))
        else:
            _bars(ax, ensemble, quantity, low, median, high)
        zero_line(ax, 1.0)
        name = {"reactions": "Reaction", "axle_loads": "Axle load", **FACTORS}[quantity]
        ax.set_ylabel(f"{name}, dynamic\nby static [-]")
        legend_above(ax, clear=1.6 if quantity in FACTORS else 0.5)
        return whole(ax)

    def _top(self, quantity: Factor, largest: Rows) -> float:
        """Where the axis ends: what grows beyond that is large only for lack of a static value."""
        name, sense = FACTORS_OF[quantity]
        extremes = getattr(self._ensemble, name)
        up, down = extremes.static_max, -extremes.static_min
        static = {"positive": up, "negative": down, "either": np.fmax(up, down)}[sense]
        static = np.nanmean(np.atleast_2d(static), axis=0)
        governing = largest[static >= 0.5 * np.nanmax(static)]
        return 1.15 * float(np.nanmax(governing if np.isfinite(governing).any() else largest))

    @styled
    def envelope(self, quantity: Quantity = "moment", ax: Axes | None = None) -> Figure:
        """Largest and smallest values along the bridge: median, band from 5 to 95 %, and static.

        Parameters
        ----------
        quantity : {"deflection", "moment", "shear", "reactions", "clamp_moments"}
            Of what.
        ax : Axes, optional
            Where to draw; a new figure by default.

        Returns
        -------
        Figure

        Raises
        ------
        ValueError
            If that was not looked at, or there are no samples.
        """
        ensemble, measure = self._ensemble, measure_of(quantity)
        if quantity not in ensemble.quantities:
            raise ValueError(
                f"quantity = {quantity!r}: was not looked at; this ensemble has "
                f"{', '.join(ensemble.quantities)}"
            )
        extremes = getattr(ensemble, quantity)
        ax = axes_for(ax)
        by_section = quantity in ("deflection", "moment", "shear")
        for side, first in (("max", True), ("min", False)):
            x, curves = extremes.x, _curves(extremes, side)
            if quantity == "shear":
                both = [_curves(each, side) for each in (ensemble.shear_left, ensemble.shear_right)]
                cut = [
                    branches(extremes.x, curve, np.stack(sides, axis=-1), ensemble.supports)
                    for curve, *sides in zip(curves, *both, strict=True)
                ]
                x, curves = cut[0][0], [curve for _, curve in cut]
            low, median, high, static = (measure.factor * each for each in curves)
            if by_section:
                _band(ax, x, low, high, labelled=first)
                ax.plot(x, median, label="median" if first else None, **DYNAMIC)
                ax.plot(x, static, label="static" if first else None, **STATIC)
            else:
                _points(ax, low, median, high, static, labelled=first)
        if by_section:
            along(ax, ensemble.bridge)
        else:
            _name_supports(ax, ensemble, quantity)
        zero_line(ax)
        measure_on(ax, measure)
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
        raise ValueError("samples: none has a value to draw")
    there = ~np.isnan(values).all(axis=0)
    found = np.full((4, values.shape[1]), np.nan)
    found[:, there] = np.nanpercentile(values[:, there], [BAND[0], 50.0, BAND[1], 100.0], axis=0)
    low, median, high, largest = found
    return low, median, high, largest


def _band(ax: Axes, x: Rows, low: Rows, high: Rows, *, labelled: bool = True) -> None:
    name = f"{BAND[0]:g} to {BAND[1]:g} % of the samples"
    ax.fill_between(x, low, high, color=PALE, linewidth=0.0, label=name if labelled else None)


def _points(ax: Axes, low: Rows, median: Rows, high: Rows, static: Rows, *, labelled: bool) -> None:
    """A point with its band for each support, the static value beside it."""
    places = np.arange(len(median), dtype=np.float64)
    name = f"median, {BAND[0]:g} to {BAND[1]:g} % of the samples"
    ax.errorbar(
        places - 0.1,
        median,
        yerr=[median - low, high - median],
        fmt="o",
        markersize=4.0,
        capsize=3.0,
        color=DYNAMIC["color"],
        linewidth=1.0,
        label=name if labelled else None,
    )
    ax.plot(
        places + 0.1,
        static,
        linestyle="none",
        marker="D",
        markersize=4.5,
        markerfacecolor="white",
        markeredgecolor=STATIC["color"],
        label="static" if labelled else None,
    )


def _bars(
    ax: Axes, ensemble: Ensemble, quantity: Factor, low: Rows, median: Rows, high: Rows
) -> None:
    places = np.arange(len(median), dtype=np.float64)
    ax.errorbar(
        places,
        median,
        yerr=[median - low, high - median],
        fmt="o",
        markersize=4.0,
        capsize=3.0,
        color=DYNAMIC["color"],
        linewidth=1.0,
        label=f"median, {BAND[0]:g} to {BAND[1]:g} % of the samples",
    )
    if quantity == "reactions":
        _name_supports(ax, ensemble, quantity)
        return
    ax.set_xticks(range(len(median)), [str(k + 1) for k in range(len(median))])
    ax.set_xlabel("Axle [number, front first]")
    ax.set_xlim(-0.6, len(median) - 0.4)


def _name_supports(ax: Axes, ensemble: Ensemble, quantity: str) -> None:
    bridge = ensemble.bridge
    names = [
        f"{letter}\n{x:g} m"
        for letter, (x, _) in zip(support_letters(bridge), bridge.supports, strict=True)
        if quantity == "reactions" or x in bridge.clamps
    ]
    ax.set_xticks(range(len(names)), names)
    ax.set_xlabel("Support [letter, distance from the left end]")
    ax.set_xlim(-0.6, len(names) - 0.4)
