"""One crossing of a bridge by vehicles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from spanwise import _core
from spanwise._checks import of_kind
from spanwise._computed import Computed
from spanwise._conditions import FOX_GOODWIN, Conditions, Crossing, Recovery
from spanwise._keys import alike, suggesting
from spanwise._plausible import doubts
from spanwise._remarks import remarks
from spanwise._warnings import PlausibilityWarning, warn
from spanwise._wheels import GRAVITY, Wheels
from spanwise.bridge import Bridge
from spanwise.damping import Damping
from spanwise.errors import InputError, wrong_kind
from spanwise.roads import Road, Smooth
from spanwise.roads.base import A_ROAD
from spanwise.runs import Run
from spanwise.traffic import Drive, Passage, Speeds, plain_drive
from spanwise.vehicles import PRESETS, AnyVehicle

Traffic: TypeAlias = AnyVehicle | Passage | Sequence[Passage]


@suggesting
def cross(
    bridge: Bridge,
    vehicle: Traffic,
    *,
    speed: float | None = None,
    modes: int | None = None,
    drive: Drive = "constant-speed",
    damping: Damping | None = None,
    road: Road | None = None,
    approach: float | None = None,
    ramp: float | None = None,
    tail: float | None = None,
    sections: Sequence[float] | None = None,
    recovery: Recovery = "force-summation",
    accuracy: float = 1e-3,
    step: float | None = None,
    beta: float = FOX_GOODWIN,
    gravity: float = GRAVITY,
    lift_off: bool = True,
    mask: float = 0.05,
) -> Run:
    """Drive a vehicle, or several, over a bridge once.

    Each vehicle starts in static equilibrium with its front axle at the start of the approach; the
    bridge is at rest. The crossing ends when the last axle has left the bridge, or the last vehicle
    has come to a stop, and the tail is over. The results are those of the vehicles alone, without
    the dead load of the bridge. Extremes of axle loads and lift-offs are those until the last axle
    has left the bridge, from the start of the approach on; histories go on to the end.

    Parameters
    ----------
    bridge : Bridge
        The bridge.
    vehicle : Vehicle, ForceTrain, MovingMasses, Passage or sequence of Passage
        The vehicle, or several, each with its own way of crossing.
    speed : float, optional
        Speed at the start [m/s]; needed unless every passage, or the drive, has its own, and not
        allowed beside `Speeds` where nothing uses it.
    modes : int, optional
        Number of natural modes included. By default two for each span, at least three, at most as
        many as there are masses.
    drive : {"constant-speed", "constant-traction"}, Acceleration, Speeds or Braking, optional
        Keep the speed; or keep traction and resistance in balance, so that the speed follows the
        slope of bridge and road; or one of the drives that have numbers of their own.
    damping : float, array_like or Rayleigh, optional
        Ratio to critical damping, one for all modes or one for each; `Rayleigh`, or a table with
        the key ``rayleigh`` and the value ``[alpha, beta]`` or ``{"alpha": ..., "beta": ...}``; or
        the damping matrix C at the moving masses [N s/m], shape (stations, stations). Unless given
        the bridge is not damped, with a warning; 0 says that this is meant.
    road : Road, optional
        The road; smooth by default.
    approach : float, optional
        Length of the rigid approach [m]: by default none on a smooth road, 100 m on another.
    ramp : float, optional
        Way on which the unevenness fades in at the start of the approach [m]; by default 20 m, or
        the approach if that is shorter. With 0 the vehicle starts at rest on the road it stands on.
    tail : float, optional
        Free vibration kept after the last axle has left, or the last vehicle has stopped [s]. The
        maxima can lie in it: by default it lasts until none can, which a bound from the energies of
        the modes tells to a thousandth of each extreme, but ten periods of the slowest included
        mode at most, as also where a vehicle stands on the bridge. The road goes on under the
        vehicles; where it was measured no further, at its last elevation.
    sections : sequence of float, optional
        Where to look [m], ascending. By default mass stations, supports and tenth points.
    recovery : {"force-summation", "force-summation-by-rates", "superposition"}, optional
        How responses follow from the included modes: by force summation with the inertia and
        damping forces from the coordinates (Eq. 11 of [1]_) or from their rates (Eq. 6), or by
        plain superposition of the modes (Eq. 2).
    accuracy : float, optional
        What extremes may be off because time goes in steps, in parts of the largest of each
        response along the bridge: the step follows from it, by the frequencies of bridge and
        vehicles, the spans and how rough the road is. docs/theory.md, "Time step", tells how, how
        far it was tried, and where it does not hold (accelerations of the deck, damped tyres and
        masses that meet a lively bridge, very rough roads); `Run.check` tells of a single case.
    step : float, optional
        Longest time step [s], in place of the one that follows.
    beta : float, optional
        Newmark's beta: 1/12 for the least error (default), 1/6 for linear, 1/4 for constant average
        acceleration.
    gravity : float, optional
        Gravity [m/s2].
    lift_off : bool, optional
        Whether wheels leave the road (default) or are held to it even if that takes tension, as
        masses in rigid contact always are.
    mask : float, optional
        Impact factors are not given where the static value is at most this fraction of the largest
        among the sections.

    Returns
    -------
    Run
        Responses, static and dynamic, their extremes and impact factors.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is; if the step is beyond the stability limit,
        naming the limit; if the road does not cover the path; if vehicles of a lane overlap.
    RuntimeError
        If the numerics fail, if under constant traction a vehicle comes to rest, or if the system
        does not start the thread that long work needs.

    Warns
    -----
    DampingWarning
        If `damping` is not given.
    PlausibilityWarning
        If bridge, damping, loads, springs, speed or the road are far outside of what there is, as
        those in other units are. Each message begins with the name of what it doubts.
    UserWarning
        If a vehicle brakes or accelerates and has all its centres of mass at road level, if its
        brakes never come on, or if it stops before it reaches the bridge.

    Notes
    -----
    What of a road moves a vehicle up and down is what it is off a straight line, the datum of its
    way: of a `Profile` the least-squares line of the first 10 m from the start of the approach, of
    single features the level at that start; random roads count as they are. So neither the height
    of a profile above the sea nor a grade changes anything at a prescribed speed. What rolls freely
    is slowed or pushed by the grade from the start, by g times its rise.

    An axle that drives on to a *free* end of the bridge loads it suddenly with all it carries, and
    its wheel drops off the deflected end as it leaves. The bridge rings from that at any speed, so
    there impact factors do not tend to one as the speed goes down.

    With tyre damping the contact force jumps as an axle enters or leaves the deflected bridge,
    where the slope under it does; the results are then of first order in the step across such
    instants, and of second order between them.

    References
    ----------
    .. [1] H. Kishan and R. W. Traill-Nash, IABSE Publications 33 (1973).
    """
    asked = Crossing.of(locals())
    of_kind("bridge", bridge, Bridge, "a Bridge")
    passages = passages_of(vehicle)
    surface = surface_of(road)
    speed, driven = asked.speed, asked.drive
    check_speed([passages], speed, driven)
    uneven = not all((each.road or surface).is_smooth for each in passages)
    conditions = Conditions.filled(bridge, asked, uneven=uneven)
    doubted = doubts(
        bridge,
        bridge.modes(conditions.modes).frequencies[0],
        [passages],
        speed=speed,
        drive=driven,
        road=surface,
        conditions=conditions,
        step=conditions.step,
    )
    # Before what it may take, or be refused for.
    for doubt in doubted:
        warn(doubt, PlausibilityWarning)
    core = _core.cross(
        bridge._core,
        passages,
        conditions,
        speed=speed,
        road=surface._core,
    )
    settings: dict[str, object] = {
        **({} if speed is None else {"speed": speed}),
        "modes": conditions.modes,
        "drive": plain_drive(driven),
        **conditions.plain,
        "step": core.step,
    }
    computed = Computed(bridge, passages, conditions, speed, surface, core)
    run = Run(bridge, passages, surface, settings, computed, doubted)
    for remark in remarks(run):
        warn(remark)
    return run


def surface_of(road: object) -> Road:
    """The road given, or a smooth one."""
    return Smooth() if road is None else of_kind("road", road, Road, A_ROAD)


def passages_of(vehicle: object) -> tuple[Passage, ...]:
    """Who crosses: a vehicle, or several, each with its own way."""
    if isinstance(vehicle, Wheels):
        return (Passage(vehicle=vehicle),)  # type: ignore[arg-type]
    if isinstance(vehicle, Passage):
        return (vehicle,)
    if isinstance(vehicle, list | tuple):
        for i, each in enumerate(vehicle):
            if not isinstance(each, Passage):
                row = "; sw.convoy makes passages of vehicles in a row"
                hint = row if isinstance(each, Wheels) else made_by(each)
                raise wrong_kind(f"vehicle[{i}]", each, f"must be a Passage{hint}")
        if vehicle:
            return tuple(vehicle)
    allowed = f"must be a Vehicle, a train, a Passage or a list of Passage{made_by(vehicle)}"
    raise wrong_kind("vehicle", vehicle, allowed)


def made_by(name: object) -> str:
    """What makes a vehicle of the catalogue, of which the name alone was given; or nothing."""
    meant = alike(name, PRESETS)
    return (
        f"; {PRESETS[meant].called} makes one"
        if isinstance(meant, str) and meant in PRESETS
        else ""
    )


def check_speed(events: Sequence[tuple[Passage, ...]], speed: float | None, drive: Drive) -> None:
    """Refuses a speed that is missing, and one beside speeds in time that nothing uses."""
    needed = timed = False
    for passages in events:
        for k, each in enumerate(passages):
            has_times = isinstance(each.drive or drive, Speeds)
            if has_times and each.speed is not None:
                key = "speed" if len(passages) == 1 else f"vehicles[{k}].speed"
                raise InputError(key, f"{each.speed:g}", "not used with speeds in time")
            timed = timed or has_times
            needed = needed or (each.speed is None and not has_times)
    if speed is None and needed:
        raise InputError("speed", None, "missing; give it here or with every passage")
    if speed is not None and not needed and timed:
        raise InputError("speed", f"{speed:g}", "not used with speeds in time")
