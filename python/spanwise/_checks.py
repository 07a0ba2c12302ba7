"""Turns what the user passed into plain numbers, naming the key when that cannot be done."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from numbers import Integral, Real
from typing import Any, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import NDArray

Numbers: TypeAlias = float | Iterable[float]

#: Longest text of an offending value in a message.
_SHOWN = 80


def shown(value: object) -> str:
    """The value as text on one line, cut where it is long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."


def number(key: str, value: object) -> float:
    """One real number as a float."""
    value = _unwrapped(value)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"{key} = {shown(value)}: must be a number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{key} = {shown(value)}: is too large") from None


def finite(key: str, value: object) -> float:
    """One finite real number as a float; refused in the words of the core, as the two below."""
    found = number(key, value)
    if not math.isfinite(found):
        raise ValueError(f"{key} = {_plain(found)}: must be a finite number")
    return found


def positive(key: str, value: object) -> float:
    """One finite real number above 0 as a float."""
    found = number(key, value)
    if not (math.isfinite(found) and found > 0.0):
        raise ValueError(f"{key} = {_plain(found)}: must be finite and greater than 0")
    return found


def not_negative(key: str, value: object) -> float:
    """One finite real number, 0 or more, as a float."""
    found = number(key, value)
    if not (math.isfinite(found) and found >= 0.0):
        raise ValueError(f"{key} = {_plain(found)}: must be finite and 0 or more")
    return found


def _plain(value: float) -> str:
    """As the core writes it."""
    return "NaN" if math.isnan(value) else repr(value).removesuffix(".0")


def numbers(key: str, value: object) -> list[float]:
    """One real number or several, as a list of floats."""
    value = _unwrapped(value)
    if isinstance(value, Real):
        return [number(key, value)]
    if is_list(value):
        return [number(f"{key}[{i}]", each) for i, each in enumerate(value)]
    raise ValueError(f"{key} = {shown(value)}: must be a number or a list of numbers")


def whole(key: str, value: object) -> int:
    """One whole number."""
    value = _unwrapped(value)
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise ValueError(f"{key} = {shown(value)}: must be a whole number")
    return int(value)


def count(key: str, value: object) -> int:
    """One whole number that is not negative."""
    found = whole(key, value)
    if found < 0:
        raise ValueError(f"{key} = {shown(value)}: must not be negative")
    if found > sys.maxsize:
        raise ValueError(f"{key} = {shown(value)}: is too large, must be at most {sys.maxsize}")
    return found


def counts(key: str, value: object) -> list[int]:
    """One whole number or several, as a list."""
    value = _unwrapped(value)
    if is_list(value):
        return [count(f"{key}[{i}]", each) for i, each in enumerate(value)]
    return [count(key, value)]


def flag(key: str, value: object) -> bool:
    """True or false."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise ValueError(f"{key} = {shown(value)}: must be true or false")


def word(key: str, value: object, *options: str) -> str:
    """A piece of text; whether it is one of the options is left to who reads it."""
    if isinstance(value, str):
        return value
    allowed = " or ".join(filter(None, (", ".join(options[:-1]), *options[-1:]))) or "text"
    raise ValueError(f"{key} = {shown(value)}: must be {allowed}")


def pairs(key: str, value: object) -> list[tuple[object, object]]:
    """A list of pairs."""
    if is_list(value):
        found = []
        for i, each in enumerate(value):
            if not isinstance(each, list | tuple | np.ndarray) or len(each) != 2:
                raise ValueError(f"{key}[{i}] = {shown(each)}: must be a pair")
            found.append((each[0], each[1]))
        return found
    raise ValueError(f"{key} = {shown(value)}: must be a list of pairs")


def array(key: str, value: object) -> NDArray[np.float64]:
    """Finite real numbers as an array of any shape."""
    try:
        values = np.asarray(value)
    except ValueError:  # rows of different lengths
        values = np.array(None)
    if values.dtype.kind not in "iuf":
        raise ValueError(f"{key} = {shown(value)}: must be a number or an array of numbers")
    wrong = ~np.isfinite(values)
    if wrong.any():
        raise ValueError(f"{first_of(key, values, wrong)}: must be finite")
    return values.astype(np.float64)


def first_of(key: str, values: NDArray[Any], wrong: NDArray[np.bool_]) -> str:
    """The first of the wrong values and its place: ``key[3] = -1``."""
    place = tuple(map(int, np.argwhere(wrong)[0]))
    index = f"[{', '.join(map(str, place))}]" if place else ""
    return f"{key}{index} = {values[place]:g}"


def is_list(value: object) -> TypeGuard[Iterable[object]]:
    """Whether it is of several values in an order."""
    text_or_unordered = (str, bytes, Mapping, AbstractSet)
    return isinstance(value, Iterable) and not isinstance(value, text_or_unordered)


def _unwrapped(value: object) -> Any:
    """The number in an array without dimensions."""
    return value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value
