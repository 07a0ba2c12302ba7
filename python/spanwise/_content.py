"""Reads files of some size whole."""

from __future__ import annotations

import stat
from typing import TYPE_CHECKING

from spanwise.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path


def content_of(path: Path, most: int, one: str, is_: str) -> bytes:
    """All of a file of at most so many bytes; one that is meant to be something else is not read.

    Raises
    ------
    InputError
        If it is a folder, a device or too large, saying what `one` of this kind is.
    """
    status = path.stat()
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "not a regular file"
        raise InputError(path, None, f"is {kind}; {one} is {is_}")
    with path.open("rb") as file:
        # It may grow meanwhile, or not tell its size.
        content = file.read(most + 1) if status.st_size <= most else None
    if content is None or len(content) > most:
        raise InputError(path, None, f"is too large; {one} has at most {most} bytes")
    return content
