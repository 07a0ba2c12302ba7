"""Tables into objects and back, by the type hints of what is made."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import InitVar, dataclass, replace
from typing import Any, ClassVar

import pytest

from spanwise._build import Maker, Place, build_kind, build_one
from spanwise._toml import table_of, toml


@dataclass(frozen=True, kw_only=True)
class Leaf:
    size: float
    colour: str = "green"


@dataclass(frozen=True, kw_only=True)
class Twig:
    leaves: Sequence[Leaf] = ()
    end: Leaf | None = None
    bent: InitVar[float | None] = None


@dataclass(frozen=True)
class Oak:
    kind: ClassVar[str] = "oak"
    twigs: Sequence[Twig] = ()
    age: int = 0


@dataclass(frozen=True)
class Palm:
    kind: ClassVar[str] = "palm"
    fronds: Mapping[str, Leaf | dict[str, Any]]


KINDS: Mapping[str, Sequence[Maker[Oak | Palm]]] = {
    each.kind: (Maker(each),) for each in (Oak, Palm)
}
PLACE = Place(table="tree", home=lambda key: " (belongs in [soil])" if key == "depth" else "")
TREE = {
    "twigs": [
        {"leaves": [{"size": 1.0}, {"size": 2, "colour": "red"}]},
        {"end": {"size": "inf"}, "bent": 3.0},
    ],
    "age": 80,
}


def test_tables_become_what_the_hints_say() -> None:
    expected = Oak(
        [
            Twig(leaves=[Leaf(size=1.0), Leaf(size=2, colour="red")]),
            Twig(end=Leaf(size=math.inf)),
        ],
        80,
    )
    assert Maker(Oak).build(TREE, PLACE) == expected
    assert build_kind(KINDS, {"kind": "oak", **TREE}, PLACE) == expected
    # What may be a mapping by its hint stays one.
    fronds = {"left": {"size": 1.0}}
    assert build_kind(KINDS, {"kind": "palm", "fronds": fronds}, PLACE) == Palm(fronds)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (3, r"^3: must be a table with a kind: oak, palm$"),
        ({}, "^missing kind; allowed: oak, palm$"),
        ({"kind": "oka"}, r"^kind = 'oka': must be one of oak, palm \(did you mean 'oak'\?\)$"),
        ({"kind": "palm"}, "^missing fronds$"),
        (
            {"kind": "oak", "ages": 1},
            r"^unknown key 'ages' \(did you mean 'age'\?\); allowed: kind, tw",
        ),
        ({"kind": "oak", "depth": 1}, r"^unknown key 'depth' \(belongs in \[soil\]\); allowed"),
        ({"kind": "oak", "fronds": 1}, r"'fronds' \(not beside kind = 'oak', but palm\); allow"),
        ({"kind": "oak", 3: 1}, "^unknown key 3; allowed: kind, twigs, age$"),
        (
            {"kind": "oak", "twigs": 3},
            r"^twigs = 3: must be a list of tables, \[\[tree\.twigs\]\]$",
        ),
        (
            {"kind": "oak", "twigs": [{}, 3]},
            r"^twigs\[1\] = 3: must be a table, \[tree\.twigs\]$",
        ),
        (
            {"kind": "oak", "twigs": [{"leaves": [{"size": 1}, {"colour": "red"}]}]},
            r"^twigs\[0\]\.leaves\[1\]: missing size$",
        ),
        (
            {"kind": "oak", "twigs": [{"end": {"siez": 1}}]},
            r"^twigs\[0\]\.end: unknown key 'siez' \(did you mean 'size'\?\); allowed: size, co",
        ),
        (
            {"kind": "oak", "twigs": [{"end": [1]}]},
            r"^twigs\[0\]\.end = \[1\]: must be a table, \[tree\.twigs\.end\]$",
        ),
    ],
)
def test_what_is_wrong_is_told_with_its_place(table: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        build_kind(KINDS, table, PLACE)


def square(*, side: float) -> tuple[str, float]:
    return "square", side


def circle(*, radius: float, segments: int = 8) -> tuple[str, float]:
    return "circle", radius


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ({"side": 1.0}, ("square", 1.0)),
        ({"radius": 2.0}, ("circle", 2.0)),
        ({"radius": 2.0, "side": 1.0}, r"^side = 1\.0: not used with radius; allowed: radius, se"),
        ({"segments": 3}, r"^segments = 3: used with radius only; allowed: side$"),
        ({"sides": 1.0}, r"'sides' \(did you mean 'side'\?\); allowed: side, radius$"),
        ({}, "^missing side; or give radius$"),
    ],
)
def test_a_required_key_tells_what_is_made(table: dict[str, Any], expected: Any) -> None:
    makers = (Maker(square), Maker(circle))
    if isinstance(expected, tuple):
        assert build_one(makers, table, PLACE) == expected
        return
    with pytest.raises(ValueError, match=expected):
        build_one(makers, table, PLACE)


def test_objects_become_tables() -> None:
    leaves = (Leaf(size=1.0), Leaf(size=math.inf, colour="red"))
    tree = Oak((Twig(leaves=leaves, end=leaves[0]),), 80)
    table = table_of(tree)
    assert table["kind"] == "oak"
    assert table["twigs"][0]["end"] == {"size": 1.0, "colour": "green"}
    brief = table_of(replace(tree, age=0), defaults=False)
    end, red = {"size": 1.0}, {"size": math.inf, "colour": "red"}
    assert brief == {"kind": "oak", "twigs": [{"leaves": [end, red], "end": end}]}


def test_tables_as_toml() -> None:
    tables = {
        "name": 'a "b"\\',
        "bridge": {"at": [[0.0, "pinned"], {"at": 1.0, "open": True}], "far": math.inf},
        "tree": {"twigs": [{"leaves": [{"size": 1.0}, {}], "end": {"size": 1e-05}}, {}]},
        "nothing": {},
    }
    text = toml(tables)
    assert tomllib.loads(text) == tables
    assert "[tree]\n" not in text
    assert "\n\n[[tree.twigs]]\n\n[[tree.twigs.leaves]]\nsize = 1.0\n" in text
