"""How messages write the arguments of `Profile.read`: as options where a command has these."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

#: Options of a command, by the arguments that they give; empty where arguments are given as such.
_OPTIONS: Final[ContextVar[Mapping[str, str]]] = ContextVar("_OPTIONS", default={})  # noqa: B039


@contextmanager
def written_as(options: Mapping[str, str]) -> Iterator[None]:
    """Messages name options in place of the arguments that they give."""
    token = _OPTIONS.set(options)
    try:
        yield
    finally:
        _OPTIONS.reset(token)


def called(argument: str) -> str:
    """What an argument is called."""
    return _OPTIONS.get().get(argument, argument)


def given(argument: str, value: str | float | list[float]) -> str:
    """An argument with a value, as it is to be written; in Python and in a case file alike."""
    option = _OPTIONS.get().get(argument)
    if option is None:
        return f"{argument} = {value!r}"
    values = value if isinstance(value, list) else [value]
    words = [each if isinstance(each, str) else f"{each:g}" for each in values]
    return shlex.join([option, *words])
