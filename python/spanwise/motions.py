"""How vehicles, their wheels and the modes of a bridge move during a crossing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._renamed import Renamed
from spanwise._value import Value

Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Value):
    """A coordinate during the crossing.

    Attributes
    ----------
    displacement, velocity, acceleration : ndarray, shape (time,)
        From the static state [m or rad, per s, per s2]; heave is down, pitch nose down.
    """

    displacement: Array
    velocity: Array
    acceleration: Array

    def __repr__(self) -> str:
        return f"Motion({len(self.displacement)} instants)"


@dataclass(frozen=True, eq=False, repr=False)
class BodyMotion(Value):
    """A body of a vehicle during the crossing.

    Attributes
    ----------
    heave : Motion
        Of its centre of mass, down [m].
    pitch : Motion
        Nose down [rad].
    """

    heave: Motion
    pitch: Motion

    def __repr__(self) -> str:
        return f"BodyMotion({len(self.heave.displacement)} instants)"


@dataclass(frozen=True, eq=False, repr=False)
class VehicleMotion(Value):
    """A vehicle during the crossing; every array has one entry for each instant.

    Heave and pitch are those of its first body; a train has no body, and these are then missing.

    Attributes
    ----------
    bodies : tuple of BodyMotion
        Its bodies; none of a train of forces or masses.
    hops : tuple of Motion
        Unsprung masses, down [m], axle by axle; zero for massless axles.
    travel, speed, acceleration : ndarray, shape (time,)
        Centre of mass along the road, from the end of the bridge at which the vehicle enters and in
        its own direction [m, m/s, m/s2].
    axle_positions : ndarray, shape (time, axle)
        From the left end of the bridge [m].
    elevations : ndarray, shape (time, axle)
        Of the road under the axles, up [m], as they move the vehicle: faded in, averaged over the
        contact patch, and of a `Profile` off the least-squares line of the whole way, as heave,
        pitch and hops are too. Elevations as given are ``road.elevation(axle_positions)``.
    suspension_travel : ndarray, shape (time, axle)
        Shortening since the static state [m].
    friction : ndarray, shape (time, axle)
        Friction forces in the suspensions [N].
    stopped : float or None
        When it came to rest [s], if it did.
    """

    bodies: tuple[BodyMotion, ...]
    hops: tuple[Motion, ...]
    travel: Array
    speed: Array
    acceleration: Array
    axle_positions: Array
    elevations: Array
    suspension_travel: Array
    friction: Array
    stopped: float | None

    suspension_shortenings = Renamed("suspension_travel")

    def __repr__(self) -> str:
        bodies, (instants, axles) = len(self.bodies), self.axle_positions.shape
        return f"VehicleMotion({bodies} bodies, {axles} axles, {instants} instants)"

    def _body(self) -> BodyMotion:
        if not self.bodies:
            raise AttributeError("a train of forces or masses has no body that heaves or pitches")
        return self.bodies[0]

    @property
    def heave(self) -> Array:
        """First body, down from its static position [m], shape (time,)."""
        return self._body().heave.displacement

    @property
    def heave_velocity(self) -> Array:
        """First body [m/s], shape (time,)."""
        return self._body().heave.velocity

    @property
    def heave_acceleration(self) -> Array:
        """First body [m/s2], shape (time,)."""
        return self._body().heave.acceleration

    @property
    def pitch(self) -> Array:
        """First body, nose down [rad], shape (time,)."""
        return self._body().pitch.displacement

    @property
    def pitch_velocity(self) -> Array:
        """First body [rad/s], shape (time,)."""
        return self._body().pitch.velocity

    @property
    def pitch_acceleration(self) -> Array:
        """First body [rad/s2], shape (time,)."""
        return self._body().pitch.acceleration


@dataclass(frozen=True)
class LiftOff:
    """A time during which a wheel was off the road.

    Attributes
    ----------
    axle : int
        Number of the axle from 1, through all vehicles.
    start, end : float
        First instant without contact and first with contact again [s].
    """

    axle: int
    start: float
    end: float

    @property
    def duration(self) -> float:
        """How long [s]."""
        return self.end - self.start


@dataclass(frozen=True, eq=False, repr=False)
class ContactLoss(Value):
    """How often and how long wheels were off the road, axle by axle.

    Attributes
    ----------
    count : ndarray of int, shape (axle,)
        How many times.
    total : ndarray, shape (axle,)
        How long in all [s].
    longest : ndarray, shape (axle,)
        How long at most at a time [s].
    """

    count: NDArray[np.int64]
    total: Array
    longest: Array


@dataclass(frozen=True, eq=False, repr=False)
class ModalMotion(Value):
    """Modal coordinates during the crossing, for modes of unit modal mass.

    Attributes
    ----------
    coordinates, velocities, accelerations : ndarray, shape (time, mode)
        A and its rates [m kg^1/2, per s, per s2].
    """

    coordinates: Array
    velocities: Array
    accelerations: Array

    def __repr__(self) -> str:
        instants, modes = self.coordinates.shape
        return f"ModalMotion({modes} modes, {instants} instants)"
