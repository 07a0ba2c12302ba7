"""Turns what the user passed into plain numbers, naming the key when that cannot be done."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence, Sized
from collections.abc import Set as AbstractSet
from itertools import islice
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeGuard, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from spanwise._keys import alike, suggestion
from spanwise._shown import LONGEST
from spanwise._shown import shown as shown
from spanwise.errors import InputError, refused, wrong_kind

if TYPE_CHECKING:
    from pathlib import Path

Name = TypeVar("Name")
T = TypeVar("T")

Numbers: TypeAlias = float | Iterable[float]

#: Most values in a list, and in an array: what never ends is told before it takes all memory.
MOST_LISTED: Final = 1_000_000
MOST_IN_ARRAY: Final = 100_000_000


def number(key: str, value: object) -> float:
    """One real number as a float."""
    value = _unwrapped(value)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise refused(key, value, "must be a number")
    try:
        found = float(value)
    except OverflowError:
        raise refused(key, value, "is too large") from None
    return found


def finite(key: str, value: object) -> float:
    """One finite real number as a float; refused in the words of the core, as the two below."""
    return _limited(key, value, math.isfinite, "must be a finite number")


def positive(key: str, value: object) -> float:
    """One finite real number above 0 as a float."""
    return _limited(key, value, lambda x: 0.0 < x < math.inf, "must be finite and greater than 0")


def not_negative(key: str, value: object) -> float:
    """One finite real number, 0 or more, as a float."""
    return _limited(key, value, lambda x: 0.0 <= x < math.inf, "must be finite and 0 or more")


def _limited(key: str, value: object, is_allowed: Callable[[float], bool], allowed: str) -> float:
    found = number(key, value)
    if not is_allowed(found):
        raise InputError(key, _plain(found), allowed)
    return found


def _plain(value: float) -> str:
    """As the core writes it."""
    return "NaN" if math.isnan(value) else repr(value).removesuffix(".0")


def numbers(key: str, value: object) -> list[float]:
    """One real number or several, as a list of floats."""
    value = _unwrapped(value)
    if isinstance(value, Real):
        return [number(key, value)]
    return [
        each if type(each) is float else number(f"{key}[{i}]", each)
        for i, each in enumerate(items(key, value, "a number or a list of numbers"))
    ]


def whole(key: str, value: object) -> int:
    """One whole number."""
    value = _unwrapped(value)
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise refused(key, value, "must be a whole number")
    return int(value)


def whole_from(key: str, value: object, least: int, most: int) -> int:
    """One whole number within limits."""
    found = whole(key, value)
    if not least <= found <= most:
        raise refused(key, found, f"must be from {least} to {most}")
    return found


def count(key: str, value: object) -> int:
    """One whole number that is not negative."""
    found = whole(key, value)
    if found < 0:
        raise refused(key, found, "must not be negative")
    if found > sys.maxsize:
        raise refused(key, found, f"is too large, must be at most {sys.maxsize}")
    return found


def counts(key: str, value: object) -> list[int]:
    """One whole number or several, as a list."""
    value = _unwrapped(value)
    if not is_list(value):
        return [count(key, value)]
    return [count(f"{key}[{i}]", each) for i, each in enumerate(items(key, value))]


def flag(key: str, value: object) -> bool:
    """True or false."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise refused(key, value, "must be true or false")


def word(key: str, value: object, *options: str) -> str:
    """A piece of text; whether it is one of the options is left to who reads it."""
    if isinstance(value, str) and len(value) <= LONGEST and value.isprintable():
        return value
    allowed = " or ".join(filter(None, (", ".join(options[:-1]), *options[-1:]))) or "text"
    raise refused(key, value, f"must be {allowed}")


def choice(key: str, value: object, options: Iterable[str]) -> str:
    """One of several words, which the message names with the one that may have been meant."""
    allowed = [*options]
    if not isinstance(value, str) or value not in allowed:
        near = suggestion(value, allowed)
        raise refused(key, value, f"must be one of {', '.join(allowed)}{near}")
    return str(value)


def one_of(key: str, value: object, options: Sequence[str]) -> str:
    """One of a few words."""
    if not isinstance(value, str) or value not in options:
        allowed = f"{', '.join(options[:-1])} or {options[-1]}"
        raise refused(key, value, f"must be {allowed}")
    return value


def named(key: str, value: Name, options: Iterable[str]) -> Name:
    """The option that is meant, with hyphens or underscores, in singular or plural."""
    allowed = [*options]
    meant = alike(value, allowed)
    choice(key, meant, allowed)
    return cast("Name", meant)


def text(key: str, value: object) -> str:
    """A piece of text of any kind."""
    if not isinstance(value, str):
        raise refused(key, value, "must be text")
    return value


