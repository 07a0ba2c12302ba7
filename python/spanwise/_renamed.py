"""Names that have gone: they work for one version more, and say what has taken their place."""

from __future__ import annotations

import warnings


def renamed(old: str, new: str) -> None:
    """Warn whoever called what calls this."""
    warnings.warn(
        f"{old} is now {new}; the old name goes with the next version",
        DeprecationWarning,
        stacklevel=3,
    )
