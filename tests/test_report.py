"""Reports: JSON that computes the run again, CSV with all digits, frames, no half-written file."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise._files import write_files
from spanwise._run_files import as_dict

MOTION = ["slope", "velocity", "acceleration"]
QUANTITIES = ["deflection", "moment", "shear", "reactions", *MOTION, "axle_loads"]


@pytest.fixture(scope="module")
def run() -> sw.Run:
    bridge = sw.Bridge(
        spans=[12.0, 9.0],
        ends=("clamped", "pinned"),
        EI=[1.0e9, 0.8e9],
        mass=4e3,
        stations_per_span=3,
        point_masses=[(5.0, 700.0)],
    )
    truck = sw.vehicles.kishan_1973().with_initial_friction(3e3, -2e3)
    # More steps than are turned into CSV text at a time.
    run = sw.cross(bridge, truck, speed=20.0, modes=3, damping=0.02, tail=0.1, step=1e-3)
    assert run.steps > 1000
    return run


@pytest.fixture(scope="module")
def report(run: sw.Run) -> dict[str, Any]:
    return run.to_dict()


def again(settings: dict[str, Any]) -> sw.Run:
    """The run that the settings of a report describe."""
    return sw.Case.from_dict(settings).run()


def test_keys(report: dict[str, Any]) -> None:
    assert set(report) == {
        *("version", "settings", "sections", "supports", "frequencies", "damping", "warnings"),
        *("final_speed", "steps", "tail", "vehicles", "lift_offs", "impact_factors"),
        *("clamp_moments", *QUANTITIES),
    }
    assert report["version"] == sw.__version__
    assert set(report["settings"]) == {"bridge", "vehicle", "road", "crossing"}
    for quantity in (*QUANTITIES, "clamp_moments"):
        assert set(report[quantity]) == {
            f"{kind}{sense}{what}"
            for kind in ("", "static_")
            for sense in ("max", "min")
            for what in ("", "_time", "_position", "_partner")
        }


def test_values(run: sw.Run, report: dict[str, Any]) -> None:
    assert report["sections"] == run.sections.tolist()
    assert report["supports"] == [0.0, 12.0, 21.0]
    assert report["frequencies"] == run.frequencies.tolist()
    assert report["final_speed"] == 20.0
    assert report["steps"] == len(run.time) - 1
    envelope = run.envelope("moment")
    assert report["moment"]["max"] == envelope.max.value.tolist()
    assert report["moment"]["max_time"] == envelope.max.time.tolist()
    assert report["moment"]["static_min_position"] == envelope.static_min.position.tolist()
    assert len(report["axle_loads"]["max"]) == 2
    assert len(report["clamp_moments"]["min"]) == 1


def test_clamp_moments_only_where_there_is_a_clamp() -> None:
    bridge = sw.Bridge(spans=[12.0], EI=1e9, mass=4e3)
    assert "clamp_moments" not in sw.cross(bridge, sw.vehicles.kishan_1973(), speed=20.0).to_dict()


def test_masked_factors_are_null(run: sw.Run, report: dict[str, Any]) -> None:
    factors = report["impact_factors"]
    assert factors["ratio"] == "extremes"
    assert factors["mask"] == 0.05
    for name in ("deflection", "sagging", "hogging", "shear", "reactions"):
        masked = [factor is None for factor in factors[name]]
        assert masked == factors["masked"][name]
        assert masked == np.isnan(getattr(run.impact_factors, name)).tolist()
    # The deflection over a support is nothing, statically and dynamically.
    assert factors["deflection"][0] is None
    assert None not in factors["axle_loads"]


def test_the_settings_compute_the_run_again(run: sw.Run, report: dict[str, Any]) -> None:
    same = again(json.loads(json.dumps(report["settings"])))
    assert_array_equal(same.moment, run.moment)
    assert_array_equal(same.shear, run.shear)
    assert_array_equal(same.axle_loads, run.axle_loads)
    assert same.settings == run.settings


@pytest.mark.parametrize(
    ("traffic", "settings"),
    [
        (
            [
                sw.Passage(vehicle=sw.vehicles.articulated_5_axle(), drive="constant-traction"),
                sw.Passage(
                    vehicle=sw.vehicles.t44(),
                    speed=15.0,
                    direction="left",
                    entry=0.3,
                    lane=4,
                    road=sw.ISO8608("A", seed=2),
                ),
            ],
            {"road": sw.ISO8608("D", seed=1) + sw.Joint(0.0, 0.05, 0.02), "ramp": 5.0},
        ),
        (sw.vehicles.kishan_1973(), {"drive": sw.Braking(deceleration=4.0), "tail": 0.5}),
        (
            sw.MovingMasses(masses=[1e4, 2e4], spacings=[3.0]),
            {
                "drive": sw.Speeds(times=[0.0, 1.0], speeds=[20.0, 10.0]),
                "speed": None,
                "lift_off": False,
            },
        ),
        (
            sw.vehicles.quarter_car(),
            {"road": sw.Profile(np.arange(-20.0, 40.0), np.zeros(60)) + sw.Bump(2.0, 1.0, 0.05),
             "approach": 15.0},
        ),
    ],
    ids=["opposing", "braking", "masses", "measured"],
)  # fmt: skip
def test_traffic_roads_and_drives_are_computed_again(
    traffic: Any, settings: dict[str, Any]
) -> None:
    bridge = sw.Bridge(spans=[22.0], EI=2e9, mass=7e3, stations_per_span=5)
    run = sw.cross(bridge, traffic, **{"speed": 20.0, "modes": 3, "accuracy": 0.02, **settings})
    report = json.loads(json.dumps(run.to_dict()))
    same = again(report["settings"])
    assert_array_equal(same.moment, run.moment)
    assert_array_equal(same.axle_loads, run.axle_loads)
    assert same.lift_offs == run.lift_offs
    assert same.settings == run.settings
    assert same.passages == run.passages
    assert same.road == run.road
    assert same.to_dict() == run.to_dict()


def test_vehicles_of_the_report() -> None:
    bridge = sw.Bridge(spans=[22.0], EI=2e9, mass=7e3, stations_per_span=5)
    passages = [
        sw.Passage(vehicle=sw.vehicles.hs20_44()),
        sw.Passage(vehicle=sw.vehicles.half_car(), direction="left", speed=15.0),
    ]
    run = sw.cross(bridge, passages, speed=25.0, road=sw.ISO8608("D", seed=1))
    first, second = run.to_dict()["vehicles"]
    assert first["static_axle_loads"] == run.static_axle_loads[:3].tolist()
    assert second["static_axle_loads"] == run.static_axle_loads[3:].tolist()
    assert (first["final_speed"], second["final_speed"]) == (25.0, 15.0)
    assert first["stopped"] is None
    counts = first["off_road"]["count"] + second["off_road"]["count"]
    assert counts == run.contact_loss.count.tolist()
    assert sum(counts) == len(run.to_dict()["lift_offs"]) > 0


def test_json_is_strict(tmp_path: Path, run: sw.Run) -> None:
    def refuse(name: str) -> None:
        raise AssertionError(name)

    path = tmp_path / "run.json"
    run.to_json(path)
    text = path.read_text(encoding="utf-8")
    assert json.loads(text, parse_constant=refuse) == as_dict(run)


def test_a_locked_suspension_is_written_and_read(tmp_path: Path) -> None:
    locked = sw.Axle(
        position=0.0,
        tyre_stiffness=2e6,
        suspension_stiffness=1e6,
        friction_limit=float("inf"),
    )
    truck = sw.Vehicle(mass=10e3, pitch_inertia=1.0, axles=[locked])
    bridge = sw.Bridge(spans=[12.0], EI=1e9, mass=4e3, stations_per_span=3)
    matrix = np.diag([1e3, 2e3, 3e3])
    run = sw.cross(bridge, truck, speed=20.0, modes=2, damping=matrix)
    run.to_json(tmp_path / "run.json")
    report = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    assert report["settings"]["vehicle"]["axles"][0]["friction_limit"] == "inf"
    assert report["settings"]["crossing"]["damping"] == matrix.tolist()
    assert_array_equal(again(report["settings"]).moment, run.moment)


# CSV


def rows(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(encoding="ascii", newline="") as file:
        head, *body = csv.reader(file)
    assert all(len(row) == len(head) for row in body)
    return head, body


def numbers(body: list[list[str]]) -> np.ndarray:
    return np.array([[float(text) for text in row] for row in body])


@pytest.fixture(scope="module")
def written(run: sw.Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("tables") / "out"
    run.to_csv(folder)
    return folder


def test_csv_files(written: Path) -> None:
    quantities = [*QUANTITIES, "clamp_moments"]
    assert {path.name for path in written.iterdir()} == {
        "impact_factors.csv",
        "lift_offs.csv",
        "history_vehicle.csv",
        *(f"{kind}_{quantity}.csv" for kind in ("envelope", "history") for quantity in quantities),
    }


def test_histories_keep_all_digits(written: Path, run: sw.Run) -> None:
    for quantity, first, values in (
        ("deflection", "deflection at 0.0 m [m]", run.deflection),
        ("moment", "moment at 0.0 m [N m]", run.moment),
        ("reactions", "reaction at 0.0 m [N]", run.reactions),
        ("clamp_moments", "clamp moment at 0.0 m [N m]", run.clamp_moments),
        ("axle_loads", "load of axle 1 [N]", run.axle_loads),
    ):
        head, body = rows(written / f"history_{quantity}.csv")
        assert head[:2] == ["time [s]", first]
        assert_array_equal(numbers(body), np.column_stack([run.time, values]))
    head, body = rows(written / "history_shear.csv")
    assert head[1:3] == ["shear left of 0.0 m [N]", "shear right of 0.0 m [N]"]
    assert_array_equal(numbers(body)[:, 1::2], run.shear_left)
    assert_array_equal(numbers(body)[:, 2::2], run.shear_right)


def test_history_of_the_vehicle(written: Path, run: sw.Run) -> None:
    head, body = rows(written / "history_vehicle.csv")
    columns = dict(zip(head, numbers(body).T, strict=True))
    assert_array_equal(columns["time [s]"], run.time)
    assert_array_equal(columns["heave acceleration [m/s2]"], run.vehicle.heave_acceleration)
    assert_array_equal(columns["pitch [rad]"], run.vehicle.pitch)
    assert_array_equal(columns["position of axle 2 [m]"], run.vehicle.axle_positions[:, 1])
    assert_array_equal(columns["friction of axle 1 [N]"], run.vehicle.friction[:, 0])
    assert len(head) == 1 + 9 + 3 * 2


def test_histories_of_several_vehicles(tmp_path: Path) -> None:
    bridge = sw.Bridge(spans=[22.0], EI=2e9, mass=7e3, stations_per_span=5)
    passages = [
        sw.Passage(vehicle=sw.vehicles.hs20_44()),
        sw.Passage(vehicle=sw.vehicles.flm3(), direction="left"),
    ]
    rough = sw.ISO8608("D", seed=1)
    run = sw.cross(bridge, passages, speed=25.0, road=rough, step=5e-3, beta=0.25)
    assert run.lift_offs
    run.to_csv(tmp_path)
    assert not (tmp_path / "history_vehicle.csv").exists()
    head, body = rows(tmp_path / "history_vehicle_1.csv")
    columns = dict(zip(head, numbers(body).T, strict=True))
    motion = run.vehicles[0]
    trailer = motion.bodies[1].pitch
    assert_array_equal(columns["pitch velocity of body 2 [rad/s]"], trailer.velocity)
    assert_array_equal(columns["hop of axle 3 [m]"], motion.hops[2].displacement)
    assert_array_equal(columns["elevation of axle 2 [m]"], motion.elevations[:, 1])
    head, body = rows(tmp_path / "history_vehicle_2.csv")
    assert not any("heave" in name or "hop" in name for name in head)
    head, body = rows(tmp_path / "history_axle_loads.csv")
    assert head[1] == "load of vehicle 1 axle 1 [N]"
    assert head[-1] == "load of vehicle 2 axle 4 [N]"
    head, body = rows(tmp_path / "lift_offs.csv")
    assert head[:3] == ["axle", "vehicle", "axle of the vehicle"]
    expected = [(each.axle, 1, each.axle, each.start, each.end) for each in run.lift_offs]
    assert [tuple(row[:5]) for row in numbers(body).tolist()] == expected


def test_envelopes(written: Path, run: sw.Run) -> None:
    for quantity in (*QUANTITIES, "clamp_moments"):
        envelope = run.envelope(quantity)
        head, body = rows(written / f"envelope_{quantity}.csv")
        columns = dict(zip(head, numbers(body).T, strict=True))
        units = {"deflection": "m", "slope": "rad", "velocity": "m/s", "acceleration": "m/s2"}
        unit = "N m" if "moment" in quantity else units.get(quantity, "N")
        assert_array_equal(columns["axle" if quantity == "axle_loads" else "x [m]"], envelope.x)
        assert_array_equal(columns[f"max [{unit}]"], envelope.max.value)
        assert_array_equal(columns[f"max_partner [{unit}]"], envelope.max.partner)
        assert_array_equal(columns["static_min_time [s]"], envelope.static_min.time)
        assert_array_equal(columns["min_position [m]"], envelope.min.position)


def test_impact_factors(written: Path, run: sw.Run) -> None:
    head, body = rows(written / "impact_factors.csv")
    assert head == ["of", "x [m]", "axle"] + [
        f"{name} [-]"
        for name in ("deflection", "sagging", "hogging", "shear", "reaction", "axle load")
    ]
    kinds = [row[0] for row in body]
    assert kinds == ["section"] * len(run.sections) + ["support"] * 3 + ["axle"] * 2
    factors = run.impact_factors
    sagging = [float(row[4] or "nan") for row in body if row[0] == "section"]
    assert_array_equal(sagging, factors.sagging)
    reactions = [(float(row[1]), float(row[7])) for row in body if row[0] == "support"]
    assert_array_equal(reactions, np.column_stack([factors.supports, factors.reactions]))
    loads = [(int(row[2]), float(row[8])) for row in body if row[0] == "axle"]
    assert loads == [*enumerate(factors.axle_loads, 1)]


# Frames


@pytest.mark.parametrize(
    ("quantity", "name"),
    [
        ("deflection", "x [m]"),
        ("moment", "x [m]"),
        ("reactions", "support [m]"),
        ("clamp_moments", "clamp [m]"),
        ("axle_loads", "axle"),
    ],
)
def test_frames(run: sw.Run, quantity: Any, name: str) -> None:
    frame = run.to_pandas(quantity)
    assert_array_equal(frame.to_numpy(), getattr(run, quantity))
    assert_array_equal(frame.index, run.time)
    assert frame.index.name == "time [s]"
    assert frame.columns.name == name
    assert_array_equal(frame.columns, run.envelope(quantity).x)


def test_frame_of_shears_has_both_sides(run: sw.Run) -> None:
    frame = run.to_pandas("shear")
    assert isinstance(frame.columns, pd.MultiIndex)
    assert frame.columns.names == ["x [m]", "side"]
    right = frame.xs("right", axis="columns", level="side")
    assert_array_equal(right.to_numpy(), run.shear_right)


def test_frame_of_nothing(run: sw.Run) -> None:
    with pytest.raises(ValueError, match="quantity = 'time': must be one of deflection, moment"):
        run.to_pandas("time")


def test_pandas_is_asked_for_by_name(run: sw.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install 'spanwise\[pandas\]'"):
        run.to_pandas()


# Files


def failing() -> Iterator[bytes]:
    yield b"half"
    raise RuntimeError("the other half")


def test_nothing_is_left_half_written(tmp_path: Path) -> None:
    old, new = tmp_path / "old.csv", tmp_path / "a" / "b" / "new.csv"
    old.write_bytes(b"as it was")
    with pytest.raises(RuntimeError, match="the other half"):
        write_files([(old, [b"first"]), (new, failing())], folders=[new.parent])
    assert old.read_bytes() == b"as it was"
    assert [path.name for path in tmp_path.iterdir()] == ["old.csv"]


def test_files_are_replaced_and_folders_made(tmp_path: Path) -> None:
    old, new = tmp_path / "old.csv", tmp_path / "a" / "b" / "new.csv"
    old.write_bytes(b"as it was")
    write_files([(old, [b"one", b"two"]), (new, [])], folders=[new.parent])
    assert old.read_bytes() == b"onetwo"
    assert new.read_bytes() == b""
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["a", "b", "new.csv", "old.csv"]


def test_links_are_followed(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_files([(link, [b"new"])])
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


def test_the_same_file_twice(tmp_path: Path) -> None:
    same = tmp_path / "x" / ".." / "a"
    (tmp_path / "x").mkdir()
    with pytest.raises(FileExistsError, match="two outputs have this name"):
        write_files([(tmp_path / "a", [b"1"]), (same, [b"2"])])
    assert not (tmp_path / "a").exists()


def test_places_where_no_file_can_be(tmp_path: Path, run: sw.Run) -> None:
    (tmp_path / "file").write_text("old", encoding="ascii")
    with pytest.raises(NotADirectoryError, match="is a file, not a folder"):
        run.to_csv(tmp_path / "file")
    with pytest.raises(NotADirectoryError, match="is a file, not a folder"):
        run.to_csv(tmp_path / "file" / "below")
    with pytest.raises(IsADirectoryError, match="is a folder, not a file"):
        run.to_json(tmp_path)
    with pytest.raises(FileNotFoundError, match="no such folder"):
        run.to_json(tmp_path / "nowhere" / "run.json")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert (tmp_path / "file").read_text(encoding="ascii") == "old"


@pytest.mark.skipif(sys.platform == "win32", reason="no such devices")
def test_devices_are_not_replaced(run: sw.Run) -> None:
    with pytest.raises(OSError, match="is a device or pipe"):
        run.to_json("/dev/null")
    assert not Path("/dev/null").is_file()


def test_the_summary_of_a_run() -> None:
    bridge = sw.Bridge(spans=[18.0, 18.0], EI=1.9e9, mass=6e3, stations_per_span=3)
    run = sw.cross(bridge, sw.vehicles.kishan_1973(), speed=20.0, modes=3, tail=0.0)
    text = run.summary()
    assert text.endswith(str(run.impact_factors))
    assert run._repr_html_().startswith("<pre>bridge    36 m, ")
    for name, of, scale in (
        ("deflection, up [mm]", run.envelope("deflection"), 1e3),
        ("reaction, uplift [kN]", run.envelope("reactions"), 1e-3),
    ):
        (line,) = [line for line in text.splitlines() if line.startswith(name)]
        i = int(np.argmin(of.min.value))
        value, static = of.min.value[i], of.static_min.value[i]
        assert f"{scale * value:.3f} " in line
        assert f"{scale * static:.3f} " in line
        assert line.endswith(f"{value / static:.3f}")
    assert "are to be read with the response itself" in text
    # One span goes down and is pressed down.
    simple = sw.Bridge(spans=[18.0], EI=1.9e9, mass=6e3)
    force = sw.ForceTrain(loads=[1e5])
    text = sw.cross(simple, force, speed=5.0, modes=1, tail=0.0).summary()
    assert "reaction, uplift [kN]" not in text


def test_a_long_train_and_deck_motion_in_a_summary() -> None:
    bridge = sw.Bridge(spans=[30.0], EI=3e10, mass=1e4)
    loads = [1.7e5 + 1e3 * k for k in range(32)]
    train = sw.ForceTrain(loads=loads, spacings=31 * [6.0])
    lines = sw.cross(bridge, train, speed=40.0, modes=1, damping=0.02).summary().splitlines()
    (said,) = (line for line in lines if line.startswith("vehicle"))
    assert said == "vehicle   32 static axle loads 170 to 201 kN; 186 m from first to last axle"
    for name, static in (("slope", False), ("velocity", True), ("acceleration", True)):
        (row,) = (line.split() for line in lines if line.startswith(f"{name} ["))
        assert (row[-2] == "-") == static
