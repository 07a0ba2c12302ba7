"""Modules depend on each other in one direction: no circle, however late they are imported."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from graphlib import TopologicalSorter
from importlib import import_module
from pathlib import Path

import spanwise as sw

PACKAGE = Path(sw.__file__).parent


def modules() -> dict[str, ast.Module]:
    """The files of the package by name, without the front pages that name all."""
    found = {}
    for path in PACKAGE.rglob("*.py"):
        parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        if name not in ("spanwise", "spanwise.__main__"):
            found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


def uses(tree: ast.Module, known: set[str]) -> set[str]:
    """What a file imports, at once or in a function; not what only its annotations name."""
    only_types = {
        id(each)
        for branch in ast.walk(tree)
        if isinstance(branch, ast.If) and getattr(branch.test, "id", "") == "TYPE_CHECKING"
        for each in ast.walk(branch)
    }
    found = set()
    for each in ast.walk(tree):
        if isinstance(each, ast.ImportFrom) and each.module and id(each) not in only_types:
            for name in each.names:
                full = f"{each.module}.{name.name}"
                found.add(full if full in known else each.module)
    return found & known


def test_no_module_depends_on_itself_by_way_of_others() -> None:
    known = modules()
    graph = {name: uses(tree, {*known}) - {name} for name, tree in known.items()}
    TopologicalSorter(graph).prepare()
    assert "spanwise.quantities" in graph["spanwise.runs"]


def test_what_is_behind_the_door_is_there() -> None:
    doors = set()
    for path in PACKAGE.rglob("*.py"):
        doors |= {*re.findall(r'view\("([\w.]+)"\)', path.read_text(encoding="utf-8"))}
    assert {"plotting.RunPlot", "_run_summary.summary", "_run_files.write_csv"} <= doors
    for each in doors:
        module, _, name = each.rpartition(".")
        assert callable(getattr(import_module(f"spanwise.{module}"), name))


def test_what_shows_results_waits_until_it_is_asked_for() -> None:
    program = "import sys, spanwise; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    loaded = {*done.stdout.split()}
    assert "spanwise.runs" in loaded
    views = ("plotting", "_run_summary", "_run_files", "_ensemble_summary", "_ensemble_tables")
    readers = ("roads.reading", "roads.sheet", "roads.sniffing", "cli")
    assert loaded.isdisjoint(f"spanwise.{name}" for name in readers)
    assert loaded.isdisjoint(("tomllib", "csv", "argparse", "concurrent.futures"))
    assert loaded.isdisjoint(f"spanwise.{name}" for name in views)
    assert loaded.isdisjoint(("matplotlib", "pandas", "pyarrow", "xarray", "scipy"))
