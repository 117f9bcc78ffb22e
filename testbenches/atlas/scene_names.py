"""Short names of scenes, for charts in which a path has no room."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from pathlib import Path


def short_names(names: Sequence[str], most: int) -> dict[str, str]:
    """Name → another of ``most`` characters at most, so that no two are alike.

    A file's has no folder, unless another scene's file has that name; what is still too long loses
    its middle, since what tells scenes apart is at an end.  Where they are alike then, all of them
    keep more than ``most`` characters.

    >>> short_names(["scenes/teapot.obj", "tetra:depth=1", "a_long_name_1.scene"], 12)
    {'scenes/teapot.obj': 'teapot.obj', 'tetra:depth=1': 'tetra:…pth=1', \
'a_long_name_1.scene': 'a_long…scene'}
    >>> short_names(["old/a.scene", "new/a.scene"], 20)
    {'old/a.scene': 'old/a.scene', 'new/a.scene': 'new/a.scene'}
    """
    names = list(dict.fromkeys(names))
    files = [Path(name).name for name in names]
    whole = {name: file if files.count(file) == 1 else name
             for name, file in zip(names, files, strict=True)}
    for length in count(most):
        found = {name: _shortened(shown, length) for name, shown in whole.items()}
        if len(set(found.values())) == len(names):
            break
    return found


def _shortened(name: str, most: int) -> str:
    if len(name) <= most:
        return name
    end = (most - 1) // 2
    return f"{name[:most - 1 - end]}…{name[len(name) - end:]}"
