"""Where objects can have pixels, and how they come to the elements that draw these."""

import numpy as np
import pytest

from cardcage.golden.objects.forwarded_objects import ForwardedObjects
from cardcage.golden.objects.object_boxes import ObjectBoxes
from cardcage.golden.organisations.region_table import runs_table
from cardcage.golden.reference.exact import draw
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.object_list import ObjectList, ObjectMesh
from cardcage.golden.specification.regions import regions_of


def some_objects(random, picture, count, sizes=(0, 1, 4, 20, 60)):
    """Meshes of one to three triangles, anywhere on the screen and beside it."""
    unit = 1 << picture.sub_bits
    meshes = [ObjectMesh(random.integers(-size * unit, size * unit + 1, (triangles, 3, 2)),
                         random.integers(0, 100, (triangles, 3)),
                         random.integers(0, 256, (triangles, 3, 3)).astype(np.uint8))
              for size in sizes for triangles in (1, 3)]
    reach = np.array([picture.width, picture.height]) * unit
    offset = np.concatenate([random.integers(-10 * unit, reach + 10 * unit, (count, 2)),
                             random.integers(0, 100, (count, 1))], axis=1)
    offset[::3] = offset[::3] // (unit // 2) * (unit // 2)  # on centres, and between two
    return ObjectList(picture, (0, 0, 0), tuple(meshes), random.integers(0, len(meshes), count),
                      offset, random.integers(0, 256, (count, 3)).astype(np.uint8))


@pytest.mark.parametrize("seed", range(4))
def test_no_object_covers_a_pixel_outside_its_box_and_no_box_is_wider_than_its_corners(seed):
    random = np.random.default_rng(seed)
    picture = PictureFormat(40, 24, sub_bits=2)
    objects = some_objects(random, picture, 60)
    boxes = ObjectBoxes.of(objects)
    assert 0 < boxes.empty.sum() < 60
    regions = regions_of(40, 24, 5, 3)
    y, x = np.mgrid[:24, :40]
    for number in range(60):
        one = ObjectList(picture, objects.background, objects.meshes,
                         *(getattr(objects, name)[[number]] for name in (
                             "mesh", "offset", "color")))
        covered = draw(one.display_list()).winner >= 0
        left, top, right, bottom = objects.meshes[objects.mesh[number]].box
        centre = np.stack([x, y], axis=-1) * 4 + 2 - objects.offset[number, :2]
        inside = ((centre >= [left, top]) & (centre <= [right, bottom])).all(axis=-1)
        assert inside[covered].all()
        assert boxes.empty[number] == (not inside.any())
        found = np.zeros((24, 40), bool)
        if not boxes.empty[number]:
            found[boxes.top[number]:boxes.bottom[number] + 1,
                  boxes.left[number]:boxes.right[number] + 1] = True
        assert (found == inside).all()
        met = np.unique(regions.region(x, y)[inside])
        assert np.flatnonzero(boxes.met(regions)[number]).tolist() == met.tolist()


def passed_by_hand(elements, source, met, table):
    """From neighbour to neighbour, one object after another."""
    drawn, left, right = [0] * elements, [0] * elements, [0] * elements
    for first, regions in zip(source.tolist(), met, strict=True):
        wanted = set(table[regions].tolist())
        for element in wanted:
            drawn[element] += 1
        for step, passed in ((-1, left), (1, right)):
            here = first
            while any((element - here) * step > 0 for element in wanted):
                passed[here] += 1
                here += step
    return drawn, left, right


@pytest.mark.parametrize("elements", [1, 2, 3, 4, 8, 16])
@pytest.mark.parametrize("columns, rows", [(1, 12), (5, 3), (4, 4)])
def test_objects_go_from_neighbour_to_neighbour(elements, columns, rows):
    random = np.random.default_rng((elements, columns))
    table = runs_table(columns * rows, elements)
    met = np.zeros((80, rows, columns), bool)
    for each in met[8:]:
        top, left = random.integers(0, rows), random.integers(0, columns)
        each[top:top + random.integers(1, rows + 1), left:left + random.integers(1, columns + 1)
             ] = True
    met = met.reshape(80, -1)
    source = random.integers(0, elements, 80)
    forwarded = ForwardedObjects(elements, source, met, table)
    assert (forwarded.drawn.sum(axis=0).tolist(), forwarded.left.tolist(),
            forwarded.right.tolist()) == passed_by_hand(elements, source, met, table)
    assert forwarded.left[0] == forwarded.right[-1] == 0
