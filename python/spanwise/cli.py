"""The command line: ``spanwise cross``, ``ensemble``, ``vehicles`` and ``road``."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import Any, NoReturn

from spanwise import _ensemblecommand, _roadcommand
from spanwise._checks import count
from spanwise._command_options import add_case, add_json, add_key, add_plot, add_road
from spanwise._core import __version__
from spanwise._figures import figure_files, figures_of_run
from spanwise._files import Content, write_files
from spanwise._keys import suggestion
from spanwise._run_files import csv_files, json_text
from spanwise._signals import Terminated, terminable
from spanwise._streams import say, tell
from spanwise.case import Case
from spanwise.catalogue import detail, listing
from spanwise.roads import Road
from spanwise.roads.random import is_random, reseeded

BAD_INPUT, FAILURE, INTERRUPTED, SIGNALLED = 2, 1, 130, 128


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 0, 2 for bad input, 1 if the numerics fail.

    What ends it by a signal has the code of the shell, 128 and the number of the signal.
    """
    try:
        with terminable():
            return _main(arguments)
    except Terminated as signal:
        tell("spanwise: terminated")
        return SIGNALLED + signal.number


def _main(arguments: Sequence[str] | None) -> int:
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always", UserWarning)
            warnings.filterwarnings("always", ".* is now .*", DeprecationWarning)
            options = _parser().parse_args(arguments)
            try:
                text = options.work(options)
            finally:
                for said in dict.fromkeys(str(each.message) for each in told):
                    tell(f"spanwise: warning: {said}")
        say(text)
    except KeyboardInterrupt:
        tell("spanwise: interrupted")
        return INTERRUPTED
    except (ValueError, ImportError) as error:
        return _complain(str(error), BAD_INPUT)
    except OSError as error:
        where = "" if error.filename is None else f"{error.filename}: "
        return _complain(f"{where}{error.strerror or error}", BAD_INPUT)
    except (RuntimeError, MemoryError) as error:
        return _complain(str(error) or "out of memory", FAILURE)
    return 0


class _Parser(argparse.ArgumentParser):
    #: All commands by name, of which one may have the option that another does not.
    commands: Mapping[str, _Parser] = MappingProxyType({})

    def error(self, message: str) -> NoReturn:
        tell(self.format_usage().rstrip())
        raise SystemExit(_complain(message, BAD_INPUT))

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Options that there are not are refused here, where those of the command are known."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            hint = self._hint(unknown[0].partition("=")[0])
            self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
        return found, unknown

    def _hint(self, option: str) -> str:
        """What may be meant: an option of another command, or else one that is written alike."""
        others = [
            f"spanwise {name}"
            for name, each in self.commands.items()
            if option.startswith("-") and option in each._option_string_actions
        ]
        if others:
            return f" (an option of {' and '.join(others)})"
        known = [each for each in self._option_string_actions if each.startswith("--")]
        return suggestion(option, known)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Of a command that there is not the nearest is named."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            near = suggestion(value, action.choices or ())
            raise argparse.ArgumentError(action, f"{error.message}{near}") from None

    def _print_message(self, message: str, file: object = None) -> None:
        say(message)


def _parser() -> _Parser:
    parser = _Parser(
        prog="spanwise",
        description="What vehicles do to bridges: dynamic response of beam bridges.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"spanwise {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    cross = commands.add_parser(
        "cross",
        allow_abbrev=False,
        help="drive a vehicle, or several, over a bridge once",
        description="Drive a vehicle, or several, over a bridge once and print the largest "
        "responses and the impact factors. Everything is computed before any file is written.",
    )
    add_case(cross, "crossing")
    add_key(
        cross,
        "--speed",
        "crossing.speed",
        "speed at the start in m/s; of all vehicles without their own",
        metavar="V",
    )
    add_key(cross, "--modes", "crossing.modes", "number of modes", metavar="N")
    add_road(cross)
    cross.add_argument(
        "--seed", type=int, metavar="N", help="seed of the random road, in all its random parts"
    )
    add_json(cross, "the results")
    cross.add_argument(
        "--csv", type=Path, metavar="DIR", help="write impact factors, extremes and histories there"
    )
    add_plot(cross)
    cross.add_argument(
        "--check",
        action="store_true",
        help="cross again with half the step, more modes and more stations, and print how far "
        "extremes are off",
    )
    cross.set_defaults(work=_cross)
    _ensemblecommand.add_to(commands)
    vehicles = commands.add_parser(
        "vehicles",
        allow_abbrev=False,
        help="list the vehicles that a case can name",
        description="List the vehicles that a case can name as preset, or show one of them with "
        "its axle loads, its frequencies and all its values as TOML.",
    )
    vehicles.add_argument("preset", nargs="?", metavar="PRESET", help="the one to show")
    vehicles.set_defaults(work=_vehicles)
    _roadcommand.add_to(commands)
    for command in commands.choices.values():
        command.commands = commands.choices
    return parser


def _vehicles(options: argparse.Namespace) -> str:
    return (listing() if options.preset is None else detail(options.preset)) + "\n"


def _cross(options: argparse.Namespace) -> str:
    """Computes the crossing, writes the files asked for, and gives the text to print."""
    case = Case.read(options.case, options.settings)
    if options.check and options.json == "-":
        raise ValueError("--check: prints text, and --json - gives none; give one of the two")
    run = case.run(**_reseeded(options, case))
    files: Iterable[tuple[Path, Content]] = []
    folders = []
    text = run.summary() + "\n"
    if options.check:
        text += f"\n{run.check().summary()}\n"
    if options.json == "-":
        text = json_text(run)
    elif options.json is not None:
        files = [(Path(options.json), [json_text(run).encode()])]
    if options.csv is not None:
        folders.append(options.csv)
        tables = ((options.csv / name, content) for name, content in csv_files(run))
        files = chain(files, tables)
    if options.plot is not None:
        folders.append(options.plot)
        # Drawn when their folder is there.
        figures = (
            (options.plot / name, [content]) for name, content in figure_files(figures_of_run(run))
        )
        files = chain(files, figures)
    write_files(files, folders, case.files)
    return text


def _reseeded(options: argparse.Namespace, case: Case) -> dict[str, Road]:
    """The road of the case with the seed of the command in all its random parts."""
    if options.seed is None:
        return {}
    if case.road is None or not is_random(case.road):
        raise ValueError(
            f"--seed {options.seed}: {options.case} has no random [road]; add one, or --road"
        )
    return {"road": reseeded(case.road, count("--seed", options.seed))}


def _complain(message: str, code: int) -> int:
    tell(f"spanwise: error: {message}")
    return code
