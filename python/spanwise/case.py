"""A case file: bridge, vehicle and crossing in TOML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, TypeAlias

from spanwise._casefile import CaseError, parse_toml, read_text
from spanwise._checks import numbers, shown
from spanwise._keys import Keys, suggestion
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.run import Run
from spanwise.vehicles import PRESETS, Axle, Vehicle

__all__ = ["Case", "CaseError"]

Table: TypeAlias = Mapping[str, Any]

BRIDGE: Final = Keys.of(Bridge)
VEHICLE: Final = Keys.of(Vehicle)
AXLE: Final = Keys.of(Axle)
CROSSING: Final = Keys.of(cross)
TABLES: Final = {"bridge": BRIDGE, "vehicle": VEHICLE, "crossing": CROSSING}

#: Beside a preset all keys of a vehicle but its axles, whose initial friction alone can be given.
PRESET: Final = Keys(
    ("preset", *(key for key in VEHICLE.allowed if key != "axles"), "initial_friction")
)


@dataclass(frozen=True, eq=False)
class Case:
    """A bridge, a vehicle and how it crosses, as a case file describes them.

    The file has three tables. The keys of ``[bridge]`` are the arguments of `Bridge`; those of
    ``[crossing]`` the keyword arguments of `cross`; those of ``[vehicle]`` the arguments of
    `Vehicle`, with one table ``[[vehicle.axles]]`` for each `Axle`, front first. Or ``[vehicle]``
    names a ``preset``, and beside it what is to be different: any of these keys but the axles, and
    ``initial_friction``, a list of one force [N] for each axle. Units are SI.

    Attributes
    ----------
    bridge : Bridge
        The bridge.
    vehicle : Vehicle
        The vehicle.
    crossing : dict
        Keyword arguments of `cross`.
    source : str
        Name of the file, for messages.

    Examples
    --------
    >>> case = Case.parse('''
    ... [bridge]
    ... spans = [18.288, 18.288]  # m
    ... EI = 1.9415e9             # N m2
    ... mass = 6037.6             # kg/m
    ... [vehicle]
    ... preset = "kishan-1973"
    ... [crossing]
    ... speed = 22.86             # m/s
    ... ''')
    >>> run = case.run(modes=3)
    """

    bridge: Bridge
    vehicle: Vehicle
    crossing: dict[str, Any] = field(default_factory=dict)
    source: str = "case"

    @classmethod
    def read(cls, path: str | Path) -> Case:
        """Read a case file.

        Raises
        ------
        OSError
            If there is no such file, or it cannot be read.
        CaseError
            A ValueError: if it is not a case file, or a value in it is not allowed.
        """
        return cls.parse(read_text(Path(path)), source=str(path))

    @classmethod
    def parse(cls, text: str, source: str = "case") -> Case:
        """A case from the text of a case file; `source` is its name in messages.

        Raises
        ------
        CaseError
            A ValueError: if the text is not a case, or a value in it is not allowed.
        """
        tables = parse_toml(text, source)
        with _errors_in(source):
            _check_tables(tables)
        with _errors_in(f"{source}, [bridge]"):
            bridge = _bridge(tables["bridge"])
        with _errors_in(f"{source}, [vehicle]"):
            vehicle = _vehicle(tables["vehicle"])
        with _errors_in(f"{source}, [crossing]"):
            CROSSING.check_known(tables["crossing"], _home)
            CROSSING.check_complete(tables["crossing"])
        return cls(bridge, vehicle, tables["crossing"], source)

    def run(self, **overrides: Any) -> Run:
        """The crossing, with keyword arguments of `cross` that replace those of the file.

        Raises
        ------
        CaseError
            A ValueError: if a value is not allowed.
        RuntimeError
            If the numerics fail, or under constant traction the vehicle comes to rest.
        """
        with _errors_in(self.source if overrides else f"{self.source}, [crossing]"):
            return cross(self.bridge, self.vehicle, **{**self.crossing, **overrides})


@contextmanager
def _errors_in(place: str) -> Iterator[None]:
    """Puts the place in front of what a check says."""
    try:
        yield
    except ValueError as error:
        raise CaseError(f"{place}: {error}") from error


def _check_tables(tables: Table) -> None:
    for name, table in tables.items():
        if name not in TABLES:
            hint = _home(name) or suggestion(name, TABLES)
            raise ValueError(f"unknown table or key {name!r}{hint}; allowed: {_list(TABLES)}")
        if not isinstance(table, dict):
            raise ValueError(f"{name} = {shown(table)}: must be a table, [{name}]")
    missing = [name for name in TABLES if name not in tables]
    if missing:
        raise ValueError(f"missing {_list(missing)}; a case has {_list(TABLES)}")


def _home(key: str) -> str:
    """Where a key belongs that was found in a table without such a key, or nothing."""
    if key in AXLE.allowed:
        return " (belongs in each [[vehicle.axles]])"
    if key == "preset":
        return " (belongs in [vehicle])"
    homes = [name for name, keys in TABLES.items() if key in keys.allowed]
    return f" (belongs in {_list(homes)})" if homes else ""


def _list(tables: Iterable[str]) -> str:
    return ", ".join(f"[{name}]" for name in tables)


def _bridge(table: Table) -> Bridge:
    BRIDGE.check_known(table, _home)
    BRIDGE.check_complete(table)
    return Bridge(**table)


def _vehicle(table: Table) -> Vehicle:
    if "preset" in table:
        return _preset(table)
    Keys(("preset", *VEHICLE.allowed)).check_known(table, _home)
    try:
        VEHICLE.check_complete(table)
    except ValueError as error:
        raise ValueError(f"{error}; or name a preset: {', '.join(PRESETS)}") from error
    axles = table["axles"]
    if not isinstance(axles, list):
        raise ValueError(f"axles = {shown(axles)}: must be a list of tables, [[vehicle.axles]]")
    return Vehicle(**{**table, "axles": [_axle(k, axle) for k, axle in enumerate(axles)]})


def _axle(k: int, table: Table) -> Axle:
    if not isinstance(table, dict):
        raise ValueError(f"axles[{k}] = {shown(table)}: must be a table, [[vehicle.axles]]")
    try:
        AXLE.check_known(table, _home)
        AXLE.check_complete(table)
    except ValueError as error:
        raise ValueError(f"axles[{k}]: {error}") from error
    return Axle(**table)


def _preset(table: Table) -> Vehicle:
    name = table["preset"]
    if name not in [*PRESETS]:
        hint = suggestion(name, PRESETS) if isinstance(name, str) else ""
        raise ValueError(f"preset = {shown(name)}: must be one of {', '.join(PRESETS)}{hint}")
    PRESET.check_known(
        table, lambda key: " (not beside a preset)" if key in VEHICLE.allowed else ""
    )
    changes = {key: table[key] for key in VEHICLE.allowed if key in table}
    vehicle = replace(PRESETS[name](), **changes)
    if "initial_friction" in table:
        friction = numbers("initial_friction", table["initial_friction"])
        vehicle = vehicle.with_initial_friction(*friction)
    return vehicle
