"""A response is one row of a table, from which all that tells of it follows."""

from __future__ import annotations

import ast
import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise import _core
from spanwise._ensemble_files import as_dict
from spanwise.quantities import RESPONSES, Factor, Response

PACKAGE = Path(sw.__file__).parent
BRIDGE = sw.Bridge(spans=[18.0, 12.0], EI=2e9, mass=8e3, stations_per_span=3)
GIVEN: dict[str, Any] = {
    "speed": 30.0,
    "modes": 3,
    "damping": 0.02,
    "road": sw.ISO8608("D"),
    "approach": 20.0,
    "accuracy": 0.02,
}

#: All that Python has to know of a response that the core has learnt.
ROTATION = Response(
    "rotations",
    unit="rad",
    axis="section",
    signs=("clockwise", "anticlockwise"),
    title="Rotation",
    influence=False,
    reported=("positive", "negative"),
    factors=(Factor("turning", "either", "Rotation"),),
)


class Crossing:
    """The core's side: a crossing that knows rotations too, here twice the deflections."""

    def __init__(self, core: _core.Crossing) -> None:
        self.core = core

    def __getattr__(self, name: str) -> Any:
        return getattr(self.core, name)

    def histories(self, name: str) -> list[Any]:
        if name != "rotations":
            return self.core.histories(name)
        return [2.0 * each for each in self.core.histories("deflection")]

    def envelope(self, name: str) -> list[Any]:
        if name != "rotations":
            return self.core.envelope(name)
        twice = np.array([2.0, 1.0, 1.0, 2.0])  # value, time, position, partner
        return [each * twice for each in self.core.envelope("deflection")]

    def reach(self, name: str) -> Any:
        found = self.core.reach("deflection" if name == "rotations" else name)
        return 2.0 * found if name == "rotations" and found is not None else found

    def impact_factors(self, name: str, *more: Any) -> Any:
        return self.core.impact_factors("deflection" if name == "rotations" else name, *more)


class Ensemble:
    """The core's side of an ensemble: rotations are the last of the responses."""

    def __init__(self, core: _core.Ensemble) -> None:
        self.core = core
        self.width = dict(core.widths)["deflection"]
        self.widths = [*core.widths, ("rotations", self.width)]
        self.responses = sum(width for _, width in core.widths)
        self.columns = {
            name: (low + 2 * self.width * (low > 0), high + 2 * self.width)
            for name, (low, high) in core.columns.items()
        }
        self.numbers, self.at_rest = self.wider(core.numbers, 2.0), self.wider(core.at_rest, 2.0)
        self.instants = self.wider(core.instants, 1)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.core, name)

    def wider(self, rows: Any, times: Any) -> Any:
        """Rows that begin with the largest of all responses and then their smallest."""
        largest, smallest, rest = np.split(rows, [self.responses, 2 * self.responses], axis=1)
        own = [times * each[:, : self.width] for each in (largest, smallest)]
        return np.hstack([largest, own[0], smallest, own[1], rest]).astype(rows.dtype)


@pytest.fixture(autouse=True)
def learnt(monkeypatch: pytest.MonkeyPatch) -> None:
    """The core knows rotations, and Python has their row."""
    cross, ensemble = _core.cross, _core.ensemble

    def many(*event: Any, quantities: list[str], **given: Any) -> Any:
        known = [name for name in quantities if name != "rotations"]
        found = ensemble(*event, quantities=known, **given)
        return found if known == quantities else Ensemble(found)

    monkeypatch.setattr(_core, "cross", lambda *event, **given: Crossing(cross(*event, **given)))
    monkeypatch.setattr(_core, "ensemble", many)
    monkeypatch.setitem(RESPONSES, "rotations", ROTATION)


@pytest.fixture
def run(learnt: None) -> sw.Run:
    return sw.cross(BRIDGE, sw.vehicles.half_car(), tail=0.0, **GIVEN)


@pytest.fixture
def many(learnt: None) -> sw.Ensemble:
    return sw.ensemble(BRIDGE, sw.vehicles.half_car(), samples=5, **GIVEN)


def test_a_run_has_it(run: sw.Run) -> None:
    assert_array_equal(run.rotations, 2.0 * run.deflection)
    assert_array_equal(run.static.rotations, 2.0 * run.static.deflection)
    assert "rotations" in dir(run)
    envelope, of = run.envelope("rotation"), run.envelope("deflection")
    assert_array_equal(envelope.min.value, 2.0 * of.min.value)
    assert_array_equal(envelope.min.time, of.min.time)
    assert_array_equal(envelope.x, run.sections)
    assert_array_equal(run.impact_factors.turning, run.ratios()["turning"])
    reach = {(each.quantity, each.side): each.reach for each in run.can_grow}
    assert reach["rotations", "min"] == 2.0 * reach["deflection", "min"]


