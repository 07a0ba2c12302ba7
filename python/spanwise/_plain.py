"""Results as plain values, such as JSON can hold."""

from __future__ import annotations

import json
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any

import numpy as np


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
