"""How a text file writes its numbers: encoding, delimiter and decimal mark, from what it holds."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final

from spanwise._checks import shown

#: How an ERD file begins.
MARK: Final = "ERDFILEV"

#: Delimiters that are looked for; where two serve alike the first is meant. Blanks come in runs.
DELIMITERS: Final = ("\t", ";", "|", " ", ",")

#: How much of a file is looked at to tell what it is [bytes].
_BEGINNING: Final = 2**16

#: With which DOS ends a text.
_DOS_END: Final = "\x1a"
_CONTROL: Final = r"[\x00-\x08\x0e-\x1f]"

#: Whole numbers in groups of three, and what separates them beside the other of point and comma.
_GROUPED: Final = r"[1-9]\d{{0,2}}(?:[{group}'\u2019 \u00a0\u202f]\d{{3}})+"
_PATTERNS: Final = {
    decimal: rf"([+-]?)(?:(\d+)\+(?=\d{{2,3}}(?!\d)))?"
    rf"((?:\d+|{_GROUPED.format(group=group)})?(?:[{decimal}]{digits})?)([eE][+-]?\d+)?"
    for decimal, group, digits in ((".", ",", r"\d*"), (",", ".", r"\d+"))
}


def encoding_of(content: bytes) -> str:
    """The encoding of a text: UTF-8, UTF-16 or else Windows' Western European.

    Raises
    ------
    UnicodeError
        If it is none of them.
    """
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encoding = "utf-16"
    elif b"\0" in content[:2]:  # the first character takes two bytes
        encoding = "utf-16-le" if content[1:2] == b"\0" else "utf-16-be"
    else:
        encoding = "utf-8-sig"
        try:
            content.decode(encoding)
        except UnicodeDecodeError:
            encoding = "cp1252"
    text = content.decode(encoding)
    control = re.search(_CONTROL, text.rstrip(_DOS_END))
    if control is not None:
        raise UnicodeError(f"it has the character {control[0]!r}")
    return encoding


def rows_of(lines: Iterable[str], delimiter: str) -> Iterator[tuple[int, list[str]]]:
    """Number and cells of each line that holds anything but a comment."""
    if delimiter == " ":
        rows = ((number, line.split()) for number, line in enumerate(lines, 1))
    else:
        reader = csv.reader(lines, delimiter=delimiter)
        rows = ((reader.line_num, [*map(str.strip, row)]) for row in reader)
    return (row for row in rows if any(row[1]) and not row[1][0].startswith(("#", _DOS_END)))


def value_of(text: str, decimal: str) -> float | None:
    """The number that a text is: 1,234.5 or 1 234.5 by groups, 1+234.5 as a station; or None."""
    if decimal == ".":
        try:
            # An underscore, which Python allows, is none of a number in a file.
            return None if "_" in text else float(text)
        except ValueError:
            pass
    found = re.fullmatch(_PATTERNS[decimal], text.replace("\u2212", "-"))
    if found is None or not any(map(str.isdigit, found[3])):
        return float(text) if text.lower() in ("nan", "inf", "-inf") else None
    sign, stations, digits, exponent = found.groups("")
    whole, _, fraction = digits.partition(decimal)
    # A station counts in thousands or hundreds, as many digits follow: 1+234.5 or 12+34.5.
    whole = stations + re.sub(r"\D", "", whole)
    return float(f"{sign}{whole or '0'}.{fraction or '0'}{exponent}")


def delimiter_of(lines: Sequence[str], least: int, decimal: str | None) -> str:
    """What separates the cells: what gives most lines that many numbers, and nothing else.

    The decimal mark may be known.

    Raises
    ------
    ValueError
        If commas may be decimal marks in single numbers or separate whole ones.
    """

    def served(delimiter: str) -> tuple[int, int]:
        whole = enough = 0
        for _, cells in rows_of(lines, delimiter):
            numbers = sum(is_number(cell, decimal) for cell in cells)
            enough += numbers >= least
            whole += numbers >= least and numbers == sum(cell != "" for cell in cells)
        return whole, 0 if whole else enough

    best = max(DELIMITERS, key=served)
    pairs = [line.strip() for line in lines if re.fullmatch(r"\s*-?\d+,-?\d+\s*", line)]
    if decimal is None and best != "," and len(pairs) == served(best)[0] > 0:
        if any(",-" in pair for pair in pairs):
            return ","
        # No whole number begins with 0: 3,05 is one number.
        if not any(re.search(r",0\d", pair) for pair in pairs):
            allowed = "give decimal = ',' or delimiter = ','"
            raise ValueError(f"{shown(pairs[0])} may be one number or two; {allowed}")
    return best if any(served(best)) else ","


def decimal_of(rows: Iterable[list[str]], least: int) -> str:
    """The decimal mark of numbers, in rows of at least so many.

    Raises
    ------
    ValueError
        If all that have a comma may be thousands or thousandths.
    """
    doubtful = None
    for cells in rows:
        found = [cell for cell in cells if is_number(cell)]
        for cell in found if len(found) >= least else []:
            marks = [each for each in cell if each in ".,"]
            if not marks:
                continue
            other = "," if marks[0] == "." else "."
            if len(marks) > 1:  # groups, and the last may be another
                return other
            if not re.fullmatch(r"[+-]?[1-9]\d{0,2}[.,]\d{3}", cell):
                return marks[0]
            doubtful = cell if marks[0] == "," else doubtful
    if doubtful is not None:
        allowed = "give decimal = ',' or decimal = '.'"
        raise ValueError(f"{shown(doubtful)} may be thousands or have decimals; {allowed}")
    return "."


def looks_like_profile(path: Path) -> bool:
    """Whether a file is no case, by its name or what it holds: an ERD file, or lines of numbers."""
    if path.suffix.lower() == ".toml" or not path.is_file():
        return False
    with path.open("rb") as file:
        content = file.read(_BEGINNING)
    try:
        text = content.decode(encoding_of(content), "replace")
    except UnicodeError:
        return False
    lines = [line for line in text.splitlines() if line.strip() and line.lstrip()[0] != "#"]
    numbers = sum(is_number(re.split(r"[\s;|,]", line.strip())[0]) for line in lines)
    return text.startswith(MARK) or 2 * numbers > len(lines)


def is_number(text: str, decimal: str | None = None) -> bool:
    """Whether it is one, with either decimal mark or that which is known."""
    return any(value_of(text, each) is not None for each in decimal or ".,")
