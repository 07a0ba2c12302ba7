"""An ensemble as text, archive, figures and on the command line."""

from __future__ import annotations

import json
import signal
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise._ensemble_files import as_dict
from spanwise.cli import main

BRIDGE = sw.Bridge(spans=[18.288, 18.288], EI=1.94148e9, mass=6037.7, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()

CASE = """
[bridge]
spans = [18.288, 18.288]
EI = 1.94148e9
mass = 6037.7
stations_per_span = 3
[vehicle]
preset = "kishan-1973"
[road]
kind = "iso-8608"
class = "B"
period = 128.0
[crossing]
speed = 22.86
modes = 3
damping = 0.01
approach = 20
ramp = 5
[ensemble]
advance = 0.03
"""


@pytest.fixture(scope="module")
def found() -> sw.Ensemble:
    return sw.ensemble(
        BRIDGE,
        TRUCK,
        samples=200,
        seed=1,
        speed=np.linspace(15.0, 30.0, 200),
        road=sw.ISO8608("C", period=128.0),
        factors={"body_mass": np.linspace(0.8, 1.2, 200)},
        approach=20.0,
        ramp=5.0,
        modes=3,
    )


def test_summary(found: sw.Ensemble) -> None:
    text = found.summary()
    assert found._repr_html_().startswith("<pre>ensemble  200 samples from number 0 of seed 1")
    assert max(map(len, text.split("\n"))) <= 110
    assert "15 to 30 m/s, constant-speed" in text
    assert "iso-8608 class C, drawn anew for each sample" in text
    assert "varied    body_mass from 0.8 to 1.2" in text
    assert f"hash      {found.hash}" in text
    assert "side by side" in text
    (row,) = [line for line in text.split("\n") if line.startswith("moment, sagging")]
    most = found.envelope("moment").max.max(axis=1) / 1e3
    numbers = [float(each) for each in row.split("]")[1].split()[:5]]
    expected = [*np.percentile(most, [5, 50, 95, 99]), most.max()]
    assert numbers == pytest.approx(expected, abs=1e-3)
    row = next(line for line in text.split("\n") if line.startswith("sagging"))
    static = np.median(found.envelope("moment").static_max, axis=0)
    # The bridge is symmetric: of sections alike the one with the larger dynamic value.
    alike = np.flatnonzero(static >= (1.0 - 1e-9) * static.max())
    at = int(alike[np.argmax(np.median(found.envelope("moment").max[:, alike], axis=0))])
    factors = found.impact_factors.sagging[:, at]
    assert float(row.split()[1]) == pytest.approx(factors.mean(), abs=1e-3)
    alone = sw.ensemble(BRIDGE, TRUCK, samples=1, speed=20.0, drive="constant-traction")
    assert "each on its own way" in alone.summary()


def test_repr(found: sw.Ensemble) -> None:
    assert repr(found) == (
        "Ensemble(200 samples from 0 of seed 1, 25 sections, deflection, moment, shear, "
        f"reactions; hash {found.hash})"
    )
    assert repr(found.envelope("moment")) == "SampleExtremes(200 samples, 25 columns)"


def test_archive(found: sw.Ensemble, tmp_path: Path) -> None:
    path = tmp_path / "found.npz"
    found.to_npz(path)
    with np.load(path) as archive:
        for name in ("sections", "supports", "frequencies"):
            assert_array_equal(archive[name], getattr(found, name))
        assert_array_equal(archive["lift_offs"], found.contact_loss.count)
        assert f"damping {archive['damping']}" in found.summary()
        assert_array_equal(archive["moment_max"], found.envelope("moment").max)
        assert_array_equal(archive["shear_left_min_time"], found.envelope("shear_left").min_time)
        assert_array_equal(
            archive["axle_loads_static_max"], found.envelope("axle_loads").static_max
        )
        assert str(archive["hash"]) == found.hash
        settings = json.loads(str(archive["settings"]))
    assert settings["ensemble"]["road"]["class"] == "C"
    assert settings["ensemble"]["samples"] == 200
    with pytest.raises(OSError, match="no such folder"):
        found.to_npz(tmp_path / "missing" / "found.npz")


@pytest.mark.filterwarnings("ignore::spanwise.PlausibilityWarning")
def test_plain_values() -> None:
    """Of two kinds, of which one has one axle, and of a sample that fails."""
    kind = np.arange(20) % 2
    found = sw.ensemble(
        BRIDGE,
        [TRUCK, sw.vehicles.quarter_car()],
        samples=20,
        first=7,
        speed=np.linspace(15.0, 30.0, 20),
        kind=kind,
        factors={"body_mass": np.where(np.arange(20) == 3, 1e305, 1.0)},
        damping=0.02,
        modes=3,
    )
    told = as_dict(found)
    assert [each["sample"] for each in told["failures"]] == [10]
    sound = np.arange(20) != 3
    percentiles = (1, 5, 25, 50, 75, 95, 99)
    assert told["percentiles"] == [*percentiles]
    for name in ("deflection", "moment", "shear", "reactions"):
        for side in ("max", "min"):
            values = getattr(found.envelope(name), side)[sound]
            expected = np.percentile(values, percentiles, axis=0)
            assert_array_equal(told["extremes"][name][side], expected)
    loads = np.array(told["extremes"]["axle_loads"]["max"])
    front, rear = found.envelope("axle_loads").max.T
    assert_array_equal(loads[:, 0], np.percentile(front[sound], percentiles))
    assert_array_equal(loads[:, 1], np.percentile(rear[kind == 0], percentiles))
    at = found.sections.tolist().index(9.144)
    factors = np.array(told["impact_factors"]["sagging"])
    expected = np.percentile(found.impact_factors.sagging[sound, at], percentiles)
    assert_array_equal(factors[:, at], expected)
    tails = found.tail[sound]
    assert told["tail"] == {
        "shortest": tails.min(),
        "longest": tails.max(),
        "samples_that_can_grow": 0,
    }
    assert tails.min() < tails.max()
    assert told["elapsed"] == found.elapsed > 0.0
    failed = as_dict(
        sw.ensemble(BRIDGE, TRUCK, samples=1, speed=20.0, factors={"body_mass": [1e305]})
    )
    assert (failed["extremes"], failed["impact_factors"]) == ({}, {})
    assert failed["tail"]["longest"] is None


@pytest.mark.parametrize("quantity", ["deflection", "sagging", "hogging", "shear", "reactions"])
def test_figures_of_impact_factors(found: sw.Ensemble, quantity: str) -> None:
    figure = found.plot.impact_factors(quantity)
    (ax,) = figure.axes
    assert "dynamic" in ax.get_ylabel()
    if quantity not in ("reactions",):
        values = found.impact_factors[quantity]
        drawn = next(line for line in ax.lines if line.get_label() == "median")
        there = ~np.isnan(values).all(axis=0)
        expected = np.full(values.shape[1], np.nan)
        expected[there] = np.nanmedian(values[:, there], axis=0)
        assert_array_equal(np.asarray(drawn.get_ydata()), expected)
    figure.canvas.draw()
    found.plot.impact_factors("axle_loads").canvas.draw()


@pytest.mark.parametrize("quantity", ["deflection", "moment", "shear", "reactions"])
def test_figures_of_envelopes(found: sw.Ensemble, quantity: str) -> None:
    figure = found.plot.envelope(quantity)
    figure.canvas.draw()
    legend = figure.axes[0].get_legend()
    assert legend is not None
    assert "static, median" in [text.get_text() for text in legend.get_texts()]
    with pytest.raises(ValueError, match="was not looked at"):
        found.plot.envelope("clamp_moments")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sw.PlausibilityWarning)
        failed = sw.ensemble(BRIDGE, TRUCK, samples=1, speed=20.0, factors={"body_mass": [1e305]})
    assert len(failed.failures) == 1
    with pytest.raises(ValueError, match="samples: none has a value to draw"):
        failed.plot.envelope()


