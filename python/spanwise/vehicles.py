"""A catalogue of published vehicles, and of trucks of design codes as trains of forces.

Values that are recalled from a source, and not checked against it, are marked so.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from inspect import signature
from typing import Any, Final, TypeAlias

from spanwise._checks import count, not_negative, number, numbers, shown
from spanwise._wheels import GRAVITY
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Body, Hinge, Vehicle

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

FOOT: Final = 0.3048
POUND: Final = 4.4482216152605


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
    slug = POUND / FOOT
    axles = [
        Axle(
            position=position,
            tyre_stiffness=480_000 * POUND / FOOT,
            suspension_stiffness=270_000 * POUND / FOOT,
            friction_limit=4_800 * POUND,
        )
        for position in (7 * FOOT, -7 * FOOT)
    ]
    return Vehicle(
        mass=2 * 32_040 * POUND / GRAVITY,
        pitch_inertia=38_500 * slug * FOOT**2,
        cg_height=6 * FOOT,
        axles=axles,
    )


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
    axle = Axle(
        position=0.0,
        tyre_stiffness=1.75e6,
        suspension_stiffness=4e5,
        mass=700.0,
        suspension_damping=1e4,
    )
    return Vehicle(mass=17_300.0, pitch_inertia=17_300.0, cg_height=cg_height, axles=[axle])


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
    front = Axle(
        position=2.375,
        tyre_stiffness=1.75e6,
        suspension_stiffness=4e5,
        mass=700.0,
        suspension_damping=1e4,
    )
    rear = Axle(
        position=-2.375,
        tyre_stiffness=3.5e6,
        suspension_stiffness=1e6,
        mass=1_100.0,
        suspension_damping=2e4,
    )
    return Vehicle(mass=16_200.0, pitch_inertia=93_457.0, cg_height=cg_height, axles=[front, rear])


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
    masses = (700.0, 1_100.0, 750.0, 750.0, 750.0)
    suspensions = (0.4e6, 1.0e6, 0.75e6, 0.75e6, 0.75e6)
    tyres = (1.75e6, 3.5e6, 3.5e6, 3.5e6, 3.5e6)
    axles = [
        Axle(
            position=position,
            tyre_stiffness=tyre,
            suspension_stiffness=suspension,
            mass=mass,
            tyre_damping=1e4,
            suspension_damping=1e3,
        )
        for position, mass, suspension, tyre in zip(
            (0.5, -2.5, -1.8, -2.9, -4.0), masses, suspensions, tyres, strict=True
        )
    ]
    front, rear = _heights(cg_heights)
    tractor = Body(mass=4_500.0, pitch_inertia=4_604.0, axles=axles[:2], cg_height=front)
    trailer = Body(
        mass=31_450.0,
        pitch_inertia=16_302.0,
        axles=axles[2:],
        cg_height=rear,
        hinge=Hinge(to=0, at=-2.15, own=6.15, height=not_negative("hinge_height", hinge_height)),
    )
    return Vehicle(bodies=[tractor, trailer])


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
    lines = 2.0
    axles = [
        Axle(
            position=position,
            tyre_stiffness=lines * tyre,
            suspension_stiffness=lines * suspension,
            mass=lines * mass,
            tyre_damping=lines * 2_000.0,
            suspension_damping=lines * damping,
        )
        for position, mass, suspension, damping, tyre in (
            (1.698, 490.0, 242_604.0, 2_190.0, 875_082.0),
            (-2.569, 808.0, 1_903_172.0, 7_882.0, 3_503_307.0),
            (-2.283, 653.0, 1_969_034.0, 7_182.0, 3_507_429.0),
        )
    ]
    front, rear = _heights(cg_heights)
    tractor = Body(mass=2_612.0, pitch_inertia=2_022.0, axles=axles[:2], cg_height=front)
    trailer = Body(
        mass=26_113.0,
        pitch_inertia=33_153.0,
        axles=axles[2:],
        cg_height=rear,
        hinge=Hinge(to=0, at=-2.215, own=2.338, height=not_negative("hinge_height", hinge_height)),
    )
    return Vehicle(bodies=[tractor, trailer])


def hs20(*, rear_spacing: float = 14 * FOOT) -> ForceTrain:
    """The HS20 truck of AASHTO as forces: 8, 32 and 32 kip.

    Parameters
    ----------
    rear_spacing : float, optional
        From the second to the third axle, 14 to 30 ft, 4.267 (default) to 9.144 m.

    References
    ----------
    AASHTO, "Standard Specifications for Highway Bridges" and "LRFD Bridge Design Specifications".
    """
    rear = _within("rear_spacing", rear_spacing, 14 * FOOT, 30 * FOOT)
    kip = 1_000 * POUND
    return ForceTrain(loads=[8 * kip, 32 * kip, 32 * kip], spacings=[14 * FOOT, rear])


def t44(*, rear_spacing: float = 3.0) -> ForceTrain:
    """The T44 truck of Australia as forces, 432 kN (recalled, not read at the source).

    Parameters
    ----------
    rear_spacing : float, optional
        From the third to the fourth axle, 3 (default) to 8 m.

    References
    ----------
    NAASRA and Austroads, "Bridge Design Specification" (1976) and "Bridge Design Code" (1992).
    """
    rear = _within("rear_spacing", rear_spacing, 3.0, 8.0)
    return ForceTrain(loads=[48e3, *[96e3] * 4], spacings=[3.7, 1.2, rear, 1.2])


def cl_625() -> ForceTrain:
    """The CL-625 truck of Canada as forces, 625 kN (recalled, not read at the source).

    References
    ----------
    CSA S6, "Canadian Highway Bridge Design Code".
    """
    return ForceTrain(loads=[50e3, 125e3, 125e3, 175e3, 150e3], spacings=[3.6, 1.2, 6.6, 6.6])


def flm3() -> ForceTrain:
    """Fatigue load model 3 of the Eurocode as forces: four axles of 120 kN.

    References
    ----------
    EN 1991-2, "Actions on structures, Part 2: Traffic loads on bridges", 4.6.4.
    """
    return ForceTrain(loads=[120e3] * 4, spacings=[1.2, 6.0, 1.2])


#: Axle loads [N] and spacings [m] of the five lorries of fatigue load model 4.
_FLM4: Final[tuple[tuple[list[float], list[float]], ...]] = (
    ([70e3, 130e3], [4.5]),
    ([70e3, 120e3, 120e3], [4.2, 1.3]),
    ([70e3, 150e3, 90e3, 90e3, 90e3], [3.2, 5.2, 1.3, 1.3]),
    ([70e3, 140e3, 90e3, 90e3], [3.4, 6.0, 1.8]),
    ([70e3, 130e3, 90e3, 80e3, 80e3], [4.8, 3.6, 4.4, 1.3]),
)

#: Shares of the five lorries of fatigue load model 4 in traffic (recalled, not read at the source).
FLM4_MIX: Final[dict[str, tuple[float, ...]]] = {
    "long-distance": (0.20, 0.05, 0.50, 0.15, 0.10),
    "medium-distance": (0.40, 0.10, 0.30, 0.15, 0.05),
    "local": (0.80, 0.05, 0.05, 0.05, 0.05),
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
    which = count("lorry", lorry)
    if not 1 <= which <= len(_FLM4):
        raise ValueError(f"lorry = {which}: must be 1 to {len(_FLM4)}")
    loads, spacings = _FLM4[which - 1]
    return ForceTrain(loads=loads, spacings=spacings)


def _heights(values: Sequence[float]) -> tuple[float, float]:
    """Of tractor and semi-trailer."""
    heights = numbers("cg_heights", values)
    if len(heights) != 2:
        raise ValueError(
            f"cg_heights = {shown(values)}: give two, of the tractor and of the semi-trailer"
        )
    front, rear = (not_negative(f"cg_heights[{i}]", each) for i, each in enumerate(heights))
    return front, rear


def _within(key: str, value: float, low: float, high: float) -> float:
    """A spacing within the range of its code, which may have been rounded to the centimetre."""
    value = number(key, value)
    if not low - 0.005 <= value <= high + 0.005:
        raise ValueError(f"{key} = {value:g} m: must be {low:g} to {high:g} m")
    return value


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


#: Vehicles that a case file can name, by preset.
PRESETS: Final[dict[str, Preset]] = {
    "kishan-1973": Preset(kishan_1973, "two axles with friction", "Kishan and Traill-Nash (1973)"),
    "quarter-car": Preset(
        quarter_car, "quarter of a lorry", "McGetrick et al. (2009)", recalled=True
    ),
    "half-car": Preset(half_car, "two-axle lorry", "OBrien and Keenahan (2015)", recalled=True),
    "articulated-5-axle": Preset(
        articulated_5_axle,
        "tractor and semi-trailer",
        "D. Cantero and co-authors",
        recalled=True,
    ),
    "hs20-44": Preset(
        hs20_44,
        "tractor and semi-trailer",
        "Shi and Cai (2009)",
        recalled=True,
    ),
    "hs20": Preset(hs20, "axle loads of a code", "AASHTO HS20"),
    "t44": Preset(t44, "axle loads of a code", "NAASRA and Austroads T44", recalled=True),
    "cl-625": Preset(cl_625, "axle loads of a code", "CSA S6 CL-625", recalled=True),
    "flm3": Preset(flm3, "axle loads of a code", "EN 1991-2, FLM3"),
    **{
        f"flm4-{lorry}": Preset(
            partial(flm4, lorry),
            f"axle loads of a code, lorry {lorry} of 5",
            "EN 1991-2, FLM4",
            recalled=True,
        )
        for lorry in range(1, 6)
    },
}
