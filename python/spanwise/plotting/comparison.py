"""Figures that set several runs beside each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from spanwise._checks import choice, counts, mapping, numbers, of_kind, shown, text
from spanwise.errors import InputError, refused
from spanwise.plotting.factors import along_bridge, mask_note, plot_masked
from spanwise.plotting.style import (
    LINES,
    MARKERS,
    along,
    axes_for,
    figure_for,
    legend_above,
    styled,
    whole,
    zero_line,
)
from spanwise.runs import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


@styled
def compare_impact_factors(
    runs: Mapping[str, Run], factor: str = "deflection", *, ax: Axes | None = None
) -> Figure:
    """Impact factors of several runs over the same bridge, blank where masked.

    Parameters
    ----------
    runs : mapping of str to Run
        The runs by what the legend calls them.
    factor : str, optional
        Which impact factor, one that there is along the bridge.
    """
    for name, each in mapping("runs", runs, "runs by name").items():
        of_kind(f"runs[{shown(name)}]", each, Run, "a Run")
    if not runs:
        raise InputError("runs", None, "give at least one run")
    titles = along_bridge()
    choice("factor", factor, titles)
    ax = axes_for(ax)
    zero_line(ax, at=1.0)
    for i, (name, run) in enumerate(runs.items()):
        values = run.impact_factors[factor]
        plot_masked(
            ax, run.impact_factors.sections, values, label=str(name), **LINES[i % len(LINES)]
        )
    first = next(iter(runs.values()))
    along(ax, first.bridge, hinges=False)
    ax.set_xlabel(f"{ax.get_xlabel()}\n{mask_note(first.impact_factors.mask)}")
    ax.set_ylabel(f"Impact factor,\n{titles[factor].lower()} [-]")
    legend_above(ax, columns=3 if len(runs) != 4 else 2)
    return whole(ax)


@styled
def compare_convergence(
    modes: Sequence[int],
    errors: Mapping[str, Mapping[str, Sequence[float]]],
    *,
    reference: str = "",
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Errors against the number of modes included, a panel for each quantity.

    Parameters
    ----------
    modes : sequence of int
        Numbers of modes.
    errors : mapping of str to mapping of str to sequence of float
        By quantity and by method, the relative error with each number of modes. Errors of nought
        have no place on the logarithmic axis and are left out.
    reference : str, optional
        What the errors are measured from, for the note below the figure.
    """
    included = counts("modes", modes)
    if not included:
        raise InputError("modes", "[]", "give at least one")
    curves = _curves(errors, len(included))
    text("reference", reference)
    figure = figure_for(figure, 2.9)
    panels = figure.subplots(1, len(curves), sharex=True, sharey=True, squeeze=False)[0]
    for ax, (quantity, by_method) in zip(panels, curves.items(), strict=True):
        for i, (method, error) in enumerate(by_method.items()):
            ax.semilogy(
                included,
                [each if each > 0.0 else np.nan for each in error],
                marker=MARKERS[i % len(MARKERS)],
                markersize=3.5,
                markerfacecolor="white",
                label=method,
                **LINES[i % len(LINES)],
            )
        ax.set_title(quantity.capitalize())
        ax.set_xlabel("Modes included [-]")
        ax.locator_params(axis="x", integer=True)
        ax.set_xlim(min(included) - 0.5, max(included) + 0.5)
        ax.grid(axis="y", color="#e5e5e5", linewidth=0.6)
        ax.set_axisbelow(True)
    panels[0].set_ylabel("Relative error\nof the extremes [-]")
    if reference:
        figure.supxlabel(f"(reference: {reference})", fontsize=8.0)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=len(labels))
    return whole(figure)


def _curves(errors: object, points: int) -> dict[str, dict[str, list[float]]]:
    """The errors by quantity and by method, as many as there are points."""
    found: dict[str, dict[str, list[float]]] = {}
    for quantity, by_method in mapping("errors", errors, "errors by quantity").items():
        key = f"errors[{shown(quantity)}]"
        own = mapping(key, by_method, "errors by method")
        found[str(quantity)] = {
            str(method): numbers(f"{key}[{shown(method)}]", error) for method, error in own.items()
        }
        for method, error in found[str(quantity)].items():
            if len(error) != points:
                raise InputError(
                    f"{key}[{method!r}]",
                    f"{len(error)} values",
                    f"must be one for each of the {points} numbers of modes",
                )
    if not any(found.values()):
        raise refused("errors", errors, "give at least one quantity and method")
    return found
