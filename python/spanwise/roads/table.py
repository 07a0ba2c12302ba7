"""Roads from plain tables, as a case file has them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from inspect import Parameter, signature
from typing import Any, Final, TypeAlias

from spanwise._checks import shown, word
from spanwise._keys import Keys, suggestion
from spanwise.roads.base import Road, Smooth, total
from spanwise.roads.features import Bump, Camber, Joint, Pothole, Ramp, Step
from spanwise.roads.profile import Profile
from spanwise.roads.random import ISO8608, bridge_study, from_iri

Table: TypeAlias = Mapping[str, Any]

#: What makes a road of some keys of a table.
Maker: TypeAlias = Callable[..., Road]


def _iso(**given: Any) -> Road:
    if "iri" in given:
        for other in ("class", "G"):
            if other in given:
                raise ValueError(f"{other} = {shown(given[other])}: not used with iri")
        return from_iri(**given)
    return ISO8608(given.pop("class", None), **given)


def _profile(**given: Any) -> Road:
    if "file" not in given:
        for other in _FILE.allowed[1:]:
            if other not in _POINTS.allowed and other in given:
                raise ValueError(f"{other} = {shown(given[other])}: used with file only")
        _POINTS.check_complete(given)
        return Profile(**given)
    for other in _POINTS.required:
        if other in given:
            raise ValueError(f"{other}: not used with file")
    return Profile.read(word("file", given.pop("file")), **given)


def _keys(function: Callable[..., Any], *others: str) -> Keys:
    """All named arguments of a function or class, positional or not, after others."""
    found = [p for p in signature(function).parameters.values() if p.kind is not p.VAR_KEYWORD]
    required = tuple(p.name for p in found if p.default is Parameter.empty)
    return Keys((*others, *(p.name for p in found)), required)


_POINTS: Final = _keys(Profile)
_FILE: Final = Keys(("file", *_keys(Profile.read).allowed[1:]))
_ISO: Final = Keys(("class", "iri", *_keys(ISO8608).allowed[1:]))
_BOTH: Final = Keys((*_POINTS.allowed, *(k for k in _FILE.allowed if k not in _POINTS.allowed)))
_CONDITION: Final = Keys(
    ("condition", *(key for key in _ISO.allowed if key not in ("class", "iri", "G"))),
    ("condition",),
)

#: What makes each kind of road, and of which keys.
KINDS: Final[dict[str, tuple[Maker, Keys]]] = {
    ISO8608.kind: (_iso, _ISO),
    "bridge-study": (bridge_study, _CONDITION),
    Profile.kind: (_profile, _BOTH),
    **{
        each.kind: (each, _keys(each))
        for each in (Smooth, Step, Ramp, Bump, Pothole, Joint, Camber)
    },
}


def from_table(table: Table | list[Table]) -> Road:
    """A road from a table of plain values, such as ``[road]`` of a case file.

    Parameters
    ----------
    table : mapping or list of mapping
        Its ``kind`` (``"smooth"``, ``"iso-8608"``, ``"bridge-study"``, ``"profile"``, ``"step"``,
        ``"ramp"``, ``"bump"``, ``"pothole"``, ``"joint"`` or ``"camber"``), and beside it the
        arguments of that road: of ``"iso-8608"`` a ``class``, ``G`` or ``iri``, of
        ``"bridge-study"`` a ``condition``, of ``"profile"`` the points or a ``file`` with the
        arguments of `Profile.read`. A list of tables is the sum of their roads.

    Returns
    -------
    Road
        The road; its `arguments` make it again.

    Raises
    ------
    ValueError
        If a kind, key or value is not allowed, naming it and what is.
    OSError
        If a file cannot be read.

    Examples
    --------
    >>> road = from_table({"kind": "iso-8608", "class": "B", "seed": 1})
    >>> bumpy = from_table([road.arguments, {"kind": "step", "at": 0.0, "height": 0.01}])
    """
    if isinstance(table, list | tuple):
        roads = []
        for k, each in enumerate(table):
            with _errors_in(f"road[{k}]"):
                roads.append(road_of(each))
        return total(roads)
    with _errors_in("road"):
        return road_of(table)


def road_of(table: object, elsewhere: Callable[[str], str] = lambda key: "") -> Road:
    """The road of one table; `elsewhere` says where a key belongs that no road has."""
    if not isinstance(table, Mapping):
        raise ValueError(f"{shown(table)}: must be a table with a kind")
    if "kind" not in table:
        raise ValueError(f"missing kind; allowed: {', '.join(KINDS)}")
    kind = word("kind", table["kind"], *KINDS)
    if kind not in KINDS:
        allowed = f"must be one of {', '.join(KINDS)}{suggestion(kind, KINDS)}"
        raise ValueError(f"kind = {shown(kind)}: {allowed}")
    make, keys = KINDS[kind]
    given = {key: value for key, value in table.items() if key != "kind"}
    keys.check_known(given, lambda key: _beside(key, kind) or elsewhere(key))
    keys.check_complete(given)
    return make(**given)


def _beside(key: str, kind: str) -> str:
    """That a key is one of other kinds of roads, or nothing."""
    if key == "road_class":
        return " (did you mean 'class'?)"
    kinds = [each for each, (_, keys) in KINDS.items() if key in keys.allowed]
    return f" (not beside kind = {kind!r}, but {' and '.join(kinds)})" if kinds else ""


@contextmanager
def _errors_in(where: str) -> Iterator[None]:
    """Says where a refused value stands."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from None
