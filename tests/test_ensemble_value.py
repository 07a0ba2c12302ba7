"""An ensemble is a value: it travels, is written and read, put together, and made a table of."""

from __future__ import annotations

import copy
import json
import pickle
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw

BRIDGE = sw.Bridge(
    length=30.0,
    supports=[(0.0, "clamped"), (18.0, "pinned"), (30.0, "pinned")],
    EI=[2e9, 3e9],
    mass=8e3,
    stations_per_span=4,
)
TRUCK, CAR = sw.vehicles.kishan_1973(), sw.vehicles.half_car()
COUNT = 12


def varied(first: int, count: int) -> dict[str, Any]:
    """What differs from sample to sample, of some of all."""
    some = slice(first, first + count)
    spread = np.linspace(0.8, 1.2, COUNT)
    return {
        "speed": np.linspace(15.0, 30.0, COUNT)[some],
        "kind": (np.arange(COUNT) % 2)[some],
        "factors": {"body_mass": spread[some], "suspension_damping": 1.1},
    }


def common(first: int, count: int) -> dict[str, Any]:
    """What all are asked for."""
    return {
        "samples": count,
        "first": first,
        "seed": 5,
        "modes": 3,
        "damping": 0.02,
        "road": sw.ISO8608("C") + sw.Bump(3.0, 0.5, 0.01),
        "approach": 20.0,
        "accuracy": 0.02,
        "sections": [5.0, 9.0, 18.0, 24.0],
    }


#: Ensembles by what they are like: of samples `first` to `first + count`.
def made(name: str, first: int = 0, count: int = COUNT) -> sw.Ensemble:
    given = common(first, count)
    if name == "side by side":
        return sw.ensemble(BRIDGE, TRUCK, speed=20.0, **given)
    if name == "varied":
        return sw.ensemble(BRIDGE, [TRUCK, CAR], **(given | varied(first, count)))
    if name == "of kinds":
        # Whose loads are as given: static extremes are those of the kinds.
        kind = varied(first, count)["kind"]
        return sw.ensemble(BRIDGE, [TRUCK, CAR], speed=20.0, kind=kind, **given)
    if name == "one by one":
        event = [*sw.convoy([CAR, TRUCK], headway=1.5), sw.Passage(vehicle=CAR, direction="left")]
        return sw.ensemble(BRIDGE, event, speed=20.0, quantities=["moment"], **given)
    if name == "by itself":
        train = sw.ForceTrain(loads=[1e5, 2e5], spacings=[4.0])
        passage = sw.Passage(vehicle=train, speed=22.0)
        return sw.ensemble(BRIDGE, passage, **(given | {"road": None, "tail": 0.3}))
    assert name == "stiff"
    stiffness = np.linspace(0.9, 1.1, COUNT)[first : first + count]
    factors = {"bridge_stiffness": stiffness, "bridge_damping": 1.5}
    return sw.ensemble(BRIDGE, CAR, speed=20.0, **(given | {"factors": factors}))


NAMES = ("side by side", "varied", "of kinds", "one by one", "by itself", "stiff")


@cache
def whole(name: str) -> sw.Ensemble:
    return made(name)


@pytest.fixture(params=NAMES)
def found(request: pytest.FixtureRequest) -> sw.Ensemble:
    return whole(request.param)


def check_equal(one: sw.Ensemble, other: sw.Ensemble) -> None:
    """All that can be asked of both is the same to the bit."""
    assert one == other
    assert one.hash == other.hash
    assert one.failures == other.failures
    for name in (*one.quantities, "axle_loads"):
        for side in ("max", "min"):
            for suffix in ("", "_time", "_position"):
                a, b = (getattr(each.envelope(name), f"{side}{suffix}") for each in (one, other))
                assert_array_equal(a, b)
            a, b = (getattr(each.envelope(name), f"static_{side}") for each in (one, other))
            assert_array_equal(np.broadcast_to(a, b.shape), b)
    assert_array_equal(one.static_axle_loads, other.static_axle_loads)
    assert_array_equal(one.dynamic_load_coefficients, other.dynamic_load_coefficients)
    assert_array_equal(one.contact_loss.count, other.contact_loss.count)
    assert one.body_accelerations == other.body_accelerations
    for row in (0, one.samples - 1):
        assert one.run(row) == other.run(row)
    assert repr(one) == repr(other)


