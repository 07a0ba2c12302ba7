"""Many crossings of one bridge: random roads, speeds, vehicles, side by side on all cores."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

from numpy.typing import ArrayLike

from spanwise import _core
from spanwise._checks import count
from spanwise._conditions import FOX_GOODWIN, Recovery
from spanwise._events import is_simple
from spanwise._keys import suggesting
from spanwise._plan_of_arguments import Asked, plan_of
from spanwise._progress import Bar
from spanwise._rows import Rows
from spanwise._warnings import PlausibilityWarning, warn
from spanwise._wheels import GRAVITY
from spanwise.bridge import Bridge
from spanwise.damping import Damping
from spanwise.ensembles import Ensemble
from spanwise.errors import refused
from spanwise.quantities import RESPONSES, telling
from spanwise.roads import Road
from spanwise.traffic import Drive, Passage
from spanwise.vehicles import AnyVehicle

Event: TypeAlias = AnyVehicle | Passage | Sequence[Passage]


@suggesting
@telling
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
    tail: float | None = None,
    sections: Sequence[float] | None = None,
    quantities: Sequence[str] | None = None,
    recovery: Recovery = "force-summation",
    accuracy: float = 1e-3,
    advance: float | None = None,
    step: float | None = None,
    beta: float = FOX_GOODWIN,
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
        How many, at least 1.
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
    modes, drive, damping, approach, ramp, tail, recovery, accuracy, beta, gravity, lift_off, mask
        As for `cross`; by default the tail of each sample is as long as it needs, for the
        quantities and sections looked at.
    sections : sequence of float, optional
        Where to look [m], ascending, as for `cross`.
    quantities : sequence of str, optional
        What to look at, by default all that follows from statics; slope, velocity and acceleration
        of the deck only if asked for; shears on both sides of a section:

        {bridge}
    advance : float, optional
        Longest way per step [m], for vehicles alone at constant speed from the left, in place of
        `step`. Where a sample needs shorter steps to be stable, by its speed and stiffness, they
        are halved; whether they are short enough to be accurate is left to the caller.
    step : float, optional
        Longest time step [s]; by default as for `cross`. Vehicles alone at constant speed from the
        left never take longer ways than they do by default: for that give `advance`.
    threads : int, optional
        Threads at most; by default as many as the processor has. More than four to a processor are
        not started, nor more than the system allows. Results do not depend on them.
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
        If the numerics of the bridge fail, or if the system starts no thread. Samples that fail are
        among `Ensemble.failures`.

    Warns
    -----
    DampingWarning
        If `damping` is not given.
    PlausibilityWarning
        As for `cross`, of vehicles as given and of those with the smallest and the largest of each
        factor on masses and springs.
    UserWarning
        If what a factor multiplies is 0 in all vehicles, or is the damping of a bridge without.

    Notes
    -----
    Vehicles that cross alone, at constant speed and from the left, take equal steps in space, so
    that all samples of a kind share where axles stand and what they do to the bridge, whatever
    their speed, road, masses and springs. All others go their own ways, side by side too, which
    takes a few times as long; what rolls freely, brakes or stands on the bridge crosses by itself.

    There may be as many kinds of event as samples: memory is taken for the results and, on each
    thread, for one kind at a time. Kinds of few samples go side by side with others of their make.

    Where steps in time would not be the same for all samples, the step of each is that of the kind
    halved as often as it needs; ``run(i).settings["step"]`` tells it. The environment variable
    ``SPANWISE_ISA`` chooses an instruction set; results do not depend on it.
    """
    plan, speeds = plan_of(bridge, vehicle, Asked.of(locals()))
    events = plan.events
    for remark in plan.idle():
        warn(remark)
    for doubt in plan.doubts():
        warn(doubt, PlausibilityWarning)
    simple = all(is_simple(event, plan.drive) for event in events)
    column = speeds.column
    if simple:
        # The speeds of passages stand among those of the samples.
        column = plan.front_speeds
        events = tuple((replace(each, speed=None) if each.speed else each,) for (each,) in events)
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise refused("progress", progress, "must be callable, or True for a line")
    if progress is True:
        listener: Bar | Callable[[int, int], object] | None = Bar(sys.stderr)
    else:
        listener = progress or None
    try:
        core = _core.ensemble(
            bridge._core,
            plan,
            events=events,
            speeds=column,
            road=plan.road._core,
            quantities=[part for name in plan.quantities for part in RESPONSES[name].parts],
            threads=None if threads is None else count("threads", threads),
            progress=listener,
        )
    finally:
        # The line ends also where the computation does not.
        if isinstance(listener, Bar):
            listener.close()
    return Ensemble(plan, Rows.of(core))
