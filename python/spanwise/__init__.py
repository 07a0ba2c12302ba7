"""What vehicles do to bridges: dynamic response by a few modes and force summation."""

from spanwise import vehicles
from spanwise._core import __version__
from spanwise.bridge import Bridge, Modes, Settlement
from spanwise.case import Case
from spanwise.crossing import cross
from spanwise.damping import Rayleigh
from spanwise.layout import Along, Support
from spanwise.run import Envelope, Extremes, Run
from spanwise.table import ImpactFactors
from spanwise.vehicles import Axle, Vehicle

__all__ = [
    "Along",
    "Axle",
    "Bridge",
    "Case",
    "Envelope",
    "Extremes",
    "ImpactFactors",
    "Modes",
    "Rayleigh",
    "Run",
    "Settlement",
    "Support",
    "Vehicle",
    "__version__",
    "cross",
    "vehicles",
]
