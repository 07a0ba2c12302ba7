"""The files of the Rust core depend on each other in one direction: no circle, however long."""

import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

Module = tuple[str, ...]

ROOT = Path(__file__).resolve().parent.parent / "rust"

# `use a::{b, c::d};`, and `a::b::c` elsewhere: from the crate, the parent, or a file declared here.
USE = re.compile(r"^\s*(?:pub\s+|pub\(\w+\)\s+)?use\s+([\w:{}\s,*]+);", re.MULTILINE)
# What a front page only shows of its own files it does not take: `pub use c::d;`.
SHOWN = re.compile(r"^pub use (?!crate\b|super\b|self\b)[\w:{}\s,*]+;", re.MULTILINE)
PATH = re.compile(r"\b(?:crate|super)(?:::\w+)+")


def files(root: Path) -> dict[Module, Path]:
    """Every file of the crate by its module path."""
    return {p.relative_to(root).with_suffix("").parts: p for p in root.rglob("*.rs")}


def leaves(tree: str) -> list[str]:
    """The paths in a tree of a `use`."""
    head, brace, rest = tree.partition("{")
    if not brace:
        return [tree]
    parts, depth = [""], 0
    for c in rest[: rest.rindex("}")]:
        depth += {"{": 1, "}": -1}.get(c, 0)
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [head + path for part in parts for path in leaves(part) if part]


def uses(module: Module, text: str, known: dict[Module, Path]) -> set[Module]:
    """The files that this one takes something from."""
    text = SHOWN.sub("", re.sub(r"//.*", "", text))
    trees = [re.sub(r"\s+", "", tree) for tree in USE.findall(text)]
    paths = [path for tree in trees for path in leaves(tree)] + PATH.findall(USE.sub("", text))
    found = set()
    for path in paths:
        parts = path.split("::")
        if parts[0] == "crate":
            place = tuple(parts[1:])
        elif parts[0] == "super":
            up = sum(part == "super" for part in parts)
            place = (*module[:-up], *parts[up:])
        else:
            place = (*module, *parts) if (*module, parts[0]) in known else ()
        # The longest beginning that is a file: what follows is in it.
        place = next((place[:n] for n in range(len(place), 0, -1) if place[:n] in known), ())
        if place and place != module:
            found.add(place)
    return found


def graph(root: Path) -> dict[Module, set[Module]]:
    """What every file takes from others."""
    known = files(root)
    # The front page names every room, and nothing takes from it.
    return {
        module: uses(module, path.read_text(encoding="utf-8"), known)
        for module, path in known.items()
        if module != ("lib",)
    }


def whole(taken: dict[Module, set[Module]]) -> dict[Module, set[Module]]:
    """The same of whole rooms."""
    rooms: dict[Module, set[Module]] = {}
    for module, others in taken.items():
        own = module[:1]
        rooms.setdefault(own, set()).update(other[:1] for other in others if other[:1] != own)
    return rooms


def circle(taken: dict[Module, set[Module]]) -> list[str]:
    """A circle among files or rooms, or nothing."""
    try:
        TopologicalSorter(taken).prepare()
    except CycleError as error:
        return ["::".join(module) for module in error.args[1]]
    return []


def test_no_file_and_no_room_depends_on_itself_by_way_of_others() -> None:
    assert circle(graph(ROOT)) == []
    assert circle(whole(graph(ROOT))) == []


@pytest.mark.parametrize(
    "back",
    [
        "use crate::a;",
        "use super::super::a::{x, y};",
        "fn f() { crate::a::x() }",
        "pub use crate::{z, a::x};",
    ],
)
def test_a_circle_is_found(tmp_path: Path, back: str) -> None:
    (tmp_path / "b").mkdir()
    (tmp_path / "lib.rs").write_text("mod a; mod b;")
    (tmp_path / "a.rs").write_text("use crate::b::c::{self, Deep};")
    (tmp_path / "b.rs").write_text("pub mod c;")
    (tmp_path / "b" / "c.rs").write_text("pub struct Deep;")
    assert circle(graph(tmp_path)) == []
    (tmp_path / "b" / "c.rs").write_text(back)
    assert set(circle(graph(tmp_path))) == {"a", "b::c"}


def test_what_a_front_page_only_shows_is_no_circle(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a.rs").write_text("mod b;\npub use b::{Shown, f};\npub struct Own;")
    (tmp_path / "a" / "b.rs").write_text("use super::Own;")
    assert circle(graph(tmp_path)) == []


def test_a_child_of_its_parent_is_a_circle(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a.rs").write_text("mod b;\nuse b::f;")
    (tmp_path / "a" / "b.rs").write_text("use super::Own;")
    assert set(circle(graph(tmp_path))) == {"a", "a::b"}


def test_a_circle_of_rooms_is_found(tmp_path: Path) -> None:
    for room, other in (("a", "b"), ("b", "a")):
        (tmp_path / room).mkdir()
        (tmp_path / f"{room}.rs").write_text("pub mod deep;")
        (tmp_path / room / "deep.rs").write_text(f"use crate::{other}::plain;")
        (tmp_path / room / "plain.rs").write_text("")
    assert circle(graph(tmp_path)) == []
    assert set(circle(whole(graph(tmp_path)))) == {"a", "b"}
