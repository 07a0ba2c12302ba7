"""The command ``spanwise ensemble CASE.toml``: many crossings of a case."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from spanwise._checks import whole_from
from spanwise._command_options import add_case, add_json, add_key, add_plot, add_road
from spanwise._door import require
from spanwise._ensemble_files import as_dict, npz_writer
from spanwise._ensemble_tables import csv_pieces
from spanwise._figures import figure_files, figures_of_ensemble
from spanwise._files import Content, check_targets, write_files
from spanwise._plain import json_lines
from spanwise.case import Case

if TYPE_CHECKING:
    from argparse import _SubParsersAction

#: Most threads that can be asked for.
MOST: Final = 2**31 - 1


def add_to(commands: _SubParsersAction[Any]) -> None:
    """Add the command and its options."""
    command = commands.add_parser(
        "ensemble",
        allow_abbrev=False,
        help="drive over a bridge many times, each time on a random road of its own",
        description="Drive the vehicles of a case over its bridge many times, each time on a "
        "random road of its own if the case has one, and print percentiles of the largest "
        "responses and of the impact factors. Everything is computed before any file is written. "
        "Speeds or factors that vary from crossing to crossing are lists in [ensemble] of the "
        "case, or are given in Python, to Case.ensemble.",
    )
    add_case(command, "ensemble")
    add_key(command, "--samples", "ensemble.samples", "number of crossings", metavar="N")
    add_key(
        command,
        "--seed",
        "ensemble.seed",
        "seed of the random roads, in place of that of [road]; by default as [ensemble] says, or 0",
        metavar="N",
    )
    add_key(
        command,
        "--first",
        "ensemble.first",
        "number of the first sample; by default likewise",
        metavar="N",
    )
    add_key(command, "--speed", "ensemble.speed", "speed at the start in m/s", metavar="V")
    add_key(command, "--modes", "ensemble.modes", "number of modes", metavar="N")
    add_road(command)
    add_key(command, "--same-road", "ensemble.own_roads", nargs=0, const=False)
    command.add_argument(
        "--threads", type=int, metavar="N", help="threads; as many as the processor has by default"
    )
    command.add_argument(
        "--out",
        type=Path,
        metavar="FILE.npz",
        help="write all extremes of all samples as a NumPy archive",
    )
    command.add_argument(
        "--csv",
        type=Path,
        metavar="FILE.csv",
        help="write a table there, one row for each sample; needs spanwise[pandas]",
    )
    add_plot(command)
    add_json(command, "percentiles")
    command.set_defaults(work=run)


def run(options: argparse.Namespace) -> str:
    """Computes the ensemble, writes the files asked for, and gives the text to print."""
    if options.out is not None and options.out.suffix != ".npz":
        raise ValueError(f"--out {options.out}: must end in .npz")
    case = Case.read(options.case, options.settings)
    given = (options.json, options.out, options.csv)
    check_targets([Path(each) for each in given if each not in (None, "-")], case.files)
    for extra, wanted in (("pandas", options.csv), ("plot", options.plot)):
        if wanted is not None:
            require("matplotlib" if extra == "plot" else extra, extra=extra)
    if "samples" not in case.sampling:
        raise ValueError(f"--samples: missing; give it, or samples in [ensemble] of {options.case}")
    for key in options.settings:
        table, _, name = key.partition(".")
        if table == "crossing" and name in case.sampling:
            raise ValueError(f"{key}: [ensemble] has {name} too, which goes before; set that")
    threads = None if options.threads is None else whole_from("--threads", options.threads, 1, MOST)
    found = case.ensemble(threads=threads, progress=True)
    text = found.summary() + "\n"
    files: list[tuple[Path, Content]] = []
    figures: Iterable[tuple[Path, Content]] = []
    folders = []
    if options.json is not None:
        table = json_lines(as_dict(found))
        if options.json == "-":
            text = table
        else:
            files.append((Path(options.json), [table.encode()]))
    if options.out is not None:
        files.append((options.out, npz_writer(found)))
    if options.csv is not None:
        files.append((options.csv, csv_pieces(found, "sample")))
    if options.plot is not None:
        folders.append(options.plot)
        drawn = figure_files(figures_of_ensemble(found))
        figures = ((options.plot / name, [content]) for name, content in drawn)
    write_files(chain(files, figures), folders, case.files)
    return text
