"""Objects as tables of plain values, and tables as TOML."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from spanwise._value import same

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


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


def toml(tables: Mapping[str, Any]) -> str:
    """Tables by name as TOML."""
    return "\n".join(_lines(tables, "")).lstrip("\n")


def _lines(table: Mapping[str, Any], name: str) -> Iterator[str]:
    """The values of a table, but None, then each table in it after a blank line and its name."""
    inner = {key: each for key, each in table.items() if _is_table(each) or _is_tables(each)}
    plain = {key: each for key, each in table.items() if key not in inner and each is not None}
    yield from (f"{key} = {toml_value(each)}" for key, each in plain.items())
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
