"""The table ``[vehicle]`` of a case file: a preset, bodies and axles, or a train."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from typing import Any, Final, TypeAlias, TypeVar

from spanwise._checks import choice, numbers, shown
from spanwise._keys import Keys
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Axle, Body, Hinge, Spring, Vehicle
from spanwise.vehicles import PRESETS, AnyVehicle

Table: TypeAlias = Mapping[str, Any]
#: What to say of a key that is not allowed where it is: where it belongs, or nothing.
Home: TypeAlias = Callable[[str], str]
T = TypeVar("T")

AXLE: Final = Keys.of(Axle)
BODY: Final = Keys.of(Body)
HINGE: Final = Keys.of(Hinge)
SPRING: Final = Keys.of(Spring)
FORCES: Final = Keys.of(ForceTrain)
MASSES: Final = Keys.of(MovingMasses)

#: One body, which needs a pitch inertia too unless it is on a single axle.
ONE: Final = Keys(("mass", "pitch_inertia", "axles", "cg_height"), ("mass", "axles"))
SEVERAL: Final = Keys(("bodies",), ("bodies",))

#: Keys of `ONE` that can be given beside the preset of a vehicle of one body.
CHANGED: Final = ("mass", "pitch_inertia", "cg_height")

#: Kinds of vehicles, by the key that none but they have.
KINDS: Final = {"bodies": SEVERAL, "loads": FORCES, "masses": MASSES}

#: What some presets can be given, and nothing else.
OPTIONS: Final = tuple(
    key
    for key in dict.fromkeys(option for preset in PRESETS.values() for option in preset.options)
    if key not in ONE.allowed
)

PLACES: Final = {
    "[vehicle]": Keys(
        ("preset", *ONE.allowed, "bodies", *FORCES.allowed, *MASSES.allowed, *OPTIONS)
    ),
    "each [[vehicle.axles]]": AXLE,
    "[vehicle.bodies.hinge]": HINGE,
    "each [[vehicle.bodies.springs]]": SPRING,
    "each [[vehicle.bodies]]": BODY,
}


def home(key: str) -> str:
    """Where in the vehicle a key belongs, or nothing."""
    return next((place for place, keys in PLACES.items() if key in keys.allowed), "")


def vehicle_of(table: Table, elsewhere: Home) -> AnyVehicle:
    """The vehicle that the table describes; `elsewhere` says where other keys belong."""
    if "preset" in table:
        return _preset(table, elsewhere)
    kind = next((key for key in KINDS if key in table), None)
    if kind is not None:
        KINDS[kind].check_known(table, lambda key: _beside(key, kind) or elsewhere(key))
        KINDS[kind].check_complete(table)
    if kind == "loads":
        return ForceTrain(**table)
    if kind == "masses":
        return MovingMasses(**table)
    if kind == "bodies":
        return Vehicle(bodies=_each("bodies", table["bodies"], "vehicle.bodies", _body, elsewhere))
    Keys(("preset", *ONE.allowed, *KINDS)).check_known(
        table, lambda key: " (beside some presets only)" if key in OPTIONS else elsewhere(key)
    )
    try:
        ONE.check_complete(table)
    except ValueError as error:
        others = "bodies, loads or masses"
        raise ValueError(f"{error}; or {others}; or name a preset: {', '.join(PRESETS)}") from error
    axles = _each("axles", table["axles"], "vehicle.axles", _plain(Axle, AXLE), elsewhere)
    return Vehicle(**{**table, "axles": axles})


def table_of(vehicle: AnyVehicle) -> dict[str, Any]:
    """What `vehicle_of` makes this vehicle of; all that is None or empty is left out."""
    table: dict[str, Any] = _without_nothing(asdict(vehicle))
    if isinstance(vehicle, Vehicle) and vehicle.bodies:
        return {"bodies": table["bodies"]}
    return table


def _without_nothing(value: Any) -> Any:
    if isinstance(value, dict):
        return {
            key: _without_nothing(each) for key, each in value.items() if each not in (None, ())
        }
    return [*map(_without_nothing, value)] if isinstance(value, list | tuple) else value


def _beside(key: str, kind: str) -> str:
    return f" (not beside {kind})" if key in PLACES["[vehicle]"].allowed else ""


def _each(
    key: str, tables: object, name: str, make: Callable[[Table, Home], T], elsewhere: Home
) -> list[T]:
    """What `make` makes of each table of a list; messages begin with the key and number."""
    if not isinstance(tables, list):
        raise ValueError(f"{key} = {shown(tables)}: must be a list of tables, [[{name}]]")
    made = []
    for k, table in enumerate(tables):
        if not isinstance(table, dict):
            raise ValueError(f"{key}[{k}] = {shown(table)}: must be a table, [[{name}]]")
        try:
            made.append(make(table, elsewhere))
        except ValueError as error:
            raise ValueError(f"{key}[{k}]: {error}") from error
    return made


def _plain(kind: Callable[..., T], keys: Keys) -> Callable[[Table, Home], T]:
    """Makes what needs no more than its keys."""

    def make(table: Table, elsewhere: Home) -> T:
        keys.check_known(table, elsewhere)
        keys.check_complete(table)
        return kind(**table)

    return make


def _body(table: Table, elsewhere: Home) -> Body:
    BODY.check_known(table, elsewhere)
    BODY.check_complete(table)
    parts: dict[str, Any] = dict(table)
    for key, make in (("axles", _plain(Axle, AXLE)), ("springs", _plain(Spring, SPRING))):
        if key in table:
            parts[key] = _each(key, table[key], f"vehicle.bodies.{key}", make, elsewhere)
    if "hinge" in table:
        if not isinstance(table["hinge"], dict):
            where = "must be a table, [vehicle.bodies.hinge]"
            raise ValueError(f"hinge = {shown(table['hinge'])}: {where}")
        try:
            parts["hinge"] = _plain(Hinge, HINGE)(table["hinge"], elsewhere)
        except ValueError as error:
            raise ValueError(f"hinge: {error}") from error
    return Body(**parts)


def _preset(table: Table, elsewhere: Home) -> AnyVehicle:
    preset = PRESETS[choice("preset", table["preset"], PRESETS)]
    options = {key: table[key] for key in preset.options if key in table}
    vehicle = preset(**options)
    allowed = ["preset", *preset.options]
    if isinstance(vehicle, Vehicle):
        changed = () if vehicle.bodies else CHANGED
        allowed += [key for key in (*changed, "initial_friction") if key not in allowed]
    known = PLACES["[vehicle]"].allowed
    Keys(tuple(allowed)).check_known(
        table, lambda key: " (not beside this preset)" if key in known else elsewhere(key)
    )
    if not isinstance(vehicle, Vehicle):
        return vehicle
    changes = {key: table[key] for key in CHANGED if key in table and key not in options}
    vehicle = replace(vehicle, **changes)
    if "initial_friction" in table:
        friction = numbers("initial_friction", table["initial_friction"])
        vehicle = vehicle.with_initial_friction(*friction)
    return vehicle
