"""Measured profiles from files as people have them, and what is refused of them, line by line."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import spanwise as sw
from spanwise.cli import main
from spanwise.roads import reading

#: Conversions and sums of a few numbers.
EXACT = 1e-12

#: Five points at half a metre [m], and left and right track.
X = [0.0, 0.5, 1.0, 1.5, 2.0]
LEFT = [0.011, 0.012, 0.015, 0.012, 0.010]
RIGHT = [0.013, 0.012, 0.011, 0.018, 0.012]
MEAN = [0.012, 0.012, 0.013, 0.015, 0.011]

ERD = """ERDFILEV2.00
   2,   5,  -1,   1,   5,  0.5000,  -1,
TITLE   Section 4: Run 1
SHORTNAMLElev   RElev   \n\
UNITSNAMmm      mm      \n\
XLABEL  Distance
XUNITS  m
END
"""
#: Not a sample a line.
SAMPLES = " 11.0 13.0\n 12.0 12.0 15.0 11.0\n 12.0\n 18.0\n 10.0, 12.0\n"

Table = tuple[str, str, dict[str, Any], list[float], list[float]]


def rows(
    *columns: Sequence[object], between: str = ",", form: str = "{}", comma: bool = False
) -> str:
    lines = [between.join(form.format(each) for each in row) for row in zip(*columns, strict=True)]
    text = "\n".join(lines) + "\n"
    return text.replace(".", ",") if comma else text


def test_the_name_it_had(tmp_path: Path) -> None:
    file = tmp_path / "road.csv"
    file.write_text(rows(X, LEFT))
    with pytest.warns(DeprecationWarning, match=r"Profile\.read_csv is now Profile\.read") as told:
        road = sw.Profile.read_csv(file, scale=(1.0, 2.0))
    assert told[0].filename == __file__
    assert road == sw.Profile.read(file, scale=(1.0, 2.0))


FEET = [x / 0.3048 for x in X]
INCHES = [z / 0.0254 for z in LEFT]
IN_FEET = rows(FEET, INCHES)
THOUSAND = [1000.0 + x for x in X]

TABLES: dict[str, Table] = {
    "plain": (rows(X, LEFT), "utf-8", {}, X, LEFT),
    "blanks after commas": (rows(X, LEFT, between=" , "), "utf-8", {}, X, LEFT),
    "byte order mark": (rows(X, LEFT), "utf-8-sig", {}, X, LEFT),
    "DOS": (rows(X, LEFT).replace("\n", "\r\n") + "\x1a", "ascii", {}, X, LEFT),
    "semicolons": (rows(X, LEFT, between=";"), "utf-8", {}, X, LEFT),
    "tabs": (rows(X, LEFT, between="\t"), "utf-8", {}, X, LEFT),
    "tabs by name": (rows(X, LEFT, between="\t"), "utf-8", {"delimiter": "\\t"}, X, LEFT),
    "bars": (rows(X, LEFT, between="|"), "utf-8", {}, X, LEFT),
    "blanks": (rows(X, LEFT, between="", form="{:9.3f}"), "utf-8", {}, X, LEFT),
    "decimal comma": (rows(X, LEFT, between=";", comma=True), "utf-8", {}, X, LEFT),
    "decimal comma and blanks": (rows(X, LEFT, between="  ", comma=True), "utf-8", {}, X, LEFT),
    "decimal comma and tabs": (rows(X, LEFT, between="\t", comma=True), "utf-8", {}, X, LEFT),
    "a head in Windows-1252": (
        "Straße 7, Abschnitt 4\n\nStation;Höhe links;Höhe rechts\nm;mm;mm\n"
        + rows(X, [1e3 * z for z in LEFT], RIGHT, between=";", comma=True),
        "cp1252",
        {"columns": ("Station", "Höhe links")},
        X,
        LEFT,
    ),
    "a head in UTF-16": (
        "Straße 7, Abschnitt 4\nStation\tHöhe [mm]\n"
        + rows(X, [1e3 * z for z in LEFT], between="\t"),
        "utf-16",
        {"columns": ("Station", "Höhe [mm]")},
        X,
        LEFT,
    ),
    "UTF-16 without a mark": (rows(X, LEFT), "utf-16-le", {}, X, LEFT),
    "the other UTF-16": ("x;z\n" + rows(X, LEFT, between=";"), "utf-16-be", {}, X, LEFT),
    "names and units over blanks": (
        " x [ft]  z [in]\n" + IN_FEET.replace(",", " "),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "units in round brackets": (
        "station (ft),elevation (in)\n" + IN_FEET,
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "units after a stroke": (
        "x / ft;z / in\n" + IN_FEET.replace(",", ";"),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "units after a stroke over blanks": (
        "x / ft   z /in\n" + IN_FEET.replace(",", " "),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "units after a stroke alone": ("x/ft;z/in\n" + IN_FEET.replace(",", ";"), "utf-8", {}, X, LEFT),
    "units in words": (
        "Station in m;Höhe in mm\n" + rows(X, [1e3 * z for z in LEFT], between=";", comma=True),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "a line of units in brackets over blanks": (
        "x z\n[ft] [in]\n" + IN_FEET.replace(",", " "),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "units after a dash": ("station_ft,elevation_in\n" + IN_FEET, "utf-8", {}, X, LEFT),
    "the last brackets": (
        "x (from the joint) [ft],z [in] (left)\n" + IN_FEET,
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "yards": ("Station [yd],z [m]\n" + rows(X, LEFT), "utf-8", {}, [0.9144 * x for x in X], LEFT),
    "a unit that nothing is read of": (
        "x;t;z\nft;kN;in\n" + rows(FEET, X, INCHES, between=";"),
        "utf-8",
        {"columns": ("x", "z")},
        X,
        LEFT,
    ),
    "brackets without units": (
        "x (from the joint),z (left)\n" + rows(X, LEFT),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "names that hold a stroke": ("km/h,L/R\n" + rows(X, LEFT), "utf-8", {}, X, LEFT),
    "a factor before units that are not known": (
        "x [rod],z [in]\n" + rows(X, LEFT),
        "utf-8",
        {"scale": (2.0, 1.0)},
        [2 * x for x in X],
        LEFT,
    ),
    "a factor before units": (
        "x [m],z [mm]\n" + rows(X, LEFT),
        "utf-8",
        {"scale": (2.0, 1.0)},
        [2 * x for x in X],
        LEFT,
    ),
    "a title with numbers": (
        "Km 12 to 13\nx z\n" + rows(X, LEFT, between=" "),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "stations": (rows(THOUSAND, LEFT).replace("100", "1+00"), "utf-8", {}, THOUSAND, LEFT),
    "stations of 100 ft": (
        "station [ft] z\n"
        + rows(["12+50", "12+52.5", "12+55", "12+57.5", "12+60"], LEFT, between=" "),
        "utf-8",
        {"columns": (0, 1)},
        [0.3048 * (1250 + 2.5 * k) for k in range(5)],
        LEFT,
    ),
    "thousands": (
        "999.5;0.011\n" + rows(THOUSAND, LEFT, between=";", form="{:,}"),
        "utf-8",
        {"start": -1.0},
        [-1.0, -0.5, 0.0, 0.5, 1.0, 1.5],
        [0.011, *LEFT],
    ),
    "thousands in quotes": (rows(THOUSAND, LEFT, form='"{:,}"'), "utf-8", {}, THOUSAND, LEFT),
    "thousands by blanks": (
        rows(THOUSAND, LEFT, between=";", form="{:,}").replace(",", " "),
        "utf-8",
        {},
        THOUSAND,
        LEFT,
    ),
    "thousands by points": (
        rows(THOUSAND, LEFT, between=";", comma=True).replace("100", "1.00"),
        "utf-8",
        {},
        THOUSAND,
        LEFT,
    ),
    "x falls": (rows(X[::-1], LEFT[::-1]), "utf-8", {}, X, LEFT),
    "x falls to a start": (
        rows(X[::-1], LEFT[::-1]),
        "utf-8",
        {"start": -2.5},
        [x - 2.5 for x in X],
        LEFT,
    ),
    "the mean of tracks": (rows(X, LEFT, RIGHT), "utf-8", {"columns": (0, 1, 2)}, X, MEAN),
    "bare units over blanks": (
        "Station m   Elevation in ft\n" + rows(X, [z / 0.3048 for z in LEFT], between=" "),
        "utf-8",
        {"columns": ("Station", "Elevation")},
        X,
        LEFT,
    ),
    "a comment as heading": ("# x [ft], z [in]\n" + IN_FEET, "utf-8", {}, X, LEFT),
    "a comment as heading over blanks": (
        "# Section 4\n# x ft  z in\n" + IN_FEET.replace(",", " "),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "comments with names and units": (
        "#right;left;x\n# mm;mm;m\n" + rows(RIGHT, [1e3 * z for z in LEFT], X, between=";"),
        "utf-8",
        {"columns": ("x", "left")},
        X,
        LEFT,
    ),
    "names in a comment": (
        "# left,x\n" + rows(LEFT, X),
        "utf-8",
        {"columns": ("x", "left")},
        X,
        LEFT,
    ),
    "a comment that is no heading": (
        "# measured in 2020, left in mm, right\n# 3 runs\n" + rows(X, LEFT),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "a comment among the points": (
        "0,0.011\n# x [ft], z [in]\n" + rows(X[1:], LEFT[1:]),
        "utf-8",
        {},
        X,
        LEFT,
    ),
    "names without their units": (
        "Station [m],z (left) [mm],z_in\n" + rows(X, [1e3 * z for z in LEFT], RIGHT),
        "utf-8",
        {"columns": ("Station", "z (left)")},
        X,
        LEFT,
    ),
    "a name without its unit in words": (
        "x in m;h in mm;z_in\n" + rows(X, RIGHT, INCHES, between=";"),
        "utf-8",
        {"columns": ("x", "z")},
        X,
        LEFT,
    ),
    "the right track": (
        "x,left,right\n" + rows(X, LEFT, RIGHT),
        "utf-8",
        {"columns": ("x", "right")},
        X,
        RIGHT,
    ),
    "elevations alone": (rows(LEFT), "utf-8", {"spacing": 0.5}, X, LEFT),
    "elevations with commas": (rows(LEFT, comma=True), "utf-8", {"spacing": 0.5}, X, LEFT),
    "elevations and a start": (
        "z [mm]\n11\n12\n15\n12\n10\n",
        "utf-8",
        {"spacing": 0.5, "start": -1.0},
        [x - 1 for x in X],
        LEFT,
    ),
    "two columns alone": (
        rows(LEFT, RIGHT),
        "utf-8",
        {"spacing": 0.5, "columns": (0, 1)},
        X,
        MEAN,
    ),
    "one of two columns": (
        rows(LEFT, RIGHT),
        "utf-8",
        {"spacing": 0.5, "columns": np.int64(1)},
        X,
        RIGHT,
    ),
    "first of two elevations": (
        rows([0.0, *X], [0.5, *LEFT]),
        "utf-8",
        {"duplicates": "last"},
        X,
        LEFT,
    ),
    "last of two elevations, falling": (
        rows([*X[::-1], 0.0], [*LEFT[::-1], 0.5]),
        "utf-8",
        {"duplicates": "first"},
        X,
        LEFT,
    ),
    "the mean of two elevations": (
        rows([*X, 2.0], [*LEFT, 0.020]),
        "utf-8",
        {"duplicates": "mean"},
        X,
        [*LEFT[:-1], 0.015],
    ),
    "ERD, a track": (ERD + SAMPLES, "ascii", {"columns": "RElev"}, X, RIGHT),
    "ERD, both tracks": (
        ERD + SAMPLES,
        "ascii",
        {"columns": ["LElev", "RElev"], "start": 3.0},
        [3 + x for x in X],
        MEAN,
    ),
    "ERD, in feet and inches": (
        ERD.replace("mm      mm", "in      in").replace("XUNITS  m", "XUNITS  ft") + SAMPLES,
        "ascii",
        {"columns": [1]},
        [0.3048 * x for x in X],
        [25.4 * z for z in RIGHT],
    ),
    "ERD, its start": (
        ERD.replace("XLABEL  Distance", "XSTART  100.0") + SAMPLES,
        "ascii",
        {"columns": 0},
        [100.0 + x for x in X],
        LEFT,
    ),
    "ERD, x in a channel": (
        ERD.replace("0.5000", "0.0").replace("UNITSNAMmm", "UNITSNAMm ")
        + rows(X, [1e3 * z for z in LEFT], between=" "),
        "ascii",
        {},
        X,
        LEFT,
    ),
    "ERD, so many samples as there are": (
        ERD.replace("   5,  -1", "  -1,  -1").replace("   2,", "   1,", 1) + rows(LEFT),
        "ascii",
        {"scale": (1, 1)},
        X,
        LEFT,
    ),
}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("case", TABLES.values(), ids=TABLES)
def test_files_as_people_have_them(tmp_path: Path, case: Table) -> None:
    text, encoding, options, x, elevations = case
    file = tmp_path / "road.txt"
    file.write_bytes(text.encode(encoding))
    road = sw.Profile.read(file, **options)
    assert_allclose(road.x, x, rtol=EXACT, atol=EXACT)
    assert_allclose(road.elevations, elevations, rtol=EXACT, atol=EXACT)
    table = {"kind": "profile", "file": str(file), **options}
    assert sw.roads.from_table(table) == road


@pytest.mark.parametrize(
    ("text", "options", "parts"),
    [
        ("0,1\n1,2\n2,x\n3,1\n", {}, ("road.txt, line 3", "'x' in column 1", "not a number")),
        ("x;z\n0;1\n1;1\n-- end;\n2;1\n", {}, ("line 4", "'-- end'", "not a number")),
        ("0,1\n1\n2,2\n", {}, ("line 2", "1 columns", "column 1")),
        ("0,1\n1,1\n1,1\n2,1\n", {}, ("line 3", "x[2] = 1 m", "duplicates = 'mean' takes")),
        ("0,1\n\n2,1\n1,1\n3,1\n", {}, ("line 4", "x[2] = 1 m", "sort = true brings the points")),
        ("x,z\n0,1\n1_000,1\n", {}, ("line 3", "'1_000' in column 0", "not a number")),
        ("0,1\n1,1_0\n", {"decimal": "."}, ("line 2", "'1_0' in column 1", "not a number")),
        ("0;1\n1;1_0,5\n", {"decimal": ","}, ("line 2", "'1_0,5' in column 1", "not a number")),
        (
            "Station [rod],z [in]\n0,1\n1,2\n",
            {},
            ("road.txt, line 1: unit 'rod' of column 0 (Station [rod]): is not known; give scale",),
        ),
        (
            "Road 7\nx (m);z (Zoll)\n0;1\n1;2\n",
            {},
            ("line 2: unit 'Zoll' of column 1 (z (Zoll)): is not known; give scale",),
        ),
        ("x / m;z / Zoll\n0;1\n1;2\n", {}, ("line 1: unit 'Zoll' of column 1 (z / Zoll)",)),
        ("x [rod],z [link]\n0,1\n1,2\n", {}, ("line 1: unit 'rod' of column 0",)),
        ("x,z\nRod,in\n0,1\n1,2\n", {}, ("line 2: unit 'Rod' of column 0 (x): is not known",)),
        ("\n# x [ft], z [Rod]\n0,1\n1,2\n", {}, ("line 2: unit 'Rod' of column 1 (z [Rod])",)),
        (
            "x [m],z [m],z [mm]\n0,1,1\n1,2,1\n",
            {"columns": ("x", "z")},
            ("columns[1] = 'z': must be one of x [m], z [m], z [mm]",),
        ),
        (
            "x,left,right\n" + rows(X, LEFT, RIGHT),
            {},
            ("line 2: 3 columns: x, left, right", "give that of x and one elevation in columns"),
        ),
        (
            "Station\tTime\tz\n" + rows(X, LEFT, RIGHT, between="\t"),
            {},
            ("line 2: 3 columns: Station, Time, z", "several for their mean"),
        ),
        (
            ERD.replace("   2,   5", "   3,   5")
            .replace("0.5000", "0.0")
            .replace("LElev", "X       LElev")
            .replace("mm  ", "m       mm  ", 1)
            + rows(X, LEFT, RIGHT),
            {},
            ("line 9: 3 columns: X, LElev, RElev", "in columns"),
        ),
        ("x,z\n0,1\n1,1\n2,1\n9,1\n", {}, ("line 5", "x[3] = 9 m", "max_gap = 5 m")),
        ("0;1\n1,5;2\n", {"decimal": "."}, ("line 2", "'1,5'", "is the decimal mark ','?")),
        ("0;1\n1;2\n", {"delimiter": ","}, ("line 2", "no numbers in '1;2'", "delimiter ';'?")),
        ("a,b\n", {}, ("line 1", "no numbers in 'a,b'")),
        ("", {}, ("road.txt: x = 0 points", "4 or more")),
        ("0.1\n0.2\n", {}, ("line 1: 1 column", "give their spacing")),
        (
            "10,11\n12,13\n",
            {"spacing": 1.0},
            ("'10,11' may be one number or two", "delimiter = ','"),
        ),
        ("0;1,234\n1;1,235\n", {}, ("'1,235' may be thousands", "give decimal = ','")),
        (
            "1;2\n2;3\n",
            {"spacing": 1.0},
            ("line 1: 2 columns of elevations", "give one in columns"),
        ),
        ("0,1\n1,nan\n2,1\n3,1\n", {}, ("elevations[1] = NaN", "finite")),
        ("x,r\n0,1\n", {"columns": ("x", "R")}, ("columns[1] = 'R'", "x, r", "did you mean 'r'")),
        ("0,1\n", {"columns": ("x", "r")}, ("columns[0] = 'x'", "no line of names")),
        ("0,1\n", {"columns": (0, -1)}, ("columns[1] = -1", "number from 0")),
        ("0,1\n", {"columns": (0, True)}, ("columns[1] = True", "number from 0")),
        (
            "0,1\n",
            {"columns": 3},
            ("columns = [3]", "x and one elevation", "spacing in place of x"),
        ),
        ("0,1\n", {"columns": 1.5}, ("columns = 1.5", "names or numbers")),
        ("0,1\n", {"columns": ()}, ("columns = ()", "1 to 100")),
        ("0,1\n", {"delimiter": ", "}, ("delimiter = ', '", r"one character, or \t for a tab")),
        ("0,1\n", {"decimal": ";"}, ("decimal = ';'", "must be . or ,")),
        ("0,1\n", {"scale": 1.0}, ("scale = 1.0", "two factors")),
        ("0,1\n", {"spacing": 0.0}, ("spacing = 0", "greater than 0")),
        ("0,1\n", {"start": float("nan")}, ("start = NaN", "finite")),
        ("0,1\n", {"duplicates": "both"}, ("duplicates = 'both'", "refuse, mean, first, last")),
        (
            ERD + SAMPLES,
            {},
            ("line 9: 2 columns of elevations: LElev, RElev", "give one in columns"),
        ),
        (ERD + SAMPLES, {"columns": ["Left"]}, ("columns[0] = 'Left'", "one of LElev, RElev")),
        (ERD + SAMPLES, {"spacing": 1.0}, ("spacing = 1.0", "not used with ERD files")),
        (ERD + SAMPLES, {"delimiter": ","}, ("delimiter = ','", "not used with ERD files")),
        (ERD + SAMPLES[:-12], {"columns": 0}, ("road.txt: has 4 samples, and its header says 5",)),
        (ERD + SAMPLES[:-6], {"columns": 0}, ("line 13: the last sample has 1 of 2 channels",)),
        (ERD + "1 2\n3 x\n", {"columns": 1}, ("line 10", "'x' in column 1", "not a number")),
        (
            ERD.replace("XUNITS  m", "XUNITS  rod") + SAMPLES,
            {"columns": 0},
            ("road.txt: unit 'rod' of the step: is not known; give scale",),
        ),
        (ERD.replace("XLABEL  D", "XSTART  ?") + SAMPLES, {"columns": 0}, ("XSTART '?",)),
        (ERD, {}, ("no numbers after END", "as text")),
        (ERD.replace("END", ""), {}, ("line 8", "no line END")),
        (
            ERD.replace("0.5000,", "") + SAMPLES,
            {},
            (
                "line 2",
                "must have channels and a step",
            ),
        ),
        (ERD.replace("5, ", "five,", 1) + SAMPLES, {}, ("line 2", "numbers of channels, samples")),
    ],
)
def test_bad_files(tmp_path: Path, text: str, options: Any, parts: tuple[str, ...]) -> None:
    file = tmp_path / "road.txt"
    file.write_bytes(text.encode())
    with pytest.raises(ValueError) as refused:  # noqa: PT011 - the parts are the match
        sw.Profile.read(file, **options)
    for part in parts:
        assert part in str(refused.value), str(refused.value)


@pytest.mark.parametrize("content", [b"\xff\xfe\x00\xd8", b"PK\x03\x04\x05\x06", b"0,1\n\x81\n"])
def test_files_that_are_not_text(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "road.csv"
    file.write_bytes(content)
    with pytest.raises(ValueError, match=r"road\.csv: not a file of separated values"):
        sw.Profile.read(file)


def test_files_that_are_none_or_have_no_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(FileNotFoundError):
        sw.Profile.read(tmp_path / "no.csv")
    with pytest.raises(ValueError, match="is a folder; a profile is a file of numbers"):
        sw.Profile.read(tmp_path)
    for special in ("/dev/zero", "/dev/null"):
        with pytest.raises(ValueError, match=f"{special}: is not a regular file"):
            sw.roads.from_table({"kind": "profile", "file": special})
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)  # which waits for ever when it is opened
    with pytest.raises(ValueError, match="pipe: is not a regular file"):
        sw.Profile.read(pipe)
    file = tmp_path / "road.csv"
    with file.open("wb") as hole:
        hole.truncate(2**40)  # takes no place on the disk
    with pytest.raises(ValueError, match=r"road\.csv: is too large; .* at most 134217728 bytes"):
        sw.Profile.read(file)
    file.write_text(rows(X, LEFT))
    monkeypatch.setattr(reading, "MAX_BYTES", 10)
    with pytest.raises(ValueError, match=r"is too large; .* at most 10 bytes"):
        sw.Profile.read(file)


def test_one_line_of_many_numbers(tmp_path: Path) -> None:
    # In time that grows with the numbers, not with their square.
    file = tmp_path / "road.erd"
    z = 1e-3 * np.sin(np.arange(100_000))
    head = ERD.replace("   2,", "   1,", 1).replace("   5,  -1", "  -1,  -1")
    file.write_text(head + " ".join(map(str, 1e3 * z)))
    assert_allclose(sw.Profile.read(file).elevations, z, rtol=EXACT, atol=1e-18)


def test_the_same_options_on_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    road = sw.ISO8608("B", seed=4)
    x = np.arange(0.0, 120.0, 0.25)
    z = 1e3 * road.elevation(x)
    file = tmp_path / "road.txt"
    lines = [f"{a:.3f}\t{b:.3f}".replace(".", ",") for a, b in zip(z, z[::-1], strict=True)]
    file.write_text("links [mm]\trechts [mm]\n" + "\n".join(lines), encoding="utf-16")
    given = ["spacing=0.25", "start=-20", r"delimiter=\t", "decimal=,", "columns=links [mm]"]
    options = [word for each in given for word in ("--set", each)]
    assert main(["road", str(file), *options]) == 0
    out, err = capsys.readouterr()
    assert "480 points from -20 to 99.75 m" in out
    assert "class B" in out
    assert err == ""
    assert main(["road", str(file), *options[:-2]]) == 2
    assert "give one in columns" in capsys.readouterr().err
    # The options that there were, for one version more.
    old = ["--spacing", "0.25", "--profile-start", "-20", "--delimiter", r"\t", "--decimal", ","]
    assert main(["road", str(file), *old, "--columns", "links [mm]"]) == 0
    told, err = capsys.readouterr()
    assert told == out
    assert "warning: --profile-start is now --set start=...; the old name goes with" in err
    assert err.count("warning") == 5


#: Files, arguments, and what is said, in Python and by the command alike.
ADVICE: dict[str, tuple[str, dict[str, Any], str]] = {
    "sort": ("0,0.1\n2,0.1\n1,0.1\n3,0.1\n", {}, "sort = true brings the"),
    "duplicates": ("0,0.1\n1,0.1\n1,0.1\n2.5,0.1\n", {}, "duplicates = 'mean' takes"),
    "max_gap": ("0,1\n1,1\n2,1\n9,1\n", {}, "at most max_gap = 5 m"),
    "start": ("0,1\n1,1\n2,1\n3,1\n", {"start": float("nan")}, "start = NaN: must be"),
    "decimal": ("0;1,234\n1;1,235\n", {}, "give decimal = ',' or decimal = '.'"),
    "delimiter": ("10,11\n12,13\n", {"spacing": 1}, "give decimal = ',' or delimiter = ','"),
    "spacing": ("0.1\n0.2\n", {}, "give their spacing"),
    "spacing in place": ("0,1\n1,1\n", {"columns": 1}, "or give spacing in place of x"),
    "columns": ("x,left,right\n0,1,2\n", {}, "and one elevation in columns, or"),
    "scale": ("x [rod],z [m]\n0,1\n", {}, "give scale"),
    "scale of what is steep": (
        "".join(f"{k},{k * k % 7}\n" for k in range(40)),
        {},
        "as scale = [1.0, 0.001] does in a file",
    ),
}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("case", ADVICE.values(), ids=ADVICE)
def test_advice_names_what_there_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], case: tuple[str, dict[str, Any], str]
) -> None:
    text, given, says = case
    file = tmp_path / "road.txt"
    file.write_text(text)
    main(["road", str(file), *(f"--set={key}={value}" for key, value in given.items())])
    out, err = capsys.readouterr()
    assert says in err + " ".join(out.split())
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            sw.roads.from_table({"kind": "profile", "file": str(file), **given})
            said = str(told[0].message)
        except ValueError as refused:
            said = str(refused)
    assert says in said


#: Files with points that were not measured, what is given for these, and what is left of x.
DROPPED: list[tuple[str, float, dict[str, Any], list[int]]] = [
    (
        "0,11\n1,-9999\n2,12\n3,13\n4,-9999.0\n5,14\n",
        -9999.0,
        {"scale": (1.0, 1e-3)},
        [0, 2, 3, 5],
    ),
    ("0,11\n1,nan\n2,12\n3,\n4,13\n5,14\n", float("nan"), {}, [0, 2, 4, 5]),
    ("0,1,1\n1,1,-99\n2,-99,1\n3,2,2\n4,1,2\n5,2,1\n", -99.0, {"columns": (0, 1, 2)}, [0, 3, 4, 5]),
    ("0.11\n-1\n0.12\n0.13\n-1\n0.14\n", -1.0, {"spacing": 1.0}, [0, 2, 3, 5]),
]


@pytest.mark.parametrize(("text", "code", "given", "kept"), DROPPED, ids=range(4))
def test_points_that_were_not_measured_are_left_out(
    text: str, code: float, given: dict[str, Any], kept: list[int], tmp_path: Path
) -> None:
    file = tmp_path / "road.csv"
    file.write_text(text)
    road = sw.Profile.read(file, missing=code, max_gap=5.0, **given)
    assert road.x.tolist() == kept
    assert road.elevations.min() > 0.0
    table = {"kind": "profile", "file": str(file), "missing": code, "max_gap": 5.0}
    assert sw.roads.from_table(table | given) == road


def test_what_was_not_measured_is_refused_or_doubted_with_the_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "road.csv"
    points = [[0.1 * k, 0.001 * (k % 30)] for k in range(300)]
    for cell, says in (("", "column 1 is blank"), ("nan", "must be a finite number")):
        lines = [f"{x:g},{cell if 9 <= k < 12 else z}" for k, (x, z) in enumerate(points)]
        file.write_text("\n".join(lines))
        refused = rf"line 10: .*{says}; missing = nan leaves such points out$"
        with pytest.raises(ValueError, match=refused):
            sw.Profile.read(file)
        assert main(["road", str(file)]) == 2
        assert capsys.readouterr().err.endswith("; missing = nan leaves such points out\n")
        assert main(["road", str(file), "--set", "missing=nan"]) == 0
        capsys.readouterr()
    file.write_text(rows([x for x, _ in points], [z for _, z in points]).replace("0.02\n", "-99\n"))
    with pytest.warns(sw.PlausibilityWarning, match=r"as 9 other points.*missing does so"):
        sw.Profile.read(file)
    assert main(["road", str(file), "--set", "missing=-99"]) == 0
    assert capsys.readouterr().err == ""
    assert main(["road", str(file), "--set", "missing=-1"]) == 0
    assert "missing does so" in " ".join(capsys.readouterr().out.split())
