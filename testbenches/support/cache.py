"""Compiled models and long measurements, kept by the hash of everything they were made from."""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

import platformdirs

#: Where they are kept; the environment variable CARDCAGE_CACHE names another folder.
ENVIRONMENT_VARIABLE = "CARDCAGE_CACHE"


def cache_folder() -> Path:
    named = os.environ.get(ENVIRONMENT_VARIABLE)
    return Path(named) if named else Path(platformdirs.user_cache_dir("cardcage"))


def content_hash(parts: Iterable[str]) -> str:
    """One name for a list of texts; their borders count."""
    digest = hashlib.sha256()
    for part in parts:
        encoded = part.encode()
        digest.update(len(encoded).to_bytes(8, "little") + encoded)
    return digest.hexdigest()[:32]


@cache
def sources_hash(*folders: str) -> str:
    """A name for all source text below folders of the package, such as ``"testbenches/export"``,
    wherever in them it lies."""
    package = Path(__file__).parent.parent.parent
    sources = sorted(path for folder in folders
                     for ending in ("*.py", "*.cpp") for path in (package / folder).rglob(ending))
    assert sources, folders
    return content_hash(path.read_text("utf-8") for path in sources)


def cached(key: str, build: Callable[[Path], object]) -> tuple[Path, bool]:
    """The folder that ``build`` fills for ``key``, and whether it had to be built.

    ``build`` gets an empty folder under another name, which is renamed into place when it is
    complete: two processes at once build twice and keep one, and an interrupted build leaves
    nothing.  Where the cache cannot be written the folder is a temporary one.
    """
    target = cache_folder() / key
    if target.is_dir():
        return target, False
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        work = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{key}."))
    except OSError:
        work = target = Path(tempfile.mkdtemp(prefix="cardcage-model-"))
    try:
        build(work)
    except BaseException:
        shutil.rmtree(work, ignore_errors=True)
        raise
    if work != target:
        try:
            work.rename(target)
        except OSError:
            if not target.is_dir():
                raise
            shutil.rmtree(work, ignore_errors=True)  # another process was first
    return target, True


def clear_cache() -> int:
    """Remove all of it; how many bytes that frees."""
    size = cache_size()
    shutil.rmtree(cache_folder(), ignore_errors=True)
    return size


def cache_size() -> int:
    return sum(path.stat().st_size for path in cache_folder().rglob("*") if path.is_file())
