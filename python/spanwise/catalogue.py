"""The catalogue of vehicles for reading: a list, one of them in detail, and any vehicle as TOML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import MISSING, fields
from typing import TYPE_CHECKING, Final

from spanwise._checks import shown
from spanwise._keys import suggestion
from spanwise._table import Table, listed
from spanwise.vehicle import Vehicle
from spanwise.vehicles import PRESETS, AnyVehicle, Preset

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

RECALLED: Final = "* recalled, not read at the source: check before relying on it"

#: How many frequencies the list shows.
LOWEST: Final = 3


def listing() -> str:
    """All presets in a table: axles, mass or weight, length, lowest frequencies, source."""
    rows = []
    for name, preset in PRESETS.items():
        vehicle = preset()
        found = vehicle.frequencies(locked=True)
        sounding = listed(found[:LOWEST], ".2f") or "-"
        sounding += ", ..." if len(found) > LOWEST else ""
        marked = name + ("*" if preset.recalled else "")
        axles = len(vehicle.axle_positions)
        rows.append([marked, axles, vehicle._total, vehicle.wheelbase, sounding, preset.source])
    heads = ["preset", "axles", "total", "length [m]", "frequencies [Hz]", "source"]
    notes = [
        "",
        "length: from first to last axle; frequencies: the lowest on rigid ground, while",
        "friction holds; none of a train of forces. More of one: spanwise vehicles PRESET",
        RECALLED,
    ]
    return str(Table(heads, rows, ["<", ">", ">", ".3f", "<", "<"], notes))


def detail(name: str) -> str:
    """A preset with its axle loads and frequencies, and as the table of a case file."""
    if name not in PRESETS:
        hint = suggestion(name, PRESETS)
        raise ValueError(f"preset = {shown(name)}: must be one of {', '.join(PRESETS)}{hint}")
    preset = PRESETS[name]
    vehicle = preset()
    return "\n".join([*_description(name, preset, vehicle), "", as_toml(vehicle)])


def as_toml(vehicle: AnyVehicle) -> str:
    """The vehicle as the table ``[vehicle]`` of a case file; what has its default is left out."""
    if not isinstance(vehicle, Vehicle):
        return "\n".join(["[vehicle]", *_keys(vehicle)])
    if not vehicle.bodies:
        lines = ["[vehicle]", *_keys(vehicle)]
        return "\n".join([*lines, *_tables("vehicle.axles", vehicle.axles)])
    lines = []
    for body in vehicle.bodies:
        lines += ["", "[[vehicle.bodies]]", *_keys(body)]
        lines += _tables("vehicle.bodies.axles", body.axles)
        if body.hinge is not None:
            lines += ["", "[vehicle.bodies.hinge]", *_keys(body.hinge)]
        lines += _tables("vehicle.bodies.springs", body.springs)
    return "\n".join(lines[1:])


def _description(name: str, preset: Preset, vehicle: AnyVehicle) -> Iterator[str]:
    yield f"preset    {name}: {preset.title}"
    yield f"source    {preset.source}"
    if preset.recalled:
        yield f"          {RECALLED.removeprefix('* ')}"
    if preset.options:
        options = (f"{key} = {_value(default)}" for key, default in preset.options.items())
        yield f"options   {', '.join(options)}"
    yield f"total     {vehicle._total}"
    loads = vehicle.static_loads() / 1e3
    spacings = listed(vehicle.axle_spacings, ".3f") or 0
    yield f"axles     {listed(loads, '.1f')} kN, {spacings} m apart"
    if ground := vehicle._frequencies_in_words:
        yield f"coords    {', '.join(vehicle.coordinates)}"
        yield "on ground " + "\n          ".join(ground)


def _tables(name: str, values: Iterable[DataclassInstance]) -> Iterator[str]:
    for each in values:
        yield from ("", f"[[{name}]]", *_keys(each))


def _keys(of: DataclassInstance) -> Iterator[str]:
    """Fields that are numbers or lists of them, and not the default."""
    for each in fields(of):
        value = getattr(of, each.name)
        if each.default is not MISSING and value == each.default:
            continue
        text = _value(value)
        if text is not None:
            yield f"{each.name} = {text}"


def _value(value: object) -> str | None:
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, tuple) and all(isinstance(each, float) for each in value):
        return f"[{', '.join(map(repr, value))}]"
    return None
