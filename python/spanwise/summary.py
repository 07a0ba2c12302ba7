"""A run in words and tables, for reading on a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise.bridge import Bridge
from spanwise.run import Extremes, Run
from spanwise.table import factor_text
from spanwise.vehicles import AnyVehicle

Array: TypeAlias = NDArray[np.float64]


def summary(run: Run) -> str:
    """Bridge, vehicle and settings; the governing responses; the impact factors."""
    return "\n".join([*_description(run), "", *_governing(run), "", str(run.impact_factors)])


def _description(run: Run) -> list[str]:
    bridge, truck, used = run.bridge, run.truck, run.settings
    held = ", ".join(f"{kind} at {x:g} m" for x, kind in bridge.supports)
    rigidities = _rigidity(bridge)
    ratios = np.asarray(used["damping"])
    damping = f"ratio {_list(np.atleast_1d(ratios), '.4g')}" if ratios.ndim < 2 else "by a matrix"
    # A train of forces has none.
    mass = f"{truck.total_mass / 1000.0:.4g} t; " if truck.total_mass > 0.0 else ""
    return [
        f"bridge    {bridge.length:g} m, {held}",
        f"          {rigidities}{len(bridge.masses)} moving masses, "
        f"{bridge.masses.sum() / 1000.0:.4g} t",
        f"vehicle   {mass}static axle loads "
        f"{_list(run.static_axle_loads / 1000.0, '.4g')} kN; {truck.wheelbase:.4g} m from first to "
        "last axle",
        *_frequencies(truck),
        f"modes     {len(run.frequencies)}: {_list(run.frequencies, '.3f')} Hz; damping {damping}",
        f"crossing  {used['speed']:g} m/s, {used['drive']}, {run.final_speed:.6g} m/s at the end; "
        f"approach {used['approach']:g} m, tail {used['tail']:g} s",
        f"          {run.steps} steps of {used['step']:.4g} s, beta {used['beta']:.4g}; "
        f"recovery by {used['recovery']}",
    ]


def _frequencies(truck: AnyVehicle) -> Iterator[str]:
    """Those of the vehicle on rigid ground, in both states if it has two, in lines of a few."""
    states = {
        "while friction holds": truck.frequencies(locked=True),
        "sliding": truck.frequencies(locked=False),
    }
    holding, sliding = states.values()
    if len(holding) == 0:
        return
    if len(holding) <= 2:
        yield (
            f"          on rigid ground {_list(holding, '.3f')} Hz while friction holds, "
            f"{_list(sliding, '.3f')} Hz sliding"
        )
    elif np.array_equal(holding, sliding):
        yield f"          on rigid ground {_list(holding, '.3f')} Hz"
    else:
        for state, found in states.items():
            yield f"          on rigid ground {_list(found, '.3f')} Hz {state}"
def _rigidity(bridge: Bridge) -> str:
    """EI: its values, or its range where there are many; nothing if it is unknown."""
    if not bridge.described:
        return ""
    values = bridge.EI
    if np.ptp(values) == 0.0:
        values = values[:1]
    if len(values) > 8:
        return f"EI {values.min():.5g} to {values.max():.5g} N m2; "
    return f"EI {_list(values, '.5g')} N m2; "


def _governing(run: Run) -> list[str]:
    """The largest response of each kind: where and when, beside the static one at that place."""
    factors = run.impact_factors
    deflection, moment = run.envelope("deflection"), run.envelope("moment")
    shear, reactions = run.envelope("shear"), run.envelope("reactions")
    loads = run.envelope("axle_loads")
    sections = [f"x = {x:.3f} m" for x in run.sections]
    supports = [f"x = {x:.3f} m" for x in run.supports]
    axles = [f"axle {k}" for k in range(1, len(run.static_axle_loads) + 1)]
    most = _larger(shear.max, shear.min)
    static = _larger(shear.static_max, shear.static_min)
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
        _row("moment, sagging [kN m]", moment.max, moment.static_max, factors.sagging, sections),
        _row("moment, hogging [kN m]", moment.min, moment.static_min, factors.hogging, sections),
        _row("shear [kN]", most, static, factors.shear, sections),
        _row("reaction, up [kN]", reactions.max, reactions.static_max, factors.reactions, supports),
        _row("axle load [kN]", loads.max, loads.static_max, factors.axle_loads, axles),
        "static: the largest at the same place under the static axle loads",
    ]


def _row(
    name: str,
    dynamic: Extremes,
    static: Extremes,
    factors: Array,
    places: list[str],
    scale: float = 1e-3,
) -> str:
    i = int(np.argmax(np.abs(dynamic.value)))
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
