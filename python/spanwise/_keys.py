"""Which keys a table of a case file may have: those that the function it goes to accepts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from inspect import Parameter, signature
from typing import Any

from spanwise._shown import LONGEST, shown


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


def suggestion(word: object, known: Iterable[str]) -> str:
    """`` (did you mean ...?)`` with the nearest known word, or nothing."""
    if not isinstance(word, str) or len(word) > LONGEST:
        return ""
    by_lower = {each.lower(): each for each in known}
    near = get_close_matches(word.lower(), by_lower, n=1)
    return f" (did you mean {by_lower[near[0]]!r}?)" if near else ""
