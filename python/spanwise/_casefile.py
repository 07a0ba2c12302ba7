"""The text of a case file and the TOML tables in it, or an error that says what is wrong where."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from spanwise._content import content_of
from spanwise.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

#: Largest case file that is read, and largest file of results [bytes].
MAX_BYTES: Final = 2**20
MAX_RESULTS: Final = 2**26

#: Most parts of a dotted key: the reader's time and memory grow with their square.
MAX_PARTS: Final = 16

#: A key of more parts than that, bare or quoted, wherever it stands.
LONG_KEY: Final = (
    r"""(?<![\w.-])(?:PART)(?:[ \t]*+\.[ \t]*+(?:PART)){%d}""".replace(
        "PART", r"""[\w-]++|"[^"\n]*+"|'[^'\n]*+'"""
    )
    % MAX_PARTS
)

#: A decimal point with a digit on one side only, which TOML does not allow.
POINT: Final = r"(?<![\w.])(\d+\.(?!\d)|\.\d)"


class CaseError(InputError):
    """A case file that cannot be used, and why."""


def read_text(path: Path) -> str:
    """The text of a file that may be a case; one that is not is not read."""
    most = MAX_RESULTS if path.suffix.lower() == ".json" else MAX_BYTES
    try:
        content = content_of(path, most, "a case", "a TOML file")
    except InputError as error:
        raise CaseError.of(error) from None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise CaseError(
            f"{path}, line {line}", None, "is not UTF-8 text; a case is a TOML file"
        ) from error


def tables_of(text: str, source: str) -> dict[str, Any]:
    """The tables of a case in TOML, or in the JSON of results, whose settings they are."""
    if not text.lstrip().startswith("{"):
        return {**settings_of(parse_toml(text, source))}
    import json

    try:
        return {**settings_of(json.loads(text))}
    except (ValueError, RecursionError) as error:
        said = "brackets within brackets too deep" if isinstance(error, RecursionError) else error
        raise CaseError(source, None, f"is not valid JSON: {said}") from error


def settings_of(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a case, or those in all that is told of results, the road in its own place."""
    told = tables.get("settings")
    if isinstance(told, Mapping) and "bridge" in told:
        tables = told
    many = tables.get("ensemble")
    if not isinstance(many, Mapping) or "road" not in many or "road" in tables:
        return tables
    rest = {key: value for key, value in many.items() if key != "road"}
    return {**tables, "ensemble": rest, "road": many["road"]}


def parse_toml(text: str, source: str) -> dict[str, Any]:
    """The tables of a TOML text."""
    if len(text) > MAX_BYTES:
        raise CaseError(
            source, None, f"text has {len(text)} characters; a case has at most {MAX_BYTES}"
        )
    if long := re.search(LONG_KEY, text):
        line = text.count("\n", 0, long.start()) + 1
        raise CaseError(
            f"{source}, line {line}", None, f"a dotted key has at most {MAX_PARTS} parts"
        )
    import tomllib

    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(str(error), text, source) from error
    except RecursionError as error:
        raise CaseError(
            source, None, "is not valid TOML: brackets within brackets too deep"
        ) from error
    except ValueError as error:  # a number of thousands of digits, a date that does not exist
        raise CaseError(source, None, f"is not valid TOML: {error}") from error


def _syntax_error(message: str, text: str, source: str) -> CaseError:
    """What tomllib says, with the file and the line first and the text of the line last."""
    where = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)", message)
    if where is None:
        return CaseError(source, None, f"is not valid TOML: {message}")
    line = int(where[1] or text.rstrip().count("\n") + 1)
    characters = text.split("\n")[line - 1].strip()[:80]
    shown = "".join(each if each.isprintable() else "?" for each in characters)
    hint = " (TOML wants digits on both sides of a point: 22.0)" if re.search(POINT, shown) else ""
    said = message.replace(where[0], "")
    return CaseError(f"{source}, line {line}", None, f"is not valid TOML: {said}: {shown}{hint}")