def mapping(key: str, value: object, what: str = "a mapping") -> Mapping[Any, Any]:
    """A table of values by name."""
    if not isinstance(value, Mapping):
        raise refused(key, value, f"must be {what}")
    return value


def of_kind(key: str, value: object, kind: type[T], what: str) -> T:
    """An object of a class."""
    if not isinstance(value, kind):
        raise wrong_kind(key, value, f"must be {what}")
    return value


def file_path(key: str, value: object) -> Path:
    """Where a file or a folder is."""
    from pathlib import Path  # which takes as long to import as all of this package's roads

    if not isinstance(value, str | os.PathLike):
        raise wrong_kind(key, value, "must be a path")
    try:
        path = Path(value)
        if b"\0" in os.fsencode(path):
            raise ValueError
    except (TypeError, ValueError):  # a path of bytes, or characters that no file name has
        raise refused(key, value, "is not the name of a file") from None
    return path


def pair(key: str, value: object, what: str = "a pair") -> tuple[Any, Any]:
    """Two values in an order."""
    is_row = isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim > 0)
    if not is_row or len(value) != 2:  # type: ignore[arg-type]
        raise refused(key, value, f"must be {what}")
    return value[0], value[1]  # type: ignore[index]


def pairs(key: str, value: object) -> list[tuple[object, object]]:
    """A list of pairs."""
    return [
        pair(f"{key}[{i}]", each) for i, each in enumerate(items(key, value, "a list of pairs"))
    ]


def array(key: str, value: object) -> NDArray[np.float64]:
    """Finite real numbers as an array of any shape."""
    values = as_array(key, value)
    if values.dtype.kind not in "iuf":
        raise refused(key, value, "must be a number or an array of numbers")
    refuse_where(~np.isfinite(values), key, values, "must be finite")
    with np.errstate(over="ignore"):
        found = values.astype(np.float64)
    if values.dtype.itemsize > 8:
        refuse_where(~np.isfinite(found), key, values, "is too large")
    return found


def as_array(key: str, value: object) -> NDArray[Any]:
    """An array of whatever it is, of objects where it is no array."""
    _refuse_too_large(key, value)
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise refused(key, value, "must have no masked values")
    try:
        return np.asarray(value)
    except Exception:  # rows of different lengths, or an object that says that it is an array
        return np.array(None)


def _refuse_too_large(key: str, value: object) -> None:
    """Refuses what an array cannot be made of in time, such as a range without end."""
    size = value.size if isinstance(value, np.ndarray) else 0
    if isinstance(value, Sized) and not isinstance(value, np.ndarray | str | bytes):
        try:
            size = len(value)
            if size <= MOST_IN_ARRAY and isinstance(value, list | tuple):
                size += sum(map(_size, value))
        except Exception:  # refused as what it is, no array
            size = 0
    if size > MOST_IN_ARRAY:
        raise refused(key, value, f"has more than {MOST_IN_ARRAY} values")


def _size(value: object) -> int:
    """How many values there are in a row."""
    if isinstance(value, float | int):
        return 0
    if isinstance(value, np.ndarray):
        return value.size
    return len(value) if isinstance(value, Sized) else 0


def refuse_where(
    wrong: NDArray[np.bool_], key: str, values: NDArray[Any], allowed: str, unit: str = ""
) -> None:
    """Refuses the first of the wrong values, which it names with its place: ``key[3] = -1``."""
    if wrong.any():
        place = tuple(map(int, np.argwhere(wrong)[0]))
        index = f"[{', '.join(map(str, place))}]" if place else ""
        raise InputError(f"{key}{index}", f"{values[place]:g}{unit}", allowed)


def is_list(value: object) -> TypeGuard[Iterable[object]]:
    """Whether it is of several values in an order."""
    text_or_unordered = (str, bytes, Mapping, AbstractSet)
    return isinstance(value, Iterable) and not isinstance(value, text_or_unordered)


def items(key: str, value: object, what: str = "a list") -> list[Any]:
    """The values of a list, or of what else is gone through in an order and has an end."""
    if not is_list(value):
        raise refused(key, value, f"must be {what}")
    try:
        long = isinstance(value, Sized) and len(value) > MOST_LISTED
        found = [] if long else [*islice(value, MOST_LISTED + 1)]
    except Exception as error:
        said = f"must be {what}; it cannot be gone through: {error}"
        raise refused(key, value, said) from error
    if long or len(found) > MOST_LISTED:
        raise refused(key, value, f"must have at most {MOST_LISTED} values")
    return found


def _unwrapped(value: object) -> Any:
    """The number in an array without dimensions."""
    return value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value
