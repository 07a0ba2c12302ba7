"""Results as plain values, such as JSON can hold, and back."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any, Final

import numpy as np

from spanwise._checks import shown

#: Most tables and lists within each other.
MAX_DEPTH: Final = 32


def from_plain(value: Any, name: str = "tables", depth: int = 0) -> Any:
    """The tables with infinity in place of its name; `name` is that of the value."""
    if isinstance(value, Mapping | list | tuple) and depth > MAX_DEPTH:
        raise ValueError(f"{name} = {shown(value)}: has more than {MAX_DEPTH} levels")
    if isinstance(value, Mapping):
        before = f"{name}." if depth else ""
        return {
            key: from_plain(each, f"{before}{key}" if isinstance(key, str) else name, depth + 1)
            for key, each in value.items()
        }
    if isinstance(value, list | tuple):
        return [from_plain(each, name, depth + 1) for each in value]
    return math.inf if isinstance(value, str) and value == "inf" else value


def plain(value: object) -> Any:
    """The value in lists, dictionaries, numbers and text; NaN as None, infinity as text."""
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, Integral):
        return int(value)
    if not isinstance(value, Real):
        raise TypeError(f"{value!r} has no plain value")
    number = float(value)
    if np.isfinite(number):
        return number
    return None if np.isnan(number) else str(number)


def json_lines(table: Mapping[str, Any]) -> str:
    """A table as JSON, with a line for each key."""
    lines = (
        f"{json.dumps(key)}: {json.dumps(value, allow_nan=False)}" for key, value in table.items()
    )
    return "{\n" + ",\n".join(lines) + "\n}\n"
