"""Many crossings of one bridge: random roads, speeds, vehicles, side by side on all cores."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, TypeAlias, get_args

from numpy.typing import ArrayLike

from spanwise import _core
from spanwise._checks import choice, count, flag, number, shown
from spanwise._conditions import Conditions, Recovery
from spanwise._events import (
    core_passage,
    core_road,
    events_of,
    is_simple,
    kind_column,
    own_road,
    refuse_unused,
    speeds_by_kind,
    speeds_of,
    speeds_told,
)
from spanwise._plausible import doubt
from spanwise._progress import Bar
from spanwise._recipe import Recipe
from spanwise._variation import factors_of, idle, refuse_overdamped
from spanwise._wheels import GRAVITY
from spanwise.bridge import Bridge
from spanwise.crossing import check_speed, surface_of
from spanwise.damping import Damping
from spanwise.population import Ensemble, Quantity, _cores
from spanwise.roads import Road
from spanwise.traffic import Drive, Passage, core_drive, drive_of
from spanwise.vehicles import AnyVehicle

Event: TypeAlias = AnyVehicle | Passage | Sequence[Passage]

#: Most samples: they are numbered in 32 bits.
MOST_SAMPLES: Final = 2**32 - 1

#: Quantities that a bridge given from outside may come without, as it names them.
NAMES: Final = {"shear": "shear-left", "reactions": "reaction", "clamp_moments": "clamp-moment"}


def ensemble(
    bridge: Bridge,
    vehicle: Event | Sequence[AnyVehicle] | Sequence[Sequence[Passage]],
    *,
    samples: int,
    seed: int = 0,
    first: int = 0,
    speed: ArrayLike | None = None,
    road: Road | None = None,
    own_roads: bool = True,
    kind: ArrayLike | None = None,
    factors: Mapping[str, ArrayLike] | None = None,
    values: Mapping[str, ArrayLike] | None = None,
    modes: int | None = None,
    drive: Drive = "constant-speed",
    damping: Damping | None = None,
    approach: float | None = None,
    ramp: float | None = None,
    tail: float = 0.0,
    sections: Sequence[float] | None = None,
    quantities: Sequence[Quantity] | None = None,
    recovery: Recovery = "force-summation",
    advance: float | None = None,
    step: float | None = None,
    beta: float = 1.0 / 6.0,
    gravity: float = GRAVITY,
    lift_off: bool = True,
    mask: float = 0.05,
    threads: int | None = None,
    progress: Callable[[int, int], object] | bool | None = None,
) -> Ensemble:
    """Drive vehicles over a bridge many times, each time on a road of its own.

    Each sample is a crossing as by `cross`, of which the extremes are kept. What a sample comes to
    depends on the arguments, `seed` and its own number alone, to the bit: not on the number of
    threads, on the processor, or on which other samples are computed with it.

    Parameters
    ----------
    bridge : Bridge
        The bridge.
    vehicle : Vehicle, ForceTrain, MovingMasses, Passage or sequence
        Who crosses, as for `cross`: a vehicle, or a list of `Passage`, several vehicles at once.
        Or kinds of event, of which sample i is number ``kind[i]``: a list of vehicles, or a list of
        lists of `Passage`.
    samples : int
        How many.
    seed : int, optional
        Seed of the random roads.
    first : int, optional
        Number of the first sample; the others follow. Samples 1000 and on of a seed go on where
        samples 0 to 999 ended.
    speed : float or array_like, optional
        Speed at the start [m/s]: one for all, one for each sample, shape (samples,), or one for
        each vehicle of it, shape (samples, vehicles). Needed as for `cross`, and not allowed where
        every passage has its own.
    road : Road, optional
        The road; smooth by default. An `ISO8608` road, alone or in a sum, is drawn anew for each
        sample from `seed` and the number of the sample, in place of its own seed and sample; the
        rest of the sum is the same for all.
    own_roads : bool, optional
        Whether random roads are drawn anew (default) or are the same for all, as they stand.
    kind : array_like of int, optional
        Which kind of event each sample is, from 0, shape (samples,); needed if there are several.
    factors : mapping, optional
        What varies: factors by name, each a number, one for each sample, shape (samples,), or one
        for each of its bodies or axles, front first, shape (samples, parts). The names are
        ``body_mass`` (loads or masses of a train), ``pitch_inertia``, ``tyre_stiffness``,
        ``tyre_damping``, ``suspension_stiffness``, ``suspension_damping``, ``friction_limit``
        (which takes the initial friction along), ``initial_friction`` (no factor, but from -1 to 1
        in friction limits), ``bridge_stiffness`` (springs included) and ``bridge_damping``. One
        number for a sample varies springs and dampers between bodies along with the suspensions.
    values : mapping, optional
        The same in absolute values, in the unit of the attribute of `Vehicle`, `Body` or `Axle`:
        masses [kg] (loads [N] of a train of forces), inertias [kg m2], stiffnesses [N/m], dampings
        [N s/m], friction [N]. They must not be multiples of nothing. Not for the bridge.
    modes : int, optional
        Number of natural modes included, as for `cross`.
    drive, damping, approach, ramp, tail, recovery, beta, gravity, lift_off
        As for `cross`.
    sections : sequence of float, optional
        Where to look [m], ascending, as for `cross`.
    quantities : sequence of str, optional
        What to look at: ``"deflection"``, ``"moment"``, ``"shear"`` (on both sides of a section),
        ``"reactions"``, ``"clamp_moments"``; by default all there are.
    advance : float, optional
        Longest way per step [m], for vehicles alone at constant speed from the left, in place of
        `step`. Where a sample needs shorter steps to be stable, by its speed and stiffness, they
        are halved; whether they are short enough to be accurate is left to the caller.
    step : float, optional
        Longest time step [s]; by default as for `cross`. Vehicles alone at constant speed from the
        left never take longer ways than they do by default: for that give `advance`.
    mask : float, optional
        Impact factors are not given where the static value is at most this fraction of the largest
        among the sections.
    threads : int, optional
        Threads; by default as many as the processor has. Results do not depend on them.
    progress : callable or bool, optional
        Called with the number of samples done and that of all, at most ten times a second and at
        the end; what it raises ends the computation. Or True for a line on standard error: over
        itself on a terminal, elsewhere a line a minute.

    Returns
    -------
    Ensemble
        Extremes, impact factors and axle loads of every sample.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.
    RuntimeError
        If the numerics of the bridge fail. Samples that fail are among `Ensemble.failures`.

    Warns
    -----
    DampingWarning
        If `damping` is not given.
    PlausibilityWarning
        As for `cross`.
    UserWarning
        If what a factor multiplies is 0 in all vehicles, or is the damping of a bridge without.

    Notes
    -----
    Vehicles that cross alone, at constant speed and from the left, take equal steps in space, so
    that all samples of a kind share where axles stand and what they do to the bridge, whatever
    their speed, road, masses and springs; they march side by side. All others are crossings of
    their own, which takes about ten times as long for each.

    Where steps in time would not be the same for all samples, the step of each is that of the kind
    halved as often as it needs; ``run(i).settings["step"]`` tells it. The environment variable
    ``SPANWISE_ISA`` chooses an instruction set; results do not depend on it.
    """
    if not isinstance(bridge, Bridge):
        raise TypeError(f"bridge = {shown(bridge)}: must be a Bridge")
    events = events_of(vehicle)
    surface = surface_of(road)
    samples, seed, first = count("samples", samples), count("seed", seed), count("first", first)
    if samples > MOST_SAMPLES:
        raise ValueError(f"samples = {samples}: must be at most {MOST_SAMPLES}")
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
    for remark in idle(varied, events, conditions.core):
        warnings.warn(remark, UserWarning, stacklevel=2)
    simple = all(is_simple(event, driven) for event in events)
    doubt(
        bridge,
        bridge.modes(conditions.modes).frequencies[0],
        events,
        speed=float(speeds.column.max(initial=0.0)),
        drive=driven,
        road=surface,
        gravity=conditions.core["gravity"],
        # Side by side they take no longer ways than by default, whatever the step is.
        step=None if simple else conditions.core["step"],
        advance=advance if simple else None,
    )
    looked_at = _quantities(bridge, quantities)
    column = speeds_by_kind(speeds, events, kinds, samples) if simple else speeds
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise ValueError(f"progress = {shown(progress)}: must be callable, or True for a line")
    if progress is True:
        listener: Bar | Callable[[int, int], object] | None = Bar(sys.stderr)
    else:
        listener = progress or None
    try:
        core = _core.ensemble(
            bridge._core,
            [[core_passage(each, own_speed=not simple) for each in event] for event in events],
            drive=core_drive(driven),
            road=shared._core,
            own_road=core_road(own, seed),
            advance=advance,
            quantities=_cores(looked_at),
            first=first,
            count=samples,
            kind_of=kinds,
            speeds=column.column,
            factors=[each.core for each in varied],
            threads=None if threads is None else count("threads", threads),
            progress=listener,
            **conditions.core,
        )
    finally:
        # The line ends also where the computation does not.
        if isinstance(listener, Bar):
            listener.close()
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
        "quantities": list(looked_at),
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
        settings={key: value for key, value in settings.items() if value is not None},
    )
    return Ensemble(bridge, recipe, looked_at, core)


def _quantities(bridge: Bridge, given: object) -> list[Quantity]:
    """What is looked at, in the order of the responses."""
    names: tuple[Quantity, ...] = get_args(Quantity)
    clamped = len(bridge.clamps) > 0
    there = [name for name in names if NAMES.get(name, name) not in bridge.missing]
    if given is None:
        return [name for name in there if clamped or name != "clamp_moments"]
    if not isinstance(given, list | tuple) or not given:
        raise ValueError(f"quantities = {shown(given)}: must be a list of {', '.join(names)}")
    for i, each in enumerate(given):
        choice(f"quantities[{i}]", each, names)
        if each not in there:
            raise ValueError(
                f"quantities[{i}] = {shown(each)}: this bridge was given without influence lines "
                "of it"
            )
        if each == "clamp_moments" and not clamped:
            raise ValueError(
                f"quantities[{i}] = {shown(each)}: no support of this bridge holds the rotation"
            )
    return [name for name in names if name in given]