def test_texts_and_files_of_a_run_have_it(run: sw.Run, tmp_path: Path) -> None:
    text = run.summary()
    (line,) = (line for line in text.split("\n") if line.startswith("rotation, clockwise [mrad]"))
    assert f"{2e3 * run.envelope('deflection').max.value.max():.3f}" in line
    assert "rotation, anticlockwise [mrad]" in text
    assert "turning" in str(run.impact_factors)
    assert "<th>turning</th>" in run._repr_html_()
    told = json.loads(json.dumps(run.to_dict()))
    assert told["rotations"]["max"] == run.envelope("rotations").max.value.tolist()
    assert len(told["impact_factors"]["turning"]) == len(run.sections)
    assert "turning" in told["impact_factors"]["masked"]
    run.to_csv(tmp_path)
    with (tmp_path / "history_rotations.csv").open(encoding="utf-8") as file:
        heads, first, *_ = csv.reader(file)
    assert heads[:2] == ["time [s]", "rotation at 0.0 m [rad]"]
    assert [float(each) for each in first[1:]] == run.rotations[0].tolist()
    with (tmp_path / "envelope_rotations.csv").open(encoding="utf-8") as file:
        assert next(csv.reader(file))[:3] == ["x [m]", "max [rad]", "max_time [s]"]
    with (tmp_path / "impact_factors.csv").open(encoding="utf-8") as file:
        assert "turning [-]" in next(csv.reader(file))
    frame = run.to_pandas("rotations")
    assert_array_equal(frame.to_numpy(), run.rotations)
    assert frame.columns.name == "x [m]"


def test_what_a_bridge_has_not_is_an_empty_frame(run: sw.Run) -> None:
    assert run.to_pandas("clamp_moments").shape == (run.steps + 1, 0)
    assert "clamp_moments" not in {each.name for each in run.responses}
    assert "clamp moment" not in run.summary()


def test_figures_have_it(run: sw.Run, many: sw.Ensemble) -> None:
    for figure in (
        run.plot.envelope("rotations"),
        run.plot.history("rotations"),
        many.plot.envelope("rotations"),
    ):
        assert figure.axes[0].get_ylabel() == "Rotation [mrad]"
    titles = [ax.get_title(loc="left") for ax in run.plot.impact_factors().axes]
    assert titles == ["Deflection", "Sagging moment", "Hogging moment", "Shear force", "Rotation"]
    label = many.plot.impact_factors("turning").axes[0].get_ylabel()
    assert label == "Rotation, dynamic\nby static [-]"


def test_an_ensemble_has_it(many: sw.Ensemble, tmp_path: Path) -> None:
    assert many.quantities == ("deflection", "moment", "shear", "reactions", "rotations")
    found, of = many.envelope("rotations"), many.envelope("deflection")
    for name in ("max", "min", "static_max"):
        assert_array_equal(getattr(found, name), 2.0 * getattr(of, name))
    for name in ("max_time", "min_position"):
        assert_array_equal(getattr(found, name), getattr(of, name))
    alone = many.run(3)
    assert_array_equal(found.max[3], alone.envelope("rotations").max.value)
    assert_array_equal(many.impact_factors.turning[3], alone.impact_factors.turning)
    assert_array_equal(many.histories("rotations", 3)[0], alone.rotations)
    text = many.summary()
    assert "rotation, clockwise [mrad]" in text
    assert sum(line.startswith("turning") for line in text.split("\n")) == 2
    assert {"rotations_max", "impact_factor_turning"} <= {*many.to_pandas()}
    assert {"rotations_min_time", "impact_factor_turning"} <= {*many.to_pandas(by="section")}
    told = as_dict(many)
    assert "rotations" in told["extremes"]
    assert "turning" in told["impact_factors"]
    many.to_npz(tmp_path / "many.npz")
    again = sw.Ensemble.read(tmp_path / "many.npz")
    assert again == many
    assert_array_equal(again.envelope("rotations").max, found.max)


def test_arguments_know_it() -> None:
    few = sw.ensemble(
        BRIDGE, sw.vehicles.half_car(), samples=2, quantities=["deflection", "rotation"], **GIVEN
    )
    assert few.quantities == ("deflection", "rotations")
    with pytest.raises(ValueError, match=r"did you mean 'rotations'\?"):
        few.envelope("rotatons")


def test_without_a_factor_there_is_a_dash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RESPONSES, "rotations", replace(ROTATION, factors=()))
    run = sw.cross(BRIDGE, sw.vehicles.half_car(), **GIVEN)
    (line,) = (
        line for line in run.summary().split("\n") if line.startswith("rotation, clockwise [mrad]")
    )
    assert line.endswith(" -")


#: What is spoken of by itself: what axles weigh, where the bridge bends most, how things move.
OWN = {"deflection", "moment", "axle_loads", "velocity", "acceleration"}


def test_nothing_else_names_a_response() -> None:
    names = {name for each in RESPONSES.values() for name in (each.name, *each.parts)} - OWN
    assert {"shear_left", "reactions", "clamp_moments"} < names
    for path in PACKAGE.rglob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        named = {each.value for each in ast.walk(tree) if isinstance(each, ast.Constant)} & names
        assert not named or path.name == "quantities.py", f"{path} names {named}"
