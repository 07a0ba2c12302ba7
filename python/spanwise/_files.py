"""Writes files, of which none is in place before all are complete."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path


def write_files(
    files: Iterable[tuple[Path, Iterable[bytes]]], folders: Iterable[Path] = ()
) -> None:
    """Make the folders that do not exist, and write the files, in pieces as they come.

    Each file is written beside its place under another name and moved there when all are written.
    When something goes wrong before that, no file and no new folder is left.

    Raises
    ------
    OSError
        If a folder or file cannot be made, naming it.
    """
    made: list[Path] = []
    staged: dict[Path, Path] = {}
    try:
        for folder in folders:
            _make(folder, made)
        for file, content in files:
            target = _checked(file)
            if target in staged.values():
                raise FileExistsError(errno.EEXIST, "two outputs have this name", str(file))
            temporary = target.with_name(f".{secrets.token_hex(8)}.tmp")
            staged[temporary] = target
            _write(temporary, content, file)
        for temporary, target in staged.items():
            temporary.replace(target)
    except BaseException:
        for temporary in staged:
            temporary.unlink(missing_ok=True)
        for folder in reversed(made):
            with suppress(OSError):
                folder.rmdir()
        raise


def _make(folder: Path, made: list[Path]) -> None:
    """Makes a folder and those above it, and adds the new ones to the list."""
    if not folder.exists():
        _make(folder.parent, made)
        folder.mkdir()
        made.append(folder)
    elif not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "is a file, not a folder", str(folder))


def _checked(file: Path) -> Path:
    """Where a file goes, links followed, if a file can be put there."""
    target = Path(os.path.realpath(file))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "is a folder, not a file", str(file))
    if target.exists() and not target.is_file():
        raise OSError(errno.EINVAL, "is a device or pipe, not a file", str(file))
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder", str(file.parent))
    return target


def _write(temporary: Path, content: Iterable[bytes], file: Path) -> None:
    try:
        with temporary.open("xb") as stream:
            for piece in content:
                stream.write(piece)
    except OSError as error:
        # In the user's words: the temporary name says nothing.
        raise OSError(error.errno, error.strerror, str(file)) from error
