"""Writes to standard output and standard error, whose readers may have gone."""

from __future__ import annotations

import os
import sys
from typing import TextIO


def say(text: str) -> None:
    """Print to standard output; who has stopped reading has seen enough.

    Raises
    ------
    OSError
        If it cannot be written for another reason.
    """
    try:
        print(text, end="", flush=True)
    except OSError as error:
        _silence(sys.stdout)
        if not isinstance(error, BrokenPipeError):
            raise OSError(error.errno, error.strerror, "standard output") from error


def tell(text: str) -> None:
    """Print a line to standard error, if there is one: the exit code says what matters."""
    if sys.stderr is None:
        return
    try:
        print(text, file=sys.stderr, flush=True)
    except OSError:
        _silence(sys.stderr)


def _silence(stream: TextIO) -> None:
    """What is left to be written is not to be tried again when Python ends."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)
