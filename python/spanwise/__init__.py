"""What vehicles do to bridges: dynamic response by a few modes and force summation."""

from spanwise import vehicles
from spanwise._core import __version__
from spanwise.bridge import Bridge, Modes
from spanwise.case import Case
from spanwise.crossing import cross
from spanwise.run import Envelope, Extremes, Run
from spanwise.table import ImpactFactors
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Body, Hinge, Spring, Vehicle

__all__ = [
    "Axle",
    "Body",
    "Bridge",
    "Case",
    "Envelope",
    "Extremes",
    "ForceTrain",
    "Hinge",
    "ImpactFactors",
    "Modes",
    "MovingMasses",
    "Run",
    "Spring",
    "Vehicle",
    "__version__",
    "cross",
    "vehicles",
]
