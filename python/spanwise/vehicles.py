"""Vehicles: a rigid body on massless axles whose suspensions rub, and some published ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._checks import flag, number, shown

if TYPE_CHECKING:
    from spanwise.plotting import VehiclePlot

Array: TypeAlias = NDArray[np.float64]

#: Standard gravity [m/s2].
GRAVITY: Final = 9.80665


@dataclass(frozen=True, kw_only=True)
class Axle:
    """A massless axle: a tyre spring in series with a suspension that Coulomb friction bridges.

    Parameters
    ----------
    position : float
        Distance ahead of the centre of mass [m].
    tyre_stiffness : float
        Tyre stiffness [N/m].
    suspension_stiffness : float
        Suspension stiffness [N/m].
    friction_limit : float, optional
        Friction force at which the suspension slides [N]; ``inf`` locks it, 0 (default) leaves the
        two springs in series.
    initial_friction : float, optional
        Friction force in the static state [N], from -`friction_limit` to `friction_limit`. The
        static state does not determine it, and it matters: consider both signs.
    """

    position: float
    tyre_stiffness: float
    suspension_stiffness: float
    friction_limit: float = 0.0
    initial_friction: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Vehicle:
    """A rigid body that bounces, pitches and rolls along on its axles.

    Parameters
    ----------
    mass : float
        Mass of the body [kg].
    pitch_inertia : float
        Moment of inertia about the centre of mass [kg m2].
    axles : sequence of Axle
        The axles, front first. A single axle stands below the centre of mass.
    cg_height : float, optional
        Height of the centre of mass above the road [m]; matters under constant traction only.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.

    Notes
    -----
    The model of A. S. Veletsos and T. Huang as used by Kishan and Traill-Nash (1973), Fig. 2.
    Two axles share the weight by the lever rule, more as springs below a rigid body.
    """

    mass: float
    pitch_inertia: float
    axles: Sequence[Axle]
    cg_height: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.axles, list | tuple):
            raise ValueError(f"axles = {shown(self.axles)}: must be a list of Axle")
        object.__setattr__(self, "axles", tuple(self.axles))
        rows = []
        for k, axle in enumerate(self.axles):
            if not isinstance(axle, Axle):
                raise ValueError(f"axles[{k}] = {shown(axle)}: must be an Axle")
            names = (
                "position",
                "tyre_stiffness",
                "suspension_stiffness",
                "friction_limit",
                "initial_friction",
            )
            rows.append([number(f"axles[{k}].{name}", getattr(axle, name)) for name in names])
        core = _core.Vehicle(
            mass=number("vehicle mass", self.mass),
            pitch_inertia=number("pitch_inertia", self.pitch_inertia),
            cg_height=number("cg_height", self.cg_height),
            axles=rows,
        )
        object.__setattr__(self, "_core", core)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled as its fields, so that it can go to another process."""
        return _rebuilt, ({each.name: getattr(self, each.name) for each in fields(self)},)

    if TYPE_CHECKING:

        @property
        def _core(self) -> _core.Vehicle: ...

    @property
    def axle_positions(self) -> Array:
        """Distances of the axles ahead of the centre of mass [m], shape (axles,)."""
        return np.array([axle.position for axle in self.axles])

    @property
    def wheelbase(self) -> float:
        """Distance from the first to the last axle [m]."""
        return self.axles[0].position - self.axles[-1].position

    def static_loads(self, gravity: float = GRAVITY) -> Array:
        """Static axle loads [N], shape (axles,)."""
        return self._core.static_loads(number("gravity", gravity))

    def frequencies(self, *, locked: bool) -> Array:
        """Bounce and pitch frequencies on rigid ground [Hz], ascending; of one axle bounce alone.

        Parameters
        ----------
        locked : bool
            Whether friction holds the suspensions, so that the tyres alone are springs, or they
            slide.
        """
        return self._core.frequencies(flag("locked", locked))

    def with_initial_friction(self, *friction: float) -> Vehicle:
        """The same vehicle with these friction forces in the static state [N], one by axle."""
        if len(friction) != len(self.axles):
            raise ValueError(
                f"initial_friction = {shown(friction)}: give one force for each of the "
                f"{len(self.axles)} axles"
            )
        axles = (
            replace(axle, initial_friction=force)
            for axle, force in zip(self.axles, friction, strict=True)
        )
        return replace(self, axles=tuple(axles))

    @property
    def plot(self) -> VehiclePlot:
        """Figures of the vehicle; needs the extra ``spanwise[plot]``."""
        from spanwise.plotting import VehiclePlot

        return VehiclePlot(self)


def _rebuilt(arguments: dict[str, Any]) -> Vehicle:
    return Vehicle(**arguments)


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
    foot, pound = 0.3048, 4.4482216152605
    slug = pound / foot
    axles = [
        Axle(
            position=position,
            tyre_stiffness=480_000 * pound / foot,
            suspension_stiffness=270_000 * pound / foot,
            friction_limit=4_800 * pound,
        )
        for position in (7 * foot, -7 * foot)
    ]
    return Vehicle(
        mass=2 * 32_040 * pound / GRAVITY,
        pitch_inertia=38_500 * slug * foot**2,
        cg_height=6 * foot,
        axles=axles,
    )


#: Vehicles that a case file can name, by preset.
PRESETS: Final[dict[str, Callable[[], Vehicle]]] = {"kishan-1973": kishan_1973}
