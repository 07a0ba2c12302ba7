"""All that an ensemble was made of, and from it any sample as a crossing of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._conditions import Conditions
from spanwise._events import Event, Speeds
from spanwise._variation import Factors
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.roads import ISO8608, Road
from spanwise.roads.base import total
from spanwise.run import Run
from spanwise.traffic import Drive
from spanwise.traffic import Speeds as SpeedsInTime
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Body, Hinge, Spring, Vehicle
from spanwise.vehicles import AnyVehicle


@dataclass(frozen=True, eq=False)
class Recipe:
    """What `ensemble` was asked for, checked.

    Attributes
    ----------
    settings : dict
        Its keyword arguments.
    own : ISO8608 or None
        The road that is drawn anew for each sample.
    road : Road
        What all samples share of theirs.
    """

    bridge: Bridge
    events: tuple[Event, ...]
    kinds: NDArray[np.uint32]
    samples: int
    first: int
    seed: int
    drive: Drive
    speeds: Speeds
    road: Road
    own: ISO8608 | None
    factors: list[Factors]
    conditions: Conditions
    settings: dict[str, Any]

    def event(self, sample: int) -> Event:
        """Who crosses in a sample, as they are before factors."""
        return self.events[int(self.kinds[sample])] if len(self.kinds) else self.events[0]

    def road_of(self, sample: int) -> Road:
        """The whole road of a sample."""
        if self.own is None:
            return self.road
        return total([self.road, replace(self.own, seed=self.seed, sample=self.first + sample)])

    def run(self, sample: int, core: _core.Ensemble) -> Run:
        """The sample by a crossing of its own."""
        passages = []
        for number, passage in enumerate(self.event(sample)):
            vehicle = passage.vehicle
            if any(not each.name.startswith("bridge_") for each in self.factors):
                vehicle = _scaled(vehicle, *core.vehicle(sample, number))
            speed = passage.speed
            if speed is None and not isinstance(passage.drive or self.drive, SpeedsInTime):
                speed = self.speeds.of(sample, number, self.samples)
            passages.append(replace(passage, vehicle=vehicle, speed=speed))
        given: dict[str, Any] = {**self.conditions.core}
        matrix = given.pop("damping_matrix")
        given["damping"] = given["damping"] if matrix is None else matrix
        found = core.step(sample)
        if found is not None:
            given["step"] = found[0]
        bridge = self._bridge(sample, given)
        common: dict[str, Any] = {}
        speeds = {each.speed for each in passages}
        if speeds != {None} and len(speeds) == 1 and None not in speeds:
            # As one would write it down.
            common["speed"] = speeds.pop()
            passages = [replace(each, speed=None) for each in passages]
        return cross(
            bridge,
            passages,
            road=self.road_of(sample),
            drive=self.drive,
            mask=self.conditions.mask,
            **common,
            **given,
        )

    def _bridge(self, sample: int, given: dict[str, Any]) -> Bridge:
        """The bridge as the sample has it; its damping goes into what is given."""
        by_name = {each.name: each.values for each in self.factors}
        if (damping := _of(by_name.get("bridge_damping"), sample)) is not None:
            given["damping"] = np.asarray(given["damping"]) * damping
        stiffness = _of(by_name.get("bridge_stiffness"), sample)
        if stiffness is None or stiffness == 1.0:
            return self.bridge
        if not self.bridge.described:
            raise ValueError(
                f"sample = {sample}: has a bridge {stiffness:g} times as stiff, and one given by "
                "its flexibility or its modes cannot be made stiffer; give that bridge to cross"
            )
        arguments = self.bridge.arguments
        return Bridge(
            **{
                **arguments,
                "EI": _times(arguments["EI"], stiffness, "values"),
                "supports": [_stiffer(each, stiffness) for each in arguments["supports"]],
            }
        )


def _of(values: NDArray[np.float64] | None, sample: int) -> float | None:
    if values is None:
        return None
    return float(values[0 if len(values) == 1 else sample, 0])


def _times(given: Any, factor: float, key: str) -> Any:
    """Values along the bridge, or the table of them, so many times as large."""
    if isinstance(given, Mapping):
        return {**given, key: [factor * each for each in given[key]]}
    return [factor * each for each in given]


def _stiffer(support: Any, factor: float) -> Any:
    """A support whose springs are so many times as stiff."""
    if not isinstance(support, Mapping):
        return support
    stiffer = dict(support)
    for key in ("vertical", "rotation"):
        if isinstance(stiffer.get(key), float):
            stiffer[key] = factor * stiffer[key]
    return stiffer


def _scaled(nominal: AnyVehicle, core: _core.Vehicle, bodies: Sequence[_core._Body]) -> AnyVehicle:
    """The vehicle that the core made of a nominal one and a sample's factors."""
    # Places are as given, not counted from a centre that factors move: axles follow each other at
    # the same distances, to the bit, and so does what is made of these numbers once more.
    shares = core.static_loads(1.0).tolist()
    if isinstance(nominal, ForceTrain):
        return ForceTrain(loads=shares, positions=nominal.positions)
    if isinstance(nominal, MovingMasses):
        return MovingMasses(masses=shares, positions=nominal.positions)
    return Vehicle(bodies=[_body(each) for each in bodies])


def _body(body: _core._Body) -> Body:
    (mass, inertia, height), axles, hinge, springs = body
    return Body(
        mass=mass,
        pitch_inertia=inertia,
        cg_height=height,
        axles=[_axle(each) for each in axles],
        hinge=None
        if hinge is None
        else Hinge(to=hinge[0], at=hinge[1], own=hinge[2], height=hinge[3]),
        springs=[
            Spring(
                to=to, at=at, own=own, stiffness=stiffness, damping=damping, **_friction(friction)
            )
            for to, at, own, stiffness, damping, friction in springs
        ],
    )


def _axle(axle: _core._Axle) -> Axle:
    (position, mass, tyre, tyre_damping, suspension, damping), friction = axle
    return Axle(
        position=position,
        mass=mass,
        tyre_stiffness=tyre,
        tyre_damping=tyre_damping,
        suspension_stiffness=suspension,
        suspension_damping=damping,
        **_friction(friction),
    )


def _friction(friction: _core._Friction) -> dict[str, Any]:
    names = ("friction_limit", "initial_friction", "stick_stiffness", "leaf_decay")
    return dict(zip(names, friction, strict=True))
