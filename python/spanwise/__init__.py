"""What vehicles do to bridges: dynamic response by a few modes and force summation."""

from spanwise import roads, vehicles
from spanwise._core import __version__
from spanwise.bridge import Bridge, Modes
from spanwise.case import Case
from spanwise.crossing import cross
from spanwise.roads import (
    ISO8608,
    Bump,
    Camber,
    Joint,
    Pothole,
    Profile,
    Ramp,
    Smooth,
    Step,
)
from spanwise.run import Envelope, Extremes, Run
from spanwise.table import ImpactFactors
from spanwise.vehicles import Axle, Vehicle

__all__ = [
    "ISO8608",
    "Axle",
    "Bridge",
    "Bump",
    "Camber",
    "Case",
    "Envelope",
    "Extremes",
    "ImpactFactors",
    "Joint",
    "Modes",
    "Pothole",
    "Profile",
    "Ramp",
    "Run",
    "Smooth",
    "Step",
    "Vehicle",
    "__version__",
    "cross",
    "roads",
    "vehicles",
]
