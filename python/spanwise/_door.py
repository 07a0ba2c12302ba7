"""The one door from results, bridges, vehicles and roads to what shows them: texts, files, figures.

What is behind it is imported when it is first asked for, by its name. So nothing below depends on
what shows it, and a program that draws nothing does not wait for it.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

T = TypeVar("T")


def view(name: str) -> Callable[..., T]:
    """A function or class by its place in this package, such as ``plotting.RunPlot``."""
    module, _, what = name.rpartition(".")
    found: Any = getattr(import_module(f"spanwise.{module}"), what)
    return found  # type: ignore[no-any-return]
