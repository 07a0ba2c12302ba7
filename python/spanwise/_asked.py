"""The recipe of an ensemble from what a caller gives, checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, get_args

from numpy.typing import ArrayLike

from spanwise._checks import count, flag, named, number, shown, whole_from
from spanwise._conditions import Conditions, Recovery
from spanwise._events import (
    Speeds,
    events_of,
    kind_column,
    own_road,
    refuse_unused,
    speeds_of,
    speeds_told,
)
from spanwise._recipe import Quantity, Recipe
from spanwise._variation import factors_of, refuse_overdamped
from spanwise.bridge import Bridge
from spanwise.crossing import check_speed, surface_of
from spanwise.damping import Damping
from spanwise.roads import Road
from spanwise.traffic import Drive, drive_of

#: Most samples: they are numbered in 32 bits.
MOST_SAMPLES: Final = 2**32 - 1

#: Quantities that a bridge given from outside may come without, as it names them.
NAMES: Final = {"shear": "shear-left", "reactions": "reaction", "clamp_moments": "clamp-moment"}


def recipe_of(
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
    modes: int | None,
    drive: Drive,
    damping: Damping | None,
    approach: float | None,
    ramp: float | None,
    tail: float | None,
    sections: Sequence[float] | None,
    quantities: Sequence[Quantity] | None,
    recovery: Recovery,
    advance: float | None,
    step: float | None,
    beta: float,
    gravity: float,
    lift_off: bool,
    mask: float,
) -> tuple[Recipe, Speeds]:
    """What the arguments of `ensemble` come to, and the speeds as they were given."""
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
    conditions = Conditions.of(
        bridge,
        uneven=own is not None
        or not all((each.road or shared).is_smooth for event in events for each in event),
        modes=modes,
        damping=damping,
        approach=approach,
        ramp=ramp,
        tail=tail,
        sections=sections,
        recovery=recovery,
        step=step,
        beta=beta,
        gravity=gravity,
        lift_off=lift_off,
        mask=mask,
    )
    refuse_overdamped(varied, conditions.core["damping"], first)
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
        "modes": conditions.modes,
        "drive": driven,
        **conditions.settings,
        "sections": conditions.core["sections"],
        "quantities": [*looked_at],
        "advance": advance,
        "step": conditions.core["step"],
    }
    recipe = Recipe(
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
        conditions=conditions,
        quantities=tuple(looked_at),
        advance=advance,
        settings={key: value for key, value in settings.items() if value is not None},
    )
    return recipe, speeds


def known(bridge: Bridge) -> list[Quantity]:
    """What can be looked at: all that the bridge did not come without."""
    names: tuple[Quantity, ...] = get_args(Quantity)
    return [name for name in names if NAMES.get(name, name) not in bridge.missing]


def all_quantities(bridge: Bridge) -> list[Quantity]:
    """What there is to look at; without a clamp no moments of clamps."""
    clamped = len(bridge.clamps) > 0
    return [name for name in known(bridge) if clamped or name != "clamp_moments"]


def _quantities(bridge: Bridge, given: object) -> list[Quantity]:
    """What is looked at, in the order of the responses."""
    names: tuple[Quantity, ...] = get_args(Quantity)
    clamped = len(bridge.clamps) > 0
    there = known(bridge)
    if given is None:
        return [name for name in there if clamped or name != "clamp_moments"]
    if not isinstance(given, list | tuple) or not given:
        raise ValueError(f"quantities = {shown(given)}: must be a list of {', '.join(names)}")
    wanted = [named(f"quantities[{i}]", each, names) for i, each in enumerate(given)]
    for i, each in enumerate(wanted):
        if each not in there:
            raise ValueError(
                f"quantities[{i}] = {shown(each)}: this bridge was given without influence lines "
                "of it"
            )
        if each == "clamp_moments" and not clamped:
            raise ValueError(
                f"quantities[{i}] = {shown(each)}: no support of this bridge holds the rotation"
            )
    return [name for name in names if name in wanted]
