"""The command ``spanwise ensemble CASE.toml``: many crossings of a case."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from spanwise._ensemble_files import as_dict, npz_writer
from spanwise._files import Content, check_targets, write_files
from spanwise._plain import json_lines
from spanwise.case import Case, CaseError

if TYPE_CHECKING:
    from argparse import _SubParsersAction


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
    command.add_argument(
        "case", type=Path, metavar="CASE.toml", help="bridge, vehicles, road, crossing, in SI units"
    )
    command.add_argument(
        "--samples", type=int, metavar="N", help="number of crossings, not that of [ensemble]"
    )
    command.add_argument(
        "--seed",
        type=int,
        metavar="N",
        help="seed of the random roads, in place of that of [road]; by default as [ensemble] says, "
        "or 0",
    )
    command.add_argument(
        "--first", type=int, metavar="N", help="number of the first sample; by default likewise"
    )
    command.add_argument(
        "--same-road",
        action="store_const",
        const=False,
        dest="own_roads",
        help="drive on the roads of the case as they stand, not on one drawn for each sample",
    )
    command.add_argument(
        "--threads", type=int, metavar="N", help="threads; as many as the processor has by default"
    )
    command.add_argument(
        "--modes", type=int, metavar="N", help="number of modes, not that of the case"
    )
    command.add_argument(
        "--out",
        type=Path,
        metavar="FILE.npz",
        help="write all extremes of all samples as a NumPy archive",
    )
    command.add_argument(
        "--json",
        metavar="FILE",
        help="write percentiles as JSON; - for standard output, in place of the summary",
    )
    command.set_defaults(work=run)


@contextmanager
def _errors(options: Iterable[str]) -> Iterator[None]:
    """Blames the option that is at fault, or the environment, and not the case."""
    try:
        yield
    except CaseError as error:
        said = str(error.__cause__)
        key = said.split(" ")[0]
        if key in options:
            raise ValueError(f"--{said}") from error
        if key == "SPANWISE_ISA":
            raise ValueError(said) from error
        if "own_roads=False" in said:
            raise CaseError(str(error).replace("own_roads=False", "--same-road")) from error
        raise


def run(options: argparse.Namespace) -> str:
    """Computes the ensemble, writes the files asked for, and gives the text to print."""
    if options.out is not None and options.out.suffix != ".npz":
        raise ValueError(f"--out {options.out}: must end in .npz")
    case = Case.read(options.case)
    named = [Path(each) for each in (options.json, options.out) if each not in (None, "-")]
    check_targets(named, case.files)
    names = ("samples", "seed", "first", "own_roads", "modes", "threads")
    given = {key: each for key in names if (each := getattr(options, key)) is not None}
    if "samples" not in given and "samples" not in case.sampling:
        raise ValueError(f"--samples: missing; give it, or samples in [ensemble] of {options.case}")
    with _errors(given):
        found = case.ensemble(**given, progress=True)
    text = found.summary() + "\n"
    files: list[tuple[Path, Content]] = []
    if options.json is not None:
        table = json_lines(as_dict(found))
        if options.json == "-":
            text = table
        else:
            files.append((Path(options.json), [table.encode()]))
    if options.out is not None:
        files.append((options.out, npz_writer(found)))
    write_files(files, inputs=case.files)
    return text
