"""What values have in common: equal where their parts are, with a short text of them."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import MISSING, fields
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Array: TypeAlias = NDArray[np.float64]

#: Most parts of a list that a text shows, and most characters of what it shows of one.
PARTS: Final = 4
CHARACTERS: Final = 160


def same(a: object, b: object) -> bool:
    """Whether two are equal; arrays, and lists of any kind, by their values, and NaN to itself."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        try:
            left, right = np.asarray(a), np.asarray(b)
        except ValueError:  # rows of different lengths
            return False
        if left.shape != right.shape:
            return False
        both_real = left.dtype.kind in "iuf" and right.dtype.kind in "iuf"
        return bool(np.array_equal(left, right, equal_nan=both_real))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, float) and isinstance(b, float) and a != a:
        return b != b
    return bool(a == b)


def key(value: object) -> Hashable:
    """Something to hash that is alike for all that are the `same`."""
    if isinstance(value, np.ndarray):
        return key(value.tolist())
    if isinstance(value, Mapping):
        return frozenset((each, key(value[each])) for each in value)
    if isinstance(value, list | tuple):
        return tuple(map(key, value))
    if isinstance(value, float) and value != value:
        return "nan"
    assert isinstance(value, Hashable)
    return value


def brief(value: object) -> str:
    """A short text of a value: the shape of an array, the beginning and the length of a list."""
    if isinstance(value, np.ndarray):
        if value.ndim == 0:
            return repr(value.item())
        return f"{value.dtype} array {value.shape}"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{each!r}: {brief(value[each])}' for each in value)}}}"
    if isinstance(value, list | tuple) and value:
        left, right = ("[", "]") if isinstance(value, list) else ("(", ")")
        parts = [brief(each) for each in value[:PARTS]]
        if len(value) <= PARTS and sum(map(len, parts)) <= CHARACTERS:
            return (
                f"{left}{', '.join(parts)}{',' if parts[1:] == [] and left == '(' else ''}{right}"
            )
        few = parts[:2] if sum(map(len, parts[:2])) <= CHARACTERS // 2 else parts[:1]
        return f"{left}{', '.join(few)}, ... {len(value)} in all{right}"
    return repr(value)


def frozen(values: Array) -> Array:
    """The array, kept from being changed by mistake: others read it too."""
    values.setflags(write=False)
    return values


class Brief:
    """A dataclass whose text leaves out what is as by default, and arrays and long lists."""

    def __repr__(self) -> str:
        given = []
        for each in fields(cast("DataclassInstance", self)):
            value = getattr(self, each.name)
            default = each.default
            if each.repr and (default is MISSING or not same(value, default)):
                given.append(f"{each.name}={brief(value)}")
        return f"{type(self).__name__}({', '.join(given)})"


class Value(Brief):
    """A dataclass with arrays that is equal to another where all parts are."""

    def _parts(self) -> Iterator[Any]:
        """What is compared."""
        for each in fields(cast("DataclassInstance", self)):
            if each.compare:
                yield getattr(self, each.name)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        assert isinstance(other, Value)
        return all(map(same, self._parts(), other._parts()))

    # What holds large arrays is not looked up by them.
    __hash__ = None  # type: ignore[assignment]


class Hashed(Value):
    """A value small enough to be looked up by."""

    def __hash__(self) -> int:  # type: ignore[override]
        return hash((type(self), *map(key, self._parts())))
