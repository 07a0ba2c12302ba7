"""The catalogue of vehicles for reading: a list, one of them in detail, and any vehicle as TOML."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from spanwise._checks import choice
from spanwise._table import Table, listed
from spanwise._toml import toml, toml_value
from spanwise.schema import vehicle_table
from spanwise.vehicles import PRESETS, AnyVehicle, Preset

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
    preset = PRESETS[choice("preset", name, PRESETS)]
    vehicle = preset()
    return "\n".join([*_description(name, preset, vehicle), "", as_toml(vehicle)])


def as_toml(vehicle: AnyVehicle) -> str:
    """The vehicle as the table ``[vehicle]`` of a case file; what has its default is left out."""
    return toml({"vehicle": vehicle_table(vehicle, defaults=False)})


def _description(name: str, preset: Preset, vehicle: AnyVehicle) -> Iterator[str]:
    yield f"preset    {name}: {preset.title}"
    yield f"source    {preset.source}"
    if preset.recalled:
        yield f"          {RECALLED.removeprefix('* ')}"
    if preset.options:
        options = (f"{key} = {toml_value(default)}" for key, default in preset.options.items())
        yield f"options   {', '.join(options)}"
    yield f"total     {vehicle._total}"
    loads = vehicle.static_loads() / 1e3
    spacings = listed(vehicle.axle_spacings, ".3f") or 0
    yield f"axles     {listed(loads, '.1f')} kN, {spacings} m apart"
    if ground := vehicle._frequencies_in_words:
        yield f"coords    {', '.join(vehicle.coordinates)}"
        yield "on ground " + "\n          ".join(ground)
