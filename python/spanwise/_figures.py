"""The figures of a run as files, PNG and SVG."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO

from spanwise._door import require
from spanwise.runs import Run


def figure_files(run: Run) -> Iterator[tuple[str, bytes]]:
    """Names and contents; needs the extra ``spanwise[plot]``."""
    matplotlib = require("matplotlib", extra="plot")
    plot = run.plot
    numbers = range(1, len(run.passages) + 1)
    figures = [
        ("model", plot.model()),
        *(
            (each.name, plot.envelope(each.name))
            for each in run.responses
            if each.axis == "section"
        ),
        ("impact_factors", plot.impact_factors()),
        *((f"vehicle_{k}" if len(numbers) > 1 else "vehicle", plot.vehicle(k)) for k in numbers),
    ]
    if not run.road.is_smooth:
        figures.append(("road", plot.road()))
    for name, figure in figures:
        png, svg = BytesIO(), BytesIO()
        figure.savefig(png, format="png", dpi=200)
        figure.set_layout_engine("none")  # it is laid out
        # The same run gives the same file.
        with matplotlib.rc_context({"svg.hashsalt": "spanwise"}):
            figure.savefig(svg, format="svg", metadata={"Date": None})
        yield f"{name}.png", png.getvalue()
        yield f"{name}.svg", svg.getvalue()
