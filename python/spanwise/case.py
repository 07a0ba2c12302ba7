"""A case file: bridge, vehicle and crossing in TOML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TypeAlias

from spanwise._casefile import CaseError, parse_toml, read_text
from spanwise._checks import shown
from spanwise._keys import Keys, suggestion
from spanwise._vehicletable import home as vehicle_home
from spanwise._vehicletable import vehicle_of
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.run import Run
from spanwise.vehicles import AnyVehicle

__all__ = ["Case", "CaseError"]

Table: TypeAlias = Mapping[str, Any]

BRIDGE: Final = Keys.of(Bridge)
CROSSING: Final = Keys.of(cross)
HOMES: Final = {"bridge": BRIDGE, "crossing": CROSSING}
TABLES: Final = ("bridge", "vehicle", "crossing")


@dataclass(frozen=True, eq=False)
class Case:
    """A bridge, a vehicle and how it crosses, as a case file describes them.

    The file has three tables. The keys of ``[bridge]`` are the arguments of `Bridge`; those of
    ``[crossing]`` the keyword arguments of `cross`; those of ``[vehicle]`` the arguments of
    `Vehicle`, with one table ``[[vehicle.axles]]`` for each `Axle`, front first; or for a vehicle
    of several bodies one table ``[[vehicle.bodies]]`` for each `Body`, with its
    ``[[vehicle.bodies.axles]]``, ``[vehicle.bodies.hinge]`` and ``[[vehicle.bodies.springs]]``; or
    the arguments of `ForceTrain` or of `MovingMasses`. Or ``[vehicle]`` names a ``preset``, and
    beside it what is to be different: of a vehicle of one body any key but the axles, of some
    trains a spacing, and ``initial_friction``, a list of one force [N] for each axle. Units are SI.

    Attributes
    ----------
    bridge : Bridge
        The bridge.
    vehicle : Vehicle or ForceTrain or MovingMasses
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
    vehicle: AnyVehicle
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
            vehicle = vehicle_of(tables["vehicle"], _home)
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
    homes = [f"[{name}]" for name, keys in HOMES.items() if key in keys.allowed]
    if place := vehicle_home(key):
        homes.insert(1 if "[bridge]" in homes else 0, place)
    return f" (belongs in {', '.join(homes)})" if homes else ""


def _list(tables: Iterable[str]) -> str:
    return ", ".join(f"[{name}]" for name in tables)


def _bridge(table: Table) -> Bridge:
    BRIDGE.check_known(table, _home)
    BRIDGE.check_complete(table)
    return Bridge(**table)
