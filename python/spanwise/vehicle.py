"""Vehicles: rigid bodies on axles whose suspensions may rub, hinged or sprung to each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, TypeVar

from spanwise import _core
from spanwise._build import Maker, Place
from spanwise._value import Brief
from spanwise._wheels import Array, Wheels
from spanwise.errors import InputError, refused

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, repr=False)
class Axle(Brief):
    """A tyre below a suspension, with an unsprung mass between them or none.

    Parameters
    ----------
    position : float
        Distance ahead of the centre of mass of its body [m].
    tyre_stiffness : float
        Tyre stiffness [N/m].
    suspension_stiffness : float
        Suspension stiffness [N/m].
    mass : float, optional
        Unsprung mass [kg]; 0 (default) for a massless axle.
    tyre_damping, suspension_damping : float, optional
        Damping [N s/m].
    friction_limit : float, optional
        Friction force at which the suspension slides [N]; ``inf`` locks it, 0 (default) leaves the
        springs alone.
    initial_friction : float, optional
        Friction force in the static state [N], from -`friction_limit` to `friction_limit`. The
        static state does not determine it, and it matters: consider both signs.
    stick_stiffness : float, optional
        Stiffness by which friction builds up before it slides [N/m], for axles with a mass: by
        default 20 times that of the tyre. Friction of a massless axle holds rigidly unless it has
        `leaf_decay`.
    leaf_decay : float, optional
        Stroke within which the friction of a leaf spring goes towards its limit [m], some
        millimetres; in place of `stick_stiffness`. Of a massless axle too, whose friction then
        builds up with the stroke and does not hold rigidly.

    References
    ----------
    P. S. Fancher et al., "Measurement and representation of the mechanical properties of truck leaf
    springs", SAE Technical Paper 800905 (1980), for `leaf_decay`.
    """

    position: float
    tyre_stiffness: float
    suspension_stiffness: float
    mass: float = 0.0
    tyre_damping: float = 0.0
    suspension_damping: float = 0.0
    friction_limit: float = 0.0
    initial_friction: float = 0.0
    stick_stiffness: float | None = None
    leaf_decay: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Hinge(Brief):
    """A fifth wheel, a drawbar, or the pivot of a bogie: it joins a body to an earlier one.

    A bogie that is a body of its own, hinged between its axles, equalises their static loads.

    Parameters
    ----------
    to : int
        The earlier body, counted from 0.
    at : float
        Distance of the hinge ahead of the centre of mass of that body [m].
    own : float
        Distance of the hinge ahead of the centre of mass of the body that has it [m].
    height : float, optional
        Height above the road [m]; matters wherever the vehicle is accelerated or rolls freely.
    """

    to: int
    at: float
    own: float
    height: float = 0.0


@dataclass(frozen=True, kw_only=True, repr=False)
class Spring(Brief):
    """An upright spring and damper between a body and an earlier one: a secondary suspension.

    Parameters
    ----------
    to : int
        The earlier body, counted from 0.
    at : float
        Distance of the spring ahead of the centre of mass of that body [m].
    own : float
        Distance of the spring ahead of the centre of mass of the body that has it [m].
    stiffness : float
        Stiffness [N/m].
    damping : float, optional
        Damping [N s/m].
    friction_limit, initial_friction, stick_stiffness, leaf_decay : float, optional
        Friction beside the spring, as of an `Axle`. The stick has by default 20 times the stiffness
        of the spring. Positive friction pushes the body with the higher centre of mass up; of two
        at the same height, the earlier one.
    """

    to: int
    at: float
    own: float
    stiffness: float
    damping: float = 0.0
    friction_limit: float = 0.0
    initial_friction: float = 0.0
    stick_stiffness: float | None = None
    leaf_decay: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Body(Brief):
    """A rigid body of a vehicle that has several.

    Parameters
    ----------
    mass : float
        Mass [kg].
    pitch_inertia : float, optional
        Moment of inertia about the centre of mass [kg m2]. Not needed of a body that does not
        pitch: one with its one axle, and all that joins it to others, at its centre of mass.
    axles : sequence of Axle, optional
        Its axles, front first.
    cg_height : float, optional
        Height of the centre of mass above the road [m]; matters wherever the vehicle is accelerated
        (braking, acceleration, speeds in time) or rolls freely.
    hinge : Hinge, optional
        A hinge to an earlier body.
    springs : sequence of Spring, optional
        Springs to earlier bodies. Every body but the first needs a hinge or springs.
    """

    mass: float
    pitch_inertia: float | None = None
    axles: Sequence[Axle] = ()
    cg_height: float = 0.0
    hinge: Hinge | None = None
    springs: Sequence[Spring] = ()

    def __post_init__(self) -> None:
        for name, kind in (("axles", Axle), ("springs", Spring)):
            object.__setattr__(self, name, _all(name, getattr(self, name), kind))
        if self.hinge is not None and not isinstance(self.hinge, Hinge):
            raise refused("hinge", self.hinge, "must be a Hinge")

    @property
    def joints(self) -> tuple[Hinge | Spring, ...]:
        """What joins it to earlier bodies."""
        return (*(() if self.hinge is None else (self.hinge,)), *self.springs)


@dataclass(frozen=True, kw_only=True, repr=False)
class Vehicle(Wheels):
    """Rigid bodies that bounce, pitch and roll along on their axles.

    A vehicle of one body has `mass`, `pitch_inertia`, `axles` and `cg_height`; any other has
    `bodies`.

    Parameters
    ----------
    mass : float, optional
        Mass of the one body [kg], without unsprung masses. None where there are several bodies.
    pitch_inertia : float, optional
        Moment of inertia about its centre of mass [kg m2]. None where there are several bodies; not
        needed on a single axle, on which it does not pitch.
    axles : sequence of Axle, optional
        Its axles, front first. A single axle stands below the centre of mass. Of a vehicle of
        several bodies the axles of all, front first, each with its position in its own body.
    cg_height : float, optional
        Height of the centre of mass above the road [m]; matters wherever the vehicle is accelerated
        (braking, acceleration, speeds in time) or rolls freely (constant traction).
    bodies : sequence of Body, optional
        The bodies, each but the first hinged or sprung to earlier ones. Empty where there is one.

    Raises
    ------
    ValueError
        If a value is not allowed, if an axle would carry no load, if nothing resists some motion,
        or if there are more than 500 axles or bodies, naming what is wrong and what is allowed.

    Notes
    -----
    One body on massless axles is the model of A. S. Veletsos and T. Huang as used by Kishan and
    Traill-Nash (1973), Fig. 2. Static loads are those of the springs, without friction: two axles
    share the weight of their body by the lever rule, more as springs below a rigid body.

    Examples
    --------
    A tractor and its trailer, joined by a fifth wheel:

    >>> def axle(position, tyre, suspension):
    ...     return Axle(position=position, tyre_stiffness=tyre, suspension_stiffness=suspension)
    >>> tractor = Body(mass=4500, pitch_inertia=4604, axles=[axle(0.5, 2e6, 4e5), axle(-2.5, 4e6, 1e6)])
    >>> trailer = Body(
    ...     mass=31450,
    ...     pitch_inertia=16302,
    ...     axles=[axle(-2.9, 8e6, 2e6)],
    ...     hinge=Hinge(to=0, at=-2.15, own=6.15),
    ... )
    >>> truck = Vehicle(bodies=[tractor, trailer])
    """  # noqa: E501

    mass: float | None = None
    pitch_inertia: float | None = None
    axles: Sequence[Axle] = ()
    cg_height: float = 0.0
    bodies: Sequence[Body] = ()

    def __post_init__(self) -> None:
        bodies = _all("bodies", self.bodies, Body)
        if len(bodies) == 1 and bodies[0].hinge is None and not bodies[0].springs:
            self._check_alone(())
            (body,) = bodies
            for name in ("mass", "pitch_inertia", "axles", "cg_height"):
                object.__setattr__(self, name, getattr(body, name))
            bodies = ()
        core = _core.Vehicle(bodies or (self._one_body(),), alone=not bodies)
        if bodies:
            axles = tuple(bodies[b].axles[i] for b, i in core.axle_order)
            self._check_alone(axles)
            object.__setattr__(self, "axles", axles)
        object.__setattr__(self, "bodies", bodies)
        object.__setattr__(self, "_core", core)

    def _one_body(self) -> Body:
        missing = [name for name in ("mass", "pitch_inertia") if getattr(self, name) is None]
        if missing and not self.axles:
            said = f"missing {', '.join([*missing, 'axles'])}: "
            raise InputError("", None, said + "give mass, pitch_inertia and axles, or bodies")
        object.__setattr__(self, "axles", _all("axles", self.axles, Axle))
        # What is None is refused with the numbers.
        return Body(
            mass=self.mass,  # type: ignore[arg-type]
            pitch_inertia=self.pitch_inertia,
            axles=self.axles,
            cg_height=self.cg_height,
        )

    def _check_alone(self, axles: tuple[Axle, ...]) -> None:
        """Refuses what describes one body beside several."""
        given: dict[str, Any] = {"mass": self.mass, "pitch_inertia": self.pitch_inertia}
        if not _is(self.cg_height, 0.0):
            given["cg_height"] = self.cg_height
        if self.axles and tuple(self.axles) != axles:
            given["axles"] = self.axles
        for name, value in given.items():
            if value is not None:
                raise refused(name, value, "not beside bodies, which have their own")

    def __repr__(self) -> str:
        return f"Vehicle({self.total_mass / 1e3:.4g} t, {self._bodies_in_words}{self._row()})"

    @property
    def _bodies_in_words(self) -> str:
        number = len(self.bodies)
        return f"{number} bod{'ies' if number > 1 else 'y'}, " if number else ""

    @property
    def _unsprung(self) -> list[float]:
        masses = [axle.mass for axle in self.axles]
        return masses if any(masses) else []

    @property
    def parts(self) -> tuple[Body, ...]:
        """The bodies, or the one body there is."""
        return tuple(self.bodies) if self.bodies else (self._one_body(),)

    @property
    def body_positions(self) -> Array:
        """Distances of the bodies' centres of mass ahead of that of the vehicle [m]."""
        return self._core.body_positions

    @property
    def axle_order(self) -> list[tuple[int, int]]:
        """Body and number in it of every axle, both from 0, front first."""
        return self._core.axle_order

    def with_initial_friction(self, *friction: float) -> Vehicle:
        """The same vehicle with these friction forces in the static state [N], one by axle."""
        if len(friction) != len(self.axles):
            raise refused(
                "initial_friction",
                friction,
                f"give one force for each of the {len(self.axles)} axles",
            )
        parts = [[*body.axles] for body in self.parts]
        for (b, i), force in zip(self.axle_order, friction, strict=True):
            parts[b][i] = replace(parts[b][i], initial_friction=force)
        bodies = [replace(body, axles=axles) for body, axles in zip(self.parts, parts, strict=True)]
        return Vehicle(bodies=bodies)


def _all(key: str, values: object, kind: type[T]) -> tuple[T, ...]:
    name = kind.__name__
    if not isinstance(values, list | tuple):
        raise refused(key, values, f"must be a list of {name}")
    for k, each in enumerate(values):
        if not isinstance(each, kind):
            article = "an" if name[0] in "AEIOU" else "a"
            raise refused(f"{key}[{k}]", each, f"must be {article} {name}")
    return tuple(values)


def _is(given: object, value: float) -> bool:
    """Whether it is this number; what is none is refused later, by name."""
    return isinstance(given, Real) and bool(given == value)


def bodies_of(core: _core.Vehicle) -> list[Body]:
    """The bodies of a vehicle of the core."""
    return [Maker(Body).build(each, Place()) for each in core.bodies]
