"""Polygons to triangles: the area, the corners and the order of what is cut."""

import numpy as np
import pytest

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.scenes.mesh_files.polygons import triangulate
from cardcage.golden.scenes.mesh_files.reading import Reading
from cardcage.golden.specification.errors import InputError

L = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]


def star(points):
    angle = np.arange(2 * points) * np.pi / points
    radius = np.where(np.arange(2 * points) % 2, 0.4, 1.0)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1).tolist()


def spiral(turns):
    """A band that winds around itself: no corner sees all of it."""
    angle = np.linspace(0.0, 2.0 * np.pi * turns, 40 * turns)
    outer = np.stack([(angle + 3.0) * np.cos(angle), (angle + 3.0) * np.sin(angle)], axis=1)
    inner = np.stack([(angle + 1.0) * np.cos(angle), (angle + 1.0) * np.sin(angle)], axis=1)
    return np.concatenate([outer, inner[::-1]]).tolist()


SHAPES = {
    "triangle": [(0, 0), (1, 0), (0, 1)],
    "square": [(0, 0), (1, 0), (1, 1), (0, 1)],
    "dart": [(0, 0), (2, -1), (0.5, 0), (2, 1)],
    "L": L,
    "U": [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)],
    "hexagon": [(2, 0), (1, 2), (-1, 2), (-2, 0), (-1, -2), (1, -2)],
    "star": star(5),
    "star of 200 corners": star(100),
    "circle of 300 corners": np.stack([np.cos(np.arange(300) * np.pi / 150),
                                       np.sin(np.arange(300) * np.pi / 150)], 1).tolist(),
    "spiral": spiral(2),
    "corner on a straight line": [(0, 0), (1, 0), (2, 0), (2, 2), (0, 2)],
    "two on every side": [(0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (3, 2), (3, 3), (2, 3), (1, 3),
                          (0, 3), (0, 2), (0, 1)],
    "L with corners on straight lines": [(0, 0), (1, 0), (3, 0), (3, 1), (2, 1), (1, 1), (1, 3),
                                         (0, 3), (0, 2), (0, 1)],
    "square around a hole": [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1),
                             (1, 1)],
    "a corner twice": [(0, 0), (1, 0), (1, 0), (1, 1), (0, 1)],
}
MATRICES = [np.eye(3), np.eye(3)[[1, 2, 0]], np.diag([1.0, 1.0, -1.0]),
            np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])]


def shoelace(points):
    x, y = np.array(points, float).T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) / 2


def cut(points, corners=None, sizes=None):
    reading = Reading()
    corners = np.arange(len(points)) if corners is None else np.array(corners)
    sizes = np.array([len(corners)] if sizes is None else sizes)
    made = triangulate(np.array(points, float), corners, sizes, reading)
    return made.of_corners(corners), made.of_polygons(np.arange(len(sizes))), reading.notes


def vector_areas(points, triangles):
    a, b, c = (np.array(points)[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a) / 2


@pytest.mark.parametrize("matrix", range(len(MATRICES)))
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("name", SHAPES)
def test_triangles_cover_the_polygon_once_and_face_as_it_does(name, turned, matrix):
    flat = SHAPES[name][::-1] if turned else SHAPES[name]
    points = np.array([(x, y, 0.0) for x, y in flat]) @ MATRICES[matrix].T + [5, -7, 11]
    triangles, _, notes = cut(points)
    areas = vector_areas(points, triangles)
    whole = abs(shoelace(flat))
    assert notes == []
    assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(whole, rel=1e-9)
    assert np.linalg.norm(areas.sum(axis=0)) == pytest.approx(whole, rel=1e-9)
    normal = MATRICES[matrix] @ [0, 0, shoelace(flat)] * np.linalg.det(MATRICES[matrix])
    assert (areas @ normal > 0).all()


@pytest.mark.parametrize("name", [n for n in SHAPES if "twice" not in n and "hole" not in n])
def test_every_corner_is_used(name):
    """A corner on a straight line, too: the neighbour that shares it must not gape."""
    points = [(x, y, 0.0) for x, y in SHAPES[name]]
    triangles, _, _ = cut(points)
    assert len(triangles) == len(points) - 2 and set(triangles.ravel()) == set(range(len(points)))


@pytest.mark.parametrize("first", range(6))
def test_an_l_is_an_l_wherever_it_begins(tmp_path, first):
    ring = [(first + i) % 6 + 1 for i in range(6)]
    vertices = "".join(f"v {x} {y} 0\n" for x, y in L)
    (tmp_path / "l.obj").write_text(vertices + f"f {' '.join(map(str, ring))}\n")
    result = make_display_list(tmp_path / "l.obj", width=32, height=32)
    assert result.display_list.triangles == 4 and result.notes == ()


def test_quadrangles_are_cut_along_the_shorter_diagonal():
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    assert cut(square)[0].tolist() == [[0, 1, 3], [1, 2, 3]]
    leaning = [(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (-0.5, 1, 0)]
    assert cut(leaning)[0].tolist() == [[0, 1, 2], [0, 2, 3]]
    # Not flat: cut all the same.
    assert len(cut([(0, 0, 0), (1, 0, 1), (1, 1, 0), (0, 1, 1)])[0]) == 2


def test_the_order_of_the_polygons_is_kept():
    points = [(x, y, 0.0) for x, y in L]
    corners = [0, 1, 2, *range(6), 3, 4, 5, 0, 1, 2, 3]
    triangles, owner, _ = cut(points, corners, [3, 6, 3, 4])
    assert owner.tolist() == [0, 1, 1, 1, 1, 2, 3, 3]
    assert triangles[0].tolist() == [0, 1, 2] and triangles[5].tolist() == [3, 4, 5]


@pytest.mark.parametrize("points, note", [
    ([(0, 0, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3)],
     "1 of 1 faces is a polygon without area and is left out"),
    ([(5, 5, 5)] * 5, "1 of 1 faces is a polygon without area and is left out"),
    ([(0, 0, 0), (4, 4, 0), (4, 0, 0), (0, 1, 0)],
     "1 of 1 faces is a polygon that crosses itself and is left out"),
    ([(np.cos(a), np.sin(a), 0) for a in np.arange(5) * 4 * np.pi / 5],
     "1 of 1 faces is a polygon that crosses itself and is left out"),
])
def test_what_has_no_right_triangles_is_left_out(points, note):
    triangles, _, notes = cut(points)
    assert len(triangles) == 0 and notes == [note]


def test_several_are_counted_in_one_line_each():
    points = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (4, 4, 0), (0, 1, 0), (4, 0, 0)]
    corners = [0, 1, 2, 3, 3, 2, 1, 0, 0, 1, 0, 4, 6, 5, 0, 1, 5]
    triangles, owner, notes = cut(points, corners, [4, 4, 2, 4, 3])
    assert triangles.tolist() == [[0, 1, 5]] and owner.tolist() == [4]
    assert notes == ["1 of 5 faces has fewer than three corners and is left out",
                     "2 of 5 faces are polygons without area and are left out",
                     "1 of 5 faces is a polygon that crosses itself and is left out"]


def test_a_corner_that_is_not_there():
    with pytest.raises(InputError, match="names vertex 7, but there are 4"):
        cut([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [0, 1, 2, 7])