def test_a_case() -> None:
    case = sw.Case.parse(CASE)
    many = case.ensemble(samples=5, seed=3)
    assert many.settings["advance"] == 0.03
    assert case.run().sections.shape == many.sections.shape
    with pytest.raises(sw.case.CaseError, match="case: samples = -1: must be from 1 to 4294967295"):
        case.ensemble(samples=-1)
    with pytest.raises(sw.case.CaseError, match=r"unknown key 'advanse'.*did you mean"):
        sw.Case.parse(CASE.replace("advance", "advanse"))


def test_command(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    npz, table = case.parent / "out.npz", case.parent / "out.json"
    command = ["ensemble", str(case), "--samples", "20", "--seed", "5", "--first", "3"]
    command += ["--threads", "2", "--modes", "2"]
    assert main([*command, "--out", str(npz), "--json", str(table)]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    expected = sw.Case.read(case).ensemble(samples=20, seed=5, first=3, modes=2)
    assert f"hash      {expected.hash}" in out
    assert "crossings/s" in out
    with np.load(npz) as archive:
        assert_array_equal(archive["deflection_min"], expected.envelope("deflection").min)
        assert_array_equal(archive["numbers"], np.arange(3, 23))
    results = json.loads(table.read_text(encoding="utf-8"))
    assert results["hash"] == expected.hash
    percentiles = results["extremes"]["moment"]["max"]
    assert percentiles[3] == pytest.approx(
        np.median(expected.envelope("moment").max, axis=0).tolist()
    )
    assert main([*command, "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["hash"] == expected.hash


def test_command_on_the_same_road(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # Advice names the option that is there: two random parts cannot both be drawn anew.
    other = CASE.replace("[road]", "[[road]]") + '[[road]]\nkind = "iso-8608"\nclass = "A"\n'
    case.write_text(other, encoding="utf-8")
    command = ["ensemble", str(case), "--samples", "3"]
    assert main(command) == 2
    assert "or own_roads=False to take all as they stand" in capsys.readouterr().err
    expected = sw.Case.read(case).ensemble(samples=3, own_roads=False)
    for option in ("--set=own_roads=False", "--set=own_roads=false", "--same-road"):
        assert main([*command, option]) == 0
        out, err = capsys.readouterr()
        assert f"hash      {expected.hash}" in out
        assert ("--same-road is now --set own_roads=..." in err) == (option == "--same-road")


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--samples", "-3"], "samples = -3: must be from 1 to 4294967295"),
        (["--samples", "x"], "samples = 'x': must be a whole number"),
        (["--samples", "3", "--threads", "0"], "--threads = 0: must be from 1"),
        (["--samples", "3", "--out", "here.txt"], "--out here.txt: must end in .npz"),
        (["--samples", "3", "--out", "missing/here.npz"], "missing: no such folder"),
        ([], "--samples: missing; give it, or samples in [ensemble] of"),
    ],
)
def test_command_refuses(
    case: Path, more: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(["ensemble", str(case), *more])
    except SystemExit as stop:
        code = int(str(stop.code))
    assert code == 2
    assert says in capsys.readouterr().err
    assert {path.name for path in case.parent.iterdir()} == {"case.toml"}


@pytest.mark.skipif(sys.platform == "win32", reason="signals differ")
def test_command_interrupted(case: Path, start: Any) -> None:
    program = f"""
        import os, signal, sys, threading
        from spanwise.cli import main

        signal.signal(signal.SIGINT, signal.default_int_handler)
        threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        sys.exit(main(["ensemble", {str(case)!r}, "--samples", "200000",
                       "--out", {str(case.parent / "run.npz")!r}]))
    """
    done = start(program).wait()
    assert done.stderr == "spanwise: interrupted\n"
    assert done.returncode == 128 + signal.SIGINT
    assert [path.name for path in case.parent.iterdir()] == ["case.toml"]
