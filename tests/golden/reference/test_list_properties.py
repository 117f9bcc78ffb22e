"""What holds for every display list: triangulations, closed meshes, permutations, translations."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cardcage.golden.hard_cases.expectations import ANY_ORDER
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.scenes.built_in.sphere import unit_sphere
from cardcage.golden.specification.display_list import DisplayList

SIZE, SUB_BITS = 16, 4
UNIT = 1 << SUB_BITS
LIMIT = 64 * UNIT // 2  # of the guard band

properties = settings(deadline=None, max_examples=60, print_blob=True,
                      suppress_health_check=[HealthCheck.too_slow])

#: Half-pixel positions among them, where edges and vertices meet centres.
coordinate = st.one_of(st.integers(-LIMIT, LIMIT - 1), st.integers(0, SIZE * UNIT),
                       st.integers(0, 2 * SIZE).map(lambda n: n * UNIT // 2))
point = st.tuples(coordinate, coordinate)


def listed(corners, depth=None):
    """Triangles in sub-pixel units."""
    position = np.array(corners, np.int32).reshape(-1, 3, 2)
    count = len(position)
    random = np.random.default_rng(count)
    return DisplayList(
        SIZE, SIZE, position,
        random.integers(0, 2**24 - 1, (count, 3)) if depth is None else depth,
        random.integers(0, 256, (count, 3, 3), np.uint8), sub_bits=SUB_BITS)


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


# Triangulations


def winding_number(ring):
    """int64 (height, width): how often a polygon runs clockwise around each pixel centre.

    Straight from the polygon, by edges that cross the ray to the left.  The
    centre stands for the point a hair right of it and, far less, below.
    """
    y, x = np.indices((SIZE, SIZE)) * UNIT + UNIT // 2
    total = np.zeros((SIZE, SIZE), np.int64)
    for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1], strict=True):
        up = (y1 <= y) & (y < y0)  # the point is a hair lower: a level edge never counts
        down = (y0 <= y) & (y < y1)
        side = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
        # On the edge counts as right of it: then a hair right is right of it.
        total += up & (side >= 0)
        total -= down & (side <= 0)
    return total


def signed_coverage(triangles):
    """How many triangles that run clockwise cover each pixel, less those that do not."""
    total = np.zeros((SIZE, SIZE), np.int64)
    for sign in (1, -1):
        chosen = [corners for corners in triangles if sign * cross(*corners) > 0]
        total += sign * exact.depth_complexity(listed(chosen))
    return total


@properties
@given(st.lists(point, min_size=3, max_size=12), point)
def test_any_fan_of_any_polygon_adds_up_to_it(ring, hub):
    """Self-intersecting ones too: coverage with sign adds up to the winding number."""
    expected = winding_number(ring)
    sides = list(zip(ring, ring[1:] + ring[:1], strict=True))
    for centre in (hub, ring[0], ring[-1]):
        fan = [(centre, a, b) for a, b in sides]
        assert np.array_equal(signed_coverage(fan), expected)


def ears(ring, choose):
    """A triangulation of a simple clockwise polygon: cut ears, each time a chosen one."""
    ring = list(ring)
    triangles = []
    while len(ring) > 3:
        found = []
        for i in range(len(ring)):
            a, b, c = ring[i - 1], ring[i], ring[(i + 1) % len(ring)]
            others = [p for p in ring if p not in (a, b, c)]
            if cross(a, b, c) > 0 and not any(
                    cross(a, b, p) >= 0 and cross(b, c, p) >= 0 and cross(c, a, p) >= 0
                    for p in others):
                found.append(i)
        if not found:  # only vertices in a line are left
            return None
        i = found[choose(len(found))]
        triangles.append((ring[i - 1], ring[i], ring[(i + 1) % len(ring)]))
        del ring[i]
    return [*triangles, tuple(ring)]


@properties
@given(st.sets(point, min_size=4, max_size=12), st.integers(0, 2**32 - 1))
def test_every_triangulation_of_a_simple_polygon_covers_the_same_once(points, seed):
    """Two of them by ears cut in random order, of a polygon that is star-shaped about a corner."""
    random = np.random.default_rng(seed)
    first, *others = sorted(points)
    # By slope as seen from the leftmost point; of several on one ray the farthest alone.
    by_ray = {}
    for p in others:
        dx, dy = p[0] - first[0], p[1] - first[1]
        divisor = int(np.gcd(dx, dy))
        ray = dx // divisor, dy // divisor
        by_ray[ray] = max(by_ray.get(ray, (0, None)), (divisor, p))
    ring = [first, *(p for _, (_, p) in sorted(by_ray.items(), key=lambda ray_and_point:
            np.arctan2(ray_and_point[0][1], ray_and_point[0][0])))]
    if len(ring) < 4:
        return
    images = []
    for _ in range(2):
        triangles = ears(ring, lambda count: int(random.integers(count)))
        if triangles is None:
            return
        assert len(triangles) == len(ring) - 2
        images.append(exact.depth_complexity(listed(triangles)))
    assert images[0].max() <= 1
    assert np.array_equal(images[0], images[1])
    assert np.array_equal(images[0], winding_number(ring))


def test_the_winding_number_by_hand():
    ring = [(0, 0), (4 * UNIT, 0), (4 * UNIT, 4 * UNIT), (0, 4 * UNIT)]
    expected = np.zeros((SIZE, SIZE), np.int64)
    expected[:4, :4] = 1
    assert np.array_equal(winding_number(ring), expected)
    assert np.array_equal(winding_number(ring[::-1]), -expected)


# Closed meshes


@pytest.mark.parametrize("scene", ["sphereflake:depth=1,tessellation=2",
                                   "sphereflake:depth=2,tessellation=1", "tetra:depth=3",
                                   "spheres:count=40,depth=1,radius=0.4"])
@pytest.mark.parametrize("shifts", [(0, 0), (1, 1)])
def test_every_pixel_of_a_closed_mesh_is_hit_an_even_number_of_times(scene, shifts):
    display_list = make_display_list(scene, width=96, height=96).display_list
    hits = exact.depth_complexity(display_list, x_shift=shifts[0], y_shift=shifts[1])
    print(f"{scene}: {display_list.triangles} triangles, {int(hits.sum())} fragments, up to "
          f"{hits.max()} on a pixel")
    assert hits.max() > 2 and (hits % 2 == 0).all()


@properties
@given(st.integers(0, 2**32 - 1), st.sampled_from([0, 1, 2]), st.sampled_from([1, 4, 16]))
def test_every_pixel_of_a_random_closed_mesh_is_hit_an_even_number_of_times(seed, depth, grid):
    """A sphere's faces with random vertices: it intersects itself, but it is closed."""
    vertices, faces = unit_sphere(depth)
    random = np.random.default_rng(seed)
    corner = random.integers(-LIMIT // grid, LIMIT // grid, (len(vertices), 2)) * grid
    hits = exact.depth_complexity(listed(corner[faces]))
    assert (hits % 2 == 0).all()


def test_an_open_mesh_is_noticed():
    vertices, faces = unit_sphere(1)
    corner = np.round(vertices[:, :2] * 6 * UNIT).astype(np.int64) + SIZE * UNIT // 2
    hits = exact.depth_complexity(listed(corner[faces]))
    assert hits.max() == 2 and (hits % 2 == 0).all()
    assert (exact.depth_complexity(listed(corner[faces[1:]])) % 2 == 1).any()


# Permutations and translations


@st.composite
def display_lists(draw):
    """Triangles with few corners and few depths, so that many touch and many tie."""
    corners = draw(st.lists(point, min_size=3, max_size=8))
    index = st.integers(0, len(corners) - 1)
    triangles = draw(st.lists(st.tuples(index, index, index), max_size=10))
    depth = st.sampled_from([0, 7, 2**24 - 2]) | st.integers(0, 2**24 - 2)
    level = draw(st.lists(st.tuples(depth, depth, depth) | depth.map(lambda d: (d, d, d)),
                          min_size=len(triangles), max_size=len(triangles)))
    return listed([[corners[i] for i in triangle] for triangle in triangles],
                  np.array(level, np.int64).reshape(-1, 3))


@settings(properties, max_examples=30)
@given(display_lists(), st.sampled_from(["exact", 0, 3, 20]))
def test_permuting_primitives_permutes_only_ties(display_list, fraction_bits):
    def draw(permuted):
        if fraction_bits == "exact":
            return exact.draw(permuted, shading="gouraud")
        return bit_true.draw(permuted, fraction_bits=fraction_bits, shading="gouraud")

    assert ANY_ORDER.judge(display_list, draw) is None


@properties
@given(display_lists(), st.integers(-SIZE, SIZE), st.integers(-SIZE, SIZE), st.booleans())
def test_translating_by_whole_pixels_translates_the_picture(display_list, right, down, stepped):
    """Exactly, and in the datapath's model with fraction bits enough for both."""
    moved = display_list.position + np.array([right, down]) * UNIT
    inside = (moved >= -LIMIT).all(axis=(1, 2)) & (moved < LIMIT).all(axis=(1, 2))
    one = replace(display_list, position=display_list.position[inside],
                  depth=display_list.depth[inside], color=display_list.color[inside])
    other = replace(one, position=moved[inside].astype(np.int32))
    bits = max(map(scene_fraction_bits, (one, other)))

    def draw(which):
        if stepped:
            return bit_true.draw(which, fraction_bits=bits, shading="gouraud")
        return exact.draw(which, shading="gouraud")

    here, there = draw(one), draw(other)
    rows, columns = slice(max(0, -down), SIZE - max(0, down)), slice(max(0, -right),
                                                                     SIZE - max(0, right))
    moved_rows = slice(rows.start + down, rows.stop + down)
    moved_columns = slice(columns.start + right, columns.stop + right)
    for field in ("winner", "depth", "color"):
        assert np.array_equal(getattr(here, field)[rows, columns],
                              getattr(there, field)[moved_rows, moved_columns]), field
