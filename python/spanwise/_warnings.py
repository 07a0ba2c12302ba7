"""Categories of what spanwise warns of, by which each kind can be silenced, and how it warns."""

from __future__ import annotations

import sys
import warnings
from typing import Final

#: Packages whose lines are not the caller's: our own, and what we call that calls us.
_BETWEEN: Final = ("spanwise", "copy", "dataclasses", "functools")


class DampingWarning(UserWarning):
    """Nobody has said how much the bridge is damped, and so it is not."""


class PlausibilityWarning(UserWarning):
    """A value is allowed but hardly meant: in other units, or a slip."""


def warn(message: str, category: type[Warning] = UserWarning) -> None:
    """Warn the line that called the package, however deep in it this is."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None:
        name = frame.f_globals.get("__name__", "")
        if name.partition(".")[0] not in _BETWEEN:
            break
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)