def test_copies(found: sw.Ensemble) -> None:
    for each in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        check_equal(each, found)
    assert pickle.loads(pickle.dumps(found.envelope("moment"))) == found.envelope("moment")
    for each in (found.body_accelerations, found.contact_loss, found.impact_factors):
        for another in (copy.deepcopy(each), copy.copy(each), pickle.loads(pickle.dumps(each))):
            assert another == each
        assert each != "something else"
    assert found.impact_factors != found.ratios(mask=0.5)
    assert found.impact_factors != made("side by side", 1, 3).impact_factors
    assert found != "an ensemble"
    assert found != made("side by side", 1, 3)


def test_written_and_read(found: sw.Ensemble, tmp_path: Path) -> None:
    path = tmp_path / "out.npz"
    found.to_npz(path)
    again = sw.Ensemble.read(path)
    check_equal(again, found)
    assert (again.isa, again.threads, again.elapsed) == (found.isa, found.threads, found.elapsed)
    assert again.summary() == found.summary()
    # What was read is as good as what was made.
    again.to_npz(tmp_path / "again.npz")
    assert sw.Ensemble.read(tmp_path / "again.npz") == found
    with np.load(path, allow_pickle=False) as archive:
        assert_array_equal(archive["moment_max"], found.envelope("moment").max)
        assert_array_equal(archive["axle_loads_min_time"], found.envelope("axle_loads").min_time)
        assert json.loads(str(archive["settings"]))["ensemble"]["seed"] == 5


@pytest.mark.filterwarnings("ignore:centres of mass at road level")
@pytest.mark.parametrize(
    "drive",
    [
        "constant-traction",
        sw.Braking(deceleration=1.0, start=5.0),
        sw.Speeds(times=[0.0, 2.0], speeds=[20.0, 22.0]),
    ],
    ids=lambda drive: type(drive).__name__,
)
def test_drives_are_written_and_read(drive: Any, tmp_path: Path) -> None:
    speed = None if isinstance(drive, sw.Speeds) else 20.0
    found = sw.ensemble(BRIDGE, CAR, samples=2, speed=speed, damping=0.02, modes=3, drive=drive)
    found.to_npz(tmp_path / "out.npz")
    check_equal(sw.Ensemble.read(tmp_path / "out.npz"), found)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("cuts", [(5,), (1, 2, 11)])
def test_parts_make_the_whole(name: str, cuts: tuple[int, ...], tmp_path: Path) -> None:
    ends = (0, *cuts, COUNT)
    parts = [made(name, a, b - a) for a, b in pairwise(ends)]
    parts[0].to_npz(tmp_path / "part.npz")
    mixed = [*parts[1:], sw.Ensemble.read(tmp_path / "part.npz")]
    check_equal(sw.concat(iter(mixed)), whole(name))
    assert sw.concat(mixed).settings.keys() == whole(name).settings.keys()


def test_parts_of_other_processes() -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        begun = [
            pool.submit(sw.ensemble, BRIDGE, [TRUCK, CAR], **(common(*some) | varied(*some)))
            for some in ((0, 7), (7, 5))
        ]
        parts = [each.result() for each in begun]
    check_equal(sw.concat(parts), whole("varied"))


@pytest.mark.parametrize(
    ("other", "says"),
    [
        ({"first": 2}, r"ensembles\[1\]: samples 2 to 3 are in ensembles\[0\] too"),
        ({"first": 1, "samples": 2}, r"ensembles\[1\]: samples 1 to 2 are in ensembles\[0\] too"),
        (
            {"first": 6},
            r"samples from 6: samples 4 to 5 are missing before it; compute them with first=4, "
            r"samples=2, or .* pandas\.concat of their to_pandas\(\)$",
        ),
        ({"seed": 6}, r"ensembles\[1\]: seed = 6: must be as in ensembles\[0\], 5"),
        ({"damping": 0.03}, r"damping = 0.03: must be as in ensembles\[0\], 0.02"),
        ({"road": None}, r"road = Smooth\(\): must be as in"),
        ({"sections": [4.0]}, r"sections = \[4.0\]: must be as in"),
        ({"bridge": sw.Bridge(spans=[30.0], EI=2e9, mass=8e3)}, "bridge: must be as in"),
        ({"vehicle": CAR}, "vehicles: must be as in"),
        ({"quantities": ["moment"]}, "quantities: must be as in"),
        ({"factors": {"body_mass": 1.1}}, r"factors = body_mass \(1\): must be the same"),
    ],
)
def test_parts_that_do_not_fit(other: dict[str, Any], says: str) -> None:
    given: dict[str, Any] = {
        "bridge": BRIDGE,
        "vehicle": TRUCK,
        "samples": 4,
        "first": 4,
        "seed": 5,
        "speed": 20.0,
        "modes": 3,
        "damping": 0.02,
        "road": sw.ISO8608("C"),
        "sections": [5.0, 9.0],
    }
    one = sw.ensemble(**(given | {"first": 0}))
    two = sw.ensemble(**(given | other))
    with pytest.raises(ValueError, match=says):
        sw.concat([one, two])


