"""What an ensemble says of itself, in words and figures, can be read without being misled."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spanwise as sw
from spanwise.extremes import governing

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
SIMPLE = sw.Bridge(spans=[20.0], EI=5e9, mass=8e3)
TRUCK = sw.vehicles.kishan_1973()
SAMPLES = 40


def ensemble(bridge: sw.Bridge = BRIDGE, vehicle: Any = TRUCK, **more: Any) -> sw.Ensemble:
    given = {"samples": SAMPLES, "speed": 22.86, "modes": 3, **more}
    return sw.ensemble(bridge, vehicle, **given)


@pytest.fixture(scope="module")
def rough() -> sw.Ensemble:
    return ensemble(
        road=sw.ISO8608("C", period=128.0),
        speed=np.linspace(15.0, 25.0, SAMPLES),
        factors={"body_mass": np.linspace(0.7, 1.1, SAMPLES)},
        approach=20.0,
        ramp=5.0,
        tail=0.0,
    )


@pytest.fixture(scope="module")
def failing() -> sw.Ensemble:
    masses = sw.MovingMasses(masses=[500.0] * 4, positions=[0.0, -0.01, -0.02, -0.03])
    heavy = np.ones(SAMPLES)
    heavy[[3, 17]] = 1e6
    road = sw.ISO8608("B", period=128.0)
    given = {"approach": 6.0, "ramp": 3.0, "road": road, "advance": 0.2, "speed": 20.0}
    with pytest.warns(sw.PlausibilityWarning, match="are loads in N"):
        return ensemble(SIMPLE, masses, factors={"body_mass": heavy}, **given)


def row(text: str, name: str, table: str = "impact factor") -> str:
    """Of the table of this title, the row of this name."""
    lines = text.split("\n")
    start = next(i for i, line in enumerate(lines) if line.startswith(table))
    return next(line for line in lines[start + 1 :] if line.startswith(name))


def legend(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.axes[0].get_legend().get_texts()]


def numbers(line: str) -> list[float]:
    return [float(each) for each in re.findall(r"-?\d+\.\d{3}\b", line.split("]")[-1])]


@pytest.mark.parametrize(
    ("name", "here"), [("sagging", "moment, sagging"), ("deflection", "deflection, down")]
)
def test_a_tie_by_symmetry_is_told_as_a_single_crossing_tells_it(name: str, here: str) -> None:
    single = sw.cross(BRIDGE, TRUCK, speed=22.86, modes=3).summary()
    alone = row(single, here, "largest ")
    place = re.findall(r"x = [\d.]+ m", alone)
    line = row(ensemble(samples=1).summary(), name)
    assert re.findall(r"x = [\d.]+ m", line) == place
    assert numbers(line)[0] == float(alone.split()[-1])


def test_the_governing_section() -> None:
    dynamic = np.array([[1.0, 3.0, 2.0, 9.0], [1.0, 3.0, 2.5, 9.0], [np.nan] * 4])
    static = np.array([[2.0, 2.0 - 1e-10, 2.0 + 1e-10, 1.9]] * 2 + [[np.nan] * 4])
    assert governing(dynamic, static) == 1
    static[:, 2] += 1e-8
    assert governing(dynamic, static) == 2


def test_rows_say_what_they_are(rough: sw.Ensemble) -> None:
    text = rough.summary()
    assert "where the static value is largest" in text
    assert "the one with the larger dynamic value, by their medians" in text
    assert "factors far from where a response governs are to be read with the response" in text
    of = rough.envelope("moment").max.max(axis=1) / rough.envelope("moment").static_max.max(axis=1)
    line = row(text, "sagging", "largest by largest")
    expected = [of.mean(), *np.percentile(of, [5, 50, 95, 99]), of.max()]
    assert numbers(line) == pytest.approx(expected, abs=6e-4)
    assert "anywhere along the bridge by the largest static one anywhere" in text
    for name, table in (("axle load, approach too [kN]", "largest in"), ("axle_loads, app", "imp")):
        assert row(text, name, table)
    assert "approach too" not in ensemble(samples=1).summary()


def test_static_values_that_differ_are_medians(rough: sw.Ensemble) -> None:
    text = rough.summary()
    title = next(line for line in text.split("\n") if line.startswith("largest in a sample"))
    assert "static, median" in title
    expected = np.median(rough.envelope("moment").static_max.max(axis=1)) / 1e3
    assert numbers(row(text, "moment, sagging", "largest in"))[5] == pytest.approx(expected, 1e-5)
    assert "static, median" in legend(rough.plot.envelope("moment"))
    assert "static, median" in legend(rough.plot.envelope("reactions"))
    fixed = ensemble(samples=2)
    assert "static, median" not in fixed.summary()
    assert "static" in legend(fixed.plot.envelope("moment"))


def test_roads_of_their_own() -> None:
    x = np.arange(-130.0, 60.0, 0.5)
    roads = [sw.Profile(x, 0.003 * np.sin(x / 3.0 + k)) for k in range(7)]
    kinds = [[sw.Passage(vehicle=TRUCK, road=each)] for each in roads]
    found = ensemble(vehicle=kinds, kind=range(7), samples=7, speed=20.0)
    text = found.summary()
    assert "road      smooth" not in text
    assert "road      each vehicle's own" in text
    said = "on a road of its own: profile, 380 points from -130 to 59.5 m"
    assert text.count(said) == 5
    assert "and 2 kinds more" in text
    assert "nothing is random" not in text
    single = sw.cross(BRIDGE, TRUCK, speed=20.0, modes=3, road=roads[3])
    assert np.array_equal(found.envelope("moment").max[3], single.envelope("moment").max.value)
    both = [sw.Passage(vehicle=TRUCK, road=roads[0]), sw.Passage(vehicle=TRUCK, direction="left")]
    text = ensemble(vehicle=both, samples=1, road=sw.Step(at=1.0, height=0.01)).summary()
    assert f"vehicle 1 {said}" in text
    assert "to the left" in text
    assert "road      step" in text


def test_nothing_is_random() -> None:
    said = "all samples are alike: nothing is random"
    constant = {"bridge_stiffness": np.full(3, 0.8), "tyre_stiffness": [[1.0, 0.9]] * 3}
    text = ensemble(samples=3, factors=constant, speed=[20.0] * 3).summary()
    assert said in text
    assert "factor    bridge_stiffness 0.8 for all samples" in text
    assert "factor    tyre_stiffness 1, 0.9 for all samples" in text
    assert "say little" not in text
    assert said in ensemble(samples=3, road=sw.ISO8608("B"), own_roads=False).summary()
    several: tuple[dict[str, Any], ...] = (
        {"speed": [20.0, 20.0, 21.0]},
        {"factors": {"body_mass": [1.0, 1.0, 1.1]}},
        {"road": sw.ISO8608("B")},
        {"vehicle": [TRUCK, sw.vehicles.hs20()], "kind": [0, 0, 1]},
    )
    for varied in several:
        assert said not in ensemble(**{"samples": 3, **varied}).summary()


def test_the_step(rough: sw.Ensemble) -> None:
    steps: list[Any] = [rough.run(i).settings["step"] for i in range(SAMPLES)]
    assert f"step      {min(steps):.4g} to {max(steps):.4g} s" in rough.summary()
    alone = ensemble(samples=1, drive="constant-traction")
    assert 'step      of each sample as for cross, run(i).settings["step"]' in alone.summary()
    given = ensemble(samples=1, drive="constant-traction", step=0.002)
    assert "step      at most 0.002 s" in given.summary()


@pytest.mark.parametrize(
    ("samples", "said"),
    [
        (5, "of 5 samples 5 %, 50 %, 95 % and 99 % say little"),
        (100, "of 100 samples 95 % and 99 % say little"),
        (200, "of 200 samples 99 % say little"),
        (1000, None),
    ],
)
def test_few_samples(samples: int, said: str | None) -> None:
    speeds = np.linspace(20.0, 22.0, samples)
    text = ensemble(samples=samples, speed=speeds, sections=[9.0], advance=0.1).summary()
    assert (said or "") in text
    assert ("say little" in text) == (said is not None)


def test_a_single_section_is_drawn() -> None:
    found = ensemble(road=sw.ISO8608("C", period=256.0), sections=[9.0])
    for quantity in ("deflection", "moment", "shear"):
        figure = found.plot.envelope(quantity)
        points = [line for line in figure.axes[0].lines if line.get_marker() == "o"]
        assert [np.asarray(line.get_xdata()).tolist() for line in points] == [[9.0], [9.0]]
        assert len(figure.axes[0].containers) == 2
        low, high = sorted(figure.axes[0].get_ylim())
        assert all(low < float(np.asarray(line.get_ydata())[0]) < high for line in points)
        figure.canvas.draw()
    figure = found.plot.impact_factors("sagging")
    assert len(figure.axes[0].containers) == 1
    assert "largest" in legend(figure)


def test_curves_stay_in_the_frame_or_are_said_to_be_cut(rough: sw.Ensemble) -> None:
    for quantity in ("deflection", "sagging", "hogging", "shear"):
        (ax,) = rough.plot.impact_factors(quantity).axes
        drawn = np.concatenate([np.asarray(line.get_ydata(), float) for line in ax.lines[:4]])
        low, high = ax.get_ylim()
        cut = re.search(r"cut at ([\d.]+); the largest is ([\d.]+)", ax.get_xlabel())
        assert 0.5 < low < min(1.0, np.nanmin(drawn))
        if np.nanmax(drawn) > high:
            assert cut is not None
            assert float(cut[1]) == pytest.approx(high, rel=0.01)
            assert float(cut[2]) == pytest.approx(np.nanmax(drawn), rel=0.01)
        else:
            assert cut is None


def test_figures_tell_how_many_samples(rough: sw.Ensemble, failing: sw.Ensemble) -> None:
    assert f"5 to 95 % of {SAMPLES} samples" in legend(rough.plot.impact_factors("sagging"))
    assert f"median, 5 to 95 % of {SAMPLES} samples" in legend(rough.plot.envelope("reactions"))
    assert len(failing.failures) == 2
    said = f"5 to 95 % of {SAMPLES - 2} samples (2 failed)"
    assert said in legend(failing.plot.envelope("moment"))
    assert said in legend(failing.plot.impact_factors("sagging"))
    assert f"median, {said}" in legend(failing.plot.impact_factors("axle_loads"))
    failing.summary()


def test_markers_stand_at_their_support() -> None:
    clamped = sw.Bridge(length=20.0, supports=[(0.0, "clamped")], EI=5e9, mass=6e3)
    found = ensemble(clamped, road=sw.ISO8608("B", period=128.0), samples=10)
    figure = found.plot.envelope("reactions")
    (ax,) = figure.axes
    figure.canvas.draw()
    markers = [line for line in ax.lines if line.get_marker() in ("o", "D")]
    assert len(markers) == 4
    (middle, _) = ax.transData.transform((0.0, 0.0))
    for line in markers:
        assert np.asarray(line.get_xdata()).tolist() == [0.0]
        at = line.get_transform().transform((0.0, 0.0))[0]
        assert 0.0 < abs(at - middle) * 72.0 / figure.dpi < 6.0


def test_what_is_masked_everywhere() -> None:
    clamped = sw.Bridge(length=20.0, supports=[(0.0, "clamped")], EI=5e9, mass=6e3)
    found = ensemble(clamped, samples=2)
    with pytest.raises(ValueError, match="masked everywhere: no static value of 'sagging'"):
        found.plot.impact_factors("sagging")
    assert row(found.summary(), "sagging").split() == ["sagging", "-"]


def test_the_ensemble_of_the_readme_stands_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    block = next(each for each in blocks if "sw.ensemble(" in each)
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {})
    assert (tmp_path / "many.png").stat().st_size > 0


def test_docstrings_name_the_results() -> None:
    told = sw.Ensemble.envelope.__doc__ or ""
    for name in ("deflection", "moment", "shear", "reactions", "axle_loads"):
        assert f'``"{name}"``' in told
    assert "SampleExtremes" in told
    assert "(samples, " in told
    for name in (".max", ".min", ".static_max", ".max_time", ".max_position"):
        assert name in told
    assert "bridge as given" in " ".join((sw.Ensemble.__doc__ or "").split())


def test_deck_motion_has_no_static_value_and_no_sign() -> None:
    text = ensemble(samples=3, quantities=["deflection", "slope", "acceleration"]).summary()
    rows = {line.split(" [")[0]: line.split() for line in text.split("\n")}
    assert rows["acceleration"][7] == "-"
    assert float(rows["deflection, down"][8]) > 0.0
    assert "slope, acceleration: the larger of both signs, without its sign" in text
