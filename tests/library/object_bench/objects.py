"""Random meshes and objects, and the words that say them."""

from dataclasses import replace

import numpy as np

from cardcage.golden.objects.object_words import frame_words, mesh_words
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.object_list import ObjectList, ObjectMesh
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.backplane.words import ObjectOperation

#: What each command is to those who make triangles of objects.
OPERATIONS = {Opcode.CLEAR_LISTS: ObjectOperation.CLEAR, Opcode.MESH: ObjectOperation.MESH,
              Opcode.MESH_TRIANGLE: ObjectOperation.MESH_TRIANGLE,
              Opcode.OBJECT: ObjectOperation.OBJECT, Opcode.TRIANGLE: ObjectOperation.TRIANGLE}


def object_machine(cards="2x(PMC)", size=(16, 12), **changes):
    """A small one that makes triangles in its nodes."""
    return MachineConfiguration(
        cards, *size, setup="hardware",
        **{"sub_bits": 4, "depth_bits": 10, "fraction_bits": 12, "order_bits": 4,
           "objects": "nodes", "mesh_triangles": 40, "meshes": 6} | changes)


def random_objects(configuration, objects, seed, triangles=(0, 1, 2, 3, 7), *, wide=False,
                   flat=False):
    """An ``ObjectList`` of meshes with so many triangles each; objects lie all over the screen and
    around it.  ``wide``: there is one mesh more, which reaches out of the guard band.
    ``flat``: each triangle has one colour."""
    pick = np.random.default_rng(seed)
    picture = PictureFormat(configuration.width, configuration.height, configuration.sub_bits,
                            configuration.depth_bits)
    unit = 1 << configuration.sub_bits
    size = np.array([configuration.width, configuration.height]) * unit
    corners = 1 if flat else 3
    meshes = tuple(ObjectMesh(
        pick.integers(-4 * unit, 4 * unit, (count, 3, 2)),
        pick.integers(-200, 200, (count, 3)),
        pick.integers(0, 256, (count, corners, 3)).repeat(3 // corners, axis=1).astype(np.uint8))
        for count in triangles)
    offset = np.concatenate([pick.integers(-2 * unit, size + 2 * unit, (objects, 2)),
                             pick.integers(200, picture.depth_limit - 200, (objects, 1))], axis=1)
    if wide:
        corner = meshes[-1].position.copy()
        corner[:, 1] *= 12
        corner[0, 1] = (picture.guard_band + 20) * unit, 3 * unit
        meshes += (replace(meshes[-1], position=corner),)
    return ObjectList(picture, (3, 5, 7), meshes, pick.integers(0, len(meshes), objects), offset,
                      pick.integers(0, 256, (objects, 3)).astype(np.uint8))


def from_far(objects, x, y):
    """The same objects, of meshes that lie so far from their own origins, in sub-pixel units."""
    away = np.array([x, y])
    return replace(objects, offset=objects.offset - [x, y, 0], meshes=tuple(
        replace(mesh, position=mesh.position + away) for mesh in objects.meshes))


def object_word(word):
    """A command, as it is broadcast to those who make triangles of objects: operation below body,
    as in ``object_word_layout``."""
    operation = OPERATIONS[Opcode(commands.opcode_of(word))]
    return int(operation.value) | word >> commands.BODY_OFFSET << 3


def object_commands(configuration, objects):
    """Commands that load the meshes, and those that draw the objects."""
    return (mesh_words(configuration, objects),
            frame_words(configuration, objects.display_list()))
