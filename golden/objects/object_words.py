"""Meshes and objects as words of the command stream."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..organisations.object_shares import ONLY_OBJECTS, ObjectShares
from ..organisations.organisation_of import organisation_of
from ..organisations.shares import Shares
from ..reference import triangle_words
from ..scenes.scene_files.object_list import ObjectDisplayList, ObjectList
from ..specification.commands import (
    BODY_OFFSET,
    CHANNELS,
    Opcode,
    mesh_layout,
    mesh_triangle_layout,
    object_layout,
    pack,
)
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError

Int64 = NDArray[np.int64]
Words = NDArray[np.object_]


def made_of_objects(display_list: DisplayList) -> ObjectDisplayList:
    """The list itself; ``InputError`` where nothing is known of objects."""
    if not isinstance(display_list, ObjectDisplayList):
        raise InputError(ONLY_OBJECTS)
    return display_list


def source_shares(configuration: MachineConfiguration, display_list: DisplayList) -> Shares:
    """How the host deals objects out to processing elements that pass them on: as to nodes."""
    return ObjectShares.of(display_list, configuration.processing_elements,
                           configuration.packet).objects


def mesh_words(configuration: MachineConfiguration, objects: ObjectList) -> list[int]:
    """``MESH`` and ``MESH_TRIANGLE`` of all meshes, in the order of their numbers.

    ``InputError`` where the mesh memory is too small.
    """
    objects = objects.in_sub_bits(configuration.sub_bits)
    needs = {"meshes": len(objects.meshes),
             "mesh_triangles": sum(mesh.triangles for mesh in objects.meshes)}
    for field, needed in needs.items():
        if needed > (built := getattr(configuration, field)):
            raise InputError(f"objects: {field} {needed}, the machine is built for {built}: "
                             "export a machine for this scene")
    words: list[int] = []
    for mesh in objects.meshes:
        box = dict(zip(("left", "top", "right", "bottom"), mesh.box, strict=True))
        words.append(int(Opcode.MESH) | pack(mesh_layout(configuration), box) << BODY_OFFSET)
        values = {f"vertex_{corner}": _vertex(mesh.position[:, corner], mesh.depth[:, corner],
                                              mesh.shade[:, corner]) for corner in range(3)}
        words += list((pack(mesh_triangle_layout(configuration), values) << BODY_OFFSET)
                      + int(Opcode.MESH_TRIANGLE))
    return words


def frame_words(configuration: MachineConfiguration, display_list: DisplayList) -> list[int]:
    """``OBJECT`` of every object, in the order in which the host sends them; of one that is
    clipped its triangles, as ``TRIANGLE``, in its place.

    ``display_list`` is in the formats of the machine, made of objects.
    """
    listed = made_of_objects(display_list)
    objects = listed.objects.in_sub_bits(configuration.sub_bits)
    count, clipped = len(objects.mesh), objects.clipped
    share, place = _shares(configuration, listed)
    whole = np.flatnonzero(~clipped)
    values = {"mesh": objects.mesh.astype(object),
              **_vertex(objects.offset[:, :2], objects.offset[:, 2], objects.color),
              **{name: numbers.astype(object) for name, numbers in share.items()}}
    sent: Words = np.zeros(count, object)
    sent[:] = (pack(object_layout(configuration), values) << BODY_OFFSET) + int(Opcode.OBJECT)
    pieces = np.flatnonzero(clipped[listed.object_of])
    of_pieces = {name: numbers[listed.object_of[pieces]] for name, numbers in share.items()}
    triangles = triangle_words.triangles(configuration, listed.chosen(pieces), of_pieces)
    order = np.argsort(np.concatenate([place[whole], place[listed.object_of[pieces]]]),
                       kind="stable")
    return list(np.concatenate([sent[whole], triangles])[order])


def commands_before(configuration: MachineConfiguration, display_list: DisplayList,
                    triangle: int) -> int:
    """How many of ``frame_words`` come before the one that has a triangle made, or sends it."""
    listed = made_of_objects(display_list)
    clipped, number = listed.objects.clipped, listed.object_of[triangle]
    _, place = _shares(configuration, listed)
    before = place < place[number]
    earlier = triangle - int(listed.counts[:number].sum()) if clipped[number] else 0
    return int(np.where(clipped, listed.counts, 1)[before].sum()) + earlier


def _vertex(position: Int64, depth: Int64, color: NDArray[np.uint8]) -> dict[str, Any]:
    """The fields of a vertex, or of an object, of many of them."""
    return {"x": position[:, 0].astype(object), "y": position[:, 1].astype(object),
            "depth": depth.astype(object),
            **{name: color[:, channel].astype(object)
               for channel, name in enumerate(CHANNELS)}}


def _shares(configuration: MachineConfiguration, listed: ObjectDisplayList
            ) -> tuple[dict[str, Int64], Int64]:
    """Of each object what its command says of node and order, and how many the host sends before
    it."""
    count = len(listed.counts)
    if configuration.keeps_list_order:
        if count > 1 << configuration.order_bits:
            raise InputError(f"objects: the pixels of the machine tell "
                             f"{1 << configuration.order_bits:,} apart, the scene has {count:,}: "
                             "export a machine for this scene")
        dealt = source_shares(configuration, listed)
        return {"round": np.arange(count), "element": dealt.node}, dealt.host_place
    shares = organisation_of(configuration).shares(listed)
    if not isinstance(shares, ObjectShares):
        return {}, np.arange(count)
    dealt = shares.objects
    share = {"node": dealt.node} | ({"round": dealt.round} if configuration.round_bits else {})
    return share, dealt.host_place
