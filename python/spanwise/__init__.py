"""What vehicles do to bridges: dynamic response by a few modes and force summation."""

from spanwise import vehicles
from spanwise._core import __version__
from spanwise.bridge import Bridge, Modes
from spanwise.case import Case
from spanwise.crossing import cross
from spanwise.run import Envelope, Extremes, Run
from spanwise.table import ImpactFactors
from spanwise.vehicles import Axle, Vehicle

__all__ = [
    "Axle",
    "Bridge",
    "Case",
    "Envelope",
    "Extremes",
    "ImpactFactors",
    "Modes",
    "Run",
    "Vehicle",
    "__version__",
    "cross",
    "vehicles",
]
