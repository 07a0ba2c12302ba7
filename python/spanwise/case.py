"""A case file: bridge, vehicles, road and crossing in TOML."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypeVar

from spanwise._build import Place, Table, within
from spanwise._case_tables import (
    CROSSING,
    SAMPLING,
    TABLES,
    assigned,
    check_complete,
    check_tables,
    home,
)
from spanwise._casefile import CaseError, read_text, settings_of, tables_of
from spanwise._checks import file_path, items, mapping, of_kind
from spanwise._checks import text as checks_text
from spanwise._renamed import renamed
from spanwise._value import Hashed
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.ensembles import Ensemble
from spanwise.errors import InputError
from spanwise.roads import Road, Smooth
from spanwise.roads.base import A_ROAD
from spanwise.runs import Run
from spanwise.schema import (
    Reading,
    bridge_of,
    events_of,
    passage_of,
    vehicle_of,
)
from spanwise.study import ensemble
from spanwise.traffic import Passage
from spanwise.vehicles import AnyVehicle

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["Case", "CaseError"]

T = TypeVar("T")


@dataclass(frozen=True, eq=False, repr=False)
class Case(Hashed):
    """A bridge, what crosses it and how, as a case file describes it.

    The keys of ``[bridge]`` are the arguments of `Bridge`; those of ``[crossing]`` the keyword
    arguments of `cross`, a ``drive`` with numbers as ``{ kind = "braking", deceleration = 4.0 }``.
    ``[ensemble]``, beside ``[crossing]`` or in its place, has keyword arguments of `ensemble`.

    The keys of ``[vehicle]`` are the arguments of `Vehicle`, with one table ``[[vehicle.axles]]``
    for each `Axle`, front first; or for a vehicle of several bodies one table
    ``[[vehicle.bodies]]`` for each `Body`, with its ``[[vehicle.bodies.axles]]``,
    ``[vehicle.bodies.hinge]`` and ``[[vehicle.bodies.springs]]``; or the arguments of `ForceTrain`
    or of `MovingMasses`. Or ``[vehicle]`` names a ``preset``, and beside it what is to be
    different: of a vehicle of one body any key but the axles, of one of several bodies
    ``cg_heights`` and ``hinge_height``, of some trains a spacing, and ``initial_friction``,
    a list of one force [N] for each axle.

    In place of ``[vehicle]`` one table ``[[traffic]]`` for each of several vehicles has the
    arguments of `Passage`: a ``vehicle`` with the keys above, and how that one crosses. For an
    ensemble of several kinds of event there is ``[[events]]``, each such a table or a list of them.

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
        Keyword arguments of `cross`, but the road; with objects in place of tables.
    road : Road or None
        The road, if the case has one.
    source : str
        Name of the file, for messages.
    files : tuple of Path
        The file itself, and the files of roads that it names.
    sampling : dict
        Keyword arguments of `ensemble`, beside those and in their place.
    events : tuple of tuple of Passage
        The kinds of event of an ensemble, if there are several.

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
    sampling: dict[str, Any] = field(default_factory=dict)
    events: tuple[tuple[Passage, ...], ...] = ()

    def __post_init__(self) -> None:
        of_kind("bridge", self.bridge, Bridge, "a Bridge")
        passages = _passages("passages", self.passages)
        if not passages:
            raise InputError("passages", "[]", "must have at least one")
        if self.road is not None:
            of_kind("road", self.road, Road, A_ROAD)
        checks_text("source", self.source)
        events = items("events", self.events, "a list of kinds of event")
        made: dict[str, Any] = {
            "passages": passages,
            "events": tuple(_passages(f"events[{k}]", each) for k, each in enumerate(events)),
        }
        given = {
            name: mapping(name, getattr(self, name), "a mapping of arguments by name")
            for name in ("crossing", "sampling")
        }
        if "advance" in given["crossing"]:
            renamed("advance in [crossing]", "advance in [ensemble]")
            crossing = {**given["crossing"]}
            given["sampling"] = {"advance": crossing.pop("advance"), **given["sampling"]}
            given["crossing"] = crossing
        for name, table, maker in (
            ("crossing", "crossing", CROSSING),
            ("sampling", "ensemble", SAMPLING),
        ):
            with within(f"{self.source}, [{table}]", CaseError):
                made[name] = maker.arguments(given[name], Reading(home=home).place(table))
                maker.make(**made[name])
        vars(self).update(made)

    @classmethod
    def read(cls, path: str | Path, settings: Mapping[str, Any] | None = None) -> Case:
        """Read a case file, or the JSON of results, of which it is the case again.

        Parameters
        ----------
        path : str or Path
            The file.
        settings : mapping, optional
            Values that stand in place of the file's, or beside them, by table and key, such as
            ``{"crossing.speed": 25.0, "vehicle.bodies[0].mass": 9e3}``.

        Raises
        ------
        OSError
            If there is no such file, or it or one that it names cannot be read.
        CaseError
            A ValueError: if it is not a case file, or a value in it is not allowed.
        """
        path = file_path("path", path)
        try:
            source, tables = _read(path, settings)
            case = cls._of(tables, source, path.parent)
        except CaseError as error:
            from spanwise._toml import toml_value
            from spanwise.roads.sniffing import looks_like_profile

            if looks_like_profile(path):
                raise CaseError(
                    path,
                    None,
                    "is a measured profile, not a case; in a case it is the road:\n"
                    f'[road]\nkind = "profile"\nfile = {toml_value(path.as_posix())}',
                ) from error
            raise
        return replace(case, files=(path, *case.files))

    @classmethod
    def read_road(
        cls, path: str | Path, settings: Mapping[str, Any] | None = None
    ) -> tuple[Road, tuple[Path, ...]]:
        """The road of a case file, of which nothing else is needed, and the files it is read from.

        A file that is not called .toml or .json is a measured profile.

        Raises
        ------
        OSError, CaseError
            As from `read`.
        """
        path = file_path("path", path)
        reading = Reading(path.parent, home)
        if path.suffix.lower() in (".toml", ".json"):
            source, tables = _read(path, settings)
            with within(source, CaseError):
                check_tables(tables)
            source, files = f"{source}, [road]", [path]
        else:
            profile = {"road": {"kind": "profile", "file": path.name}}
            source, tables, files = (
                "",
                assigned(profile, mapping("settings", {} if settings is None else settings)),
                [],
            )
        with within(source, CaseError):
            road = reading.road(tables.get("road", Smooth()), reading.place("road"))
        return road, (*files, *reading.files)

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
        OSError, CaseError
            As from `read`.
        """
        checks_text("source", source)
        tables = tables_of(checks_text("text", text), source)
        return cls._of(tables, source, file_path("folder", folder))

    @classmethod
    def from_dict(cls, tables: Table, source: str = "case", folder: str | Path = ".") -> Case:
        """A case from the tables of a case file, or from all that `Run.to_dict` tells.

        Parameters
        ----------
        tables : mapping
            The tables by name; ``"inf"`` is infinity, which JSON does not know.
        source, folder
            As for `parse`.

        Raises
        ------
        OSError, CaseError
            As from `read`.
        """
        checks_text("source", source)
        with within(source, CaseError):
            mapping("tables", tables, "the tables of a case by name")
        return cls._of(settings_of(tables), source, file_path("folder", folder))

    @classmethod
    def _of(cls, tables: Table, source: str, folder: Path) -> Case:
        reading = Reading(folder, home)

        def read(name: str, make: Callable[[Any, Place], T], *table: Any, where: str = "") -> T:
            with within(f"{source}, {where or TABLES[name]}", CaseError):
                return make(table[0] if table else tables[name], reading.place(name))

        with within(source, CaseError):
            check_tables(tables)
            check_complete(tables)
        bridge = read("bridge", bridge_of)
        road = read("road", reading.road) if "road" in tables else None
        if "events" in tables:
            events = read("events", events_of)
        elif "vehicle" in tables:
            events = [(Passage(vehicle=read("vehicle", vehicle_of)),)]
        else:
            each = enumerate(tables["traffic"])
            events = [tuple(read("traffic", passage_of, one, where=_number(k)) for k, one in each)]
        kinds = tuple(events) if len(events) > 1 else ()
        crossing, sampling = (tables.get(name, {}) for name in ("crossing", "ensemble"))
        files = tuple(reading.files)
        return cls(bridge, events[0], crossing, road, source, files, sampling, kinds)

    @property
    def vehicle(self) -> AnyVehicle:
        """The first vehicle."""
        return self.passages[0].vehicle

    def run(self, **overrides: Any) -> Run:
        """The crossing, with keyword arguments of `cross` that replace those of the file.

        Raises
        ------
        CaseError
            A ValueError: if a value is not allowed, or the case is one of an ensemble alone.
        RuntimeError
            If the numerics fail, or under constant traction a vehicle comes to rest.
        """
        if self.events or (self.sampling and not self.crossing and not overrides):
            needed = "a single crossing takes one event, and a [crossing]"
            raise CaseError(self.source, None, f"is a case of an ensemble; {needed}")
        given = {"road": self.road, **self.crossing, **overrides}
        with self._errors({"crossing": self.crossing}, overrides):
            return cross(self.bridge, self.passages, **given)

    def ensemble(self, *, samples: int | None = None, **overrides: Any) -> Ensemble:
        """Many crossings, with keyword arguments of `ensemble` beside or in place of the file's.

        Without `samples` there are as many as the file's ``[ensemble]`` says.

        Raises
        ------
        CaseError, RuntimeError
            As from `run`.
        """
        overrides |= {} if samples is None else {"samples": samples}
        given = {"road": self.road, **self.crossing, **self.sampling, **overrides}
        if "samples" not in given:
            said = "missing samples; give them here or in [ensemble]"
            raise CaseError(self.source, None, said)
        events = self.events or (self.passages,)
        # As for a single crossing, the file's speed may be there for nobody.
        if "speed" not in overrides and all(e.speed is not None for event in events for e in event):
            given.pop("speed", None)
        who = [[*event] for event in events]
        tables = {"crossing": self.crossing}
        tables = {"ensemble": self.sampling, **tables} if self.sampling else tables
        with self._errors(tables, overrides):
            return ensemble(self.bridge, who if self.events else who[0], **given)

    @contextmanager
    def _errors(self, tables: Mapping[str, Table], overrides: Table) -> Iterator[None]:
        """Puts the place in front of what is said of arguments, which these tables may give."""
        try:
            yield
        except ValueError as error:
            found = CaseError.of(error)
            if found.key == "SPANWISE_ISA":  # which is of no case
                raise
            key, allowed = self._numbered(found.key), self._numbered(found.allowed)
            argument = next(iter(found.key.replace("[", " ").split()), "")
            # What no table gives is missing in the first, unless it could be among the arguments.
            giving = [name for name, each in tables.items() if argument in each]
            home = [*giving, *([] if overrides else tables)]
            in_file = home and key == found.key and argument not in overrides
            place = f"{self.source}, {TABLES[home[0]]}" if in_file else self.source
            raise CaseError(key, found.value, allowed).within(place) from error

    def _numbered(self, said: str) -> str:
        """The same with vehicles called as their tables are."""
        for k in range(len(self.passages)):
            said = said.replace(f"vehicles[{k}]", _number(k))
        return said


def _number(vehicle: int) -> str:
    """What the table of a vehicle is called, which is counted from 0."""
    return f"[[traffic]] number {vehicle + 1}"


def _passages(key: str, given: object) -> tuple[Passage, ...]:
    passages = enumerate(items(key, given, "a list of Passage"))
    return tuple(of_kind(f"{key}[{i}]", each, Passage, "a Passage") for i, each in passages)


def _read(path: Path, settings: Mapping[str, Any] | None) -> tuple[str, dict[str, Any]]:
    """The tables of a file with settings in place of its own, and what messages call them."""
    source = str(path)
    tables = tables_of(read_text(path), source)
    if settings is None or settings == {}:
        return source, tables
    with within(source, CaseError):
        tables = assigned(tables, mapping("settings", settings))
    which = f"{len(settings)} values" if len(settings) > 3 else ", ".join(settings)
    return f"{source} with {which} set", tables
