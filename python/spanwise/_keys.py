"""Which known name is meant by one that is not known."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import wraps
from typing import Any, Final, TypeVar, cast

from spanwise._shown import LONGEST, shown

T = TypeVar("T")


def suggesting(target: T) -> T:
    """A function or a class that suggests the nearest keyword for one that it does not have.

    Of what is given by position and goes by name, it says by which.
    """
    function: Any = vars(target)["__init__"] if isinstance(target, type) else target
    # Not by `inspect`, which takes long for what is done for every class on import.
    code = getattr(function, "__wrapped__", function).__code__
    known = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    placed, named_only = known[: code.co_argcount], known[code.co_argcount :]
    name = getattr(target, "__qualname__", "")

    @wraps(function)
    def checked(*given: Any, **named: Any) -> Any:
        for key in named:
            if key not in known:
                said = f"{name}() got an unexpected keyword argument {key!r}"
                raise TypeError(said + suggestion(key, known))
        if named_only and len(given) > len(placed):
            first = " and ".join(each for each in placed if each != "self")
            what = f"{first} by position and the rest" if first else "all arguments"
            meant = f"{named_only[0]}={shown(given[len(placed)])}"
            raise TypeError(f"{name}() takes {what} by name: write {meant}")
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
    from difflib import SequenceMatcher  # seldom needed

    return SequenceMatcher(None, known, given).ratio()
