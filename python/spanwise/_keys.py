"""Which keys a table of a case file may have: those that the function it goes to accepts."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import wraps
from inspect import Parameter, signature
from typing import Any, Final, TypeVar, cast

from spanwise._shown import LONGEST, shown

T = TypeVar("T")


@dataclass(frozen=True)
class Keys:
    """Keys of one table.

    Attributes
    ----------
    allowed : tuple of str
        All of them, in the order of the function's signature.
    required : tuple of str
        Those without a default.
    """

    allowed: tuple[str, ...]
    required: tuple[str, ...] = ()

    @classmethod
    def of(cls, function: Callable[..., Any]) -> Keys:
        """The keyword-only arguments of a function or class."""
        found = [p for p in signature(function).parameters.values() if p.kind is p.KEYWORD_ONLY]
        required = [p.name for p in found if p.default is Parameter.empty]
        return cls(tuple(p.name for p in found), tuple(required))

    def check_known(self, table: Mapping[Any, object], hint: Callable[[str], str]) -> None:
        """Refuse unknown keys, with a hint or else the nearest known key."""
        for key in table:
            if key not in self.allowed:
                help_ = (hint(key) if isinstance(key, str) else "") or suggestion(key, self.allowed)
                raise ValueError(
                    f"unknown key {shown(key)}{help_}; allowed: {', '.join(self.allowed)}"
                )

    def check_complete(self, table: Mapping[str, object]) -> None:
        """Refuse a table in which a required key is missing."""
        missing = [key for key in self.required if key not in table]
        if missing:
            raise ValueError(f"missing {', '.join(missing)}")


def suggesting(target: T) -> T:
    """A function or a class that suggests the nearest keyword for one that it does not have."""
    function: Any = vars(target)["__init__"] if isinstance(target, type) else target
    known = [*signature(function).parameters]
    name = getattr(target, "__qualname__", "")

    @wraps(function)
    def checked(*given: Any, **named: Any) -> Any:
        for key in named:
            if key not in known:
                said = f"{name}() got an unexpected keyword argument {key!r}"
                raise TypeError(said + suggestion(key, known))
        return function(*given, **named)

    if not isinstance(target, type):
        return cast("T", checked)
    setattr(target, "__init__", checked)  # noqa: B010
    return target


def alike(name: object, known: Iterable[str]) -> object:
    """The known name that differs in no more than hyphens and a plural s, or what was given."""

    def bare(each: str) -> str:
        return each.lower().replace("_", "-").replace(" ", "-").removesuffix("s")

    if not isinstance(name, str):
        return name
    return next((each for each in known if bare(each) == bare(name)), name)


#: How alike a word must be to be meant, each of several, one of them that is a number, one of
#: several, and all written as one.
_ALIKE: Final = 0.6
_EACH_ALIKE: Final = 0.75
_DIGITS_ALIKE: Final = 0.5
_ONE_ALIKE: Final = 0.9
_WHOLE_ALIKE: Final = 0.8


def suggestion(word: object, known: Iterable[str]) -> str:
    """`` (did you mean ...?)`` with the nearest known word, or nothing.

    Word by word, so that "very poor" is not taken for "very good": of several words all must be
    alike. Failing that, a known word that is among them: "poor".
    """
    if not isinstance(word, str) or len(word) > LONGEST:
        return ""
    by_words = {_words(each): each for each in known}
    given = _words(word)
    near = max(by_words, key=lambda each: _likeness(given, each), default=())
    if _likeness(given, near) == 0.0:
        single = (each for each in by_words if len(each) == 1)
        near = next((each for each in single if _is_among(each[0], given)), ())
    return f" (did you mean {by_words[near]!r}?)" if near else ""


def _words(text: str) -> tuple[str, ...]:
    return tuple(re.split(r"[\s_-]+", text.lower()))


def _is_among(word: str, given: tuple[str, ...]) -> bool:
    return len(given) > 1 and any(_ratio(word, each) >= _ONE_ALIKE for each in given)


def _likeness(given: tuple[str, ...], known: tuple[str, ...]) -> float:
    """From 0 to 1, and 0 if they are not alike enough to be meant."""
    whole = _ratio("".join(known), "".join(given))
    if len(given) == len(known):
        enough = all(
            _ratio(each, word)
            >= (_ALIKE if len(given) == 1 else _DIGITS_ALIKE if each.isdigit() else _EACH_ALIKE)
            for each, word in zip(known, given, strict=True)
        )
    else:
        enough = whole >= _WHOLE_ALIKE
    return whole if enough else 0.0


def _ratio(known: str, given: str) -> float:
    return SequenceMatcher(None, known, given).ratio()
