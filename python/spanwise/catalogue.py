"""The catalogue of vehicles for reading: a list, one of them in detail, and any vehicle as TOML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from spanwise._checks import choice
from spanwise._toml import toml, toml_value
from spanwise.schema import vehicle_table
from spanwise.trains import ForceTrain
from spanwise.vehicles import PRESETS, AnyVehicle, Preset

RECALLED: Final = "* recalled, not read at the source: check before relying on it"

#: How many frequencies the list shows.
LOWEST: Final = 3


def listing() -> str:
    """All presets in a table: axles, mass or weight, length, lowest frequencies, source."""
    names = max(map(len, PRESETS)) + 1
    lines = [f"{'preset':<{names}} axles      total  length [m]  frequencies [Hz]       source"]
    for name, preset in PRESETS.items():
        vehicle = preset()
        marked = name + ("*" if preset.recalled else "")
        found = vehicle.frequencies(locked=True)
        sounding = ", ".join(f"{f:.2f}" for f in found[:LOWEST]) or "-"
        sounding += ", ..." if len(found) > LOWEST else ""
        lines.append(
            f"{marked:<{names}} {len(vehicle.axle_positions):>5}  {_total(vehicle):>9}"
            f"  {vehicle.wheelbase:>10.3f}  {sounding:<22} {preset.source}"
        )
    return "\n".join(
        [
            *lines,
            "",
            "length: from first to last axle; frequencies: the lowest on rigid ground, while",
            "friction holds; none of a train of forces. More of one: spanwise vehicles PRESET",
            RECALLED,
        ]
    )


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
    yield f"total     {_total(vehicle)}"
    loads = vehicle.static_loads() / 1e3
    yield f"axles     {_list(loads, '.1f')} kN, {_list(vehicle.axle_spacings, '.3f') or 0} m apart"
    holding, sliding = (vehicle.frequencies(locked=locked) for locked in (True, False))
    if len(holding) == 0:
        return
    yield f"coords    {', '.join(vehicle.coordinates)}"
    rubs = not (holding == sliding).all()
    yield f"on ground {_list(holding, '.3f')} Hz{' while friction holds' if rubs else ''}"
    if rubs:
        yield f"          {_list(sliding, '.3f')} Hz sliding"


def _total(vehicle: AnyVehicle) -> str:
    """Mass, or of forces their sum."""
    if isinstance(vehicle, ForceTrain):
        return f"{sum(vehicle.loads) / 1e3:.1f} kN"
    return f"{vehicle.total_mass / 1e3:.2f} t"


def _list(values: Iterable[float], form: str) -> str:
    return ", ".join(format(value, form) for value in values)
