"""Roads in Python: kinds, sums, tables, files, indexes of roughness, and what is refused."""

from __future__ import annotations

import copy
import json
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import spanwise as sw
from spanwise import roads

nan, inf = float("nan"), float("inf")

X = np.linspace(-5.0, 25.0, 31)
MEASURED = sw.Profile(X, 0.01 * np.sin(X), detrend=True, max_gap=2.0)
ROADS = [
    sw.Smooth(),
    sw.ISO8608("C", seed=4, sample=2),
    sw.ISO8608(G=5e-5, waviness=2.2, band=(0.02, 2.0), contact_patch=0.0, period=500.0),
    MEASURED,
    sw.Step(3.0, -0.01),
    sw.Ramp(1.0, 2.0, 0.01, contact_patch=0.0),
    sw.Bump(5.0, 2.0, 0.05),
    sw.Pothole(4.0, 1.0, 0.03, edge=0.1),
    sw.Joint(0.0, 0.05, 0.02),
    sw.Camber(0.0, 20.0, 0.02),
    sw.ISO8608("A") + sw.Joint(0.0, 0.05, 0.02) + MEASURED,
]


@pytest.mark.parametrize("road", ROADS, ids=lambda road: type(road).__name__)
def test_roads_go_to_other_processes_and_to_json(road: sw.roads.Road) -> None:
    table = json.loads(json.dumps(road.arguments))
    for again in (
        pickle.loads(pickle.dumps(road)),
        copy.deepcopy(road),
        roads.from_table(table),
    ):
        assert again == road
        assert hash(again) == hash(road)
        for what in ("elevation", "slope", "curvature"):
            assert_array_equal(getattr(again, what)(X), getattr(road, what)(X))


def test_sums_add_up() -> None:
    a, b = sw.ISO8608("B"), sw.Bump(5.0, 2.0, 0.05)
    assert_allclose((a + b).elevation(X), a.elevation(X) + b.elevation(X), atol=1e-15)
    assert a + sw.Smooth() == a
    assert (a + b + MEASURED).arguments == [a.arguments, b.arguments, MEASURED.arguments]
    assert sw.Smooth().arguments == {"kind": "smooth"}


def test_shapes_of_features() -> None:
    # Without contact patch, at points where their heights are known.
    flat: dict[str, Any] = {"contact_patch": 0.0}
    for road, x, height in (
        (sw.Step(3.0, 0.01, **flat), [2.9, 3.1], [0.0, 0.01]),
        (sw.Ramp(1.0, 3.0, 0.01, **flat), [0.0, 1.5, 2.0, 9.0], [0.0, 0.0025, 0.005, 0.01]),
        (sw.Bump(5.0, 2.0, 0.05, **flat), [3.9, 4.5, 5.0], [0.0, 0.025, 0.05]),
        (sw.Pothole(4.0, 1.0, 0.03, **flat), [3.4, 4.0, 4.4], [0.0, -0.03, -0.03]),
        (sw.Camber(0.0, 20.0, 0.02, **flat), [-1.0, 5.0, 10.0], [0.0, 0.015, 0.02]),
    ):
        assert_allclose(road.elevation(x), height, atol=1e-15)
    # A patch of 0.24 m over a gap of 0.05 m that is 0.02 m deep.
    assert sw.Joint(0.0, 0.05, 0.02).elevation(0.0) == pytest.approx(-0.02 * 0.05 / 0.24)


def test_a_random_road_has_the_roughness_of_its_class() -> None:
    for letter, mean in roads.CLASSES.items():
        road = sw.ISO8608(letter, seed=2)
        assert road.repeats_after == 1024.0
        found = road.iso_class(0.0, 1024.0)
        assert found.letter == letter
        assert pytest.approx(mean, rel=0.15) == found.G
        # The index follows the square root of the roughness.
        index = 0.543 * np.sqrt(mean / 1e-6)
        assert road.iri(0.0, 1024.0) == pytest.approx(index, rel=0.1)
    assert roads.from_iri(4.0, seed=1).iri(0.0, 1024.0) == pytest.approx(4.0, rel=0.1)


def test_seeds_and_samples_are_other_roads() -> None:
    made = [sw.ISO8608("B", seed=s, sample=n).elevation(X) for s in (0, 1) for n in (0, 1)]
    for k, each in enumerate(made):
        for other in made[:k]:
            assert np.abs(each - other).max() > 1e-3


