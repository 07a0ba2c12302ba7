"""The command line: what it prints and writes, and how it says no."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import pytest

import spanwise as sw
from spanwise.cli import main

CASE = """
[bridge]
spans = [18.288, 18.288]
EI = 1.9415e9
mass = 6037.6
stations_per_span = 3
[vehicle]
preset = "kishan-1973"
[crossing]
speed = 22.86
drive = "constant-traction"
modes = 3
damping = 0
step = 5e-3
beta = 0.25
"""

#: So soft that the vehicle does not come out of the sag.
SOFT = CASE.replace("1.9415e9", "1e7").replace("22.86", "1.0")

ROAD = """
[road]
kind = "iso-8608"
class = "C"
seed = 2
"""
JOINT = """
[[road]]
kind = "joint"
at = 0.0
gap = 0.05
depth = 0.02
"""

MOTION = ("slope", "velocity", "acceleration")
FIGURES = ("model", "deflection", "moment", "shear", *MOTION, "impact_factors", "vehicle")


def left(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()} - {"case.toml"}


def test_summary(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cross", str(case)]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    run = sw.Case.read(case).run()
    assert str(run.impact_factors) in out
    lines = {line[:24].strip(): line.split() for line in out.splitlines()}
    # The greatest sagging moment, where and when, its static partner in the table, their ratio.
    moment = run.envelope("moment")
    i = int(moment.max.value.argmax())
    expected = [
        f"{moment.max.value[i] / 1e3:.3f}",
        *("x", "=", f"{run.sections[i]:.3f}", "m"),
        f"{moment.max.time[i]:.4f}",
        f"{moment.max.position[i]:.3f}",
        f"{moment.static_max.value[i] / 1e3:.3f}",
        f"{moment.max.value[i] / moment.static_max.value[i]:.3f}",
    ]
    assert lines["moment, sagging [kN m]"][4:] == expected
    # 32 040 lb an axle.
    assert "static axle loads 142.5, 142.5 kN" in out
    assert "constant-traction" in out
    assert f"{run.frequencies[0]:.3f}" in out
    # The hogging moment is governed by the middle support.
    assert "x = 18.288 m" in out


def test_summary_of_every_kind_of_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = tmp_path / "case.toml"
    matrix = "[[1000.0, 0.0], [0.0, 1000.0]]"
    case.write_text(
        CASE.replace("spans = [18.288, 18.288]", "spans = [18.0]")
        .replace("= 3\n[v", '= 2\nends = ["clamped", "pinned"]\n[v')
        .replace("modes = 3\ndamping = 0", f"modes = 2\ndamping = {matrix}"),
        encoding="utf-8",
    )
    assert main(["cross", str(case)]) == 0
    out, _ = capsys.readouterr()
    assert "damping by a matrix" in out
    assert "clamped at 0 m" in out


def test_modes_go_before_those_of_the_case(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cross", str(case), "--modes", "1", "--json", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)["frequencies"]) == 1


def test_speed_and_road_go_before_those_of_the_case(
    case: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["--speed", "15", "--road", "B", "--seed", "3"]
    assert main(["cross", str(case), *given, "--json", "-"]) == 0
    settings = json.loads(capsys.readouterr().out)["settings"]
    assert settings["crossing"]["speed"] == 15.0
    assert settings["road"] == sw.ISO8608("B", seed=3).arguments | {"band": [0.01, 4.0]}
    case.write_text(CASE + '[[road]]\nkind = "iso-8608"\nG = 2e-5\n' + JOINT, encoding="utf-8")
    # A road of another class keeps the seed of the case.
    assert main(["cross", str(case), "--road", "D", "--json", "-"]) == 0
    road = json.loads(capsys.readouterr().out)["settings"]["road"]
    assert (road["class"], road["seed"]) == ("D", 0)
    case.write_text(CASE + ROAD, encoding="utf-8")
    assert main(["cross", str(case), "--road", "D", "--json", "-"]) == 0
    road = json.loads(capsys.readouterr().out)["settings"]["road"]
    assert (road["class"], road["seed"]) == ("D", 2)
    case.write_text(CASE + '[[road]]\nkind = "iso-8608"\nG = 2e-5\n' + JOINT, encoding="utf-8")
    assert main(["cross", str(case), "--seed", "3", "--json", "-"]) == 0
    road = json.loads(capsys.readouterr().out)["settings"]["road"]
    assert (road[0]["G"], road[0]["seed"], road[1]["kind"]) == (2e-5, 3, "joint")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--speed", "-2"], "speed = -2: must be"),
        (["--road", "b"], "with road set, [road]: class = 'b': must be one of A, B, C"),
        (["--road", "B", "--seed", "-1"], "--seed = -1: must not be negative"),
        (["--seed", "1"], "has no random [road]; add one, or --road"),
    ],
)
def test_bad_overrides(
    case: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    assert main(["cross", str(case), *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("spanwise: error: ")
    assert message in err
    assert err.count("\n") == 1


def test_road(case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case.write_text(CASE + ROAD, encoding="utf-8")
    assert main(["road", str(case)]) == 0
    road = sw.ISO8608("C", seed=2)
    out = capsys.readouterr().out
    assert "section   0 to 1024 m\n" in out
    assert f"IRI       {road.iri(0.0, 1024.0):.2f} m/km\n" in out
    assert "ISO 8608  class C (0.000128 to 0.000512 m3), fitted G_d(n0)" in out
    profile = tmp_path / "profile.csv"
    x = [0.2 * k for k in range(1000)]
    lines = [f"{a},{b}" for a, b in zip(x, road.elevation(x), strict=True)]
    profile.write_text("\n".join(["x,z", *lines]), encoding="ascii")
    assert main(["road", str(profile), "--start", "20", "--end", "120"]) == 0
    out = capsys.readouterr().out
    assert "profile, 1000 points from 0 to 199.8 m" in out
    assert "section   20 to 120 m\n" in out
    assert "class C" in out
    assert main(["road", str(profile), "--end", "500"]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "covers only" in err
    other = tmp_path / "mm.csv"
    other.write_text("a;z;x\n" + "".join(f"0;{1e3 * float(road.elevation(a))};{a}\n" for a in x))
    at = ["road", str(other), "--set", "delimiter=;", "--end", "150", "--set", "road.max_gap=0.5"]
    assert main([*at, "--set", "columns=['x', 'z']", "--set", "scale=[1, 1e-3]"]) == 0
    found = capsys.readouterr()
    assert "class C" in found.out
    assert found.err == ""
    assert main([*at, "--set", "columns=[2, 1]"]) == 0
    # The text says it, and so does standard error, once each.
    for text in capsys.readouterr():
        assert text.count("elevations: their median slope is") == 1
    assert main(["road", str(case), "--set", "scale=[1, 1e-3]"]) == 2
    assert "'scale' (not beside kind = 'iso-8608', but profile)" in capsys.readouterr().err


def test_the_road_of_a_case_needs_no_more_than_a_road(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "road.toml"
    file.write_text(ROAD + '[bridge]\nspans = "to come"\n', encoding="utf-8")
    assert main(["road", str(file)]) == 0
    assert "road      iso-8608 class C" in capsys.readouterr().out
    file.write_text(ROAD.replace("road", "raod"), encoding="utf-8")
    assert main(["road", str(file)]) == 2
    assert "unknown table or key 'raod' (did you mean 'road'?)" in capsys.readouterr().err
    file.write_text(ROAD.replace("seed", "sead"), encoding="utf-8")
    assert main(["road", str(file)]) == 2
    assert f"{file}, [road]: unknown key 'sead'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "is_profile"),
    [
        ("x [m];z [mm]\n" + "".join(f"{k},5;{k}\n" for k in range(20)), True),
        ("# measured\n" + "".join(f"  {k}.5  0.1\n" for k in range(20)), True),
        ("ERDFILEV2.00\n   2,   5,  -1,   1,   5,  0.5,  -1,\nEND\n", True),
        (CASE.replace("speed", "sped"), False),
        (CASE + "points = [\n1.0,\n2.0\n", False),
        ("", False),
    ],
)
def test_a_profile_in_place_of_a_case(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, is_profile: bool
) -> None:
    file = tmp_path / "p.csv"
    file.write_text(text, encoding="utf-8")
    for command in (["cross", str(file)], ["ensemble", str(file), "--samples", "2"]):
        assert main(command) == 2
        err = capsys.readouterr().err
        said = f"{file}: is a measured profile, not a case; in a case it is the road:\n"
        lines = f'[road]\nkind = "profile"\nfile = "{file}"\n'
        assert ((said + lines) in err) == is_profile


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (["cross", "a.toml", "--speeed", "3"], "--speeed 3 (did you mean '--speed'?)"),
        (["cross", "a.toml", "--plots=x"], "--plots=x (did you mean '--plot'?)"),
        (["ensemble", "--samples", "3", "a.toml", "--thread", "3"], "(did you mean '--threads'?)"),
        (["road", "a.csv", "--profile_start", "3"], "(did you mean '--profile-start'?)"),
        (["vehicles", "t44", "t45"], "unrecognized arguments: t45\n"),
        (
            ["cross", "a.toml", "--samples", "20"],
            "--samples 20 (an option of spanwise ensemble)\n",
        ),
        (["road", "a.toml", "--seed=2"], "--seed=2 (an option of spanwise cross and "),
        (["croos", "a.toml"], "(did you mean 'cross'?)\n"),
    ],
)
def test_an_option_misspelt_is_suggested(
    given: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(given)
    assert says in capsys.readouterr().err


def test_road_by_segments_and_as_json(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case.write_text(CASE + ROAD, encoding="utf-8")
    road = sw.ISO8608("C", seed=2)
    given = ["road", str(case), "--start", "10", "--end", "210", "--every", "50"]
    assert main(given) == 0
    out = capsys.readouterr().out
    found, segments = road.iso_class(10.0, 210.0), road.iri(10.0, 210.0, every=50.0)
    assert found.error is not None
    assert found.band is not None
    said = f"standard error {100 * found.error:.0f} %, from 0.06 to {found.band[1]:.3g} cycle/m\n"
    assert said in out
    assert f"IRI by segments, after a lead-in of 50 m\n{segments}\n" in out
    file = tmp_path / "road.json"
    assert main([*given, "--json", str(file)]) == 0
    assert capsys.readouterr().out == out
    assert main([*given, "--json", "-"]) == 0
    written = capsys.readouterr().out
    assert file.read_text(encoding="utf-8") == written
    told = json.loads(written)
    assert told["section"] == [10.0, 210.0]
    assert told["iri"] == road.iri(10.0, 210.0)
    assert told["iri_segments"]["values"] == segments.values.tolist()
    assert told["iri_segments"]["lead_in"] == 50.0
    iso = told["iso_8608"]
    assert (iso["class"], iso["G"], iso["error"]) == (found.letter, found.G, found.error)
    assert iso["band"] == list(found.band)
    # What was read is not written over.
    assert main(["road", str(case), "--json", str(case)]) == 2
    assert "was read, and is not overwritten" in capsys.readouterr().err
    # Too short for a class: the reason in its place.
    assert main(["road", str(case), "--end", "12", "--json", "-"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["iso_8608"] is None
    assert "two octaves" in told["iso_8608_refused"]


def test_road_of_coarse_points(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    road = sw.ISO8608("B", seed=4, contact_patch=0.0)

    def asked(spacing: float, end: float, *options: str) -> tuple[int, str, str]:
        file = tmp_path / "profile.csv"
        lines = [f"{x},{float(road.elevation(x))}\n" for x in np.arange(0.0, end, spacing)]
        file.write_text("".join(lines), encoding="ascii")
        return main(["road", str(file), *options]), *capsys.readouterr()

    # Once, however often it is looked at.
    code, out, err = asked(0.5, 600.0, "--end", "544", "--every", "100")
    assert code == 0
    for text in (out, err):
        assert text.count("its points are 0.5 m apart") == 1
    assert "IRI       4.07 m/km\n" in out
    assert "\nwarning   road: its points are 0.5 m apart" in out
    _, out, err = asked(0.5, 600.0, "--end", "544", "--json", "-")
    assert err.startswith("spanwise: warning: road: its points are 0.5 m apart")
    assert [f"spanwise: warning: {each}\n" for each in json.loads(out)["warnings"]] == [err]
    # What they cannot hold is not told, and the class still is.
    code, out, err = asked(2.5, 2000.0)
    assert (code, err) == (0, "")
    assert "IRI       road: its points are 2.5 m apart" in out
    assert "ISO 8608  class B" in out
    code, out, err = asked(2.5, 2000.0, "--json", "-")
    told = json.loads(out)
    assert told["iri"] is None
    assert told["iri_refused"].startswith("road: its points are 2.5 m apart")
    assert told["iso_8608"]["class"] == "B"
    # Nothing is left to tell of so few, or of segments.
    for end, *options in ((100.0,), (2000.0, "--every", "100")):
        code, out, err = asked(2.5, end, *options)
        assert (code, out, err.count("\n")) == (2, "", 1)
        assert err.startswith("spanwise: error: road: its points are 2.5 m apart")


def test_figures_of_traffic(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Which there are: what is on them is looked at elsewhere.
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda *_, **__: None)
    case = tmp_path / "case.toml"
    bridge, _, crossing = CASE.partition("[vehicle]")
    traffic = '[[traffic]]\nvehicle = { preset = "hs20" }\n'
    other = traffic + 'direction = "left"\n'
    crossing = "[crossing]\nspeed = 20.0\nstep = 5e-3\nbeta = 0.25\n"
    case.write_text(bridge + traffic + other + ROAD + crossing, encoding="utf-8")
    assert main(["cross", str(case), "--plot", str(tmp_path / "figures")]) == 0
    names = {*FIGURES, "vehicle_1", "vehicle_2", "road"} - {"vehicle"}
    assert left(tmp_path / "figures") == {f"{n}.{form}" for n in names for form in ("png", "svg")}


def test_json_alone_on_standard_output(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cross", str(case), "--json", "-"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out) == sw.Case.read(case).run().to_dict()
    assert err == ""
    assert left(case.parent) == set()


def test_check(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cross", str(case), "--check"]) == 0
    run = sw.Case.read(case).run()
    assert capsys.readouterr().out == f"{run.summary()}\n\n{run.check().summary()}\n"
    assert main(["cross", str(case), "--check", "--json", "-"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert "--check: prints text, and --json - gives none" in err


def test_files(case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    json_file, csv_folder = tmp_path / "run.json", tmp_path / "a" / "csv"
    assert main(["cross", str(case), "--json", str(json_file), "--csv", str(csv_folder)]) == 0
    assert "largest" in capsys.readouterr().out
    run = sw.Case.read(case).run()
    assert json.loads(json_file.read_text(encoding="utf-8")) == run.to_dict()
    run.to_csv(tmp_path / "same")
    same = {path.name: path.read_bytes() for path in (tmp_path / "same").iterdir()}
    assert {path.name: path.read_bytes() for path in csv_folder.iterdir()} == same


def test_figures(case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written = matplotlib.figure.Figure.savefig

    def coarsely(figure: Any, file: Any, dpi: float = 100.0, **given: Any) -> None:
        """As it writes them, but coarser and not laid out, which takes most of the time."""
        figure.set_layout_engine("none")
        written(figure, file, dpi=0.2 * dpi, **given)

    monkeypatch.setattr("matplotlib.figure.Figure.savefig", coarsely)
    assert main(["cross", str(case), "--plot", str(tmp_path / "figures")]) == 0
    expected = {f"{name}.{form}" for name in FIGURES for form in ("png", "svg")}
    assert left(tmp_path / "figures") == expected
    for name in FIGURES:
        assert (tmp_path / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert "<svg" in (tmp_path / "figures" / f"{name}.svg").read_text(encoding="utf-8")


def test_tables_and_figures_of_an_ensemble(
    case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # Which there are: what is on them is looked at elsewhere.
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda *_, **__: None)
    case.write_text(CASE.replace("step = 5e-3\nbeta = 0.25\n", "") + ROAD, encoding="utf-8")
    table, figures = tmp_path / "many.csv", tmp_path / "figures"
    given = ["--samples", "4", "--csv", str(table), "--plot", str(figures)]
    assert main(["ensemble", str(case), *given]) == 0
    factors = [f"impact_factor_{name}" for name in ("deflection", "sagging", "hogging", "shear")]
    names = {"deflection", "moment", "shear", "reactions", *factors}
    names |= {f"impact_factor_{name}" for name in ("reactions", "axle_loads")}
    assert left(figures) == {f"{name}.{form}" for name in names for form in ("png", "svg")}
    expected = tmp_path / "expected.csv"
    sw.Case.read(case).ensemble(samples=4).to_csv(expected)
    assert table.read_bytes() == expected.read_bytes()
    capsys.readouterr()
    # Told before the work of an hour.
    for module, option in (("pandas", "--csv"), ("matplotlib", "--plot")):
        monkeypatch.setitem(sys.modules, module, None)
        asked = ["ensemble", str(case), "--samples", "100000000", option, str(tmp_path / "x")]
        assert main(asked) == 2
        assert f"this needs {module}" in capsys.readouterr().err


def test_results_are_cases_again(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case.write_text(CASE + ROAD, encoding="utf-8")
    results, again = tmp_path / "run.json", tmp_path / "again.json"
    assert main(["cross", str(case), "--json", str(results)]) == 0
    first = capsys.readouterr().out
    assert main(["cross", str(results), "--json", str(again)]) == 0
    assert capsys.readouterr().out == first
    assert again.read_bytes() == results.read_bytes()
    told = json.loads(results.read_text(encoding="utf-8"))
    run = sw.Case.read(results).run()
    assert run.to_dict() == told
    assert sw.Case.from_dict(told).run() == run
    # Keys are set, and roads looked at, as those of any case; what was read is not written over.
    assert main(["cross", str(results), "--set", "crossing.modes=1", "--json", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)["frequencies"]) == 1
    assert main(["cross", str(results), "--json", str(results)]) == 2
    assert "was read, and is not overwritten" in capsys.readouterr().err
    assert main(["road", str(results)]) == 0
    assert "road      iso-8608 class C" in capsys.readouterr().out
    case.write_text(CASE.replace("step = 5e-3\nbeta = 0.25\n", "") + ROAD, encoding="utf-8")
    assert main(["ensemble", str(case), "--samples", "3", "--json", str(results)]) == 0
    assert main(["road", str(results)]) == 0
    assert "road      iso-8608 class C" in capsys.readouterr().out
    digest = json.loads(results.read_text(encoding="utf-8"))["hash"]
    assert sw.Case.read(results).ensemble().hash == digest
    results.write_text('{"version": 1,', encoding="utf-8")
    assert main(["cross", str(results)]) == 2
    assert f"{results}: is not valid JSON: Expecting property name" in capsys.readouterr().err


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out == f"spanwise {sw.__version__}\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (CASE.replace("6037.6", "-1"), r"[bridge]: mass"),
        (CASE.replace("speed", "sped"), "did you mean 'speed'?"),
        (CASE + "x = [", "line 16: is not valid TOML: Invalid value: x = ["),
        (CASE.replace("modes = 3", "modes = 9"), "modes = 9: must be 1 to 6"),
        (CASE.replace("traction", "traktion"), "drive = 'constant-traktion'"),
    ],
)
def test_a_bad_case(
    case: Path, capsys: pytest.CaptureFixture[str], text: str, message: str
) -> None:
    case.write_text(text, encoding="utf-8")
    outputs = [f"--{form}={case.parent / form}" for form in ("json", "csv", "plot")]
    assert main(["cross", str(case), *outputs]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"spanwise: error: {case}")
    assert message in err
    assert err.count("\n") == 1
    assert left(case.parent) == set()


def test_no_such_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cross", str(tmp_path / "no.toml")]) == 2
    expected = f"spanwise: error: {tmp_path / 'no.toml'}: No such file or directory\n"
    assert capsys.readouterr().err == expected


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "COMMAND"),
        (["crosss"], "invalid choice: 'crosss'"),
        (["cross"], "CASE.toml"),
        (["cross", "case.toml", "--set", "modes"], "'modes': must be key=value, such as crossing."),
        (["cross", "case.toml", "--set", "sections=[a]"], "'[a]': is not a value in TOML, where"),
        (["cross", "case.toml", "--set", "mass=2"], "mass: in which table? (belongs in [bridge], "),
        (["cross", "case.toml", "--set", "crosing.speed=2"], "(did you mean 'crossing'?); give"),
        (
            ["cross", "case.toml", "--set", "sped=2"],
            "(did you mean 'speed'?); give that too, as in",
        ),
        (["cross", "case.toml", "--mod", "2"], "unrecognized arguments: --mod"),
    ],
)
def test_a_bad_command(
    capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2
    _, err = capsys.readouterr()
    assert "\nspanwise: error: " in err
    assert message in err


@pytest.mark.parametrize("modes", ["0", "7", "-1"])
def test_a_bad_number_of_modes(case: Path, capsys: pytest.CaptureFixture[str], modes: str) -> None:
    assert main(["cross", str(case), f"--modes={modes}"]) == 2
    assert f"modes = {modes}: must " in capsys.readouterr().err


def test_numerical_failure(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case.write_text(SOFT, encoding="utf-8")
    assert main(["cross", str(case), "--json", str(case.parent / "run.json")]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    # What is doubted is told first.
    *doubts, error = err.splitlines()
    assert doubts[0].startswith("spanwise: warning: EI, mass: ")
    assert all(each.startswith("spanwise: warning: ") for each in doubts)
    assert error.startswith("spanwise: error: the vehicle comes to rest")
    assert left(case.parent) == set()


def test_one_bad_place_and_nothing_is_written(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "place"
    place.write_text("taken", encoding="ascii")
    outputs = ["--json", str(tmp_path / "run.json"), "--csv", str(place)]
    assert main(["cross", str(case), *outputs]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"spanwise: error: {place}: is a file, not a folder\n"
    assert left(tmp_path) == {"place"}
    outputs = [
        "--csv",
        str(tmp_path / "csv"),
        "--json",
        str(tmp_path / "csv" / "impact_factors.csv"),
    ]
    assert main(["cross", str(case), *outputs]) == 2
    assert "two outputs have this name" in capsys.readouterr().err
    assert left(tmp_path) == {"place"}


def test_figures_need_matplotlib(
    case: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["cross", str(case), "--plot", str(case.parent / "figures")]) == 2
    assert "pip install 'spanwise[plot]'" in capsys.readouterr().err
    assert left(case.parent) == set()


# In a process of its own


def test_as_a_module(case: Path) -> None:
    command = [sys.executable, "-m", "spanwise", "cross", str(case)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "moment, sagging" in done.stdout
    assert done.stderr == ""


@pytest.mark.skipif(sys.platform == "win32", reason="pipes differ")
def test_a_reader_that_goes_away(case: Path) -> None:
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "spanwise", "cross", str(case)]
    done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_standard_output_that_is_full(case: Path) -> None:
    command = [sys.executable, "-m", "spanwise", "cross", str(case)]
    with Path("/dev/full").open("w", encoding="ascii") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("spanwise: error: standard output: No space left")
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals differ")
def test_interrupt(case: Path, start: Any) -> None:
    # A crossing of seconds, interrupted by the process itself soon after it has begun.
    slow = CASE.replace("5e-3", "1e-6").replace("modes = 3", "modes = 6")
    case.write_text(slow, encoding="utf-8")
    program = f"""
        import os, signal, sys, threading
        from spanwise.cli import main

        # Started in the background, the process would inherit that interrupts are ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        sys.exit(main(["cross", {str(case)!r}, "--json", {str(case.parent / "run.json")!r}]))
    """
    done = start(program).wait()
    assert done.stderr == "spanwise: interrupted\n"
    assert done.returncode == 128 + signal.SIGINT
    assert left(case.parent) == set()
