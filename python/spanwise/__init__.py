"""What vehicles do to bridges: dynamic response by a few modes and force summation."""

from spanwise import roads, vehicles
from spanwise._concat import concat
from spanwise._core import __version__
from spanwise._keys import suggesting
from spanwise._warnings import DampingWarning, PlausibilityWarning
from spanwise.bridge import Bridge, Modes, Settlement
from spanwise.case import Case, CaseError
from spanwise.convergence import Convergence
from spanwise.crossing import cross
from spanwise.damping import Rayleigh
from spanwise.ensembles import Ensemble
from spanwise.errors import InputError
from spanwise.extremes import Envelope, Extremes
from spanwise.impact_factors import ImpactFactors
from spanwise.layout import Along, Support
from spanwise.motions import LiftOff
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
from spanwise.runs import Run
from spanwise.samples import Failure
from spanwise.study import ensemble
from spanwise.traffic import Acceleration, Braking, Passage, Speeds, convoy
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Body, Hinge, Spring, Vehicle

__all__ = [
    "ISO8608",
    "Acceleration",
    "Along",
    "Axle",
    "Body",
    "Braking",
    "Bridge",
    "Bump",
    "Camber",
    "Case",
    "CaseError",
    "Convergence",
    "DampingWarning",
    "Ensemble",
    "Envelope",
    "Extremes",
    "Failure",
    "ForceTrain",
    "Hinge",
    "ImpactFactors",
    "InputError",
    "Joint",
    "LiftOff",
    "Modes",
    "MovingMasses",
    "Passage",
    "PlausibilityWarning",
    "Pothole",
    "Profile",
    "Ramp",
    "Rayleigh",
    "Run",
    "Settlement",
    "Smooth",
    "Speeds",
    "Spring",
    "Step",
    "Support",
    "Vehicle",
    "__version__",
    "concat",
    "convoy",
    "cross",
    "ensemble",
    "roads",
    "vehicles",
]


for _made in (
    *(Along, Axle, Body, Bridge, Hinge, Spring, Support, Vehicle, ForceTrain, MovingMasses),
    *(ISO8608, Bump, Camber, Joint, Pothole, Profile, Ramp, Step),
    *(Acceleration, Braking, Passage, Rayleigh, Speeds),
):
    suggesting(_made)


def __dir__() -> list[str]:
    """What is meant for users."""
    return __all__
