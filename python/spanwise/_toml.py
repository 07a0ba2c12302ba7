"""Objects as tables of plain values, and tables as TOML."""

from __future__ import annotations

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
    given = {each.name: getattr(made, each.name) for each in fields(made)}
    usual = {} if defaults else {each.name: each.default for each in fields(made)}
    return table | {
        key: _plain(value, defaults)
        for key, value in given.items()
        if not any(same(value, each) for each in (None, (), usual.get(key)))
    }


def _plain(value: Any, defaults: bool) -> Any:
    if hasattr(value, "arguments"):  # a road, which knows better
        return value.arguments
    if is_dataclass(value) and not isinstance(value, type):
        return table_of(value, defaults=defaults)
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(each, defaults) for each in value] if isinstance(value, list | tuple) else value


def toml(table: Mapping[str, Any]) -> str:
    """A table of tables as TOML."""
    return "\n".join(_lines(table, "")).lstrip("\n")


def _lines(table: Mapping[str, Any], name: str) -> Iterator[str]:
    """The values of a table, but None, then each table in it after a blank line and its name."""
    inner = {key: tables for key, each in table.items() if (tables := _tables(each))}
    for key, each in table.items():
        if key not in inner and each is not None:
            yield f"{key} = {toml_value(each)}"
    for key, tables in inner.items():
        path = f"{name}.{key}" if name else key
        for one in tables:
            if tables is table[key]:
                yield from ("", f"[[{path}]]")
            elif not one or not all(map(_tables, one.values())):
                yield from ("", f"[{path}]")
            yield from _lines(one, path)


def _tables(value: object) -> list[Any]:
    """The tables that a value is, or none."""
    if isinstance(value, list):
        return value if all(isinstance(each, Mapping) for each in value) else []
    return [value] if isinstance(value, Mapping) else []


def toml_value(value: Any) -> str:
    """A value as TOML, a table on one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {toml_value(value[key])}' for key in value)} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, str | bool):
        import json

        return json.dumps(value)
    return repr(value)
