"""Writes files, of which none is in place before all are complete."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, TypeAlias

#: What a file holds: its pieces as they come, or what writes it.
Content: TypeAlias = Iterable[bytes] | Callable[[BinaryIO], object]


def write_files(
    files: Iterable[tuple[Path, Content]],
    folders: Iterable[Path] = (),
    inputs: Iterable[Path] = (),
) -> None:
    """Make the folders that do not exist, and write the files, none of which is an input.

    Each file is written beside its place under another name, reaches the disk, and is moved there
    when all are written: whatever ends the process, a file is the old one or the new one. When
    something goes wrong before that, no file and no new folder is left.

    Raises
    ------
    OSError
        If a folder or file cannot be made, naming it.
    """
    read = [*inputs]
    made: list[Path] = []
    staged: dict[Path, Path] = {}
    try:
        for folder in folders:
            _make(folder, made)
        for file, content in files:
            target = _checked(file, read, staged.values())
            temporary = target.with_name(f".{secrets.token_hex(8)}.tmp")
            staged[temporary] = target
            _write(temporary, content, file)
        for temporary, target in staged.items():
            temporary.replace(target)
        for folder in {target.parent for target in staged.values()}:
            _settle(folder)
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


def check_targets(files: Iterable[Path], inputs: Iterable[Path]) -> None:
    """Refuses what could not be written in the end, before the work for it is done.

    Raises
    ------
    OSError
        If a file cannot be put somewhere, naming it.
    """
    read, before = [*inputs], list[Path]()
    for file in files:
        before.append(_checked(file, read, before))


def _checked(file: Path, inputs: Iterable[Path], others: Iterable[Path]) -> Path:
    """Where a file goes, links followed, if a file can be put there that is none of the others."""
    target = Path(os.path.realpath(file))
    if target in others:
        raise FileExistsError(errno.EEXIST, "two outputs have this name", str(file))
    if any(_same(target, each) for each in inputs):
        raise FileExistsError(errno.EEXIST, "was read, and is not overwritten", str(file))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "is a folder, not a file", str(file))
    if target.exists() and not target.is_file():
        raise OSError(errno.EINVAL, "is a device or pipe, not a file", str(file))
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder", str(file.parent))
    return target


def _same(target: Path, other: Path) -> bool:
    """Whether both are one file, by whatever names."""
    return target.exists() and other.exists() and target.samefile(other)


def _write(temporary: Path, content: Content, file: Path) -> None:
    try:
        with temporary.open("xb") as stream:
            if callable(content):
                content(stream)
            else:
                for piece in content:
                    stream.write(piece)
            stream.flush()
            os.fsync(stream.fileno())
    except OSError as error:
        # In the user's words: the temporary name says nothing.
        raise OSError(error.errno, error.strerror, str(file)) from error


def _settle(folder: Path) -> None:
    """Brings the names in a folder to the disk, where the system can do that."""
    with suppress(OSError):
        opened = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(opened)
        finally:
            os.close(opened)
