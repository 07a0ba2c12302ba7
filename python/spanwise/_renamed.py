"""Names that have gone: they work for one version more, and say what has taken their place."""

from __future__ import annotations

from typing import Any

from spanwise._warnings import warn


def renamed(old: str, new: str) -> None:
    """Warn whoever used the old one."""
    warn(f"{old} is now {new}; the old name goes with the next version", DeprecationWarning)


class Renamed:
    """An attribute under its old name, in a class that has it under a new one."""

    def __init__(self, new: str) -> None:
        self.new = new

    def __set_name__(self, owner: type, name: str) -> None:
        self.old = name

    def __get__(self, found: object, owner: type) -> Any:
        if found is None:
            return self
        renamed(f"{owner.__name__}.{self.old}", f"{owner.__name__}.{self.new}")
        return getattr(found, self.new)
