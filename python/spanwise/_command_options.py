"""What commands have in common: the case, and options for its keys, ``--set key=value`` for any."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Final

from spanwise._case_tables import OfClass, assignment, value_of
from spanwise._renamed import renamed

#: Examples that the help of a command has.
EXAMPLE: Final = (
    "Any key can be set, in place of those of the file or beside them: %(prog)s CASE.toml "
    "--set speed=25 --set vehicle.preset=half-car --set road.class=C --set 'bridge.EI=[2e10, 1e10]'"
)
ROAD_EXAMPLE: Final = (
    "Any key of a [road] can be set: %(prog)s CASE.toml --set class=C; those of a measured profile "
    'are the arguments of Profile.read: %(prog)s profile.csv --set \'columns=["x", "left"]\' '
    "--set spacing=0.25 --set delimiter=';' --set decimal=, --set 'scale=[1, 0.001]' "
    "--set missing=-9999 --set sort=true --set duplicates=mean --set max_gap=2 --set start=-180"
)


class _Key(argparse.Action):
    """Keeps a value under its key; a `now` names what takes the place of the option."""

    def __init__(self, *names: Any, key: str = "", now: str = "", **more: Any) -> None:
        super().__init__(*names, **more)
        self.default = argparse.SUPPRESS
        self.key, self.now = key, now

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        key, value = (self.key, self.const if self.nargs == 0 else values) if self.key else values
        if self.now:
            renamed(str(option_string), f"--set {self.now}")
        # What comes later counts.
        kept = {own: each for own, each in namespace.settings.items() if own != key}
        namespace.settings = {**kept, key: value}


def _telling(read: Callable[[str], Any]) -> Callable[[str], Any]:
    """Reads a text, or has the command say why it cannot be read."""

    def told(text: str) -> Any:
        try:
            return read(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return told


def add_case(command: argparse.ArgumentParser, table: str) -> None:
    """Add the case, and ``--set``."""
    command.add_argument(
        "case", type=Path, metavar="CASE.toml", help="bridge, vehicles, road, crossing, in SI units"
    )
    add_set(command, table)


def add_json(command: argparse.ArgumentParser, what: str) -> None:
    """Add the option that asks for JSON."""
    help = f"write {what} as JSON; - for standard output, in place of the text"
    command.add_argument("--json", metavar="FILE", help=help)


def add_plot(command: argparse.ArgumentParser) -> None:
    """Add the option that asks for figures."""
    help = "write figures there, as PNG and SVG; needs spanwise[plot]"
    command.add_argument("--plot", type=Path, metavar="DIR", help=help)


def add_set(command: argparse.ArgumentParser, table: str) -> None:
    """Add ``--set``, of which keys without a table are of this one if it has them."""
    command.epilog = ROAD_EXAMPLE if table == "road" else EXAMPLE
    command.set_defaults(settings={})
    command.add_argument(
        "--set",
        action=_Key,
        type=_telling(lambda text: assignment(text, table)),
        dest="settings",
        metavar="KEY=VALUE",
        help=f"set a key of the case; the table, as in {table}.KEY, may be left out where it is "
        "clear; values as in TOML, a word without quotes; can be given many times",
    )


def add_key(
    command: argparse.ArgumentParser,
    option: str,
    key: str,
    help: str = argparse.SUPPRESS,
    **more: Any,
) -> None:
    """Add a short option for one key; without help it is an old one, which warns."""
    now = f"{key.partition('.')[2]}=..." if help == argparse.SUPPRESS else ""
    kind = {} if more.get("nargs") == 0 else {"type": _telling(value_of)}
    arguments = {"dest": "settings", "key": key, "now": now, "help": help, **kind, **more}
    command.add_argument(option, action=_Key, **arguments)


#: The short option for a random road.
add_road: Final = partial(
    add_key,
    option="--road",
    key="road",
    type=OfClass,
    metavar="CLASS",
    help="a random road of this class of ISO 8608, A to H, with the seed of the case, not its road",
)
