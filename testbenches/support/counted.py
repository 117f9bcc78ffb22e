"""Numbers of things, in words."""

from __future__ import annotations


def counted(number: int, one: str, many: str | None = None) -> str:
    """How many of what: ``many`` is ``one`` with an s unless it is said.

    >>> counted(1, "point"), counted(1200, "point"), counted(2, "mesh", "meshes")
    ('1 point', '1,200 points', '2 meshes')
    """
    return f"{number:,} {one if number == 1 else many or f'{one}s'}"
