"""What documents and docstrings show runs and prints what they say; their links lead somewhere."""

from __future__ import annotations

import doctest
import re
import shlex
import shutil
import tomllib
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

import spanwise as sw
from spanwise import _run_files, case, roads, vehicle
from spanwise.cli import main

ROOT = Path(__file__).parent.parent
#: Of which every block runs.
RUN = ("README.md", "docs/tour.md")
LINKED = (*RUN, "docs/theory.md")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)

#: What is shown says how much the bridge is damped.
pytestmark = pytest.mark.filterwarnings("error::spanwise.DampingWarning")


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def run_case(block: str) -> None:
    """A file of its own if its first line names one, for a command below; else a part of a case."""
    if named := re.match(r"# (\w+\.toml)\n", block):
        Path(named[1]).write_text(block, encoding="utf-8")
        return
    tables = tomllib.loads(block)
    missing: dict[str, Any] = {"bridge": {"spans": [20.0, 20.0], "EI": 5e9, "mass": 8e3}}
    if not {"vehicle", "traffic", "events"} & tables.keys():
        missing["vehicle"] = {"preset": "kishan-1973"}
    if not {"crossing", "ensemble"} & tables.keys():
        missing["crossing"] = {"speed": 20.0, "damping": 0.02}
    found = sw.Case.from_dict({**missing, **tables})
    if "ensemble" in tables:
        found.ensemble(modes=2)
    else:
        found.run(modes=2)


def run_commands(block: str) -> None:
    """Commands of the package run; make, which would build and test all, has to know its target."""
    for line in block.splitlines():
        command, *arguments = shlex.split(line, comments=True)
        if command == "make":
            for target in arguments:
                assert re.search(rf"^{target}:", read("Makefile"), re.MULTILINE), line
        else:
            assert command == "spanwise", line
            assert main(arguments) == 0, line


def check_printed(shown: str, printed: str) -> None:
    """``...`` stands for anything, as in doctests."""
    checker, flags = doctest.OutputChecker(), doctest.ELLIPSIS
    example = doctest.Example("", shown)
    assert checker.check_output(shown, printed, flags), checker.output_difference(
        example, printed, flags
    )


@pytest.mark.parametrize("name", RUN)
def test_blocks_run_and_print_what_is_shown(
    name: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    # Histories of a few rows: all of them are megabytes, and looked at elsewhere.
    rows = _run_files._history_rows
    monkeypatch.setattr(_run_files, "_history_rows", lambda *given: islice(rows(*given), 9))
    # Each goes on from those above it.
    names: dict[str, Any] = {}
    printed, languages = "", []
    for language, block in BLOCK.findall(read(name)):
        languages.append(language)
        if language == "text":
            check_printed(block, printed)
            continue
        if language == "python":
            exec(compile(block, name, "exec"), names)
        elif language == "toml":
            run_case(block)
        else:
            assert language == "sh", f"```{language} does not run"
            run_commands(block)
        printed = capsys.readouterr().out
    assert {"python", "toml", "sh", "text"} <= set(languages)
    assert read(name).count("```") == 2 * len(languages)
    assert (tmp_path / "moment.png").stat().st_size > 0


@pytest.mark.parametrize("name", sorted(each.name for each in ROOT.glob("examples/*.toml")))
def test_example_cases_say_their_damping(name: str) -> None:
    assert "damping" in sw.Case.read(ROOT / "examples" / name).crossing


@pytest.mark.parametrize("name", RUN)
def test_files_that_the_documents_name_are_there(name: str) -> None:
    named = re.findall(r"(?:examples|docs|benches)/[\w./]+\.(?:toml|md|png|py|rs|csv)", read(name))
    assert named
    for each in named:
        assert (ROOT / each).is_file(), each


def anchors(text: str) -> Iterator[str]:
    """What GitHub calls the headings."""
    for heading in re.findall(r"^#+ (.+)$", BLOCK.sub("", text), re.MULTILINE):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


@pytest.mark.parametrize("name", LINKED)
def test_links_lead_somewhere(name: str) -> None:
    links = re.findall(r"\]\(([^)\s]+)\)", BLOCK.sub("", read(name)))
    assert links
    for link in links:
        if link.startswith("https://"):
            continue
        path, _, anchor = link.partition("#")
        target = (ROOT / name).parent / path if path else ROOT / name
        assert target.exists(), link
        if anchor:
            assert anchor in anchors(target.read_text(encoding="utf-8")), link


@pytest.mark.parametrize("module", [case, vehicle, roads.table], ids=lambda each: each.__name__)
def test_examples_in_docstrings(module: Any) -> None:
    result = doctest.testmod(module)
    assert result.attempted > 0
    assert result.failed == 0