def test_constants_that_differ_from_part_to_part() -> None:
    given: dict[str, Any] = {"damping": 0.02, "modes": 3, "sections": [9.0]}
    parts = [
        sw.ensemble(
            BRIDGE, TRUCK, samples=n, first=a, speed=v, factors={"body_mass": f}, kind=k, **given
        )
        for n, a, v, f, k in (
            (2, 0, 20.0, 1.1, None),
            (3, 2, 20.0, 1.2, [0, 0, 0]),
            (1, 5, 25.0, 1.2, None),
        )
    ]
    speeds, factors = [20.0] * 5 + [25.0], {"body_mass": [1.1] * 2 + [1.2] * 4}
    every = sw.ensemble(BRIDGE, TRUCK, samples=6, speed=speeds, factors=factors, **given)
    check_equal(sw.concat(parts), every)


def test_parts_of_another_version() -> None:
    one, two = made("varied", 0, 5), made("varied", 5, 7)
    two._rows.columns["news"] = (0, 0)
    with pytest.raises(
        ValueError, match=r"ensembles\[1\]: is of another version than ensembles\[0\]"
    ):
        sw.concat([one, two])


def test_parts_are_told_by_their_places() -> None:
    last, first, second, other = (
        sw.ensemble(BRIDGE, TRUCK, samples=4, first=a, seed=seed, speed=20.0, damping=0.02, modes=3)
        for a, seed in ((8, 5), (0, 5), (2, 5), (4, 6))
    )
    with pytest.raises(
        ValueError, match=r"ensembles\[2\]: samples 2 to 3 are in ensembles\[1\] too"
    ):
        sw.concat([last, first, second])
    with pytest.raises(
        ValueError, match=r"ensembles\[2\]: seed = 6: must be as in ensembles\[1\], 5"
    ):
        sw.concat([last, first, other])


def test_what_is_no_list_of_parts() -> None:
    with pytest.raises(ValueError, match="must be one or more"):
        sw.concat([])
    with pytest.raises(TypeError, match=r"ensembles\[0\] = 1: must be an Ensemble"):
        sw.concat([1])  # type: ignore[list-item]
    with pytest.raises(TypeError, match="must be a list of Ensemble"):
        sw.concat(whole("varied"))
    assert sw.concat([whole("varied")]) is whole("varied")


def failing(first: int, count: int) -> sw.Ensemble:
    """Every third sample fails: heavy masses that ride side by side accelerate each other."""
    heavy = np.where(np.arange(first, first + count) % 3 == 2, 1e6, 1.0)
    with pytest.warns(sw.PlausibilityWarning, match="are loads in N"):
        return sw.ensemble(
            BRIDGE,
            sw.MovingMasses(masses=[500.0] * 4, positions=[0.0, -0.01, -0.02, -0.03]),
            samples=count,
            first=first,
            speed=20.0,
            modes=2,
            damping=0.02,
            advance=0.2,
            factors={"body_mass": heavy},
        )


