"""How all figures look: size, fonts, lines that survive greyscale, and the words on the axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, Final, ParamSpec, TypeVar

from spanwise._checks import finite, numbers, of_kind
from spanwise._door import require

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from spanwise.bridge import Bridge
    from spanwise.quantities import Axis, Response

P = ParamSpec("P")
T = TypeVar("T")

#: Width of a figure [in], the text width of an A4 report.
WIDTH: Final = 6.3
#: Height of one panel with a curve [in].
HEIGHT: Final = 2.7

STYLE: Final[dict[str, Any]] = {
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.0,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 6),
    "axes.xmargin": 0.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "lines.linewidth": 1.3,
    "lines.dash_capstyle": "butt",
    "hatch.linewidth": 0.6,
    "mathtext.default": "regular",
}

#: Ink of dimensions, reference lines and notes.
GREY: Final = "#6b6b6b"
#: Fill of bodies and areas.
PALE: Final = "#d9d9d9"

#: Bands over times without contact.
LIFTED: Final = "#f2b880"

#: Lines told apart by dashes as well as by the colours of Okabe and Ito, in order of use.
LINES: Final[tuple[dict[str, Any], ...]] = (
    {"color": "#000000", "linestyle": "-"},
    {"color": "#d55e00", "linestyle": (0, (5.0, 1.6))},
    {"color": "#0072b2", "linestyle": (0, (1.2, 1.2))},
    {"color": "#009e73", "linestyle": (0, (6.0, 1.5, 1.2, 1.5))},
    {"color": "#56b4e9", "linestyle": (0, (3.0, 1.2, 1.0, 1.2, 1.0, 1.2))},
    {"color": "#cc79a7", "linestyle": (0, (9.0, 2.0))},
)
MARKERS: Final = ("o", "s", "^", "D", "v", "P")
DYNAMIC: Final = LINES[0]
STATIC: Final = LINES[1]


def styled(draw: Callable[P, T]) -> Callable[P, T]:
    """Let a function draw in the style of this package, if matplotlib is there."""

    @wraps(draw)
    def in_style(*args: P.args, **kwargs: P.kwargs) -> T:
        matplotlib = require("matplotlib", extra="plot")
        with matplotlib.rc_context(STYLE):
            return draw(*args, **kwargs)

    return in_style


def new_figure(height: float) -> Figure:
    """An empty figure of the width of a report and this height [in]."""
    from spanwise.plotting.figure import Figure

    return Figure(figsize=(WIDTH, height), layout="constrained")


def axes_for(ax: Axes | None, height: float = HEIGHT) -> Axes:
    """The axes given, or the only ones of a new figure of this height [in]."""
    if ax is None:
        return new_figure(height).subplots()
    from matplotlib.axes import Axes

    of_kind("ax", ax, Axes, "Axes of matplotlib")
    return ax


def figure_for(figure: Figure | SubFigure | None, height: float) -> Figure | SubFigure:
    """The figure given, or a new one of this height [in]."""
    if figure is None:
        return new_figure(height)
    from matplotlib.figure import FigureBase

    of_kind("figure", figure, FigureBase, "a Figure or SubFigure of matplotlib")
    return figure


def whole(part: Axes | Figure | SubFigure) -> Figure:
    """The whole figure of which this is a part."""
    figure = part.figure
    assert figure is not None
    return figure.figure


def response_on(ax: Axes, of: Response, side: str = "", per: str = "") -> None:
    """Label the upright axis and turn it the way the response is drawn."""
    ax.set_ylabel(of.label(side, per))
    if of.downward:
        ax.yaxis.set_inverted(True)


def name_supports(ax: Axes, bridge: Bridge, axis: Axis) -> None:
    """Let the horizontal axis run over the supports, or those that hold the rotation."""
    names = [
        f"{letter}\n{metres(x)}"
        for letter, (x, _) in zip(support_letters(bridge), bridge.supports, strict=True)
        if axis == "support" or x in bridge.clamps
    ]
    name_places(ax, names, "Support [letter, distance from the left end]")


def name_places(ax: Axes, names: Sequence[str], label: str) -> None:
    """Let the horizontal axis run over places by name."""
    ax.set_xticks(range(len(names)), names)
    ax.set_xlabel(label)
    ax.set_xlim(-0.6, len(names) - 0.4)


def along(
    ax: Axes, bridge: Bridge, *, letters: bool = True, label: bool = True, hinges: bool = True
) -> None:
    """Let the horizontal axis run along the bridge: hairlines at the supports, lettered on top.

    Hinges are open circles at nought.
    """
    ax.set_xlim(0.0, bridge.length)
    if label:
        ax.set_xlabel("Distance from the left end, x [m]")
    for letter, (x, _) in zip(support_letters(bridge), bridge.supports, strict=True):
        ax.axvline(x, color=GREY, linewidth=0.5, zorder=0.5, clip_on=False)
        if letters:
            ax.annotate(
                letter,
                (x, 1.0),
                xycoords=ax.get_xaxis_transform(),
                xytext=(0.0, 2.0),
                textcoords="offset points",
                ha="center",
                fontsize=8.0,
                color=GREY,
                annotation_clip=False,
            )
    if hinges and len(bridge.hinges):
        ax.plot(
            bridge.hinges,
            [0.0] * len(bridge.hinges),
            linestyle="none",
            marker="o",
            markersize=6.5,
            markerfacecolor="white",
            markeredgecolor="black",
            zorder=6.0,
            clip_on=False,
        )


def zero_line(ax: Axes, at: float = 0.0) -> None:
    """A thin line at nought, or at another value that the eye should compare with."""
    ax.axhline(at, color=GREY, linewidth=0.7, zorder=0.6)


def limits_on(ax: Axes, of: Response, limit: float | Sequence[float] | None) -> None:
    """Dotted lines at limits that a caller has given in SI."""
    several = isinstance(limit, list | tuple)
    levels = numbers("limit", limit) if several else [] if limit is None else [limit]
    for k, each in enumerate(levels):
        level = of.shown[1] * finite("limit", each)
        ax.axhline(level, color=GREY, linestyle=":", label="limit" if k == 0 else None)


def legend_above(ax: Axes, *, columns: int = 4, clear: float = 1.6) -> None:
    """A legend above the axes, in one row if it has no more entries than columns."""
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=clear)


def support_letters(bridge: Bridge) -> list[str]:
    """A, B, C, ... for the supports, left to right."""
    return [chr(ord("A") + i) if i < 26 else f"S{i + 1}" for i in range(len(bridge.supports))]


def metres(x: float) -> str:
    """A length to the millimetre."""
    return f"{round(x, 3):g} m"
