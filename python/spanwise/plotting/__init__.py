"""Figures of bridges, vehicles, roads and runs, by matplotlib (the extra ``spanwise[plot]``).

Every method draws into the axes `ax` or the figure `figure` of matplotlib that it is given, by
default into a new one, and returns the `matplotlib.figure.Figure`. A new one belongs to no window:
save it with ``figure.savefig("name.svg")``, or leave it as the last line of a notebook cell.
"""

from spanwise.plotting.bridge import BridgePlot, SettlementPlot
from spanwise.plotting.comparison import compare_convergence, compare_impact_factors
from spanwise.plotting.ensemble import EnsemblePlot
from spanwise.plotting.road import RoadPlot
from spanwise.plotting.run import RunPlot
from spanwise.plotting.vehicle import VehiclePlot

__all__ = [
    "BridgePlot",
    "EnsemblePlot",
    "RoadPlot",
    "RunPlot",
    "SettlementPlot",
    "VehiclePlot",
    "compare_convergence",
    "compare_impact_factors",
]


def __dir__() -> list[str]:
    """What is meant for users."""
    return __all__