def test_failures_are_kept(tmp_path: Path) -> None:
    every = failing(10, 8)
    assert [each.sample for each in every.failures] == [11, 14, 17]
    joined = sw.concat([failing(13, 5), failing(10, 3)])
    joined.to_npz(tmp_path / "out.npz")
    again = sw.Ensemble.read(tmp_path / "out.npz")
    assert joined == every == again == pickle.loads(pickle.dumps(every))
    assert again.failures == every.failures
    with np.load(tmp_path / "out.npz") as archive:
        assert archive["failures"].tolist() == [11, 14, 17]
    assert np.isnan(again.envelope("moment").max_time[[1, 4, 7]]).all()
    assert not np.isnan(again.envelope("moment").max_position[[0, 2]]).any()
    with pytest.raises(RuntimeError, match="row 1: sample number 11 failed"):
        again.run(1)
    table = again.to_pandas()
    assert table.index.tolist() == [*range(10, 18)]
    assert again.to_pandas("axle").index.get_level_values("sample").unique().equals(table.index)
    assert table["failed"].tolist() == [row % 3 == 1 for row in range(8)]
    assert table["moment_max"].isna().equals(table["failed"])


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        ("text", "File is not a zip file"),
        ("npy", "File is not a zip file"),
        ("pickle", "Object arrays cannot be loaded when allow_pickle=False"),
        ("member", "instants is not a file in the archive"),
        ("shape", r"moment_max = shape \(1, 4\): must be \(12, 4\)"),
        ("digests", r"digests = shape \(1,\): must be \(12,\)"),
        ("hash", r"hash = .*: is not that of its samples, "),
        ("version", "is of another version of spanwise"),
        ("packed", "is compressed, as no archive of an ensemble is"),
    ],
)
def test_what_is_no_archive(damage: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "out.npz"
    whole("side by side").to_npz(path)
    with np.load(path) as archive:
        arrays = dict(archive)
    if damage == "text":
        path.write_text("sample,moment\n", encoding="ascii")
    elif damage == "npy":
        with path.open("wb") as stream:
            np.save(stream, np.zeros(3))
    elif damage == "pickle":
        np.savez(path, layout=np.array([{}], dtype=object), allow_pickle=True)
    elif damage == "packed":
        with ZipFile(path) as archive, ZipFile(tmp_path / "new.npz", "w", ZIP_DEFLATED) as packed:
            for each in archive.namelist():
                packed.writestr(each, archive.read(each))
        path = tmp_path / "new.npz"
    else:
        if damage == "member":
            del arrays["instants"]
        elif damage == "shape":
            arrays["moment_max"] = arrays["moment_max"][:1]
        elif damage == "digests":
            arrays["digests"] = arrays["digests"][:1]
        elif damage == "version":
            layout = json.loads(str(arrays["layout"]))
            arrays["layout"] = np.array(json.dumps(layout | {"format": 0}))
        else:
            arrays["digests"] = arrays["digests"] + np.uint64(1)
        np.savez(path, **arrays)
    with pytest.raises(
        ValueError, match=f"{path.name}: is not the archive of an ensemble: .*{says}"
    ):
        sw.Ensemble.read(path)


def test_what_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        sw.Ensemble.read(tmp_path / "out.npz")
    with pytest.raises(OSError, match="is not a regular file"):
        sw.Ensemble.read(tmp_path)


def test_a_row_a_sample() -> None:
    found = whole("varied")
    table = found.to_pandas()
    assert table.index.tolist() == [*range(COUNT)]
    assert table.index.name == "sample"
    assert_array_equal(table["kind"], np.arange(COUNT) % 2)
    assert_array_equal(table["speed"], np.linspace(15.0, 30.0, COUNT))
    assert_array_equal(table["body_mass"], np.linspace(0.8, 1.2, COUNT))
    assert (table["suspension_damping"] == 1.1).all()
    assert_array_equal(table["moment_max"], found.envelope("moment").max.max(axis=1))
    assert_array_equal(table["moment_min"], found.envelope("moment").min.min(axis=1))
    at = found.envelope("moment").x.tolist().index(table.attrs["governing"]["sagging"])
    assert_array_equal(table["impact_factor_sagging"], found.impact_factors.sagging[:, at])
    assert_array_equal(table["load_coefficient_1"], found.dynamic_load_coefficients[:, 0])
    assert_array_equal(table["body_acceleration_rms_1"], found.body_accelerations.rms[:, 0])
    assert not table["failed"].any()
    several = whole("one by one").to_pandas()
    assert (several[["speed_1", "speed_2", "speed_3"]] == 20.0).all(axis=None)
    assert "kind" not in several
    assert (whole("by itself").to_pandas()["speed"] == 22.0).all()


@pytest.mark.parametrize(
    ("by", "quantity", "factor"),
    [
        ("section", "deflection", "deflection"),
        ("section", "moment", "hogging"),
        ("section", "shear", "shear"),
        ("support", "reactions", "reactions"),
        ("clamp", "clamp_moments", None),
        ("axle", "axle_loads", "axle_loads"),
    ],
)
def test_a_row_a_sample_and_place(by: Any, quantity: str, factor: Any) -> None:
    found = whole("varied")
    table, extremes = found.to_pandas(by), found.envelope(quantity)
    assert table.index.names == ["sample", by]
    assert table.index.get_level_values(by).unique().tolist() == extremes.x.tolist()
    for name in ("max", "min", "max_time", "min_position"):
        assert_array_equal(table[f"{quantity}_{name}"].unstack(), getattr(extremes, name))
    for name in ("static_max", "static_min"):
        static = table[f"{quantity}_{name}"].unstack()
        assert_array_equal(static, np.broadcast_to(getattr(extremes, name), static.shape))
    if factor is not None:
        assert_array_equal(table[f"impact_factor_{factor}"].unstack(), found.impact_factors[factor])


def test_kinds_with_fewer_axles_that_leave_the_road() -> None:
    found = sw.ensemble(
        BRIDGE,
        [TRUCK, sw.vehicles.quarter_car()],
        samples=4,
        speed=25.0,
        kind=[0, 1, 0, 1],
        modes=3,
        damping=0.02,
        road=sw.Step(3.0, -0.1),
    )
    table, loads = found.to_pandas(), found.envelope("axle_loads")
    assert np.isnan(loads.max[:, 1]).tolist() == [False, True, False, True]
    assert_array_equal(table["axle_loads_max"], [*map(max, [loads.max[0], loads.max[1, :1]] * 2)])
    off = found.contact_loss
    assert (off.count[:, 0] > 0).any()
    assert_array_equal(table["lift_offs_1"], off.count[:, 0])
    assert_array_equal(table["time_off_road_1"], off.total[:, 0])
    assert_array_equal(table["body_acceleration_max_1"], found.body_accelerations.max[:, 0])
    # Down goes most of the bridge, in the middle of the longer span.
    at = int(np.argmax(np.median(found.envelope("deflection").static_max, axis=0)))
    assert table.attrs["governing"]["deflection"] == found.sections[at] > 0.0
    assert_array_equal(table["impact_factor_deflection"], found.impact_factors.deflection[:, at])
    axles = found.to_pandas("axle").index.get_level_values("axle")
    assert pd.api.types.is_integer_dtype(axles)


def test_places_that_are_not_there() -> None:
    with pytest.raises(ValueError, match=r"by = 'sections': must be one of .*did you mean"):
        whole("varied").to_pandas("sections")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match='by = "support": this ensemble has moment'):
        whole("one by one").to_pandas("support")


