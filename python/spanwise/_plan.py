"""All that an ensemble was made of, and from it any sample as a crossing of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._conditions import Conditions, Settings
from spanwise._events import Event, Speeds, is_simple
from spanwise._plausible import doubts
from spanwise._rows import Rows
from spanwise._value import Value, same
from spanwise._variation import Factors, idle
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.errors import InputError
from spanwise.roads import ISO8608, Road
from spanwise.roads.base import total
from spanwise.runs import Run
from spanwise.traffic import Drive
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Vehicle, bodies_of
from spanwise.vehicles import AnyVehicle

Array: TypeAlias = NDArray[np.float64]

#: What static axle loads depend on: masses, and springs that share them out.
SHARED_OUT: Final = ("body_mass", "tyre_stiffness", "suspension_stiffness")


@dataclass(frozen=True, eq=False, repr=False)
class Plan(Value):
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
    quantities: tuple[str, ...]
    advance: float | None
    settings: dict[str, Any]

    @property
    def varies_loads(self) -> bool:
        """Whether static axle loads differ from sample to sample."""
        return len(self.events) > 1 or any(each.name in SHARED_OUT for each in self.factors)

    @property
    def alike(self) -> bool:
        """Whether all samples are the same crossing."""
        varied = [self.speeds_driven, *(each.values for each in self.factors)]
        constant = all(same(each, np.broadcast_to(each[:1], each.shape)) for each in varied)
        return self.own is None and len(np.unique(self.kinds)) < 2 and constant

    @property
    def front_speeds(self) -> Array:
        """Speeds of the first vehicles at the start [m/s]: of each sample, or of all."""
        column = self.speeds_driven[:, 0]
        # Of one speed for all the core makes more in common.
        return np.ascontiguousarray(column[:1] if (column == column[0]).all() else column)

    @property
    def speeds_driven(self) -> Array:
        """Speeds at the start [m/s], (1 or sample, vehicle); NaN by time, and of no vehicle."""
        return self.speeds.driven(self.events, self.kinds, self.samples, self.drive)

    def static_loads(self) -> Array:
        """Static axle loads [N], shape (axle,), or (sample, axle) where samples differ in them."""
        loads = _core.static_loads(self, self.conditions.gravity)
        return loads if self.varies_loads else loads[0]

    def event(self, sample: int) -> Event:
        """Who crosses in a sample, as they are before factors."""
        return self.events[int(self.kinds[sample])] if len(self.kinds) else self.events[0]

    def road_of(self, sample: int) -> Road:
        """The whole road of a sample."""
        if self.own is None:
            return self.road
        return total([self.road, replace(self.own, seed=self.seed, sample=self.first + sample)])

    def vehicles(self, sample: int) -> list[AnyVehicle]:
        """Those of a sample, with its factors."""
        event = self.event(sample)
        if all(each.name.startswith("bridge_") for each in self.factors):
            return [each.vehicle for each in event]
        varied = _core.varied(event, [each.of(sample) for each in self.factors])
        return [_scaled(one.vehicle, core) for one, core in zip(event, varied, strict=True)]

    def doubts(self) -> tuple[str, ...]:
        """Sentences to say of what is hardly meant."""
        simple = all(is_simple(event, self.drive) for event in self.events)
        return doubts(
            self.bridge,
            self.bridge.modes(self.conditions.modes).frequencies[0],
            self._extreme_events(),
            speed=None,
            drive=self.drive,
            road=self.settings["road"],
            conditions=self.conditions,
            # Side by side no way is longer than by default, or `advance`, whatever the step is.
            step=None if simple and self.advance is None else self.conditions.step,
            advance=self.advance if simple else None,
        )

    def idle(self) -> list[str]:
        """Sentences to say of factors on nothing."""
        return [*idle(self.factors, self.events, self.conditions.ratios, self.conditions.matrix)]

    @property
    def roads(self) -> list[Road]:
        """All roads that are driven on."""
        own = (each.road for event in self.events for each in event)
        return [self.settings["road"], *(each for each in own if each is not None)]

    def _extreme_events(self) -> Iterator[Event]:
        """Events, and those with the smallest and the largest of each factor on masses and springs.

        Each vehicle at the highest of its speeds at the start.
        """
        speeds = self.speeds_driven
        most = np.zeros((len(self.events), speeds.shape[1]))
        np.maximum.at(most, self.kinds if len(self.kinds) else np.zeros(len(speeds), int), speeds)

        def fastest(kind: int, event: Event) -> Event:
            return tuple(
                replace(each, speed=speed) if speed > 0.0 else each
                for each, speed in zip(event, most[kind].tolist(), strict=False)
            )

        for kind, event in enumerate(self.events):
            yield fastest(kind, event)
        rows = set()
        for each in self.factors:
            if each.name in SHARED_OUT:
                places = (int(each.values.argmin()), int(each.values.argmax()))
                rows |= {place // each.values.shape[1] for place in places}
        for row in sorted(rows):
            # What cannot be made of factors is among the failures.
            with suppress(ValueError):
                pairs = zip(self.event(row), self.vehicles(row), strict=True)
                varied = tuple(replace(passage, vehicle=vehicle) for passage, vehicle in pairs)
                yield fastest(int(self.kinds[row]) if len(self.kinds) else 0, varied)

    def run(self, sample: int, rows: Rows, tail: float | None = None) -> Run:
        """The sample by a crossing of its own, with this tail [s] if that was not given."""
        passages = []
        vehicles = self.vehicles(sample)
        driven = self.speeds_driven
        speeds = driven[sample if len(driven) > 1 else 0].tolist()
        for passage, vehicle, speed in zip(self.event(sample), vehicles, speeds, strict=False):
            # By time there is none.
            speed = None if np.isnan(speed) else speed
            passages.append(replace(passage, vehicle=vehicle, speed=speed))
        of_all = self.conditions
        given: dict[str, Any] = {each.name: getattr(of_all, each.name) for each in fields(Settings)}
        given["damping"] = of_all.ratios if of_all.matrix is None else of_all.matrix
        if given["tail"] is None:
            given["tail"] = tail
        found = rows.step(sample, speeds[0])
        if found is not None:
            given["step"] = found[0]
        bridge = self._bridge(sample, given)
        common: dict[str, Any] = {}
        common_speeds = {each.speed for each in passages}
        if len(common_speeds) == 1 and None not in common_speeds:
            # As one would write it down.
            common["speed"] = common_speeds.pop()
            passages = [replace(each, speed=None) for each in passages]
        return cross(
            bridge,
            passages,
            road=self.road_of(sample),
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
            raise InputError(
                "sample",
                sample,
                f"has a bridge {stiffness:g} times as stiff, and one given by its flexibility "
                "or its modes cannot be made stiffer; give that bridge to cross",
            )
        # The core varies modes of a bridge; a run has a whole bridge, to be asked for anything.
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


def _scaled(nominal: AnyVehicle, core: _core.Vehicle) -> AnyVehicle:
    """The vehicle that the core made of a nominal one and a sample's factors."""
    # Places are as given, not counted from a centre that factors move: axles follow each other at
    # the same distances, to the bit, and so does what is made of these numbers once more.
    shares = core.static_loads(1.0).tolist()
    if isinstance(nominal, ForceTrain):
        return ForceTrain(loads=shares, positions=nominal.positions)
    if isinstance(nominal, MovingMasses):
        return MovingMasses(masses=shares, positions=nominal.positions)
    return Vehicle(bodies=bodies_of(core))
