"""Objects of which many tie, all over the screen, and of every kind."""

from dataclasses import replace

import numpy as np
from object_bench.objects import object_machine, random_objects

from cardcage.golden.scenes.scene_files.object_list import ObjectMesh

MESHES = (0, 1, 2, 5)

#: Cards, size, regions, and the rest; 1 to 16 elements, strips and grids.  Of some an element has
#: no region.
MODELS = {
    "one": ("PMM", (13, 7), (1, 1), {"memory_ports": 2}),
    "two strips": ("2x(PM)", (16, 12), (1, 12), {"packet": 3}),
    "three strips, one port": ("3x(PMM)", (16, 12), (1, 6), {"packet": "work"}),
    "four of a grid": ("4x(PM)", (33, 17), (5, 3), {"memory_ports": 2, "shading": "gouraud",
                                                    "setup_interval": 12}),
    "eight, of which one has nothing": ("8x(PM)", (16, 12), (1, 6), {
        "memory_ports": 2, "packet": "contiguous"}),
    "sixteen of a grid": ("16x(PM)", (33, 17), (5, 5), {"memory_ports": 2}),
}


def machine(name, **changes):
    cards, size, regions, options = MODELS[name]
    return object_machine(cards, size, **{
        "objects": "elements", "regions": regions, "balance": "static", "order_bits": 6,
        "fraction_bits": 30, "clocks_per_pixel": 2, "shading": "flat", "setup_interval": 64,
    } | options | changes)


def scenes(configuration):
    """Objects of the same meshes: anywhere; all over the whole screen and all equally far, in all
    their triangles; all in the first element's regions; clipped ones among others; none."""
    flat = configuration.shading == "flat"
    some, all_tied, first, clipped, none = (
        random_objects(configuration, count, seed, MESHES, wide=True, flat=flat)
        for seed, count in enumerate((40, 24, 20, 12, 0)))
    meshes = (*some.meshes, _cover(configuration, len(some.meshes)))
    mesh = np.full(len(all_tied.mesh), len(some.meshes))
    all_tied = replace(all_tied, mesh=mesh, offset=np.full((len(mesh), 3), (3, -2, 500)))
    first.offset[:, :2] = np.minimum(first.offset[:, :2], 1 << configuration.sub_bits)
    first = replace(first, mesh=np.minimum(first.mesh, 3))
    clipped = replace(clipped, mesh=np.where(np.arange(12) % 3, clipped.mesh, 4))
    return {name: replace(objects, meshes=meshes).display_list() for name, objects in {
        "anywhere": some, "all tied everywhere": all_tied, "in the first element": first,
        "clipped": clipped, "none": none}.items()}


def _cover(configuration, seed):
    """Two triangles over the whole screen that tie with each other where they overlap."""
    unit = 1 << configuration.sub_bits
    width, height = configuration.width * unit, configuration.height * unit
    position = np.array([[[-unit, -unit], [2 * width, 0], [0, 2 * height]],
                         [[width, height], [-width // 2, height], [width, -height // 2]]])
    shade = np.random.default_rng(seed).integers(100, 256, (2, 1, 3)).repeat(3, axis=1)
    return ObjectMesh(position, np.zeros((2, 3), np.int64), shade.astype(np.uint8))
