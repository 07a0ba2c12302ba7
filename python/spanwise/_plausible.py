"""Input that is allowed but hardly meant: other units, slips, points too coarse.

Each check is a function that gives the sentences to say, most often none. The bounds are about ten
times as wide as what is published, so that footbridges, models in laboratories and long spans pass.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import pairwise
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._conditions import Conditions
from spanwise.bridge import Bridge
from spanwise.damping import Rayleigh
from spanwise.roads import ISO8608, Profile, Road
from spanwise.traffic import Drive, Passage, Speeds
from spanwise.vehicle import Vehicle

Array: TypeAlias = NDArray[np.float64]
Event: TypeAlias = Sequence[Passage]

#: How many times lower or higher than the limits of EN 1991-2, figure 6.10, a first frequency may
#: be. Bridges with slender spans lie far below the lower limit, few come near to the upper one.
_LOWER, _UPPER = 10.0, 5.0

#: Span from which on one that is too slow is rather given in other units [m].
_ENDLESS: Final = 1000.0

#: Span below which the lower limit says nothing [m]: strips in laboratories are as slow.
_SHORT: Final = 4.0

#: Static deflection under the vehicles by span beyond which no bridge is used; codes allow 1/250.
_DEFLECTED: Final = 1.0 / 20.0

#: Largest axle load that is hardly one [N]: above those of railways in kN, below the 280 N by which
#: the load of a pedestrian swings. And the mass of a span from which on it is no model in a
#: laboratory [kg].
_LIGHT, _FULL_SIZE = 275.0, 5e3

#: Speeds that lorries, cars, trains and those of heavy axles do not reach [m/s], and the axle loads
#: of a lorry and of such a train [N].
_LORRY_SPEED, _CAR_SPEED, _RAIL_SPEED, _FREIGHT_SPEED = 45.0, 60.0, 120.0, 85.0
_HEAVY, _FREIGHT = 25e3, 215e3

#: What tells trains: the stiffness of a wheel on a rail [N/m]; the length of forces or masses in a
#: row [m], which no lorry has, or none with axles loaded alike, as those of a coach are.
_ON_RAILS, _LONG, _LONG_ALIKE, _ALIKE = 5e7, 30.0, 15.0, 0.5

#: Ratio to critical damping from which on it is hardly one of a bridge.
_DAMPED: Final = 0.15

#: How far springs may give way under the weight that they carry [m]: then it bounces at 0.5 Hz.
_SAG: Final = 1.0

#: Frequency up to which a vehicle feels waves that a road should hold [Hz], and a spacing of its
#: points that is fine at any speed [m].
_FELT, _FINE = 10.0, 0.5


def doubts(
    bridge: Bridge,
    first_frequency: float,
    events: Iterable[Event],
    *,
    speed: float | None,
    drive: Drive,
    road: Road,
    conditions: Conditions,
    step: float | None,
    advance: float | None = None,
) -> tuple[str, ...]:
    """Sentences to say of what a crossing, or the events of an ensemble, hardly mean."""
    span = _longest_span(bridge)
    moving = float(bridge.masses.sum()) * span / bridge.length
    gravity = conditions.gravity
    found = [*_frequency(bridge, span, first_frequency), *_damping(conditions)]
    seen = {"deflection"} if _is_endless(bridge, span, first_frequency) else set()
    for passage in (each for event in events for each in event):
        fastest = _fastest(passage, speed, drive)
        surface = passage.road or road
        checks: dict[str, Callable[[], str | None]] = {
            "deflection": partial(_deflection, passage, span, moving, first_frequency, gravity),
            "loads": partial(_loads, passage, moving, gravity),
            "springs": partial(_springs, passage, gravity),
            "speed": partial(_speed, passage, fastest),
            "spacing": partial(_spacing, surface, fastest),
            "step": partial(_passed_over, surface, fastest, step, advance),
        }
        # Of many vehicles the first of each kind of slip tells enough.
        for key, check in checks.items():
            if key not in seen and (said := check()) is not None:
                seen.add(key)
                found.append(said)
    return tuple(found)


def doubts_of_roads(roads: Iterable[Road]) -> tuple[str, ...]:
    """What was said of roads as they were made."""
    found = (f"road: {each}" for road in roads for part in road._summands for each in part._doubts)
    return tuple(dict.fromkeys(found))


def _longest_span(bridge: Bridge) -> float:
    bounds = bridge.span_bounds.tolist()
    return max((b - a for a, b in pairwise(bounds)), default=bridge.length)


def _fastest(passage: Passage, speed: float | None, drive: Drive) -> float:
    """The speed at the start, or the largest of the speeds in time [m/s]."""
    own = passage.drive or drive
    if isinstance(own, Speeds):
        return max(own.speeds)
    return passage.speed if passage.speed is not None else speed or 0.0


def _limits(span: float) -> tuple[float, float]:
    """First frequencies between which those of most bridges are [Hz]."""
    return 23.58 * max(span, _SHORT) ** -0.592, 94.76 * span**-0.748


def _ends_are_held(bridge: Bridge) -> bool:
    return {0.0, bridge.length} <= {x for x, _ in bridge.supports}


def _is_endless(bridge: Bridge, span: float, first: float) -> bool:
    """Whether the length of the bridge is to be doubted before all that follows from it."""
    return bridge.described and span >= _ENDLESS and first < _limits(span)[0] / _LOWER


def _frequency(bridge: Bridge, span: float, first: float) -> Iterator[str]:
    """Of the bridge: lengths, EI or mass in other units."""
    low, high = _limits(span)
    if low / _LOWER < first < high * _UPPER:
        return
    if _is_endless(bridge, span, first):
        yield (
            f"spans: the longest is {span:g} m, and the first frequency of the bridge {first:.3g} "
            "Hz; are lengths in mm instead of m?"
        )
        return
    # A cantilever is slower than a span twice as long.
    if first < low and not _ends_are_held(bridge):
        span *= 2.0
        low, high = _limits(span)
        if low / _LOWER < first:
            return
    usual = f"{first:.3g} Hz, where spans of {span:g} m have about {low:.2g} to {high:.2g} Hz"
    if not bridge.described:
        yield f"bridge: its first frequency is {usual}; is it given in N, m, kg and Hz?"
    elif first < high:
        yield (
            f"EI, mass: the first frequency of the bridge is {usual}; is EI in kN m2 instead of "
            "N m2, E in MPa instead of Pa, or mass in kg instead of kg/m?"
        )
    else:
        yield (
            f"EI, mass: the first frequency of the bridge is {usual}; is mass in t/m instead of "
            "kg/m, or EI in N mm2 instead of N m2?"
        )


def _damping(conditions: Conditions) -> Iterator[str]:
    """Of the bridge: ratios in percent, or tenths for hundredths."""
    ratios = conditions.ratios
    # Rayleigh's constants may damp upper modes more than any bridge is.
    by_rayleigh = isinstance(conditions.damping, Rayleigh)
    ratio = (min if by_rayleigh else max)(ratios, default=0.0)
    if ratio >= _DAMPED:
        yield (
            f"damping = {ratio:.4g}: is {100.0 * ratio:.4g} % of critical, where bridges have up "
            "to about 5 %; it is a ratio, 0.02 for 2 %"
        )


def _deflection(
    passage: Passage, span: float, moving: float, first: float, gravity: float
) -> str | None:
    """Of a vehicle on the bridge: loads too large for it.

    The deflection is estimated: weight on the span by stiffness of the first mode of a simple beam.
    """
    truck = passage.vehicle
    if moving == 0.0:
        return None
    part = min(1.0, span / max(truck.wheelbase, 1e-9))
    weight = part * float(truck.static_loads(gravity).sum())
    deflection = weight / (0.5 * moving * (2.0 * np.pi * first) ** 2)
    if deflection < _DEFLECTED * span:
        return None
    return (
        f"loads, EI: the static axle loads bend a span of {span:g} m by about {deflection:.3g} m; "
        "are loads in N, masses in kg and EI in N m2?"
    )


def _loads(passage: Passage, moving: float, gravity: float) -> str | None:
    """Of a vehicle on a bridge that is no model: loads in kN, masses in t."""
    most = float(passage.vehicle.static_loads(gravity).max())
    # A load of 1 N is one of reference, by which results are scaled; 100 may be kN.
    if not 0.0 < most < _LIGHT or moving < _FULL_SIZE or most == 1.0:
        return None
    return (
        f"loads: the largest axle load is {most:.4g} N, less than that of a pedestrian, on a span "
        f"of {moving / 1e3:.3g} t; are loads in kN instead of N, or masses in t instead of kg?"
    )


def _springs(passage: Passage, gravity: float) -> str | None:
    """Of a vehicle on its tyres and suspensions: stiffness in kN/m."""
    truck = passage.vehicle
    if not isinstance(truck, Vehicle):
        return None
    weight = gravity * truck.total_mass
    for key in ("tyre_stiffness", "suspension_stiffness"):
        stiffness = sum(getattr(axle, key) for axle in truck.axles)
        if weight > _SAG * stiffness > 0.0:
            return (
                f"{key}: the vehicle sags by {weight / stiffness:.3g} m on it; is it in kN/m or "
                "N/mm instead of N/m?"
            )
    return None


def _speed(passage: Passage, speed: float) -> str | None:
    """Of a vehicle: speed in km/h. That of a single axle is left to theory."""
    truck = passage.vehicle
    if not _LORRY_SPEED < speed < math.inf or len(truck.axle_positions) == 1:
        return None
    loads = truck.static_loads()
    if isinstance(truck, Vehicle):
        rails = all(axle.tyre_stiffness >= _ON_RAILS for axle in truck.axles)
    else:
        alike = loads.min() >= _ALIKE * loads.max()
        rails = truck.wheelbase >= (_LONG_ALIKE if alike else _LONG)
    on_road = _LORRY_SPEED if loads.max() > _HEAVY else _CAR_SPEED
    on_rails = _FREIGHT_SPEED if loads.max() > _FREIGHT else _RAIL_SPEED
    if speed <= (on_rails if rails else on_road):
        return None
    return (
        f"speed = {speed:g}: m/s, which is {3.6 * speed:.0f} km/h; if {speed:g} km/h are meant, "
        f"write {speed / 3.6:.4g}"
    )


def _spacing(road: Road, speed: float) -> str | None:
    """Of a measured road at a speed: points too far apart for what a vehicle feels."""
    measured = [each for each in road._summands if isinstance(each, Profile) and not each.is_smooth]
    coarse = (each for each in measured if each.spacing > max(_FINE, speed / (2.0 * _FELT)))
    if (found := next(coarse, None)) is None:
        return None
    spacing = found.spacing
    return (
        f"road: its points are {spacing:.3g} m apart, and waves shorter than {2 * spacing:.3g} m, "
        f"which at {speed:.3g} m/s a vehicle feels from {speed / (2 * spacing):.2g} Hz on, are not "
        "in it; is x in m?"
    )


def _passed_over(road: Road, speed: float, step: float | None, advance: float | None) -> str | None:
    """Of a step, or a way per step, that was given: waves of the road that it passes over."""
    by_step = math.inf if step is None else step * speed
    way = by_step if advance is None else min(advance, by_step)
    waves = map(_shortest, road._summands)
    patch, shortest = min(waves, key=lambda each: (max(each), each[0]))
    # What is shorter than the contact patch is averaged away.
    if not math.isfinite(way) or way <= patch or way <= 0.5 * shortest:
        return None
    given = f"step = {step:g} s: at {speed:.3g} m/s" if way == by_step else f"advance = {way:g} m:"
    return (
        f"{given} an axle goes {way:.3g} m in a step, more than half of the shortest wave of the "
        f"road, {shortest:.3g} m, which it passes over; is the step in s, the way in m?"
    )


def _shortest(road: Road) -> tuple[float, float]:
    """Contact patch and shortest wave, or edge, of a road that is no sum [m]."""
    patch = float(getattr(road, "contact_patch", 0.0))
    if road.is_smooth:
        return patch, np.inf
    if isinstance(road, ISO8608):
        return patch, 1.0 / road.band[1]
    if isinstance(road, Profile):
        return patch, 2.0 * road.spacing
    # Of a single feature the core takes short enough steps, unless a step is given.
    lengths = [getattr(road, name, 0.0) for name in ("edge", "gap", "length")]
    lengths.append(getattr(road, "end", 0.0) - getattr(road, "start", 0.0))
    return patch, min((each for each in lengths if each > 0.0), default=np.inf)
