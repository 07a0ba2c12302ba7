"""The plan of an ensemble from what a caller gives, checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from numpy.typing import ArrayLike

from spanwise._checks import count, flag, named, number, shown, whole_from
from spanwise._conditions import Conditions
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
from spanwise._variation import factors_of, refuse_overdamped
from spanwise.bridge import Bridge
from spanwise.crossing import check_speed, surface_of
from spanwise.quantities import of_bridges, there_are
from spanwise.roads import Road
from spanwise.traffic import Drive, drive_of

#: Most samples: they are numbered in 32 bits.
MOST_SAMPLES: Final = 2**32 - 1


def plan_of(
    bridge: Bridge,
    vehicle: object,
    *,
    samples: int,
    seed: int,
    first: int,
    speed: ArrayLike | None,
    road: Road | None,
    own_roads: bool,
    kind: ArrayLike | None,
    factors: Mapping[str, ArrayLike] | None,
    values: Mapping[str, ArrayLike] | None,
    drive: Drive,
    quantities: Sequence[str] | None,
    advance: float | None,
    **conditions: Any,
) -> tuple[Plan, Speeds]:
    """What the arguments of `ensemble` come to, and the speeds as they were given.

    Conditions are those arguments that `Conditions.of` takes.
    """
    if not isinstance(bridge, Bridge):
        raise TypeError(f"bridge = {shown(bridge)}: must be a Bridge")
    events = events_of(vehicle)
    surface = surface_of(road)
    samples = whole_from("samples", samples, 1, MOST_SAMPLES)
    seed, first = count("seed", seed), count("first", first)
    advance = None if advance is None else number("advance", advance)
    driven = drive_of(drive)
    own_roads = flag("own_roads", own_roads)
    kinds = kind_column(kind, events, samples)
    speeds = speeds_of(speed, events, samples)
    check_speed(events, None if speed is None else float(speeds.column[:1].sum()), driven)
    refuse_unused(speeds, events, driven)
    shared, own = own_road(surface, events, own_roads)
    varied = factors_of(factors, values, events, kinds, samples)
    common = Conditions.of(
        bridge,
        uneven=own is not None
        or not all((each.road or shared).is_smooth for event in events for each in event),
        **conditions,
    )
    refuse_overdamped(varied, common.core["damping"], first)
    looked_at = _quantities(bridge, quantities)
    told = speeds_told(speeds, events, kinds, samples, driven)
    settings: dict[str, Any] = {
        "samples": samples,
        "seed": seed,
        "first": first,
        "speed": told.given,
        "road": surface,
        "own_roads": own_roads,
        "kind": kinds if len(events) > 1 else None,
        "factors": {each.name: each.plain for each in varied} or None,
        "modes": common.modes,
        "drive": driven,
        **common.settings,
        "sections": common.core["sections"],
        "quantities": [*looked_at],
        "advance": advance,
        "step": common.core["step"],
    }
    plan = Plan(
        bridge=bridge,
        events=events,
        kinds=kinds,
        samples=samples,
        first=first,
        seed=seed,
        drive=driven,
        speeds=told,
        road=shared,
        own=own,
        factors=varied,
        conditions=common,
        quantities=tuple(looked_at),
        advance=advance,
        settings={key: value for key, value in settings.items() if value is not None},
    )
    return plan, speeds


def all_quantities(bridge: Bridge) -> list[str]:
    """What there is to look at; without a clamp no moments of clamps."""
    return [each.name for each in there_are(bridge.missing, clamps=len(bridge.clamps) > 0)]


def _quantities(bridge: Bridge, given: object) -> list[str]:
    """What is looked at, in the order of the responses."""
    names = [each.name for each in of_bridges()]
    if given is None:
        return all_quantities(bridge)
    if not isinstance(given, list | tuple) or not given:
        raise ValueError(f"quantities = {shown(given)}: must be a list of {', '.join(names)}")
    wanted = [named(f"quantities[{i}]", each, names) for i, each in enumerate(given)]
    known = [each.name for each in there_are(bridge.missing, clamps=True)]
    there = all_quantities(bridge)
    for i, each in enumerate(wanted):
        if each not in there:
            why = (
                "no support of this bridge holds the rotation"
                if each in known
                else "this bridge was given without influence lines of it"
            )
            raise ValueError(f"quantities[{i}] = {shown(each)}: {why}")
    return [name for name in names if name in wanted]
