"""Names that have gone: they work for one version more, and say what has taken their place."""

from __future__ import annotations

from spanwise._warnings import warn


def renamed(old: str, new: str) -> None:
    """Warn whoever used the old one."""
    warn(f"{old} is now {new}; the old name goes with the next version", DeprecationWarning)
