"""The tables of a case: what may stand in each, what is made of it, and how that is written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from spanwise._build import Maker, Place, build_one, check_known, keys_of
from spanwise._checks import choice, file_path, numbers
from spanwise._toml import table_of
from spanwise.bridge import Bridge
from spanwise.damping import Rayleigh, damping_of
from spanwise.roads import Road
from spanwise.roads.table import KINDS as ROADS
from spanwise.roads.table import road_of
from spanwise.traffic import KINDS as DRIVES
from spanwise.traffic import Braking, Passage, drive_of, is_alone
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Body, Hinge, Spring, Vehicle
from spanwise.vehicles import PRESETS, AnyVehicle

if TYPE_CHECKING:
    from pathlib import Path

BRIDGE: Final = Maker(Bridge)
#: Tables in ``[bridge]`` of a bridge that is given from outside.
GIVEN: Final = {m.__name__: Maker(m) for m in (Bridge.from_flexibility, Bridge.from_modes)}
PASSAGE: Final = Maker(Passage)

#: Keys that can be given beside the preset of a vehicle of one body.
CHANGED: Final = ("mass", "pitch_inertia", "cg_height")
VEHICLES: Final[tuple[Maker[AnyVehicle], ...]] = (
    Maker(Vehicle, without=("bodies",), needs=("mass", "axles")),
    Maker(Vehicle, without=("axles", *CHANGED), needs=("bodies",)),
    Maker(ForceTrain),
    Maker(MovingMasses),
)

#: What some presets can be given, and nothing else.
OPTIONS: Final = {key for preset in PRESETS.values() for key in preset.options} - {*CHANGED}

#: Places in each table of a case, and the keys that belong there.
Places: TypeAlias = Mapping[str, Mapping[str, Collection[str]]]


@cache
def places() -> Places:
    """Where keys belong; of the places in a table the first that has the key counts."""
    vehicle = {"preset", *OPTIONS, *(key for each in VEHICLES for key in each.keys)}
    return {
        "bridge": {"[bridge]": BRIDGE.keys},
        "vehicle": {
            "[vehicle]": vehicle,
            "each [[vehicle.axles]]": Maker(Axle).keys,
            "[vehicle.bodies.hinge]": Maker(Hinge).keys,
            "each [[vehicle.bodies.springs]]": Maker(Spring).keys,
            "each [[vehicle.bodies]]": Maker(Body).keys,
        },
        "traffic": {"each [[traffic]]": ("direction", "entry", "lane")},
        "road": {"[road]": {"kind", *keys_of(ROADS)}},
        "drive": {"a drive": keys_of(DRIVES)},
    }


def belong(key: str, tables: Places) -> list[str]:
    """Where a key belongs, one place in a table; what is likelier meant has the shorter name."""
    found = (next((at for at, keys in each.items() if key in keys), "") for each in tables.values())
    return sorted(filter(None, found), key=len)


def belongs(key: str, tables: Places | None = None) -> str:
    """Where a key belongs that was found in a table without such a key, or nothing."""
    found = belong(key, tables or places())
    return f" (belongs in {', '.join(found)})" if found else ""


@dataclass(frozen=True, eq=False, repr=False)
class Reading:
    """How the tables of a case are read, and the files that they name."""

    #: Where these are looked for.
    folder: str | Path = ""
    #: Says where a key belongs that is not allowed where it is.
    home: Callable[[str], str] = belongs
    #: Those that have been read.
    files: list[Path] = field(default_factory=list)

    def place(self, table: str) -> Place:
        """The place of a table of the case."""
        readers = {Vehicle: vehicle_of, Road: self.road, Rayleigh: _damping, Braking: drive_of}
        return Place(table=table, home=self.home, readers=readers)

    def road(self, value: Any, place: Place) -> Road:
        """The road of a table, or the sum of the roads of a list of them."""
        if isinstance(value, Road):
            return value
        several = isinstance(value, list | tuple)
        return road_of([*map(self._found, value)] if several else self._found(value), place)

    def _found(self, value: Any) -> Any:
        """The table with the path of its file if it names one."""
        if isinstance(value, Mapping) and isinstance(value.get("file"), str):
            self.files.append(file_path("folder", self.folder) / value["file"])
            return {**value, "file": str(self.files[-1])}
        return value


def passage_of(table: Any, place: Place) -> Passage:
    """The passage of a table."""

    def home(key: str) -> str:
        inside = f" (belongs in its vehicle: vehicle = {{ {key} = ... }})"
        return inside if key in places()["vehicle"]["[vehicle]"] else place.home(key)

    return PASSAGE.build(table, replace(place, home=home))


def events_of(tables: Any, place: Place) -> list[tuple[Passage, ...]]:
    """Kinds of event, each the table of a passage or a list of them."""
    if not isinstance(tables, list | tuple) or not tables:
        raise place["events"].wrong(tables, "tables, [[events]]")
    return [
        tuple(passage_of(one, place[k][i]) for i, one in enumerate(each))
        if isinstance(each, list | tuple)
        else (passage_of(each, place[k]),)
        for k, each in enumerate(tables)
    ]


def bridge_of(table: Any, place: Place) -> Bridge:
    """The bridge of a table, described by its spans or given from outside."""
    name = next((each for each in GIVEN if each in table), None)
    if name is not None:
        check_known(table, [name], place)
        return GIVEN[name].build(table[name], place[name])
    return BRIDGE.build(table, place)


def vehicle_of(table: Any, place: Place) -> AnyVehicle:
    """The vehicle of a table: a preset, bodies and axles, or a train."""
    if isinstance(table, Mapping) and "preset" in table:
        return _preset(table, place)

    def home(key: str) -> str:
        return " (beside some presets only)" if key in OPTIONS else place.home(key)

    return build_one(VEHICLES, table, replace(place, home=home), "preset")


def _preset(table: Mapping[str, Any], place: Place) -> AnyVehicle:
    preset = PRESETS[choice(place["preset"].name, table["preset"], PRESETS)]
    vehicle = preset(**{key: table[key] for key in preset.options if key in table})
    changed = CHANGED if isinstance(vehicle, Vehicle) and not vehicle.bodies else ()
    allowed = dict.fromkeys(("preset", *preset.options, *changed))
    allowed |= {"initial_friction": None} if isinstance(vehicle, Vehicle) else {}

    known = places()["vehicle"]["[vehicle]"]

    def home(key: str) -> str:
        return " (not beside this preset)" if key in known else place.home(key)

    check_known(table, [*allowed], replace(place, home=home))
    if isinstance(vehicle, Vehicle):
        own = {*changed} - {*preset.options}
        vehicle = replace(vehicle, **{key: table[key] for key in table if key in own})
        if "initial_friction" in table:
            friction = numbers("initial_friction", table["initial_friction"])
            vehicle = vehicle.with_initial_friction(*friction)
    return vehicle


def _damping(value: Any, place: Place) -> Any:
    """As it is given, or of its table."""
    damping = damping_of(value, place)
    return damping if isinstance(value, Mapping) else value


def vehicle_table(vehicle: AnyVehicle, *, defaults: bool = True) -> dict[str, Any]:
    """What `vehicle_of` makes this vehicle of; without `defaults` only what differs from them."""
    table = table_of(vehicle, defaults=defaults)
    return {"bodies": table["bodies"]} if "bodies" in table else table


def passage_table(passage: Passage) -> dict[str, Any]:
    """The table of a passage."""
    return table_of(passage) | {"vehicle": vehicle_table(passage.vehicle)}


def event_table(passages: Sequence[Passage]) -> Any:
    """What `events_of` makes these passages of."""
    if is_alone(passages):
        return {"vehicle": vehicle_table(passages[0].vehicle)}
    return [passage_table(each) for each in passages]
