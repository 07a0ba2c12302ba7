"""The plan of an ensemble from what a caller gives, checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final

from numpy.typing import ArrayLike

from spanwise._checks import array, count, flag, of_kind, whole_from
from spanwise._conditions import Conditions, Settings
from spanwise._events import (
    Speeds,
    events_of,
    kind_column,
    own_road,
    refuse_unused,
    speeds_of,
    speeds_told,
)
from spanwise._plan import Plan
from spanwise._variation import by_parameter, factors_of
from spanwise.bridge import Bridge
from spanwise.crossing import check_speed, surface_of
from spanwise.errors import refused
from spanwise.quantities import RESPONSES, asked, of_bridges, there_are
from spanwise.roads import Road

#: Most samples: they are numbered in 32 bits.
MOST_SAMPLES: Final = 2**32 - 1


def numbers_as_given(key: str, value: ArrayLike) -> ArrayLike:
    """One number or an array of them, which whoever uses it looks into."""
    array(key, value)
    return value


def _responses(key: str, given: object) -> list[str]:
    names = [each.name for each in of_bridges()]
    if not isinstance(given, list | tuple) or not given:
        raise refused(key, given, f"must be a list of {', '.join(names)}")
    return [asked(f"{key}[{i}]", each, names) for i, each in enumerate(given)]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Asked(Settings):
    """What `ensemble` is asked for, checked as far as neither bridge nor vehicles matter."""

    samples: int = 1
    seed: int = 0
    first: int = 0
    speed: ArrayLike | None = None
    road: Road | None = None
    own_roads: bool = True
    kind: ArrayLike | None = None
    factors: Mapping[str, ArrayLike] | None = None
    values: Mapping[str, ArrayLike] | None = None
    quantities: Sequence[str] | None = None
    advance: float | None = None

    checks: ClassVar[Mapping[str, Callable[[str, Any], object]]] = {
        **Settings.checks,
        "samples": lambda key, value: whole_from(key, value, 1, MOST_SAMPLES),
        **dict.fromkeys(("seed", "first"), count),
        **dict.fromkeys(("speed", "kind"), numbers_as_given),
        "road": lambda key, value: surface_of(value),
        "own_roads": flag,
        **dict.fromkeys(("factors", "values"), by_parameter),
        "quantities": _responses,
    }


def plan_of(bridge: Bridge, vehicle: object, asked: Asked) -> tuple[Plan, Speeds]:
    """What the arguments of `ensemble` come to, and the speeds as they were given."""
    of_kind("bridge", bridge, Bridge, "a Bridge")
    events = events_of(vehicle)
    surface = surface_of(asked.road)
    samples, driven = asked.samples, asked.drive
    kinds = kind_column(asked.kind, events, samples)
    speeds = speeds_of(asked.speed, events, samples)
    check_speed(events, None if asked.speed is None else float(speeds.column[0]), driven)
    refuse_unused(speeds, events, driven)
    shared, own = own_road(surface, events, asked.own_roads)
    varied = factors_of(asked.factors, asked.values, events, kinds, speeds.column, samples)
    uneven = own is not None or not all(
        (each.road or shared).is_smooth for event in events for each in event
    )
    conditions = Conditions.filled(bridge, asked, uneven=uneven)
    looked_at = _quantities(bridge, asked.quantities)
    told = speeds_told(speeds, events, kinds, samples, driven)
    settings: dict[str, Any] = {
        **{name: getattr(asked, name) for name in ("samples", "seed", "first")},
        "speed": told.given,
        "road": surface,
        "own_roads": asked.own_roads,
        "kind": kinds if len(events) > 1 else None,
        "factors": {each.name: each.plain for each in varied} or None,
        "modes": conditions.modes,
        "drive": driven,
        **conditions.plain,
        "sections": asked.sections,
        "quantities": [*looked_at],
        "advance": asked.advance,
        "step": asked.step,
    }
    plan = Plan(
        bridge=bridge,
        events=events,
        kinds=kinds,
        samples=samples,
        first=asked.first,
        seed=asked.seed,
        drive=driven,
        speeds=told,
        road=shared,
        own=own,
        factors=varied,
        conditions=conditions,
        quantities=tuple(looked_at),
        advance=asked.advance,
        settings={key: value for key, value in settings.items() if value is not None},
    )
    return plan, speeds


def all_quantities(bridge: Bridge) -> list[str]:
    """What there is to look at; without a clamp no moments of clamps."""
    return [each.name for each in there_are(bridge.missing, clamps=len(bridge.clamps) > 0)]


def usual_quantities(bridge: Bridge) -> list[str]:
    """What is looked at unless others are asked for."""
    return [name for name in all_quantities(bridge) if RESPONSES[name].usual]


def _quantities(bridge: Bridge, wanted: Sequence[str] | None) -> list[str]:
    """What is looked at, in the order of the responses."""
    there = all_quantities(bridge)
    if wanted is None:
        return usual_quantities(bridge)
    known = [each.name for each in there_are(bridge.missing, clamps=True)]
    for i, each in enumerate(wanted):
        if each not in there:
            why = (
                "no support of this bridge holds the rotation"
                if each in known
                else "this bridge was given without influence lines of it"
            )
            raise refused(f"quantities[{i}]", each, why)
    return [name for name in there if name in wanted]
