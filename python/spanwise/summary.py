"""A run in words and tables, for reading on a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._freevibration import growth_in_words, tail_in_words
from spanwise._shown import warned
from spanwise._values import axle_names, stop
from spanwise.bridge import Bridge
from spanwise.damping import in_words
from spanwise.layout import Support
from spanwise.responses import Envelope, Extremes, Quantity
from spanwise.roads import ISO8608, Profile, Road, Sum
from spanwise.runs import Run
from spanwise.table import factor_text
from spanwise.traffic import Passage, is_alone, plain_drive
from spanwise.vehicle import Vehicle
from spanwise.vehicles import AnyVehicle

Array: TypeAlias = NDArray[np.float64]

#: Part of the largest response below which one of the other sign is not shown.
OPPOSITE: Final = 0.02


def summary(run: Run) -> str:
    """Bridge, vehicles, road and settings; the governing responses; the impact factors."""
    return "\n".join([*_description(run), "", *_governing(run), "", str(run.impact_factors)])


def _description(run: Run) -> Iterator[str]:
    bridge, used = run.bridge, run.settings
    held = ", ".join(
        [*map(_support, bridge.springs), *(f"hinge at {x:g} m" for x in bridge.hinges)]
    )
    rigidities = _rigidity(bridge)
    damping = in_words(used["damping"], run.frequencies)
    yield f"bridge    {bridge.length:g} m, {held}"
    yield (
        f"          {rigidities}{len(bridge.masses)} moving masses, "
        f"{bridge.masses.sum() / 1000.0:.4g} t"
    )
    yield f"modes     {len(run.frequencies)}: {_list(run.frequencies, '.3f')} Hz; damping {damping}"
    for k, passage in enumerate(run.passages):
        yield from _vehicle(run, k, passage)
    yield f"road      {road_in_words(run.road)}"
    ramp = f" ({used['ramp']:g} m of it to fade in the road)" if used["ramp"] else ""
    yield (
        f"crossing  approach {used['approach']:g} m{ramp}; {run.steps} steps of "
        f"{used['step']:.4g} s, beta {used['beta']:.4g}"
    )
    yield f"          {tail_in_words(run)}"
    yield f"          recovery by {used['recovery']}"
    if run.can_grow:
        yield "note      free vibration after the end can reach more than was recorded; where it"
        yield "          grows most, by a bound that need not be met:"
    for growth in run.can_grow:
        yield f"          {growth_in_words(growth)}"
    if run.can_grow and used["tail"] is not None:
        yield "          (without `tail` the record goes on until no extreme can follow)"
    for k in range(len(run.passages)):
        if (stopped := stop(run, k)) is not None:
            yield _standing(run, k, *stopped)
    yield from _varying(run)
    yield from _off_road(run)
    yield from warned(run.warnings)


def _vehicle(run: Run, number: int, passage: Passage) -> Iterator[str]:
    """What the vehicle is, and how it crosses."""
    truck, motion = passage.vehicle, run.vehicles[number]
    own = [k for k, (vehicle, _) in enumerate(run.axles) if vehicle == number + 1]
    name = "vehicle" if len(run.passages) == 1 else f"vehicle {number + 1}"
    bodies = f"{len(truck.bodies)} bodies, " if isinstance(truck, Vehicle) and truck.bodies else ""
    # A train of forces has no mass.
    mass = f"{truck.total_mass / 1000.0:.4g} t; " if truck.total_mass > 0.0 else ""
    yield (
        f"{name:<10}{bodies}{mass}static axle loads "
        f"{_list(run.static_axle_loads[own] / 1000.0, '.4g')} kN; {truck.wheelbase:.4g} m from "
        "first to last axle"
    )
    if isinstance(truck, Vehicle) and any(axle.mass > 0.0 for axle in truck.axles):
        masses = _list((axle.mass / 1000.0 for axle in truck.axles), ".4g")
        yield f"          unsprung masses {masses} t, included above"
    yield from _frequencies(truck)
    drive = run.settings["drive"] if passage.drive is None else plain_drive(passage.drive)
    way = [f"{motion.speed[0]:g} m/s", _drive(drive)]
    way.append(f"{motion.speed[-1]:.6g} m/s at the end")
    if not is_alone(run.passages):
        lane = f"in lane {passage.lane_number}"
        way[:0] = [f"to the {passage.direction} {lane}", f"enters at {passage.entry:g} s"]
    yield f"          {', '.join(way)}"
    if passage.road is not None:
        yield f"          on a road of its own: {road_in_words(passage.road)}"


def _drive(drive: object) -> str:
    if not isinstance(drive, Mapping):
        return str(drive)
    given = {key: value for key, value in drive.items() if key != "kind"}
    if drive["kind"] == "acceleration":
        return f"acceleration {given['acceleration']:g} m/s2"
    if drive["kind"] == "speeds":
        return f"{len(given['times'])} speeds in time"
    return (
        f"braking by {given['deceleration']:g} m/s2 from {given['start']:g} m after its end of the "
        f"bridge, friction {given['friction']:g}"
    )


def road_in_words(road: Road) -> str:
    """Kind, roughness, seed and contact patch; of a sum those of every part."""
    if isinstance(road, Sum):
        return " + ".join(map(road_in_words, road.parts))
    words = [road.kind]
    for key in ("at", "start", "end"):
        if hasattr(road, key):
            words.append(f"{key} {getattr(road, key):g} m")
    if isinstance(road, ISO8608):
        words[0] += f" class {road.road_class}" if road.road_class else ""
        words.append(f"G_d(n0) {road.G:.4g} m3")
        words.append(f"seed {road.seed}" + (f" sample {road.sample}" if road.sample else ""))
    if isinstance(road, Profile):
        words.append(f"{len(road.x)} points from {road.x[0]:g} to {road.x[-1]:g} m")
    patch = getattr(road, "contact_patch", None)
    return ", ".join(words if patch is None else [*words, f"contact patch {patch:g} m"])


def _standing(run: Run, number: int, time: float, at: Array) -> str:
    name = "the vehicle" if len(run.passages) == 1 else f"vehicle {number + 1}"
    on = "on the bridge" if ((at >= 0.0) & (at <= run.bridge.length)).any() else "off the bridge"
    where = f"x = {at[0]:.3f} m (front axle)"
    return f"          {name} stops {on} at t = {time:.3f} s, {where}, and stays"


def _varying(run: Run) -> Iterator[str]:
    """How much the axle loads vary, if they do."""
    percent = 100.0 * run.load_coefficients
    if not percent.any():
        return
    values = f"{percent.min():.1f} to {percent.max():.1f}"
    if len(percent) <= 8:
        values = _list(percent, ".1f")
    yield f"loads     on the bridge {values} % from their static values (root mean square)"


def _off_road(run: Run) -> Iterator[str]:
    """How often and how long wheels leave the road."""
    off = run.off_road
    if not run.settings["lift_off"]:
        yield "wheels    held to the road, in tension if need be"
    elif not off.count.any():
        yield "wheels    never leave the road"
    else:
        times = f"{off.count.sum()} time{'s' if off.count.sum() > 1 else ''}"
        yield f"wheels    leave the road {times}, {off.total.sum():.3f} s in all:"
        for name, count, total, longest in zip(
            axle_names(run), off.count, off.total, off.longest, strict=True
        ):
            if count > 0:
                yield f"          {name}: {count}, {total:.3f} s in all, {longest:.3f} s at most"


def _frequencies(truck: AnyVehicle) -> Iterator[str]:
    """Those of the vehicle on rigid ground, in both states if it has two, in lines of a few."""
    states = {
        "while friction holds": truck.frequencies(locked=True),
        "sliding": truck.frequencies(locked=False),
    }
    holding, sliding = states.values()
    if len(holding) == 0:
        return
    if np.array_equal(holding, sliding):
        yield f"          on rigid ground {_list(holding, '.3f')} Hz"
    elif len(holding) <= 2:
        yield (
            f"          on rigid ground {_list(holding, '.3f')} Hz while friction holds, "
            f"{_list(sliding, '.3f')} Hz sliding"
        )
    else:
        for state, found in states.items():
            yield f"          on rigid ground {_list(found, '.3f')} Hz {state}"


def _support(support: Support) -> str:
    """Kind and place, of springs the stiffnesses."""
    place = f"{support.kind} at {support.at:g} m"
    if support.kind != "elastic":
        return place
    words = "rigid" if np.isinf(support.vertical) else f"{support.vertical:.4g} N/m"
    if support.rotation > 0.0:
        turns = support.rotation
        words += ", clamped" if np.isinf(turns) else f", {turns:.4g} N m/rad"
    return f"{place} ({words})"


def _rigidity(bridge: Bridge) -> str:
    """EI as it was given, or its range where there are many values; nothing if it is unknown."""
    if not bridge.described:
        return ""
    given = bridge.arguments["EI"]
    at, values = (given["at"], given["values"]) if isinstance(given, Mapping) else (None, given)
    if np.ptp(values) == 0.0:
        return f"EI {values[0]:.5g} N m2; "
    if len(values) > 8:
        return f"EI {min(values):.5g} to {max(values):.5g} N m2; "
    text = f"EI {_list(values, '.5g')} N m2"
    if at is not None:
        text += f" {'at' if len(at) == len(values) else 'between'} {_list(at, 'g')} m"
    return f"{text}; "


def _governing(run: Run) -> list[str]:
    """The largest response of each kind: where and when, beside the static one at that place."""
    factors = run.impact_factors
    deflection, moment = run.envelope("deflection"), run.envelope("moment")
    shear, reactions = run.envelope("shear"), run.envelope("reactions")
    loads = run.envelope("axle_loads")
    sections = [f"x = {x:.3f} m" for x in run.sections]
    supports = [f"x = {x:.3f} m" for x in run.supports]
    axles = [name.replace("vehicle", "veh.") for name in axle_names(run)]
    most = _larger(shear.max, shear.min)
    static = _larger(shear.static_max, shear.static_min)

    def upward(
        name: str, of: Envelope, quantity: Quantity, places: list[str], scale: float = 1e-3
    ) -> list[str]:
        """What goes the other way, if it is more than nothing."""
        if not of.min.value.min() < -OPPOSITE * of.max.value.max():
            return []
        lifted = run._core.impact_factors(quantity, "negative", factors.ratio, factors.mask)
        i = int(np.argmin(of.min.value))
        return [_row(name, of.min, of.static_min, lifted, places, scale, i)]

    return [
        f"{'largest':<24}{'dynamic':>10}{'at':>14}{'time [s]':>10}{'front axle [m]':>16}"
        f"{'static':>10}{'factor':>8}",
        _row(
            "deflection, down [mm]",
            deflection.max,
            deflection.static_max,
            factors.deflection,
            sections,
            1e3,
        ),
        *upward("deflection, up [mm]", deflection, "deflection", sections, 1e3),
        _row("moment, sagging [kN m]", moment.max, moment.static_max, factors.sagging, sections),
        _row("moment, hogging [kN m]", moment.min, moment.static_min, factors.hogging, sections),
        _row("shear [kN]", most, static, factors.shear, sections),
        _row("reaction, up [kN]", reactions.max, reactions.static_max, factors.reactions, supports),
        *upward("reaction, uplift [kN]", reactions, "reactions", supports),
        _row("axle load [kN]", loads.max, loads.static_max, factors.axle_loads, axles),
        "static: the largest at the same place under the static axle loads",
        "factors far from where a response governs are to be read with the response itself",
    ]


def _row(
    name: str,
    dynamic: Extremes,
    static: Extremes,
    factors: Array,
    places: list[str],
    scale: float = 1e-3,
    at: int | None = None,
) -> str:
    i = int(np.argmax(np.abs(dynamic.value))) if at is None else at
    beside = round(static.value[i] * scale, 3) + 0.0  # never -0.000
    return (
        f"{name:<24}{dynamic.value[i] * scale:>10.3f}{places[i]:>14}{dynamic.time[i]:>10.4f}"
        f"{dynamic.position[i]:>16.3f}{beside:>10.3f}{factor_text(factors[i]):>8}"
    )


def _larger(a: Extremes, b: Extremes) -> Extremes:
    """At each section the one of the larger magnitude."""
    first = np.abs(a.value) >= np.abs(b.value)
    names = ("value", "time", "position", "partner")
    return Extremes(*(np.where(first, getattr(a, each), getattr(b, each)) for each in names))


def _list(values: Iterable[float], form: str) -> str:
    return ", ".join(format(value, form) for value in values)
