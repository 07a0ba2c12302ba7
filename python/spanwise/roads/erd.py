"""The header of an ERD file, the format in which road profilers and profile viewers exchange data.

University of Michigan Transportation Research Institute, Engineering Research Division: the first
line is ``ERDFILEV2.00``; the second has the numbers of channels, samples, records and bytes, the
kind of data and the step; lines that begin with a word of eight letters follow up to ``END``, and
then the data, here as text.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from spanwise.errors import InputError

#: How the first line begins.
MARK: Final = "ERDFILEV"

#: Most lines of a header.
LONGEST: Final = 1000


@dataclass(frozen=True)
class Header:
    """What the header says.

    Attributes
    ----------
    lines : int
        Number of its lines.
    channels : int
        Number of channels.
    samples : int
        Samples of each channel; less than 1 if that is not known.
    step : float
        Distance of the samples; 0 if the first channel says where they are.
    start : float
        Place of the first sample.
    unit : str
        Unit of the step.
    names, units : list of str
        Of the channels; empty if they have none.
    """

    lines: int
    channels: int
    samples: int
    step: float
    start: float
    unit: str
    names: list[str]
    units: list[str]


def header_of(lines: list[str]) -> Header:
    """The header at the beginning of a file.

    Raises
    ------
    ValueError
        If it is not whole, naming the line.
    """
    end = next((k for k, line in enumerate(lines[:LONGEST]) if line.strip() == "END"), None)
    if end is None:
        raise InputError(
            f"line {min(len(lines), LONGEST)}", None, "the header has no line END before"
        )
    given = [each.strip() for each in lines[1].split(",")]
    try:
        channels, samples, step = int(given[0]), int(given[1]), float(given[5])
    except (IndexError, ValueError):
        allowed = "must be the numbers of channels, samples, records and bytes, the kind, the step"
        raise InputError("line 2", None, f"{lines[1].strip()!r}: {allowed}") from None
    if channels < 1 or not step >= 0.0:
        allowed = "must have channels and a step that is not negative"
        raise InputError("line 2", None, f"{lines[1].strip()!r}: {allowed}")
    said: dict[str, str] = {}
    for line in lines[2:end]:
        # Of keywords that come again, such as TITLE, the first.
        said.setdefault(line[:8].strip().upper(), line[8:].rstrip("\r\n"))
    names = _fields(said.get("LONGNAME", ""), 32, channels) or _fields(
        said.get("SHORTNAM", ""), 8, channels
    )
    return Header(
        lines=end + 1,
        channels=channels,
        samples=samples,
        step=step,
        start=_start(said.get("XSTART", "")),
        unit=said.get("XUNITS", "").strip(),
        names=names,
        units=_fields(said.get("UNITSNAM", ""), 8, channels),
    )


def _start(text: str) -> float:
    try:
        return float(text.strip() or 0.0)
    except ValueError:
        raise InputError(f"XSTART {text.strip()!r}", None, "must be a number") from None


def _fields(text: str, width: int, channels: int) -> list[str]:
    """Fields of a width, one for each channel, or none of them."""
    found = [text[k : k + width].strip() for k in range(0, len(text), width)]
    return found[:channels] if len(found) >= channels else []
