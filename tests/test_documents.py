"""What the README and the docstrings show runs."""

from __future__ import annotations

import doctest
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

import spanwise as sw
from spanwise import case, roads, vehicle

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
TRAFFIC = "[[traffic]]"

#: What is shown says how much the bridge is damped.
pytestmark = pytest.mark.filterwarnings("error::spanwise.DampingWarning")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.DOTALL | re.MULTILINE)


def test_python_in_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = blocks("python")
    assert len(found) >= 5
    # Each goes on from those above it.
    names: dict[str, Any] = {}
    for block in found:
        exec(compile(block, "README.md", "exec"), names)
    assert (tmp_path / "moment.png").stat().st_size > 0


def test_case_files_in_the_readme() -> None:
    found = blocks("toml")
    assert found
    for block in found:
        tables = tomllib.loads(block)
        bridge = {"spans": [20.0, 20.0], "EI": 5e9, "mass": 8e3}
        missing = {"bridge": bridge, "crossing": {"speed": 20.0, "damping": 0.02}}
        sw.Case.from_dict({**missing, **tables}).run(modes=2)


@pytest.mark.parametrize("name", sorted(each.name for each in ROOT.glob("examples/*.toml")))
def test_example_cases_say_their_damping(name: str) -> None:
    assert "damping" in sw.Case.read(ROOT / "examples" / name).crossing


def test_files_that_the_readme_names_are_there() -> None:
    named = re.findall(r"(?:examples|docs|benches)/[\w./]+\.(?:toml|md|png|py|csv)", README)
    assert named
    for name in named:
        assert (ROOT / name).is_file(), name


@pytest.mark.parametrize("module", [case, vehicle, roads.table], ids=lambda each: each.__name__)
def test_examples_in_docstrings(module: Any) -> None:
    result = doctest.testmod(module)
    assert result.attempted > 0
    assert result.failed == 0
