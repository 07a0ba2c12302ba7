"""The example of 1973 runs, prints what it should and draws every figure, the same every time."""

from __future__ import annotations

import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import spanwise as sw

EXAMPLES = Path(__file__).parent.parent / "examples"

FIGURES = (
    "fig01_bridge",
    "fig02_vehicle",
    "fig03_basic_bridge",
    "fig04_model",
    "fig05_modes",
    "fig06_deflection",
    "fig07a_sagging",
    "fig07b_hogging",
    "fig08_superposition",
    "fig09_convergence",
)


def load(name: str = "kishan_1973") -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_example_prints_its_tables_and_draws_every_figure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out, module = tmp_path / "figures", load()

    def save(figure: Any, path: Path) -> None:
        """One form of each, not laid out; below both are written as it writes them."""
        figure.set_layout_engine("none")
        figure.savefig(f"{path}.svg")

    monkeypatch.setattr(module, "save", save)
    module.main(["--out", str(out)])
    printed = capsys.readouterr().out
    assert "2522.0, 2522.0, 2522.0, 2522.0, 2522.0, 2522.0" in printed
    assert "K^R [lb/ft]: 130500, printed 130500" in printed
    assert "nan" not in printed
    expected = {f"{name}.svg" for name in FIGURES}
    assert {path.name for path in out.iterdir()} == expected
    for path in out.iterdir():
        assert path.stat().st_size > 5000, path


def test_figures_are_the_same_every_time(tmp_path: Path) -> None:
    module = load()
    case = sw.Case.read(EXAMPLES / "kishan_1973.toml")
    for name in ("first", "second"):
        module.save(case.run().plot.envelope("moment"), tmp_path / name)
    for kind in ("png", "svg"):
        first, second = ((tmp_path / f"{name}.{kind}").read_bytes() for name in ("first", "second"))
        assert first == second
        assert len(first) > 5000


def test_case_is_the_published_one_to_the_digits_given() -> None:
    with (EXAMPLES / "kishan_1973.toml").open("rb") as file:
        bridge = tomllib.load(file)["bridge"]
    foot, pound = 0.3048, 4.4482216152605
    # Nine digits or more are given.
    np.testing.assert_allclose(bridge["spans"], [60.0 * foot] * 2, rtol=1e-12)
    assert bridge["EI"] == pytest.approx(4.698e9 * pound * foot**2, rel=1e-9)
    assert bridge["mass"] == pytest.approx(126.1 * pound / foot**2, rel=1e-9)


def test_impact_factors_by_class(capsys: pytest.CaptureFixture[str]) -> None:
    load("impact_factors_by_class").main()
    _, head, *rows = capsys.readouterr().out.splitlines()
    assert head.split() == [
        "class",
        *(w for k in range(5) for w in ("seed", str(k))),
        "mean",
        "max",
    ]
    assert [row.split()[0] for row in rows] == list("ABCD")
    for row in rows:
        *factors, mean, largest = map(float, row.split()[1:])
        assert mean == pytest.approx(np.mean(factors), abs=1e-3)
        assert largest == max(factors)


def test_random_roads(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    load("random_roads").main(["--samples", "40", "--out", str(tmp_path)])
    _, head, *rows = capsys.readouterr().out.splitlines()
    assert head.split()[:2] == ["class", "mean"]
    assert [row.split()[0] for row in rows] == list("ABCD")
    means = [float(row.split()[1]) for row in rows]
    assert means == sorted(means)
    assert (tmp_path / "random_roads.png").stat().st_size > 5000


def test_haunches_bearing_and_hinges_of_a_case() -> None:
    case = sw.Case.read(EXAMPLES / "gerber.toml")
    run = case.run(modes=4)
    for hinge in (27.0, 43.0):
        (at,) = np.flatnonzero(run.sections == hinge)
        assert np.abs(run.moment[:, at]).max() < 1e-9 * np.abs(run.moment).max()
    settled = case.bridge.settlement({20.0: 0.01})
    assert settled.reactions.sum() == pytest.approx(0.0, abs=1e-3)
