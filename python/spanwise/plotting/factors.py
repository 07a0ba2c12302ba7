"""Curves of impact factors, with the gaps that a mask leaves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from spanwise.quantities import factors

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def along_bridge() -> dict[str, str]:
    """Titles of the factors with a value for each section, by name."""
    return {name: each.title for name, (of, each) in factors().items() if of.axis == "section"}


def plot_masked(ax: Axes, x: NDArray[np.float64], y: NDArray[np.float64], **line: Any) -> None:
    """A curve with gaps at NaN, in which a point between two gaps still shows."""
    (drawn,) = ax.plot(x, y, **line)
    here = np.isfinite(np.concatenate([[np.nan], y, [np.nan]]))
    alone = here[1:-1] & ~here[:-2] & ~here[2:]
    ax.plot(x[alone], y[alone], ".", color=drawn.get_color(), markersize=4.0)


def mask_note(mask: float) -> str:
    """Why a curve of impact factors has gaps."""
    return f"(blank where the static value is at most {100.0 * mask:g} % of the largest)"
