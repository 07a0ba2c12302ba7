"""Categories of what spanwise warns of, by which each kind can be silenced."""

from __future__ import annotations


class DampingWarning(UserWarning):
    """Nobody has said how much the bridge is damped, and so it is not."""


class PlausibilityWarning(UserWarning):
    """A value is allowed but hardly meant: in other units, or a slip."""
