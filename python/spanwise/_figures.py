"""The figures of a run or of an ensemble as files, PNG and SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from spanwise._door import require
from spanwise.ensembles import Ensemble
from spanwise.runs import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figures_of_run(run: Run) -> Iterator[tuple[str, Figure]]:
    """Model, envelopes, impact factors and the motion of the vehicles, by name."""
    plot, numbers = run.plot, range(1, len(run.passages) + 1)
    yield "model", plot.model()
    for each in run.responses:
        if each.axis == "section":
            yield each.name, plot.envelope(each.name)
    yield "impact_factors", plot.impact_factors()
    for k in numbers:
        yield f"vehicle_{k}" if len(numbers) > 1 else "vehicle", plot.vehicle(k)
    if not run.road.is_smooth:
        yield "road", plot.road()


def figures_of_ensemble(ensemble: Ensemble) -> Iterator[tuple[str, Figure]]:
    """Envelopes, and those impact factors that there are, by name."""
    for each in ensemble.responses:
        if each.axis != "axle" and len(ensemble.envelope(each.name).x):
            yield each.name, ensemble.plot.envelope(each.name)
    for name in ensemble.impact_factors.names:
        if not np.isnan(ensemble.impact_factors[name]).all():
            yield f"impact_factor_{name}", ensemble.plot.impact_factors(name)


def figure_files(figures: Iterable[tuple[str, Figure]]) -> Iterator[tuple[str, bytes]]:
    """Names and contents; needs the extra ``spanwise[plot]``."""
    matplotlib = require("matplotlib", extra="plot")
    for name, figure in figures:
        png, svg = BytesIO(), BytesIO()
        figure.savefig(png, format="png", dpi=200)
        figure.set_layout_engine("none")  # it is laid out
        # The same run gives the same file.
        with matplotlib.rc_context({"svg.hashsalt": "spanwise"}):
            figure.savefig(svg, format="svg", metadata={"Date": None})
        yield f"{name}.png", png.getvalue()
        yield f"{name}.svg", svg.getvalue()
