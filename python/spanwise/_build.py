"""Objects from tables of plain values, and tables from objects, by the type hints of both."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import InitVar, dataclass, field, fields, is_dataclass, replace
from functools import cached_property
from inspect import Parameter, signature
from types import NoneType, UnionType
from typing import (
    TYPE_CHECKING,
    Any,
    Final,
    Literal,
    TypeAlias,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np
from numpy.typing import ArrayLike

from spanwise._checks import array, choice, flag, number, numbers, shown, whole
from spanwise._keys import suggestion
from spanwise._value import same

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Table: TypeAlias = Mapping[str, Any]
#: What to say of a key that is not allowed where it is: where it belongs, or nothing.
Home: TypeAlias = Callable[[str], str]


@dataclass(frozen=True)
class Place:
    """Where in a file a value stands, and what is known there.

    Attributes
    ----------
    name : str
        What messages call it, such as ``bodies[0].axles[1]``; nothing if it is the whole table.
    table : str
        The table of the file that the name begins in.
    home : callable
        Says where a key belongs that is not allowed.
    readers : mapping
        What reads a value whose hint has one of these classes.
    """

    name: str = ""
    table: str = ""
    home: Home = lambda key: ""
    readers: Mapping[type, Callable[[Any, Place], object]] = field(default_factory=dict)

    def __getitem__(self, key: object) -> Place:
        """The place of a value in a table or of an item of a list."""
        if isinstance(key, int):
            return replace(self, name=f"{self.name or self.table}[{key}]")
        return replace(self, name=f"{self.name}.{key}" if self.name else str(key))

    @property
    def written(self) -> str:
        """The table as a file has it, without numbers."""
        return re.sub(r"\[\d+\]", "", ".".join(filter(None, (self.table, self.name))))

    def refused(self, said: str) -> ValueError:
        """The error that says so of the table that stands here."""
        return ValueError(f"{self.name}: {said}" if self.name else said)

    def wrong(self, value: object, allowed: str) -> ValueError:
        """The error that says what the value that stands here must be."""
        name = f"{self.name} = " if self.name else ""
        return ValueError(f"{name}{shown(value)}: must be {allowed}")


@contextmanager
def within(place: str, kind: type[ValueError] = ValueError) -> Iterator[None]:
    """Puts the place in front of what is said of a value."""
    try:
        yield
    except ValueError as error:
        raise kind(f"{place}: {error}" if place else str(error)) from error


@dataclass(frozen=True)
class Maker:
    """What makes something of a table; its arguments are the keys.

    Attributes
    ----------
    make : callable
        A class or a function.
    options_of : callable, optional
        Where the arguments go that `make` passes on.
    without : tuple of str
        Arguments that are no keys.
    called : mapping
        Arguments by the keys that are called otherwise.
    needs : tuple of str
        Keys that there must be; without, those of arguments that have no default.
    """

    make: Callable[..., Any]
    options_of: Callable[..., Any] | None = None
    without: tuple[str, ...] = ()
    called: Mapping[str, str] = field(default_factory=dict)
    needs: tuple[str, ...] | None = None

    @cached_property
    def keys(self) -> dict[str, tuple[Any, bool]]:
        """Type and whether it is required, of every key."""
        names = {argument: key for key, argument in self.called.items()}
        found: dict[str, tuple[Any, bool]] = {}
        for each in filter(None, (self.make, self.options_of)):
            target: Any = each
            hints = get_type_hints(target.__init__ if isinstance(each, type) else target)
            for name, one in signature(each).parameters.items():
                if one.kind is not Parameter.VAR_KEYWORD and name not in self.without:
                    required = one.default is Parameter.empty
                    found.setdefault(names.get(name, name), (hints.get(name, Any), required))
        return found

    @property
    def required(self) -> list[str]:
        """Keys that there must be."""
        if self.needs is not None:
            return [*self.needs]
        return [key for key, (_, required) in self.keys.items() if required]

    def arguments(self, table: object, place: Place, others: Sequence[str] = ()) -> dict[str, Any]:
        """What it is called with, objects in place of tables; `others` are keys of other makers."""
        if not isinstance(table, Mapping):
            raise place.wrong(table, f"a table, [{place.written}]")
        check_known(table, [*self.keys, *others], place)
        if missing := [key for key in self.required if key not in table]:
            instead = f"; or give {', '.join(others)}" if others else ""
            raise place.refused(f"missing {', '.join(missing)}{instead}")
        return {
            self.called.get(key, key): _built(self.keys[key][0], value, place[key])
            for key, value in table.items()
        }

    def checked(self, table: object, place: Place) -> dict[str, Any]:
        """The same for what is not called at once: plain values too are of the types of hints."""
        arguments = self.arguments(table, place)
        for key, value in arguments.items():
            _check(self.keys[key][0], value, place[key])
        return arguments

    def build(self, table: object, place: Place, others: Sequence[str] = ()) -> Any:
        """What it makes of a table."""
        arguments = self.arguments(table, place, others)
        with within(place.name):
            return self.make(**arguments)


def check_known(table: Mapping[Any, object], allowed: Sequence[str], place: Place) -> None:
    """Refuses unknown keys, with the table where they belong or else the nearest known key."""
    for key in table:
        if key not in allowed:
            hint = (place.home(key) if isinstance(key, str) else "") or suggestion(key, allowed)
            raise place.refused(f"unknown key {shown(key)}{hint}; allowed: {', '.join(allowed)}")


def build_one(makers: Sequence[Maker], table: object, place: Place, *others: str) -> Any:
    """What the first of several makers makes, or the one of which a required key is there."""
    first, *more = makers
    signs = {key: each for each in more for key in each.required if key not in first.keys}
    given = table if isinstance(table, Mapping) else {}
    sign = next((key for key in signs if key in given), None)
    maker = first if sign is None else signs[sign]
    for key, value in given.items():
        users = [own for own, each in signs.items() if key in each.keys]
        if key not in maker.keys and (users or key in first.keys):
            used = f"not used with {sign}" if sign else f"used with {' or '.join(users)} only"
            allowed = ", ".join(maker.keys)
            raise ValueError(f"{place[key].name} = {shown(value)}: {used}; allowed: {allowed}")
    return maker.build(table, place, () if sign else [*others, *signs])


def build_kind(kinds: Mapping[str, Sequence[Maker]], table: object, place: Place) -> Any:
    """What those makers make that the ``kind`` of the table is of."""
    if not isinstance(table, Mapping):
        raise place.wrong(table, f"a table with a kind: {', '.join(kinds)}")
    if "kind" not in table:
        raise place.refused(f"missing kind; allowed: {', '.join(kinds)}")
    kind = choice(place["kind"].name, table["kind"], kinds)

    def beside(key: str) -> str:
        found = [each for each, makers in kinds.items() if any(key in one.keys for one in makers)]
        other = f" (not beside kind = {kind!r}, but {' and '.join(found)})" if found else ""
        return other or place.home(key)

    rest = {key: value for key, value in table.items() if key != "kind"}
    return build_one(kinds[kind], rest, replace(place, home=beside))


def _types(hint: Any) -> list[Any]:
    """The types of a union, or the one there is."""
    hint = hint.type if isinstance(hint, InitVar) else hint
    return [*get_args(hint)] if get_origin(hint) in (Union, UnionType) else [hint]


def _built(hint: Any, value: Any, place: Place) -> Any:
    """The value with objects in place of tables, unless its hint says that these may stay."""
    types = _types(hint)
    if value is None and NoneType in types:
        return None
    if reader := next((place.readers[each] for each in types if each in place.readers), None):
        return reader(value, place)
    as_it_is = any(get_origin(each) is Mapping for each in types)
    for each in [] if as_it_is else types:
        if isinstance(each, type) and is_dataclass(each):
            return value if isinstance(value, each) else Maker(each).build(value, place)
        if get_origin(each) is Sequence and is_dataclass(get_args(each)[0]):
            if not isinstance(value, list | tuple):
                raise place.wrong(value, f"a list of tables, [[{place.written}]]")
            return [_built(get_args(each)[0], one, place[k]) for k, one in enumerate(value)]
    # JSON has no infinity.
    return math.inf if float in types and isinstance(value, str) and value == "inf" else value


def _check(hint: Any, value: Any, place: Place) -> None:
    """Refuses a value that is not of its type, where that is a plain one."""
    types = [each for each in _types(hint) if each is not NoneType]
    if value is None or any(each in place.readers for each in types):
        return
    if set(types) >= set(get_args(ArrayLike) or [ArrayLike]):
        array(place.name, value)
    elif types == [Sequence[float]]:
        numbers(place.name, value)
    elif get_origin(types[0]) is Literal:
        choice(place.name, value, get_args(types[0]))
    elif types[0] in _CHECKS:
        _CHECKS[types[0]](place.name, value)


_CHECKS: Final[dict[Any, Callable[[str, object], object]]] = {
    bool: flag,
    int: whole,
    float: number,
}


def table_of(made: DataclassInstance, *, defaults: bool = True) -> dict[str, Any]:
    """The table that makes the same again: all fields but those that are None or empty.

    Without `defaults` what is as by default is left out too.
    """
    kind = getattr(type(made), "kind", None)
    table: dict[str, Any] = {"kind": kind} if isinstance(kind, str) else {}
    for each in fields(made):
        value = getattr(made, each.name)
        empty = value is None or (isinstance(value, tuple) and not value)
        if not empty and (defaults or not same(value, each.default)):
            table[each.name] = _plain(value, defaults)
    return table


def _plain(value: Any, defaults: bool) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return table_of(value, defaults=defaults)
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(each, defaults) for each in value] if isinstance(value, list | tuple) else value


def toml(tables: Table) -> str:
    """Tables by name as TOML."""
    return "\n".join(_lines(tables, ""))[1:]


def _lines(table: Table, name: str) -> Iterator[str]:
    """The values of a table, then the tables in it, each after a blank line and its name."""
    inner = {key: each for key, each in table.items() if _is_table(each) or _is_tables(each)}
    yield from (f"{key} = {toml_value(v)}" for key, v in table.items() if key not in inner)
    for key, each in inner.items():
        path = f"{name}.{key}" if name else key
        for one in each if isinstance(each, list) else [each]:
            if isinstance(each, list):
                yield from ("", f"[[{path}]]")
            elif not one or not all(_is_table(v) or _is_tables(v) for v in one.values()):
                yield from ("", f"[{path}]")
            yield from _lines(one, path)


def _is_table(value: object) -> bool:
    return isinstance(value, Mapping)


def _is_tables(value: object) -> bool:
    return isinstance(value, list) and len(value) > 0 and all(map(_is_table, value))


def toml_value(value: Any) -> str:
    """A value as TOML, a table on one line."""
    if isinstance(value, str | bool):
        return json.dumps(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, Mapping):
        inner = (f"{key} = {toml_value(each)}" for key, each in value.items())
        return f"{{ {', '.join(inner)} }}"
    return repr(value)
