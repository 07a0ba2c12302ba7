"""Objects from tables of plain values, by the type hints of what makes them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import InitVar, dataclass, field, is_dataclass, replace
from functools import cache, cached_property
from inspect import Parameter, signature
from types import NoneType, UnionType
from typing import (
    Any,
    Final,
    Generic,
    TypeAlias,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

from spanwise._checks import choice, shown
from spanwise._keys import suggestion
from spanwise.errors import InputError, refused

T = TypeVar("T")
Table: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True, eq=False, repr=False)
class Place:
    """Where in a file a value stands, and how what stands there is read."""

    #: What messages call it, such as ``bodies[0].axles[1]``; nothing if it is the whole table.
    name: str = ""
    #: The table that the name begins in.
    table: str = ""
    #: Says where a key belongs that is not allowed here, or nothing.
    home: Callable[[str], str] = lambda key: ""
    #: What reads a value whose hint has one of these classes.
    readers: Mapping[type, Callable[[Any, Place], object]] = field(default_factory=dict)
    #: A key that has been read already.
    read: tuple[str, ...] = ()

    def __getitem__(self, key: object) -> Place:
        name = f"{self.name}.{key}" if self.name else str(key)
        name = f"{self.name or self.table}[{key}]" if isinstance(key, int) else name
        return replace(self, name=name, read=())

    def refused(self, said: str) -> InputError:
        """The error that says so of the table that stands here."""
        return InputError(self.name, None, said)

    def wrong(self, value: object, allowed: str) -> InputError:
        """The error that says what the value here must be; ``[]`` is how a table is written."""
        written = re.sub(r"\[\d+\]", "", ".".join(filter(None, (self.table, self.name))))
        return refused(self.name, value, f"must be {allowed.replace('[]', f'[{written}]')}")


@contextmanager
def within(place: str, kind: type[InputError] = InputError) -> Iterator[None]:
    """Puts the place in front of what is said of a value."""
    try:
        yield
    except ValueError as error:
        raise kind.of(error).within(place) from error


def check_known(
    table: Mapping[Any, object], known: Sequence[str], place: Place, what: str = "key"
) -> None:
    """Refuses unknown keys, with the table where they belong or else the nearest known key."""
    for key in table:
        if key not in known:
            home = place.home(key) if isinstance(key, str) else ""
            # One and many are mistaken before tables are.
            many = [each for each in known if each.removesuffix("s") == str(key).removesuffix("s")]
            hint = suggestion(key, many) or home or suggestion(key, known)
            allowed = ", ".join([*place.read, *known])
            raise place.refused(f"unknown {what} {shown(key)}{hint}; allowed: {allowed}")


@dataclass(frozen=True, eq=False, repr=False)
class Maker(Generic[T]):
    """What makes something of a table, the keys of which are its arguments."""

    #: A class or a function.
    make: Callable[..., T]
    #: Where the arguments go that it passes on.
    options_of: Callable[..., Any] | None = None
    #: Arguments that are no keys.
    without: tuple[str, ...] = ()
    #: Arguments by the keys that are called otherwise.
    called: Mapping[str, str] = field(default_factory=dict)
    #: Keys that there must be; by default those of arguments without a default.
    needs: tuple[str, ...] | None = None

    @cached_property
    def keys(self) -> dict[str, Parameter]:
        """Arguments by key."""
        names = {argument: key for key, argument in self.called.items()}
        found = [one for each in (self.make, self.options_of) if each for one in _arguments(each)]
        named = [p for p in found if p.kind is not p.VAR_KEYWORD and p.name not in self.without]
        return {names.get(each.name, each.name): each for each in named}

    @property
    def required(self) -> Sequence[str]:
        """Keys that there must be."""
        without_default = [key for key, each in self.keys.items() if each.default is each.empty]
        return without_default if self.needs is None else self.needs

    def arguments(self, table: object, place: Place, others: Sequence[str] = ()) -> dict[str, Any]:
        """What it is called with, objects in place of tables; `others` are keys of other makers."""
        if not isinstance(table, Mapping):
            raise place.wrong(table, "a table, []")
        check_known(table, [*self.keys, *others], place)
        if missing := [key for key in self.required if key not in table]:
            instead = f"; or give {', '.join(others)}" if others else ""
            raise place.refused(f"missing {', '.join(missing)}{instead}")
        return {
            self.keys[key].name: _built(self.keys[key].annotation, value, place[key])
            for key, value in table.items()
        }

    def build(self, table: object, place: Place, others: Sequence[str] = ()) -> T:
        """What it makes of a table."""
        arguments = self.arguments(table, place, others)
        with within(place.name):
            return self.make(**arguments)


def build_one(makers: Sequence[Maker[T]], table: object, place: Place, *others: str) -> T:
    """What the first of several makers makes, or the one of which a required key is there."""
    first, *more = makers
    signs = {key: each for each in more for key in each.required if key not in first.keys}
    given = table if isinstance(table, Mapping) else {}
    sign = next((key for key in signs if key in given), None)
    every = {key for each in makers for key in each.keys}
    unknown = [key for key in given if key not in every and key not in others]
    if sign is None:  # or one of which the nearest is there
        meant = {suggestion(key, every) for key in unknown} - {""}
        sign = next((key for key in signs if suggestion(key, [key]) in meant), None)
    maker = first if sign is None else signs[sign]
    for key, value in () if unknown else given.items():
        users = [own for own, each in signs.items() if key in each.keys]
        if key not in maker.keys and (users or key in first.keys):
            used = f"not used with {sign}" if sign else f"used with {' or '.join(users)} only"
            allowed = ", ".join([*place.read, *maker.keys])
            raise refused(place[key].name, value, f"{used}; allowed: {allowed}")
    return maker.build(table, place, () if sign else [*others, *signs])


def build_kind(kinds: Mapping[str, Sequence[Maker[T]]], table: object, place: Place) -> T:
    """What those makers make that the ``kind`` of the table is of."""
    if not isinstance(table, Mapping):
        raise place.wrong(table, f"a table with a kind: {', '.join(kinds)}")
    if "kind" not in table:
        raise place.refused(f"missing kind; allowed: {', '.join(kinds)}")
    kind = choice(place["kind"].name, table["kind"], kinds)

    def beside(key: str) -> str:
        found = " and ".join(each for each in kinds if key in keys_of({each: kinds[each]}))
        return f" (not beside kind = {kind!r}, but {found})" if found else place.home(key)

    rest = {key: value for key, value in table.items() if key != "kind"}
    return build_one(kinds[kind], rest, replace(place, home=beside, read=("kind",)))


def keys_of(kinds: Mapping[str, Sequence[Maker[T]]]) -> set[str]:
    """All keys of tables with a kind."""
    return {key for makers in kinds.values() for each in makers for key in each.keys}


def _arguments(function: Callable[..., Any]) -> Iterator[Parameter]:
    """The arguments of a function or a class, with their hints evaluated."""
    target: Any = function
    is_plain = isinstance(function, type) and not is_dataclass(function)
    hints = get_type_hints(target.__init__ if is_plain else function)
    for each in signature(function).parameters.values():
        yield each.replace(annotation=hints[each.name])


_maker: Final = cache(Maker)


def _types(hint: Any) -> list[Any]:
    """The types of a union, or the one there is."""
    hint = hint.type if isinstance(hint, InitVar) else hint
    return [*get_args(hint)] if get_origin(hint) in (Union, UnionType) else [hint]


def _built(hint: Any, value: Any, place: Place) -> Any:
    """The value with objects in place of tables, unless its hint says that these may stay."""
    types = _types(hint)
    if value is None and NoneType in types:
        return None
    for each in types:
        if each in place.readers:
            return place.readers[each](value, place)
    for each in [] if Mapping in {get_origin(each) for each in types} else types:
        if isinstance(each, type) and is_dataclass(each):
            return value if isinstance(value, each) else _maker(each).build(value, place)
        if get_origin(each) is Sequence and is_dataclass(get_args(each)[0]):
            if not isinstance(value, list | tuple):
                raise place.wrong(value, "a list of tables, [[]]")
            return [_built(get_args(each)[0], one, place[k]) for k, one in enumerate(value)]
    # JSON has no infinity.
    return math.inf if float in types and isinstance(value, str) and value == "inf" else value
