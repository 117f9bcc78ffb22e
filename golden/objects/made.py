"""What one place makes of objects."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Made:
    """At one place that makes triangles, in one frame.

    ``objects``  that it is sent whole
    ``made``     triangles of these
    ``sent``     triangles that it is sent as vertices, of objects that are clipped
    ``dropped``  triangles of either kind that set-up drops, which have no pixel
    """

    objects: int
    made: int
    sent: int
    dropped: int
