"""Measurements that take long, kept by the hash of everything they were made from."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any

from .cache import content_hash, lookup, sources_hash, store

_NAME = "measurement.json"


def recall(parts: Iterable[str]) -> dict[str, Any] | None:
    """What was measured of ``parts`` before; None if it never was, or is lost."""
    folder = lookup(content_hash(parts))
    if folder is None:
        return None
    try:
        return dict(json.loads((folder / _NAME).read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return None


def keep(parts: Iterable[str], measured: dict[str, Any]) -> None:
    """Keep ``measured``, plain data, for ``recall``; an interrupted call leaves nothing.

    Where the cache cannot be written it is not kept.
    """
    with suppress(OSError):
        keep_or_raise(parts, measured)


def keep_or_raise(parts: Iterable[str], measured: dict[str, Any]) -> None:
    """The same; raises ``OSError`` where the cache cannot be written, or is full."""

    def write(folder: Path) -> None:
        (folder / _NAME).write_text(json.dumps(measured), encoding="utf-8")

    store(content_hash(parts), write)


def measured_once(parts: Iterable[str], measure: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """The measurement of ``parts``, made now unless it was made before."""
    parts = tuple(parts)
    found = recall(parts)
    if found is None:
        found = measure()
        keep(parts, found)
    return found


def package_hash() -> str:
    """A name for this release of everything that measures and is measured."""
    return content_hash([version("amaranth"), sources_hash("golden", "hdl", "testbenches")])
