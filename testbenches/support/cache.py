"""Compiled models and long measurements, kept by the hash of everything they were made from."""

from __future__ import annotations

import errno
import hashlib
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

from ...golden.specification.errors import InputError
from .interruption import uninterrupted

#: Where they are kept; the environment variable CARDCAGE_CACHE names another folder.
ENVIRONMENT_VARIABLE = "CARDCAGE_CACHE"


def cache_folder() -> Path:
    """Where they are kept, as a path from the root.  Raises ``InputError`` where no folder is named
    and the user has none."""
    named = os.environ.get(ENVIRONMENT_VARIABLE)
    try:
        return Path(named or platformdirs.user_cache_dir("cardcage")).absolute()
    except RuntimeError:
        raise InputError("no home folder to keep compiled models in: name a folder in "
                         f"{ENVIRONMENT_VARIABLE}") from None


def content_hash(parts: Iterable[str]) -> str:
    """One name for a list of texts; their borders count."""
    digest = hashlib.sha256()
    for part in parts:
        encoded = part.encode("utf-8", "surrogatepass")  # a file name may be part of it
        digest.update(len(encoded).to_bytes(8, "little") + encoded)
    return digest.hexdigest()[:32]


@cache
def sources_hash(*folders: str) -> str:
    """A name for all source text and data below folders of the package, such as
    ``"testbenches/export"``, wherever in them it lies."""
    package = Path(__file__).parent.parent.parent
    sources = sorted(path for folder in folders
                     for ending in ("*.py", "*.cpp", "*.h", "*.json")
                     for path in (package / folder).rglob(ending))
    assert sources, folders
    return content_hash(path.read_text("utf-8") for path in sources)


def lookup(key: str) -> Path | None:
    """The folder kept for ``key``; None where there is none, or it is not what was kept: cut
    short, changed, or made not executable."""
    folder = cache_folder() / key
    return folder if _sound(folder) else None


def store(key: str, build: Callable[[Path], object]) -> Path:
    """The folder that ``build`` fills for ``key``, in the cache.

    ``build`` gets an empty folder under another name, which is renamed into place when it is
    complete: two processes at once build twice and keep one, and an interrupted build leaves
    nothing.  A damaged folder is replaced.  Raises ``OSError`` where the cache cannot be written.
    """
    target = cache_folder() / key
    _make_cache()
    work = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{key}."))
    try:
        build(work)
        (work / _CHECKSUM).write_text(_checksum(work), encoding="ascii")
        _put(work, target)
    except BaseException as error:
        with uninterrupted():
            if isinstance(error, Exception) and not work.exists():
                # Whatever failed, it failed because somebody emptied the cache meanwhile.
                raise FileNotFoundError(errno.ENOENT, "was removed", str(work)) from None
            shutil.rmtree(work, ignore_errors=True)
        raise
    return target


def cached(key: str, build: Callable[[Path], object]) -> tuple[Path, bool]:
    """The folder that ``build`` fills for ``key``, and whether it had to be built.

    As ``store``, but where the cache cannot be written, or is full, the folder is a temporary one,
    which is removed when the program ends.  Raises ``OSError`` where that cannot be had either.
    """
    found = lookup(key)
    if found is not None:
        return found, False
    try:
        return store(key, build), True
    except OSError:
        temporary = tempfile.TemporaryDirectory(prefix="cardcage-model-",
                                                ignore_cleanup_errors=True)
        _temporary.append(temporary)
        build(Path(temporary.name))
        return Path(temporary.name), True


def clear_cache() -> int:
    """Remove what was kept here and nothing else; how many bytes that frees.

    The folder itself goes too where Cardcage made it and nobody else has put anything there.
    Raises ``OSError`` where something of ours stays.
    """
    size = cache_size()
    for folder in _ours():
        shutil.rmtree(folder)
    tag = cache_folder() / _TAG
    if _content(tag) == _TAG_TEXT and [*cache_folder().iterdir()] == [tag]:
        tag.unlink()
        cache_folder().rmdir()
    return size


def cache_size() -> int:
    """The bytes of what was kept here, and of nothing else."""
    size = 0
    for folder in _ours():
        for path in folder.rglob("*"):
            with suppress(OSError):  # another process may have removed it
                size += path.lstat().st_size if path.is_file() else 0
    return size


#: Folders that are removed when the program ends.
_temporary: list[tempfile.TemporaryDirectory[str]] = []

#: What belongs to the cache in its folder: what is kept, and what an end by force left of a build.
_OURS = re.compile(r"[0-9a-f]{32}|\.[0-9a-f]{32}\..+")

#: In each kept folder: of everything else in it.
_CHECKSUM = "checksum"

#: Says that Cardcage made the folder; backups know the file, too (https://bford.info/cachedir).
_TAG = "CACHEDIR.TAG"
_TAG_TEXT = "Signature: 8a477f597d28d172789f06886806bc55\n# A cache of Cardcage.\n"


def _make_cache() -> None:
    folder = cache_folder()
    if not folder.exists():
        folder.mkdir(parents=True, exist_ok=True)
        (folder / _TAG).write_text(_TAG_TEXT, encoding="ascii")


def _ours() -> list[Path]:
    try:
        return sorted(path for path in cache_folder().iterdir()
                      if _OURS.fullmatch(path.name) and path.is_dir() and not path.is_symlink())
    except OSError:
        return []  # no folder, or none that may be read


def _content(file: Path) -> str | None:
    try:
        return file.read_text(encoding="ascii")
    except (OSError, ValueError):
        return None


def _checksum(folder: Path) -> str:
    """Of every file's name, whether it may be executed, and what is in it."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path != folder / _CHECKSUM:
            name = os.fsencode(path.relative_to(folder))
            executable = bool(path.stat().st_mode & 0o100)
            digest.update(name + bytes([0, executable])
                          + hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def _sound(folder: Path) -> bool:
    try:
        return _content(folder / _CHECKSUM) == _checksum(folder)
    except OSError:
        return False


def _put(work: Path, target: Path) -> None:
    """Rename ``work`` to ``target``, unless another process was first."""
    try:
        work.rename(target)
    except OSError:
        if _sound(target):
            shutil.rmtree(work, ignore_errors=True)
            return
        # What lies there is damaged: move it away at once, remove it at leisure.
        grave = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}."))
        try:
            target.rename(grave / "damaged")
            work.rename(target)
        finally:
            shutil.rmtree(grave, ignore_errors=True)
