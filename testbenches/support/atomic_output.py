"""Output that appears whole or not at all: written beside its place, then renamed into it."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from ...golden.specification.errors import InputError
from .interruption import uninterrupted

#: How the names of temporary folders begin.
TEMPORARY_PREFIX = ".cardcage-"


@contextmanager
def atomic_folder(target: Path, names: Collection[str], option: str = "--out") -> Iterator[Path]:
    """A temporary folder for the files ``names``; when the block ends they are moved to ``target``.

    Folders on the way to ``target`` are made at the end as well.  If ``target`` exists already,
    files of the same names are replaced, others kept.  If the block raises, nothing has changed.
    Raises ``InputError``, before the block and naming ``option``, where ``target`` cannot be
    written.
    """
    with output_errors(target, option):
        if target.exists() and not target.is_dir():
            raise InputError(f"{option}: {target} is a file; name a folder")
        for name in names:
            _check_replaceable(target / name, option)
        place = _nearest_existing(target)
    with _temporary_folder(place, target, option) as temporary:
        yield temporary
        with output_errors(target, option), uninterrupted():
            _move(temporary, target)


@contextmanager
def atomic_file(target: Path, option: str) -> Iterator[Path]:
    """A temporary name for one file, which is moved to ``target`` when the block ends.

    Folders on the way to ``target`` are made then, as by ``atomic_folder``; otherwise as there.
    """
    with output_errors(target, option):
        _check_replaceable(target, option)
        place = _nearest_existing(target.parent)
    with _temporary_folder(place, target, option) as temporary:
        yield temporary / target.name
        with output_errors(target, option), uninterrupted():
            target.parent.mkdir(parents=True, exist_ok=True)
            (temporary / target.name).replace(target)


@contextmanager
def output_errors(target: Path, option: str) -> Iterator[None]:
    """What the file system refuses becomes an ``InputError`` of one line."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(f"{option}: {target} cannot be written ({reason}); choose another "
                         "place") from None


@contextmanager
def _temporary_folder(place: Path, target: Path, option: str) -> Iterator[Path]:
    temporary = place / f"{TEMPORARY_PREFIX}{os.getpid()}-{secrets.token_hex(4)}"
    try:
        with output_errors(target, option):
            # Not tempfile.mkdtemp: that folder would be its owner's alone, once in place as well.
            temporary.mkdir()
        yield temporary
    finally:
        with uninterrupted():
            shutil.rmtree(temporary, ignore_errors=True)


def _check_replaceable(file: Path, option: str) -> None:
    """Renaming would put a file in the place of a folder or a device."""
    if file.exists() and not file.is_file():
        raise InputError(f"{option}: {file} is no ordinary file; choose another place")


def _nearest_existing(target: Path) -> Path:
    """``target`` or the first folder above it that exists: surely on the same file system."""
    place = target.absolute()
    while not place.exists():
        place = place.parent
    if not place.is_dir():
        raise NotADirectoryError(None, f"{place} is a file")
    return place


def _move(temporary: Path, target: Path) -> None:
    if not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        temporary.rename(target)
        return
    for file in sorted(temporary.iterdir()):
        file.replace(target / file.name)
