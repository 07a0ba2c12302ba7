"""A run in words and tables, for reading on a terminal or in a notebook."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._shown import warned
from spanwise._table import MANY, Block, Table, html, listed, ranged, text
from spanwise.bridge import Bridge
from spanwise.damping import in_words
from spanwise.layout import Support
from spanwise.quantities import Response, Sense
from spanwise.runs import Run
from spanwise.traffic import Passage, is_alone, plain_drive

Array: TypeAlias = NDArray[np.float64]

#: Below the table of the largest responses.
GOVERNING: Final = (
    "static: the largest at the same place under the static axle loads",
    "factors far from where a response governs are to be read with the response itself",
)

#: Part of the largest response below which one of the other sign is not shown.
OPPOSITE: Final = 0.02


def summary(run: Run) -> str:
    """Bridge, vehicles, road and settings; the governing responses; the impact factors."""
    return text(_blocks(run))


def page(run: Run) -> str:
    """The same for a notebook."""
    return html(_blocks(run))


def _blocks(run: Run) -> Iterator[Block]:
    yield _description(run)
    yield _governing(run)
    yield from run.impact_factors.blocks()


def _description(run: Run) -> Iterator[str]:
    bridge, used = run.bridge, run.settings
    held = ", ".join(
        [*map(_support, bridge.springs), *(f"hinge at {x:g} m" for x in bridge.hinges)]
    )
    rigidities = _rigidity(bridge)
    damping = in_words(used["damping"], run.frequencies)
    frequencies = listed(run.frequencies, ".3f")
    yield f"bridge    {bridge.length:g} m, {held}"
    yield (
        f"          {rigidities}{len(bridge.masses)} moving masses, "
        f"{bridge.masses.sum() / 1000.0:.4g} t"
    )
    yield f"modes     {len(run.frequencies)}: {frequencies} Hz; damping {damping}"
    for k, passage in enumerate(run.passages):
        yield from _vehicle(run, k, passage)
    yield f"road      {run.road}"
    ramp = f" ({used['ramp']:g} m of it to fade in the road)" if used["ramp"] else ""
    yield (
        f"crossing  approach {used['approach']:g} m{ramp}; {run.steps} steps of "
        f"{used['step']:.4g} s, beta {used['beta']:.4g}"
    )
    yield f"          {_tail(run)}"
    yield f"          recovery by {used['recovery']}"
    if run.can_grow:
        yield "note      free vibration after the end can reach more than was recorded; where it"
        yield "          grows most, by a bound that need not be met:"
    for growth in run.can_grow:
        yield f"          {growth}"
    if run.can_grow and used["tail"] is not None:
        yield "          (without `tail` the record goes on until no extreme can follow)"
    for k in range(len(run.passages)):
        if (stopped := run.stop(k)) is not None:
            yield _standing(run, k, *stopped)
    yield from _varying(run)
    yield from _contact_loss(run)
    yield from warned(run.warnings)


def _vehicle(run: Run, number: int, passage: Passage) -> Iterator[str]:
    """What the vehicle is, and how it crosses."""
    truck, motion = passage.vehicle, run.vehicles[number]
    own = [k for k, (vehicle, _) in enumerate(run.axles) if vehicle == number + 1]
    name = "vehicle" if len(run.passages) == 1 else f"vehicle {number + 1}"
    loads = run.static_axle_loads[own] / 1000.0
    several = f"{len(own)} " if len(own) > MANY else ""
    # A train of forces has no mass.
    mass = f"{truck.total_mass / 1000.0:.4g} t; " if truck.total_mass > 0.0 else ""
    yield (
        f"{name:<10}{truck._bodies_in_words}{mass}{several}static axle loads "
        f"{ranged(loads, '.4g')} kN; {truck.wheelbase:.4g} m from first to last axle"
    )
    if unsprung := truck._unsprung:
        masses = listed((each / 1000.0 for each in unsprung), ".4g")
        yield f"          unsprung masses {masses} t, included above"
    ground = truck._frequencies_in_words
    # Of a few in one line.
    for words in [", ".join(ground)] if 0 < len(truck.coordinates) <= 2 else ground:
        yield f"          on rigid ground {words}"
    drive = run.settings["drive"] if passage.drive is None else plain_drive(passage.drive)
    way = [f"{motion.speed[0]:g} m/s", _drive(drive)]
    way.append(f"{motion.speed[-1]:.6g} m/s at the end")
    if not is_alone(run.passages):
        lane = f"in lane {passage.lane_number}"
        way[:0] = [f"to the {passage.direction} {lane}", f"enters at {passage.entry:g} s"]
    yield f"          {', '.join(way)}"
    if passage.road is not None:
        yield f"          on a road of its own: {passage.road}"


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


def _tail(run: Run) -> str:
    """How long the tail is, and why."""
    length = f"tail {run.tail:.4g} s"
    if np.isnan(run.growth):
        length += ", a vehicle standing on the bridge"
    if run.settings["tail"] is not None:
        return length
    if run.settled:
        return f"{length}, until no extreme can follow"
    return f"{length}, the longest kept: ten periods of the slowest mode"


def _standing(run: Run, number: int, time: float, at: Array) -> str:
    name = "the vehicle" if len(run.passages) == 1 else f"vehicle {number + 1}"
    on = "on the bridge" if ((at >= 0.0) & (at <= run.bridge.length)).any() else "off the bridge"
    where = f"x = {at[0]:.3f} m (front axle)"
    return f"          {name} stops {on} at t = {time:.3f} s, {where}, and stays"


def _varying(run: Run) -> Iterator[str]:
    """How much the axle loads vary, if they do."""
    percent = 100.0 * run.dynamic_load_coefficients
    if not percent.any():
        return
    varying = ranged(percent, ".1f")
    yield f"loads     on the bridge {varying} % from their static values (root mean square)"


def _contact_loss(run: Run) -> Iterator[str]:
    """How often and how long wheels leave the road."""
    off = run.contact_loss
    if not run.settings["lift_off"]:
        yield "wheels    held to the road, in tension if need be"
    elif not off.count.any():
        yield "wheels    never leave the road"
    else:
        times = f"{off.count.sum()} time{'s' if off.count.sum() > 1 else ''}"
        yield f"wheels    leave the road {times}, {off.total.sum():.3f} s in all:"
        for name, count, total, longest in zip(
            run.axle_names, off.count, off.total, off.longest, strict=True
        ):
            if count > 0:
                yield f"          {name}: {count}, {total:.3f} s in all, {longest:.3f} s at most"


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
    text = f"EI {ranged(values, '.5g')} N m2"
    if at is not None and len(values) <= MANY:
        text += f" {'at' if len(at) == len(values) else 'between'} {listed(at, 'g')} m"
    return f"{text}; "


def _governing(run: Run) -> Table:
    """The largest response of each kind: where and when, beside the static one at that place."""
    heads = ["largest", "dynamic", "at", "time [s]", "front axle [m]", "static", "factor"]
    forms = ["<", ".3f", "<", ".4f", ".3f", ".3f", ".3f"]
    rows = [row for each in run.responses for row in _rows(run, each)]
    return Table(heads, rows, forms, GOVERNING)


def _rows(run: Run, of: Response) -> Iterator[list[object]]:
    """The extremes that are always told, and what goes the other way if it is more than nothing."""
    envelope, (unit, scale) = run.envelope(of.name), of.shown
    if len(envelope.x) == 0:
        return
    senses: list[Sense] = [*of.reported]
    if senses == ["positive"] and envelope.min.value.min() < -OPPOSITE * envelope.max.value.max():
        senses.append("negative")
    # Deck motion has no static value.
    still = not (envelope.static_max.value.any() or envelope.static_min.value.any())
    axles = of.axis == "axle"
    places = run.axle_names if axles else [f"x = {x:.3f} m" for x in envelope.x]
    for sense in senses:
        dynamic, static = envelope.of(sense)
        sign = {"positive": 1.0, "negative": -1.0}.get(sense)
        i = int(np.argmax(np.abs(dynamic.value) if sign is None else sign * dynamic.value))
        yield [
            f"{of.called(sense)} [{unit}]",
            float(scale * dynamic.value[i]),
            places[i],
            float(dynamic.time[i]),
            float(dynamic.position[i]),
            np.nan if still else float(scale * static.value[i]),
            _factor(run, of, sense, i),
        ]


def _factor(run: Run, of: Response, sense: Sense, i: int) -> float:
    """The impact factor there, of those of the run if they are of this sense."""
    if not of.factors:
        return np.nan
    for factor in of.factors if sense in of.reported else ():
        if factor.sense in (sense, "either"):
            return float(run.impact_factors[factor.name][i])
    found = run.impact_factors
    return float(run._core.impact_factors(of.name, sense, found.ratio, found.mask)[i])
