"""Roads: random by ISO 8608, measured, or single features, and sums of them."""

from spanwise.roads.base import Road, Smooth, Sum
from spanwise.roads.features import Bump, Camber, Joint, Pothole, Ramp, Step
from spanwise.roads.profile import Profile
from spanwise.roads.random import BRIDGE_STUDY, ISO8608, bridge_study, from_iri
from spanwise.roads.roughness import CLASSES, IriSegments, IsoClass, classify
from spanwise.roads.table import from_table

__all__ = [
    "BRIDGE_STUDY",
    "CLASSES",
    "ISO8608",
    "Bump",
    "Camber",
    "IriSegments",
    "IsoClass",
    "Joint",
    "Pothole",
    "Profile",
    "Ramp",
    "Road",
    "Smooth",
    "Step",
    "Sum",
    "bridge_study",
    "classify",
    "from_iri",
    "from_table",
]


def __dir__() -> list[str]:
    """What is meant for users."""
    return __all__
