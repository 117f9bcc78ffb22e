"""What one place makes of objects, and what of it has no pixel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation_of import organisation_of
from ..reference.triangle_setup import outline
from ..scenes.scene_files.object_list import ObjectDisplayList
from ..specification.configuration import MachineConfiguration
from ..specification.sampling_grid import Grid


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


def dropped_of_objects(configuration: MachineConfiguration,
                       listed: ObjectDisplayList) -> NDArray[np.int64]:
    """int64 (objects,): triangles of each object that set-up drops, wherever it is made."""
    shifts = organisation_of(configuration).resolution.shifts
    seen = outline(listed, Grid.of(listed, **shifts)).boxes.primitive
    return np.asarray(listed.counts - np.bincount(listed.object_of[seen],
                                                  minlength=len(listed.counts)))
