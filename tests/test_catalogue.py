"""The catalogue against published totals, axle loads, lengths and natural frequencies.

Each number is transcribed to the digits printed, and must agree within half a unit of the last.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw
from spanwise import vehicles
from spanwise.catalogue import as_toml, detail, listing
from spanwise.cli import main

#: Gravity that the published axle loads were computed with [m/s2].
ROUND_GRAVITY = 9.81

CROSSING = "\n[bridge]\nspans = [20.0]\nEI = 1e10\nmass = 1e4\n[crossing]\nspeed = 20.0\n"


def assert_printed(values: Sequence[float] | np.ndarray, printed: str) -> None:
    """Values as printed, such as ``"3.49 5.56"``, each to half a unit of its last digit."""
    texts = printed.split()
    assert len(values) == len(texts)
    for value, text in zip(values, texts, strict=True):
        digits = len(text.partition(".")[2])
        assert abs(value - float(text)) <= 0.5 * 10.0**-digits * (1.0 + 1e-9), (value, text)


# Kishan and Traill-Nash (1973), section 4: 32 040 lb on each axle, 14 ft apart; frequencies locked
# and sliding by the formulas for a symmetric vehicle.
# Quarter car: McGetrick, Gonzalez and OBrien (2009). Half car: OBrien and Keenahan (2015).
# Articulated: Cantero and co-authors, axle hop from 8.9 to 12.1 Hz.
# HS20-44: Shi and Cai (2009), Deng and Cai (2010).
DYNAMIC = [
    # preset, gravity, mass [kg], length [m], axle loads [kN], frequencies locked, sliding [Hz]
    ("kishan-1973", 9.80665, "29066", "4.267", "142.5 142.5", "3.494 5.563", "2.097 3.338"),
    ("quarter-car", 9.81, "18000", "0", "176.6", "0.690 8.83", "0.690 8.83"),
    ("half-car", 9.81, "18000", "4.75", "86.3 90.3", "1.00 1.55 8.83 10.2", "1.00 1.55 8.83 10.2"),
    ("hs20-44", 9.81, "32627", "8.534", "35.5 142.1 142.4", *["2.15 3.03 4.70 7.84 13.4 14.9"] * 2),
]


@pytest.mark.parametrize(
    ("name", "gravity", "mass", "length", "loads", "locked", "sliding"), DYNAMIC
)
def test_vehicles_that_vibrate(
    name: str, gravity: float, mass: str, length: str, loads: str, locked: str, sliding: str
) -> None:
    truck = vehicles.PRESETS[name]()
    assert_printed([truck.total_mass], mass)
    assert_printed([truck.wheelbase], length)
    assert_printed(truck.static_loads(gravity) / 1e3, loads)
    assert_printed(truck.frequencies(locked=True), locked)
    assert_printed(truck.frequencies(locked=False), sliding)


# Frequencies on rigid ground do not show the dampers [N s/m]; those of HS20-44 per wheel line.
DAMPERS = [
    ("kishan-1973", [0.0, 0.0], [0.0, 0.0]),
    ("quarter-car", [1e4], [0.0]),
    ("half-car", [1e4, 2e4], [0.0, 0.0]),
    ("articulated-5-axle", [1e3] * 5, [1e4] * 5),
    ("hs20-44", [2 * 2190.0, 2 * 7882.0, 2 * 7182.0], [2 * 2000.0] * 3),
]


@pytest.mark.parametrize(("name", "suspensions", "tyres"), DAMPERS)
def test_dampers(name: str, suspensions: list[float], tyres: list[float]) -> None:
    truck = vehicles.PRESETS[name]()
    assert isinstance(truck, sw.Vehicle)
    assert [axle.suspension_damping for axle in truck.axles] == suspensions
    assert [axle.tyre_damping for axle in truck.axles] == tyres


def test_the_articulated_lorry() -> None:
    truck = vehicles.articulated_5_axle()
    # 4 500 + 31 450 + 700 + 1 100 + 3 · 750 kg.
    assert_printed([truck.total_mass], "40000")
    # Tractor axles at 0.5 and -2.5 m; hinge at -2.15 m, 6.15 m ahead of the trailer's centre of
    # mass, so that the next axle is 2.15 + 6.15 + 1.8 - 2.5 m behind.
    assert_printed(truck.axle_spacings, "3.00 7.60 1.10 1.10")
    assert_printed([truck.wheelbase], "12.80")
    assert_printed(truck.static_loads(ROUND_GRAVITY) / 1e3, "55.2 105.3 78.3 77.3 76.4")
    found = truck.frequencies(locked=False)
    assert_printed(found[:3], "1.41 1.59 5.24")
    assert_printed(found[[3, -1]], "8.9 12.1")
    assert len(found) == 8
    assert_allclose(found, truck.frequencies(locked=True), rtol=0)


# Codes: loads [kN] and spacings [m].
# AASHTO HS20: 8, 32, 32 kip at 14 and 14 to 30 ft. T44 (Australia), CSA S6 CL-625, EN 1991-2.
FORCES = [
    ("hs20", {}, "320.3", "8.53", "35.6 142.3 142.3", "4.27 4.27"),
    ("hs20", {"rear_spacing": 9.144}, "320.3", "13.41", "35.6 142.3 142.3", "4.27 9.14"),
    ("t44", {}, "432", "9.1", "48 96 96 96 96", "3.7 1.2 3.0 1.2"),
    ("t44", {"rear_spacing": 8.0}, "432", "14.1", "48 96 96 96 96", "3.7 1.2 8.0 1.2"),
    ("cl-625", {}, "625", "18.0", "50 125 125 175 150", "3.6 1.2 6.6 6.6"),
    ("flm3", {}, "480", "8.4", "120 120 120 120", "1.2 6.0 1.2"),
    ("flm4-1", {}, "200", "4.5", "70 130", "4.5"),
    ("flm4-2", {}, "310", "5.5", "70 120 120", "4.2 1.3"),
    ("flm4-3", {}, "490", "11.0", "70 150 90 90 90", "3.2 5.2 1.3 1.3"),
    ("flm4-4", {}, "390", "11.2", "70 140 90 90", "3.4 6.0 1.8"),
    ("flm4-5", {}, "450", "14.1", "70 130 90 80 80", "4.8 3.6 4.4 1.3"),
]


@pytest.mark.parametrize(("name", "options", "total", "length", "loads", "spacings"), FORCES)
def test_code_trucks(
    name: str, options: dict[str, float], total: str, length: str, loads: str, spacings: str
) -> None:
    truck = vehicles.PRESETS[name](**options)
    assert isinstance(truck, sw.ForceTrain)
    found = truck.static_loads(gravity=1.0) / 1e3
    assert_printed([found.sum()], total)
    assert_printed([truck.wheelbase], length)
    assert_printed(found, loads)
    assert_printed(truck.axle_spacings, spacings)


def test_every_entry_is_tested() -> None:
    tested = {row[0] for row in (*DYNAMIC, *FORCES)} | {"articulated-5-axle"}
    assert tested == set(vehicles.PRESETS)


def test_what_was_recalled_says_so() -> None:
    recalled = {name for name, preset in vehicles.PRESETS.items() if preset.recalled}
    lorries = {f"flm4-{lorry}" for lorry in range(1, 6)}
    assert recalled == {
        "quarter-car",
        "half-car",
        "articulated-5-axle",
        "hs20-44",
        "t44",
        "cl-625",
        *lorries,
    }
    for make in (
        vehicles.quarter_car,
        vehicles.half_car,
        vehicles.articulated_5_axle,
        vehicles.hs20_44,
        vehicles.t44,
        vehicles.cl_625,
    ):
        assert "recalled, not read at the source" in str(make.__doc__)
    assert "recalled, not read at the source" in str(vehicles.flm4.__doc__)


def test_shares_of_lorries_in_traffic() -> None:
    assert set(vehicles.FLM4_MIX) == {"long-distance", "medium-distance", "local"}
    for shares in vehicles.FLM4_MIX.values():
        assert len(shares) == 5
        assert sum(shares) == pytest.approx(1.0, abs=1e-12)
    assert vehicles.FLM4_MIX["long-distance"] == (0.20, 0.05, 0.50, 0.15, 0.10)
    assert vehicles.FLM4_MIX["medium-distance"] == (0.40, 0.10, 0.30, 0.15, 0.05)
    assert vehicles.FLM4_MIX["local"] == (0.80, 0.05, 0.05, 0.05, 0.05)


@pytest.mark.parametrize("spacing", [4.2, 9.2, float("nan")])
def test_spacings_beyond_the_code_are_refused(spacing: float) -> None:
    with pytest.raises(ValueError, match=r"rear_spacing = .* m: must be 4\.2672 to 9\.144 m"):
        vehicles.hs20(rear_spacing=spacing)


@pytest.mark.parametrize("lorry", [0, 6])
def test_there_are_five_lorries(lorry: int) -> None:
    with pytest.raises(ValueError, match=rf"lorry = {lorry}: must be 1 to 5"):
        vehicles.flm4(lorry)


@pytest.mark.parametrize("name", vehicles.PRESETS)
def test_as_toml_is_the_same_vehicle(name: str) -> None:
    truck = vehicles.PRESETS[name]()
    assert sw.Case.parse(as_toml(truck) + CROSSING).vehicle == truck
    assert sw.Case.parse(f'[vehicle]\npreset = "{name}"' + CROSSING).vehicle == truck


def test_the_articulated_lorry_is_hardly_damped() -> None:
    # All heaves alike on suspensions in series with tyres: c / (2 (k m)^(1/2)), where
    # (t / (t + s))^2 of each damper is left.
    truck = vehicles.articulated_5_axle()
    tyres, suspensions = (
        np.array([getattr(axle, f"{name}_stiffness") for axle in truck.axles])
        for name in ("tyre", "suspension")
    )
    k = (tyres * suspensions / (tyres + suspensions)).sum()
    c = (1e3 * (tyres / (tyres + suspensions)) ** 2).sum()
    assert 0.003 < c / (2.0 * np.sqrt(k * 35_950.0)) < 0.015
    assert "1e3 N s/m each, is very low" in str(vehicles.articulated_5_axle.__doc__)


@pytest.mark.parametrize("name", ["articulated-5-axle", "hs20-44"])
def test_heights_of_presets(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    truck = vehicles.PRESETS[name](cg_heights=(1.0, 1.9), hinge_height=1.2)
    assert isinstance(truck, sw.Vehicle)
    assert [body.cg_height for body in truck.bodies] == [1.0, 1.9]
    assert truck.bodies[1].hinge is not None
    assert truck.bodies[1].hinge.height == 1.2
    table = f'[vehicle]\npreset = "{name}"\ncg_heights = [1.0, 1.9]\nhinge_height = 1.2\n'
    assert sw.Case.parse(table + CROSSING).vehicle == truck
    assert main(["vehicles", name]) == 0
    assert "options   cg_heights = [0.0, 0.0], hinge_height = 0.0\n" in capsys.readouterr().out
    with pytest.raises(ValueError, match=r"cg_heights = 1.5: give two, of the tractor and of"):
        vehicles.PRESETS[name](cg_heights=1.5)


@pytest.mark.parametrize("name", ["quarter-car", "half-car"])
def test_height_of_a_preset_of_one_body(name: str) -> None:
    truck = vehicles.PRESETS[name](cg_height=1.5)
    assert isinstance(truck, sw.Vehicle)
    assert truck.cg_height == 1.5
    table = f'[vehicle]\npreset = "{name}"\ncg_height = 1.5\n'
    assert sw.Case.parse(table + CROSSING).vehicle == truck
    with pytest.raises(ValueError, match=r"'cg_heights' \(did you mean 'cg_height'\?\)"):
        sw.Case.parse(f'[vehicle]\npreset = "{name}"\ncg_heights = [1.0, 1.0]' + CROSSING)


def test_the_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["vehicles"]) == 0
    out, err = capsys.readouterr()
    assert (out, err) == (listing() + "\n", "")
    for name, preset in vehicles.PRESETS.items():
        (line,) = [line for line in out.splitlines() if line.split()[:1] in ([name], [name + "*"])]
        assert line.split()[0].endswith("*") == preset.recalled
        assert line.endswith(preset.source)
    assert "recalled, not read at the source" in out
    (cantero,) = [line for line in out.splitlines() if line.startswith("articulated")]
    assert cantero.split()[1:5] == ["5", "40.00", "t", "12.800"]
    assert max(map(len, out.splitlines())) <= 105


@pytest.mark.parametrize("name", vehicles.PRESETS)
def test_one_in_detail(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["vehicles", name]) == 0
    out, _ = capsys.readouterr()
    assert out == detail(name) + "\n"
    truck = vehicles.PRESETS[name]()
    assert ", ".join(f"{load / 1e3:.1f}" for load in truck.static_loads()) + " kN" in out
    assert as_toml(truck) in out
    for frequency in truck.frequencies(locked=True):
        assert f"{frequency:.3f}" in out


def test_an_unknown_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["vehicles", "hs21"]) == 2
    assert "preset = 'hs21': must be one of kishan-1973, " in capsys.readouterr().err


BRIDGE_20 = sw.Bridge(spans=[20.0], EI=4e9, mass=9e3)
TRUCK = sw.vehicles.half_car()

#: Called with what they do not take.
CROSS: Any = sw.cross
ENSEMBLE: Any = sw.ensemble


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda: detail("hs20-45"), r"\(did you mean 'hs20-44'\?\)$"),
        (lambda: CROSS(BRIDGE_20, "half-car"), r"; sw\.vehicles\.half_car\(\) makes one$"),
        (lambda: CROSS(BRIDGE_20, "flm4-3"), r"; sw\.vehicles\.flm4\(3\) makes one$"),
        (
            lambda: ENSEMBLE(BRIDGE_20, "half_car", samples=2, seed=1),
            r"; sw\.vehicles\.half_car\(\) makes one$",
        ),
        (
            lambda: ENSEMBLE(BRIDGE_20, ["t44"], samples=2, seed=1),
            r"; sw\.vehicles\.t44\(\) makes one$",
        ),
        (lambda: CROSS(BRIDGE_20, [TRUCK, TRUCK]), r"; sw\.convoy makes passages of vehicles"),
        (lambda: sw.ISO8608("very poor"), "; very poor is class E$"),
        (lambda: sw.ISO8608("Average"), "; average is class C$"),
    ],
)
def test_what_is_meant_is_named(ask: Any, says: str) -> None:
    with pytest.raises((TypeError, ValueError), match=says):
        ask()
