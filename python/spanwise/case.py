"""A case file: bridge, vehicles, road and crossing in TOML."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, TypeAlias

from spanwise._casefile import CaseError, parse_toml, read_text
from spanwise._checks import file_path, items, mapping, shown
from spanwise._checks import text as checks_text
from spanwise._keys import Keys, suggestion
from spanwise._plain import from_plain
from spanwise._traffictable import OWN, files_in, passage_of, road_in
from spanwise._value import Hashed
from spanwise._vehicletable import home as vehicle_home
from spanwise._vehicletable import vehicle_of
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.ensembles import Ensemble
from spanwise.roads import Road, Smooth
from spanwise.roads.sniffing import looks_like_profile
from spanwise.roads.table import KINDS as ROADS
from spanwise.runs import Run
from spanwise.study import ensemble
from spanwise.traffic import KINDS as DRIVES
from spanwise.traffic import Passage
from spanwise.vehicles import AnyVehicle

__all__ = ["Case", "CaseError"]

Table: TypeAlias = Mapping[str, Any]

BRIDGE: Final = Keys.of(Bridge)
#: Keys of ``[crossing]`` that only ensembles have.
FOR_ENSEMBLES: Final = ("advance",)
#: The road has a table of its own.
CROSSING: Final = Keys((*(key for key in Keys.of(cross).allowed if key != "road"), *FOR_ENSEMBLES))
#: Tables, as they are written.
TABLES: Final = {
    "bridge": "[bridge]",
    "vehicle": "[vehicle]",
    "traffic": "[[traffic]]",
    "road": "[road]",
    "crossing": "[crossing]",
}
#: A vehicle among several, and what of it, in a message about a crossing.
VEHICLE: Final = re.compile(r"vehicles\[(\d+)\]")


@dataclass(frozen=True, eq=False, repr=False)
class Case(Hashed):
    """A bridge, what crosses it and how, as a case file describes it.

    The keys of ``[bridge]`` are the arguments of `Bridge`; those of ``[crossing]`` the keyword
    arguments of `cross`, and ``advance``, which `ensemble` alone uses; a ``drive`` with numbers as
    ``{ kind = "braking", deceleration = 4.0 }``.

    The keys of ``[vehicle]`` are the arguments of `Vehicle`, with one table ``[[vehicle.axles]]``
    for each `Axle`, front first; or for a vehicle of several bodies one table
    ``[[vehicle.bodies]]`` for each `Body`, with its ``[[vehicle.bodies.axles]]``,
    ``[vehicle.bodies.hinge]`` and ``[[vehicle.bodies.springs]]``; or the arguments of `ForceTrain`
    or of `MovingMasses`. Or ``[vehicle]`` names a ``preset``, and beside it what is to be
    different: of a vehicle of one body any key but the axles, of one of several bodies
    ``cg_heights`` and ``hinge_height``, of some trains a spacing, and ``initial_friction``,
    a list of one force [N] for each axle.

    In place of ``[vehicle]`` one table ``[[traffic]]`` for each of several vehicles has the
    arguments of `Passage`: a ``vehicle`` with the keys above, and how that one crosses.

    ``[road]``, or ``[[road]]`` for each part of a sum, is a table of `roads.from_table`; without,
    the road is smooth. Files that it names are looked for from the folder of the case file on.
    Units are SI.

    Attributes
    ----------
    bridge : Bridge
        The bridge.
    passages : tuple of Passage
        The vehicles and how each of them crosses.
    crossing : dict
        Keyword arguments of `cross`, but the road.
    road : Road or None
        The road, if the case has one.
    source : str
        Name of the file, for messages.
    files : tuple of Path
        The file itself, and the files of roads that it names.

    Examples
    --------
    >>> case = Case.parse('''
    ... [bridge]
    ... spans = [18.288, 18.288]  # m
    ... EI = 1.9415e9             # N m2
    ... mass = 6037.6             # kg/m
    ... [vehicle]
    ... preset = "kishan-1973"
    ... [road]
    ... kind = "iso-8608"
    ... class = "B"
    ... [crossing]
    ... speed = 22.86             # m/s
    ... damping = 0.02            # of critical
    ... ''')
    >>> run = case.run(modes=3)
    >>> many = case.ensemble(samples=20, modes=3)
    """

    bridge: Bridge
    passages: tuple[Passage, ...]
    crossing: dict[str, Any] = field(default_factory=dict)
    road: Road | None = None
    source: str = field(default="case", compare=False)
    files: tuple[Path, ...] = field(default=(), compare=False, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.bridge, Bridge):
            raise TypeError(f"bridge = {shown(self.bridge)}: must be a Bridge")
        passages = items("passages", self.passages, "a list of Passage")
        for i, each in enumerate(passages):
            if not isinstance(each, Passage):
                raise TypeError(f"passages[{i}] = {shown(each)}: must be a Passage")
        if not passages:
            raise ValueError("passages = []: must have at least one")
        if self.road is not None and not isinstance(self.road, Road):
            raise TypeError(f"road = {shown(self.road)}: must be a Road")
        object.__setattr__(self, "passages", tuple(passages))
        crossing = dict(mapping("crossing", self.crossing, "a mapping of arguments by name"))
        CROSSING.check_known(crossing, _home)
        object.__setattr__(self, "crossing", crossing)
        checks_text("source", self.source)

    @classmethod
    def read(cls, path: str | Path) -> Case:
        """Read a case file.

        Raises
        ------
        OSError
            If there is no such file, or it or one that it names cannot be read.
        CaseError
            A ValueError: if it is not a case file, or a value in it is not allowed.
        """
        path = file_path("path", path)
        try:
            case = cls.parse(read_text(path), source=str(path), folder=path.parent)
        except CaseError as error:
            if looks_like_profile(path):
                raise CaseError(
                    f"{path}: is a measured profile, not a case; in a case it is the road:\n"
                    f'[road]\nkind = "profile"\nfile = {json.dumps(path.as_posix())}'
                ) from error
            raise
        return replace(case, files=(path, *case.files))

    @classmethod
    def read_road(cls, path: str | Path) -> tuple[Road, tuple[Path, ...]]:
        """The road of a case file, of which nothing else is needed, and the files it is read from.

        Raises
        ------
        OSError, CaseError
            As from `read`.
        """
        path = file_path("path", path)
        tables = parse_toml(read_text(path), str(path))
        with _errors_in(str(path)):
            _check_names(tables)
        road: Road = Smooth()
        if "road" in tables:
            with _errors_in(f"{path}, [road]"):
                road = road_in(tables["road"], path.parent, _home)
        files = files_in({"road": tables.get("road", ())}, path.parent)
        return road, (path, *files)

    @classmethod
    def parse(cls, text: str, source: str = "case", folder: str | Path = ".") -> Case:
        """A case from the text of a case file.

        Parameters
        ----------
        text : str
            The text.
        source : str, optional
            Its name in messages.
        folder : str or Path, optional
            Where files that it names are looked for.

        Raises
        ------
        OSError
            If a file that it names cannot be read.
        CaseError
            A ValueError: if the text is not a case, or a value in it is not allowed.
        """
        checks_text("source", source)
        tables = parse_toml(checks_text("text", text), source)
        return cls._of(tables, source, file_path("folder", folder))

    @classmethod
    def from_dict(cls, tables: Table, source: str = "case", folder: str | Path = ".") -> Case:
        """A case from the tables of a case file, such as the ``settings`` of a report.

        Parameters
        ----------
        tables : mapping
            The tables by name; ``"inf"`` is infinity, which JSON does not know.
        source, folder
            As for `parse`.

        Raises
        ------
        OSError
            If a file that it names cannot be read.
        CaseError
            A ValueError: if a table, key or value is not allowed.
        """
        checks_text("source", source)
        with _errors_in(source):
            plain = from_plain(mapping("tables", tables, "the tables of a case by name"))
        return cls._of(plain, source, file_path("folder", folder))

    @classmethod
    def _of(cls, tables: Table, source: str, folder: Path) -> Case:
        with _errors_in(source):
            _check_tables(tables)
        with _errors_in(f"{source}, [bridge]"):
            bridge = _bridge(tables["bridge"])
        road = None
        if "road" in tables:
            with _errors_in(f"{source}, [road]"):
                road = road_in(tables["road"], folder, _home)
        if "vehicle" in tables:
            with _errors_in(f"{source}, [vehicle]"):
                passages = [Passage(vehicle=vehicle_of(tables["vehicle"], _home))]
        else:
            passages = []
            for k, table in enumerate(tables["traffic"]):
                with _errors_in(f"{source}, {_number(k)}"):
                    passages.append(passage_of(table, folder, _home))
        with _errors_in(f"{source}, [crossing]"):
            CROSSING.check_known(tables["crossing"], _home)
        files = tuple(files_in(tables, folder))
        return cls(bridge, tuple(passages), dict(tables["crossing"]), road, source, files)

    @property
    def vehicle(self) -> AnyVehicle:
        """The first vehicle."""
        return self.passages[0].vehicle

    def run(self, **overrides: Any) -> Run:
        """The crossing, with keyword arguments of `cross` that replace those of the file.

        Raises
        ------
        CaseError
            A ValueError: if a value is not allowed.
        RuntimeError
            If the numerics fail, or under constant traction a vehicle comes to rest.
        """
        own = {key: each for key, each in self.crossing.items() if key not in FOR_ENSEMBLES}
        given = {"road": self.road, **own, **overrides}
        with self._errors(overridden=bool(overrides)):
            return cross(self.bridge, self.passages, **given)

    def ensemble(self, *, samples: int, **overrides: Any) -> Ensemble:
        """Many crossings, with keyword arguments of `ensemble` beside or in place of the file's.

        Raises
        ------
        CaseError
            A ValueError: if a value is not allowed.
        RuntimeError
            If the numerics of the bridge fail.
        """
        given = {"road": self.road, **self.crossing, **overrides}
        # As for a single crossing, the file's speed may be there for nobody.
        if "speed" not in overrides and all(each.speed is not None for each in self.passages):
            given.pop("speed", None)
        with self._errors(overridden=True):
            return ensemble(self.bridge, [*self.passages], samples=samples, **given)

    @contextmanager
    def _errors(self, *, overridden: bool) -> Iterator[None]:
        """Puts the place in front of what is said about a crossing."""
        place = self.source if overridden else f"{self.source}, [crossing]"
        try:
            yield
        except ValueError as error:
            said, named = VEHICLE.subn(lambda found: _number(int(found[1])), str(error))
            raise CaseError(f"{self.source if named else place}: {said}") from error


def _number(vehicle: int) -> str:
    """What the table of a vehicle is called, which is counted from 0."""
    return f"[[traffic]] number {vehicle + 1}"


@contextmanager
def _errors_in(place: str) -> Iterator[None]:
    """Puts the place in front of what a check says."""
    try:
        yield
    except ValueError as error:
        raise CaseError(f"{place}: {error}") from error


def _check_tables(tables: Mapping[Any, Any]) -> None:
    _check_names(tables)
    if "vehicle" in tables and "traffic" in tables:
        raise ValueError("[vehicle] and [[traffic]]: give one of the two")
    missing = [name for name in ("bridge", "vehicle", "crossing") if name not in tables]
    if "traffic" in tables:
        missing.remove("vehicle")
    if missing:
        needed = "a case has [bridge], [vehicle] or [[traffic]], and [crossing]"
        raise ValueError(f"missing {_list(missing)}; {needed}")


def _check_names(tables: Mapping[Any, Any]) -> None:
    for name, table in tables.items():
        if name not in TABLES:
            hint = (_home(name) if isinstance(name, str) else "") or suggestion(name, TABLES)
            raise ValueError(f"unknown table or key {shown(name)}{hint}; allowed: {_list(TABLES)}")
        several = isinstance(table, list) and len(table) > 0 and isinstance(table[0], Mapping)
        if name == "traffic":
            if not several:
                raise ValueError(f"traffic = {shown(table)}: must be tables, [[traffic]]")
        elif not isinstance(table, Mapping) and not (name == "road" and several):
            raise ValueError(f"{name} = {shown(table)}: must be a table, {TABLES[name]}")


def _home(key: str) -> str:
    """Where a key belongs that was found in a table without such a key, or nothing."""
    homes = {
        "[bridge]": key in BRIDGE.allowed,
        vehicle_home(key): vehicle_home(key) != "",
        "each [[traffic]]": key in OWN,
        "[road]": key == "kind" or any(key in keys.allowed for _, keys in ROADS.values()),
        "[crossing]": key in CROSSING.allowed,
        "a drive": any(key in Keys.of(kind).allowed for kind in DRIVES.values()),
    }
    found = [home for home, is_there in homes.items() if is_there]
    if key in TABLES and key != "vehicle":
        return f" (a table of its own, {TABLES[key]})"
    return f" (belongs in {', '.join(found)})" if found else ""


def _list(tables: Iterable[str]) -> str:
    return ", ".join(TABLES[name] for name in tables)


def _bridge(table: Table) -> Bridge:
    BRIDGE.check_known(table, _home)
    BRIDGE.check_complete(table)
    return Bridge(**table)
