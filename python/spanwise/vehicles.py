"""A catalogue of published vehicles, and of trucks of design codes as trains of forces.

Values that are recalled from a source, and not checked against it, are marked so. The figures are
in the core.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from inspect import signature
from typing import Any, Final, TypeAlias

from spanwise import _core
from spanwise._checks import count, number, numbers
from spanwise._wheels import GRAVITY
from spanwise.errors import refused
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Vehicle, bodies_of

__all__ = [
    "FLM4_MIX",
    "GRAVITY",
    "PRESETS",
    "AnyVehicle",
    "Axle",
    "Preset",
    "Vehicle",
    "articulated_5_axle",
    "cl_625",
    "flm3",
    "flm4",
    "half_car",
    "hs20",
    "hs20_44",
    "kishan_1973",
    "quarter_car",
    "t44",
]


def __dir__() -> list[str]:
    """What is meant for users."""
    return __all__


#: What can cross a bridge.
AnyVehicle: TypeAlias = Vehicle | ForceTrain | MovingMasses


def kishan_1973() -> Vehicle:
    """The two-axle vehicle of Kishan and Traill-Nash (1973), section 4.

    32 040 lb (142.5 kN) on each axle, 14 ft (4.267 m) apart, pitching inertia 38 500 slug ft2,
    centre of mass 6 ft above the pavement, tyres 480 000 lb/ft, suspensions 270 000 lb/ft, limiting
    friction 4 800 lb at each axle. Converted from the US units, of which the SI figures printed
    beside them are rounded. The initial friction is not stated there; it is zero here.

    References
    ----------
    H. Kishan and R. W. Traill-Nash, "Calculation of response and loading of highway bridges from
    modal coordinates", IABSE Publications 33 (1973), https://doi.org/10.5169/seals-25635.
    """
    return _vehicle(_core.kishan_1973())


def quarter_car(*, cg_height: float = 0.0) -> Vehicle:
    """A quarter of a lorry: 17.3 t on one axle of 0.7 t (recalled, not read at the source).

    It does not pitch; its pitch inertia is not used.

    Parameters
    ----------
    cg_height : float, optional
        Height of the centre of mass above the road [m], which is not stated. Braking moves no load
        from a single axle.

    References
    ----------
    P. J. McGetrick, A. Gonzalez and E. J. OBrien, "Theoretical investigation of the use of a moving
    vehicle to identify bridge dynamic parameters", Insight 51 (2009).
    """
    return _vehicle(_core.quarter_car(number("cg_height", cg_height)))


def half_car(*, cg_height: float = 0.0) -> Vehicle:
    """A two-axle lorry of 18 t, axles 4.75 m apart (recalled, not read at the source).

    Parameters
    ----------
    cg_height : float, optional
        Height of the centre of mass above the road [m], which is not stated. At 0 (default) braking
        moves no load from axle to axle.

    References
    ----------
    E. J. OBrien and J. Keenahan, "Drive-by damage detection in bridges using the apparent profile",
    Structural Control and Health Monitoring 22 (2015).
    """
    return _vehicle(_core.half_car(number("cg_height", cg_height)))


def articulated_5_axle(
    *, cg_heights: Sequence[float] = (0.0, 0.0), hinge_height: float = 0.0
) -> Vehicle:
    """An articulated lorry of 40 t with a fifth wheel (recalled, not read at the source).

    Two axles in front, three behind. Tractor and semi-trailer are hinged 2.15 m behind the centre
    of mass of the tractor. The damping of the suspensions, 1e3 N s/m each, is very low, about 1 %
    of critical in bounce: check it before relying on how the lorry sways out. Which paper the
    values are from is not settled.

    Parameters
    ----------
    cg_heights : sequence of float, optional
        Heights of the centres of mass of tractor and semi-trailer above the road [m], which are not
        stated. At 0 (default) braking moves no load from axle to axle.
    hinge_height : float, optional
        Height of the fifth wheel above the road [m].

    References
    ----------
    D. Cantero and co-authors, in their studies of the dynamic amplification of bridges.
    """
    return _vehicle(_core.articulated_5_axle(*_heights(cg_heights, hinge_height)))


def hs20_44(*, cg_heights: Sequence[float] = (0.0, 0.0), hinge_height: float = 0.0) -> Vehicle:
    """The AASHTO HS20-44 truck as tractor and semi-trailer (recalled, not read at the source).

    Wheel masses, springs and dampers are twice those of a wheel line, bodies and pitch inertias
    those of the whole truck.

    Parameters
    ----------
    cg_heights : sequence of float, optional
        Heights of the centres of mass of tractor and semi-trailer above the road [m], which are not
        stated. At 0 (default) braking moves no load from axle to axle.
    hinge_height : float, optional
        Height of the fifth wheel above the road [m].

    References
    ----------
    X. Shi and C. S. Cai, "Simulation of dynamic effects of vehicles on pavement using a 3D
    interaction model", Journal of Transportation Engineering 135 (2009); L. Deng and C. S. Cai,
    "Development of dynamic impact factor for performance evaluation of existing multi-girder
    concrete bridges", Engineering Structures 32 (2010).
    """
    return _vehicle(_core.hs20_44(*_heights(cg_heights, hinge_height)))


def hs20(*, rear_spacing: float = _core.HS20_REAR_SPACING[0]) -> ForceTrain:
    """The HS20 truck of AASHTO as forces: 8, 32 and 32 kip.

    Parameters
    ----------
    rear_spacing : float, optional
        From the second to the third axle, 14 to 30 ft, 4.267 (default) to 9.144 m.

    References
    ----------
    AASHTO, "Standard Specifications for Highway Bridges" and "LRFD Bridge Design Specifications".
    """
    return _forces(_core.hs20(number("rear_spacing", rear_spacing)))


def t44(*, rear_spacing: float = _core.T44_REAR_SPACING[0]) -> ForceTrain:
    """The T44 truck of Australia as forces, 432 kN (recalled, not read at the source).

    Parameters
    ----------
    rear_spacing : float, optional
        From the third to the fourth axle, 3 (default) to 8 m.

    References
    ----------
    NAASRA and Austroads, "Bridge Design Specification" (1976) and "Bridge Design Code" (1992).
    """
    return _forces(_core.t44(number("rear_spacing", rear_spacing)))


def cl_625() -> ForceTrain:
    """The CL-625 truck of Canada as forces, 625 kN (recalled, not read at the source).

    References
    ----------
    CSA S6, "Canadian Highway Bridge Design Code".
    """
    return _forces(_core.cl_625())


def flm3() -> ForceTrain:
    """Fatigue load model 3 of the Eurocode as forces: four axles of 120 kN.

    References
    ----------
    EN 1991-2, "Actions on structures, Part 2: Traffic loads on bridges", 4.6.4.
    """
    return _forces(_core.flm3())


#: Shares of the five lorries of fatigue load model 4 in traffic (recalled, not read at the source).
FLM4_MIX: Final[dict[str, tuple[float, ...]]] = {
    traffic: tuple(shares) for traffic, shares in _core.FLM4_MIX
}


def flm4(lorry: int) -> ForceTrain:
    """A lorry of fatigue load model 4 of the Eurocode as forces (recalled, not read at the source).

    Their shares in traffic are in `FLM4_MIX`.

    Parameters
    ----------
    lorry : int
        Which of the five, from 1.

    References
    ----------
    EN 1991-2, "Actions on structures, Part 2: Traffic loads on bridges", 4.6.5.
    """
    return _forces(_core.flm4(count("lorry", lorry)))


def _vehicle(core: _core.Vehicle) -> Vehicle:
    return Vehicle(bodies=bodies_of(core))


def _forces(core: _core.Vehicle) -> ForceTrain:
    return ForceTrain(loads=core.static_loads(GRAVITY).tolist(), positions=core.places.tolist())


def _heights(cg_heights: Sequence[float], hinge_height: float) -> tuple[list[float], float]:
    """Of tractor and semi-trailer, and of the hinge between them."""
    heights = numbers("cg_heights", cg_heights)
    if len(heights) != 2:
        raise refused("cg_heights", cg_heights, "give two, of the tractor and of the semi-trailer")
    return heights, number("hinge_height", hinge_height)


@dataclass(frozen=True)
class Preset:
    """An entry of the catalogue.

    Attributes
    ----------
    make : callable
        Makes the vehicle.
    title : str
        What it is.
    source : str
        Where its values come from.
    recalled : bool
        Whether the values were recalled, and not read at the source.
    """

    make: Callable[..., AnyVehicle]
    title: str
    source: str
    recalled: bool = False

    @property
    def options(self) -> dict[str, Any]:
        """What `make` accepts, with the defaults."""
        found = signature(self.make).parameters.values()
        return {p.name: p.default for p in found if p.kind is p.KEYWORD_ONLY}

    @property
    def called(self) -> str:
        """How it is made in Python."""
        if isinstance(self.make, partial):
            return f"sw.vehicles.{self.make.func.__name__}({', '.join(map(repr, self.make.args))})"
        return f"sw.vehicles.{getattr(self.make, '__name__', 'PRESETS')}()"

    def __call__(self, **options: Any) -> AnyVehicle:
        """The vehicle."""
        return self.make(**options)


#: What makes each of them.
_MAKERS: Final[dict[str, Callable[..., AnyVehicle]]] = {
    "kishan-1973": kishan_1973,
    "quarter-car": quarter_car,
    "half-car": half_car,
    "articulated-5-axle": articulated_5_axle,
    "hs20-44": hs20_44,
    "hs20": hs20,
    "t44": t44,
    "cl-625": cl_625,
    "flm3": flm3,
    **{f"flm4-{lorry}": partial(flm4, lorry) for lorry in range(1, 6)},
}

#: Vehicles that a case file can name, by preset.
PRESETS: Final[dict[str, Preset]] = {
    name: Preset(_MAKERS[name], title, source, recalled)
    for name, title, source, recalled in _core.presets()
}
