"""The one door to what is imported when it is first asked for: texts, files, figures, libraries.

Results, bridges, vehicles and roads name here what shows them. So nothing depends on what shows it,
and a program that draws nothing does not wait for it.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

T = TypeVar("T")


def view(name: str) -> Callable[..., T]:
    """A function or class by its place in this package, such as ``plotting.RunPlot``."""
    module, _, what = name.rpartition(".")
    found: Callable[..., T] = getattr(import_module(f"spanwise.{module}"), what)
    return found


def require(module: str, *, extra: str) -> Any:
    """An optional library, or an error that says which extra brings it."""
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(
            f"this needs {package}: install the extra with  pip install 'spanwise[{extra}]'"
        ) from error