@pytest.mark.parametrize("by", ["sample", "section"])
def test_tables_in_files(by: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("spanwise._ensemble_tables.ROWS", 5)
    found = whole("varied")
    table = found.to_pandas(by)
    found.to_parquet(tmp_path / "out.parquet", by)
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "out.parquet"), table)
    found.to_csv(tmp_path / "out.csv", by)
    index = "sample" if by == "sample" else ["sample", "section"]
    assert len((tmp_path / "out.csv").read_text().split("\n")) == 1 + len(table) + 1
    again = pd.read_csv(tmp_path / "out.csv", index_col=index)
    pd.testing.assert_frame_equal(again, table, check_exact=True, check_index_type=False)
    assert {path.name for path in tmp_path.iterdir()} == {"out.parquet", "out.csv"}
    with pytest.raises(FileNotFoundError, match="no such folder"):
        found.to_csv(tmp_path / "missing" / "out.csv")


@pytest.mark.parametrize(
    ("missing", "extra", "use"),
    [
        ("pandas", "pandas", lambda found: found.to_pandas()),
        ("pandas", "pandas", lambda found: found.to_csv("out.csv")),
        ("pyarrow", "parquet", lambda found: found.to_parquet("out.parquet")),
    ],
)
def test_extras_are_named(
    missing: str, extra: str, use: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(ImportError, match=rf"spanwise\[{extra}\]"):
        use(whole("varied"))


@pytest.mark.parametrize("write", ["to_npz", "to_csv", "to_parquet"])
@pytest.mark.parametrize("name", ["kept", "kept.1", "kept.data"])
def test_a_file_has_the_name_that_was_given(write: str, name: str, tmp_path: Path) -> None:
    found = whole("varied")
    getattr(found, write)(tmp_path / name)
    assert [each.name for each in tmp_path.iterdir()] == [name]
    if write == "to_npz":
        assert sw.Ensemble.read(tmp_path / name) == found