def test_profiles_pass_through_their_points() -> None:
    road = sw.Profile(X, np.sin(X), contact_patch=0.0)
    assert_allclose(road.elevation(X), np.sin(X), atol=1e-14)
    assert road.ends == (-5.0, 25.0)
    with pytest.raises(ValueError, match=r"covers only -5 m to 25 m"):
        road.elevation(26.0)


def test_profiles_from_files(tmp_path: Path) -> None:
    path = tmp_path / "profile.csv"
    points = zip(X.tolist(), (1e3 * np.sin(X)).tolist(), strict=True)
    lines = "\n".join(f"{x!r};9;{z!r}" for x, z in points)
    path.write_text(f"# measured\nx;lane;z [mm]\n{lines}\n", encoding="utf-8")
    options: dict[str, Any] = {"columns": ["x", "z [mm]"], "delimiter": ";", "scale": [1.0, 1e-3]}
    road = sw.Profile.read_csv(path, **options)
    assert_allclose(road.elevations, np.sin(X), rtol=1e-12)
    assert roads.from_table({"kind": "profile", "file": str(path), **options}) == road
    with pytest.raises(ValueError, match=r"line 2: columns\[1\] = 'z': must be one of x, lane, z"):
        sw.Profile.read_csv(path, columns=("x", "z"), delimiter=";")


def profile(x: Any, elevations: Any) -> sw.Profile:
    return sw.Profile(x, elevations)


REFUSED: list[tuple[Callable[[], object], str]] = [
    (lambda: sw.ISO8608("Z"), "class = 'Z': must be one of A, B, C, D, E, F, G, H"),
    (lambda: sw.ISO8608(), "class, G: give one of the two"),
    (lambda: sw.ISO8608("A", G=1e-3), "G = 0.001: not used with class = 'A'"),
    (lambda: sw.ISO8608(G=-1.0), "G"),
    (lambda: sw.ISO8608("A", band=(1.0, 0.5)), "band"),
    (lambda: sw.ISO8608("A", contact_patch=-0.1), "contact_patch"),
    (lambda: sw.ISO8608("A", seed=-1), "seed = -1: must not be negative"),
    (lambda: sw.ISO8608("A", seed=1.5), "seed = 1.5: must be a whole number"),  # type: ignore[arg-type]
    (
        lambda: profile(X[::-1], X),
        "x[1] = 24 m: x must increase from point to point: must be greater",
    ),
    (
        lambda: profile([0, 1, 1, 2], [0, 0, 0, 0]),
        "x[2] = 1 m: x must increase from point to point: must be greater",
    ),
    (lambda: profile([0, 1, 2], [0, 0, 0]), "x = 3 points: must be 4 or more"),
    (lambda: profile(X, X[1:]), "elevation"),
    (lambda: profile(X, X * nan), "elevation"),
    (lambda: profile([0, 1, 2, 3, 99], [0] * 5), "max_gap"),
    (lambda: profile("abc", X), "x = 'abc': must be a list of numbers"),
    (lambda: sw.Bump(0.0, -1.0, 0.1), "length"),
    (lambda: sw.Joint(0.0, 0.0, 0.1), "gap = 0.0: must be finite and greater than 0"),
    (lambda: sw.Step(nan, 0.1), "at"),
    (lambda: sw.Pothole(0.0, 1.0, 0.1, edge=0.6), "edge"),
    (lambda: roads.bridge_study("bad"), "condition = 'bad': must be one of very good, good"),
    (lambda: roads.from_iri(0.0), "iri = 0.0: must be finite and greater than 0"),
    (lambda: roads.from_table({}), "road: missing kind; allowed: iso-8608"),
    (lambda: roads.from_table({"kind": "iso8608"}), "(did you mean 'iso-8608'?)"),
    (lambda: roads.from_table([{"kind": "step", "at": 1.0}]), "road[0]: missing height"),
    (lambda: roads.from_table({"kind": "smooth", "clas": "A"}), "unknown key 'clas'"),
    (
        lambda: roads.from_table({"kind": "bump", "class": "A"}),
        "'class' (not beside kind = 'bump', but iso-8608)",
    ),
    (lambda: sw.ISO8608("A").iri(0.0, 5.0), "end = 5 m: must lie 11 to"),
    (lambda: sw.Smooth().iso_class(0.0, 100.0), "the road is smooth there"),
]


@pytest.mark.parametrize(("make", "message"), REFUSED, ids=[each[1] for each in REFUSED])
def test_what_cannot_be_a_road_is_explained(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        make()
