"""Turns what the user passed into plain numbers, naming the key when that cannot be done."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Integral, Real
from typing import TypeAlias

Numbers: TypeAlias = float | Iterable[float]


def number(key: str, value: object) -> float:
    """One real number as a float."""
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    raise ValueError(f"{key} = {value!r}: must be a number")


def numbers(key: str, value: object) -> list[float]:
    """One real number or several, as a list of floats."""
    if isinstance(value, Real) and not isinstance(value, bool):
        return [float(value)]
    if isinstance(value, Iterable) and not isinstance(value, str | bytes | dict):
        return [number(f"{key}[{i}]", each) for i, each in enumerate(value)]
    raise ValueError(f"{key} = {value!r}: must be a number or a list of numbers")


def count(key: str, value: object) -> int:
    """One whole number that is not negative."""
    if isinstance(value, Integral) and not isinstance(value, bool) and value >= 0:
        return int(value)
    raise ValueError(f"{key} = {value!r}: must be a whole number, 0 or more")


def counts(key: str, value: object) -> list[int]:
    """One whole number or several, as a list."""
    if isinstance(value, Iterable) and not isinstance(value, str | bytes | dict):
        return [count(f"{key}[{i}]", each) for i, each in enumerate(value)]
    return [count(key, value)]


def word(key: str, value: object) -> str:
    """A piece of text."""
    if isinstance(value, str):
        return value
    raise ValueError(f"{key} = {value!r}: must be text")


def pairs(key: str, value: object) -> list[tuple[object, object]]:
    """A list of pairs."""
    if isinstance(value, Iterable) and not isinstance(value, str | bytes | dict):
        found = []
        for i, each in enumerate(value):
            if not isinstance(each, list | tuple) or len(each) != 2:
                raise ValueError(f"{key}[{i}] = {each!r}: must be a pair")
            found.append((each[0], each[1]))
        return found
    raise ValueError(f"{key} = {value!r}: must be a list of pairs")
