"""What a machine makes of objects: where, how much of it has pixels, and what the host says for
it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..organisations.object_shares import ObjectShares
from ..organisations.organisation_of import organisation_of
from ..specification.commands import command_words
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .forwarding import made_at_elements
from .made import Made, dropped_of_objects
from .object_words import made_of_objects

Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class LinkWords:
    """32-bit words on the host link.

    ``meshes``  to load the meshes, once
    ``frame``   of a frame: its start and end, objects, and triangles of clipped ones
    """

    meshes: int
    frame: int

    @property
    def total(self) -> int:
        """Of the first frame."""
        return self.meshes + self.frame


def golden_made(configuration: MachineConfiguration, display_list: DisplayList) -> list[Made]:
    """Of each place that makes triangles, from left to right."""
    if configuration.objects == "nodes":
        return made_at_nodes(configuration, display_list)
    if configuration.forwards_objects:
        return made_at_elements(configuration, display_list)
    return [made_at_controller(configuration, display_list)]


def made_at_nodes(configuration: MachineConfiguration, display_list: DisplayList) -> list[Made]:
    """Of each node, where they make the triangles of their objects."""
    shares = organisation_of(configuration).shares(display_list)
    assert isinstance(shares, ObjectShares)
    return _made(configuration, display_list, shares.objects.node, configuration.nodes)


def made_at_controller(configuration: MachineConfiguration, display_list: DisplayList) -> Made:
    """Where the controller makes all."""
    listed = made_of_objects(display_list)
    return _made(configuration, display_list, np.zeros(len(listed.counts), np.int64), 1)[0]


def _made(configuration: MachineConfiguration, display_list: DisplayList, place: Int64,
          places: int) -> list[Made]:
    """``place``: int64 (objects,), the one that makes each."""
    listed = made_of_objects(display_list)
    clipped = listed.objects.clipped
    triangles = np.bincount(place, listed.counts, places).astype(np.int64)
    sent = np.bincount(place[clipped], listed.counts[clipped], places).astype(np.int64)
    dropped = np.bincount(place, dropped_of_objects(configuration, listed), places)
    whole = np.bincount(place[~clipped], minlength=places)
    return [Made(int(whole[each]), int(triangles[each] - sent[each]), int(sent[each]),
                 int(dropped[each])) for each in range(places)]


def link_words(configuration: MachineConfiguration, display_list: DisplayList) -> LinkWords:
    """What the host sends to load the meshes, after an order to forget all others, and to draw
    ``display_list``."""
    listed = made_of_objects(display_list)
    each, clipped = command_words(configuration), listed.objects.clipped
    meshes = listed.objects.meshes
    loads = 1 + len(meshes) + sum(mesh.triangles for mesh in meshes)
    draws = 2 + int((~clipped).sum()) + int(listed.counts[clipped].sum())
    return LinkWords(each * loads, each * draws)


def triangle_link_words(configuration: MachineConfiguration, display_list: DisplayList) -> int:
    """32-bit words on the host link for the same frame, were every triangle sent as vertices."""
    return command_words(configuration) * (2 + display_list.triangles)
