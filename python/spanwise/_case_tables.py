"""The tables of a case: which there are, where a key belongs, and values set by their keys."""

from __future__ import annotations

import re
from collections.abc import Mapping
from copy import deepcopy
from typing import Any, Final

from spanwise._build import Maker, Place, Table, check_known
from spanwise._casefile import CaseError, parse_toml
from spanwise._checks import shown
from spanwise._conditions import Crossing
from spanwise._keys import suggestion
from spanwise._plan_of_arguments import Asked
from spanwise.errors import InputError, refused
from spanwise.schema import Places, belong, belongs, places

#: Tables, as they are written.
TABLES: Final = {
    **{name: f"[{name}]" for name in ("bridge", "vehicle", "road", "crossing", "ensemble")},
    **{name: f"[[{name}]]" for name in ("traffic", "events")},
}

#: The road has a table of its own.
CROSSING: Final = Maker(Crossing)
SAMPLING: Final = Maker(Asked, without=("road",))

#: A key from the case on: names, each after a point, and numbers in brackets.
_KEY: Final = re.compile(r"[^\W\d][\w-]*(?:\.[^\W\d][\w-]*|\[\d{1,9}\])*")
_STEP: Final = re.compile(r"[^\W\d][\w-]*|\d+")

#: How values begin that are meant to be TOML; what else is none is a word.
_TOML: Final = ('"', "'", "[", "{")


def check_tables(tables: Table) -> None:
    """Refuses what is no table of a case."""
    check_known(tables, [*TABLES], Place(home=home), "table or key")
    for name, table in tables.items():
        several = isinstance(table, list) and len(table) > 0 and isinstance(table[0], Mapping)
        if name == "traffic" and not several:
            raise refused("traffic", table, "must be tables, [[traffic]]")
        many = name in ("traffic", "events") or (name == "road" and several)
        if not many and not isinstance(table, Mapping):
            raise refused(name, table, f"must be a table, {TABLES[name]}")


def check_complete(tables: Table) -> None:
    """Refuses tables that are not enough for a case, or too many."""
    who = [name for name in ("vehicle", "traffic", "events") if name in tables]
    if len(who) > 1:
        key = f"{TABLES[who[0]]} and {TABLES[who[1]]}"
        raise InputError(key, None, "give one of the two")
    how = "ensemble" if "ensemble" in tables else "crossing"
    missing = [name for name in ("bridge", *(who or ["vehicle"]), how) if name not in tables]
    if missing:
        needs = "a case has [bridge], [vehicle] or [[traffic]], and [crossing] or [ensemble]"
        said = f"missing {', '.join(TABLES[name] for name in missing)}; {needs}"
        raise InputError("", None, said)


def home(key: str) -> str:
    """Where a key belongs that was found in a table without such a key, or nothing."""
    if key in TABLES and key != "vehicle":
        return f" (a table of its own, {TABLES[key]})"
    return belongs(key, _places())


def _places() -> Places:
    own = SAMPLING.keys.keys() - CROSSING.keys.keys()
    return {
        **places(),
        "crossing": {"[crossing]": CROSSING.keys},
        "ensemble": {"[ensemble]": own},
    }


def assignment(text: str, table: str) -> tuple[str, Any]:
    """Key and value of ``key=value``; a key without a table is of this one, or that which has it.

    Raises
    ------
    ValueError
        If it is none, or several tables have the key.
    """
    key, equals, value = text.partition("=")
    key = key.strip()
    if not equals or not _KEY.fullmatch(key):
        example = "such as crossing.speed=25 or vehicle.bodies[0].mass=9e3"
        raise InputError(shown(text), None, f"must be key=value, {example}")
    return _with_table(key, table), value_of(value)


def _with_table(key: str, table: str) -> str:
    name = _STEP.findall(key)[0]
    if name in TABLES:
        return key
    keys = SAMPLING.keys if table == "ensemble" else _places()[table][TABLES[table]]
    if name in keys:
        return f"{table}.{key}"
    found = belong(name, _places())
    if len(found) == 1 and found[0] in TABLES.values():
        return f"{found[0].strip('[]')}.{key}"
    known = {each for own in _places().values() for keys in own.values() for each in keys}
    known |= TABLES.keys() if "." in key else set()
    said = home(name) or suggestion(name, known)
    raise InputError(key, None, f"in which table?{said}; give that too, as in crossing.speed=25")


def value_of(text: str) -> Any:
    """The value that a text is in TOML, a number, or else the text itself."""
    try:
        table = parse_toml(f"value = {text}", text)
    except CaseError:
        if text.lstrip().startswith(_TOML):
            raise InputError(
                shown(text),
                None,
                'is not a value in TOML, where words in lists have quotes: ["a", "b"]',
            ) from None
        try:
            return float(text)  # .5 and 25. are none in TOML
        except ValueError:
            return {"True": True, "False": False}.get(text, text)
    return table["value"] if len(table) == 1 else text


class OfClass(dict[str, Any]):
    """A random road of another class: a table that keeps the seed of the one that it replaces."""

    def __init__(self, letter: str) -> None:
        super().__init__(kind="iso-8608")
        self["class"] = letter

    def after(self, road: Any) -> dict[str, Any]:
        """The table that stands in place of a road, or of the parts of one."""
        parts = road if isinstance(road, list) else [road]
        seeds = [each["seed"] for each in parts if isinstance(each, Mapping) and "seed" in each]
        return {**self, **({"seed": seeds[0]} if seeds else {})}


def assigned(tables: Table, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The tables with values in place of theirs, by keys such as ``vehicle.bodies[0].mass``."""
    changed = deepcopy({**tables})
    for key, value in settings.items():
        if not _KEY.fullmatch(str(key)):
            raise InputError(shown(key), None, "must be table and key, such as crossing.speed")
        if isinstance(value, OfClass):
            value = value.after(changed.get(key))
        _assign(changed, key, deepcopy(value))
    return changed


def _assign(tables: Any, key: str, value: Any) -> None:
    found, name = tables, ""
    steps = list(_STEP.finditer(key))
    for k, each in enumerate(steps):
        number = each[0].isdecimal()
        step: Any = int(each[0]) if number else each[0]
        if number and not isinstance(found, list):
            raise InputError(key, None, f"{name} is {'no list' if found else 'not in the case'}")
        if number and step >= len(found):
            raise InputError(key, None, f"{name} has {len(found)}, counted from 0")
        if not number and isinstance(found, list):
            raise InputError(key, None, f"{name} is a list; name one of it, as {name}[0].{step}")
        if not number and not isinstance(found, dict):
            raise InputError(key, None, f"{name} = {shown(found)} is no table; give all of {name}")
        if k == len(steps) - 1:
            found[step] = value
        else:
            found = found[step] if number else found.setdefault(step, {})
        name = key[: each.end() + number]
