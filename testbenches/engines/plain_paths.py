"""Paths that make can take: it breaks them at blanks, and gives other characters a meaning."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_PLAIN = re.compile(r"[\w@+,./~-]+", re.ASCII)

#: Where temporary things may lie: one of these has a plain name on every system.
_PLACES = (tempfile.gettempdir, lambda: "/tmp", lambda: "/var/tmp")


def is_plain(path: Path | str) -> bool:
    """Whether make can take a path: letters of ASCII, digits, and signs that mean nothing."""
    return _PLAIN.fullmatch(str(path)) is not None


def _temporary_folder() -> tempfile.TemporaryDirectory[str]:
    place = next((folder() for folder in _PLACES if is_plain(Path(folder()).resolve())), None)
    return tempfile.TemporaryDirectory(prefix="cardcage-", dir=place)


@contextmanager
def plain_paths(*paths: Path) -> Iterator[list[Path]]:
    """Other names for ``paths`` that make can take, valid within: links where need be.

    Raises ``OSError`` where no folder for temporary files can be used.
    """
    if all(map(is_plain, paths)):
        yield list(paths)
        return
    with _temporary_folder() as folder:
        links = [Path(folder, str(number)) for number in range(len(paths))]
        for link, path in zip(links, paths, strict=True):
            link.symlink_to(path)
        yield links


@contextmanager
def plain_folder(folder: Path) -> Iterator[Path]:
    """A folder to work in whose files are in ``folder`` at the end: that itself where make can work
    there, else a temporary one, for a link does not help: make looks where it really is.

    Raises ``OSError`` as ``plain_paths``, and where ``folder`` cannot be written.
    """
    if is_plain(folder.resolve()):
        yield folder
        return
    with _temporary_folder() as temporary:
        yield Path(temporary)
        shutil.copytree(temporary, folder, dirs_exist_ok=True)
