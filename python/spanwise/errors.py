"""What a value that is not allowed raises: an error that knows its name, it and what is."""

from __future__ import annotations

from typing import Self

from spanwise._shown import shown


class InputError(ValueError):
    """A value that is not allowed.

    Attributes
    ----------
    key : str
        Name of the argument, or where in it or in a file the value stands; empty where the
        sentence names what is wrong.
    value : str or None
        The value as the message shows it, if it is a matter of one.
    allowed : str
        What is allowed.
    """

    def __init__(self, key: object, value: object, allowed: str) -> None:
        self.key, self.allowed = str(key), allowed
        self.value = None if value is None else str(value)
        # What pickling makes it of again.
        super().__init__(self.key, self.value, allowed)

    def __str__(self) -> str:
        head = " = ".join(each for each in (self.key, self.value) if each)
        return f"{head}: {self.allowed}" if head else self.allowed

    @classmethod
    def of(cls, error: ValueError) -> Self:
        """Any error about a value as one of these."""
        if isinstance(error, InputError):
            return cls(error.key, error.value, error.allowed)
        return cls("", None, str(error))

    def within(self, place: str) -> Self:
        """The same with the name of the place in front of the key."""
        key = ": ".join(filter(None, (place, self.key)))
        return type(self)(key, self.value, self.allowed)


class KindError(InputError, TypeError):
    """A value of a kind that is not allowed, a TypeError too."""


def refused(key: str, value: object, allowed: str) -> InputError:
    """The error about a value of whatever kind, which it shows on one line."""
    return InputError(key, shown(value), allowed)


def wrong_kind(key: str, value: object, allowed: str) -> KindError:
    """The error about a value that is not of the kind it should be."""
    return KindError(key, shown(value), allowed)
