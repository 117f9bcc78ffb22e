"""The built-in scenes against the formulas that define them."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cardcage.golden.scene_argument import (
    BUILT_INS,
    BuiltInScene,
    DisplayListScene,
    MeshFileScene,
    list_scenes,
    parse_scene,
)
from cardcage.golden.scenes.built_in.random_numbers import RandomNumbers
from cardcage.golden.scenes.built_in.random_triangles import random_display_list
from cardcage.golden.scenes.built_in.sphere import unit_sphere
from cardcage.golden.scenes.built_in.sphereflake import (
    child_directions,
    sphereflake,
    sphereflake_layout,
)
from cardcage.golden.scenes.built_in.spheres import spheres
from cardcage.golden.scenes.built_in.teapot import teapot, teapot_parts
from cardcage.golden.scenes.built_in.terrain import elevations, terrain
from cardcage.golden.scenes.built_in.tetra import tetra
from cardcage.golden.scenes.mesh import Mesh, corner_normals, cross, dot, edge_vectors, face_normals
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.examples import EXAMPLES
from cardcage.golden.specification.errors import InputError


def directed_edges(faces):
    return Counter((int(a), int(b)) for f in faces for a, b in zip(f, np.roll(f, -1), strict=True))


def open_edges(faces):
    """Edges with a face on one side only; an edge used twice in one direction fails."""
    edges = directed_edges(faces)
    assert max(edges.values()) == 1
    return [edge for edge in edges if edge[::-1] not in edges]


def signed_volume(corners):
    return float(dot(corners[:, 0], cross(corners[:, 1], corners[:, 2])).sum() / 6)


def teapot_part_faces(tessellation):
    n = tessellation
    sizes = [32 * n * n - 4 * n, 8 * n * n, 8 * n * n, 16 * n * n - 4 * n]
    mesh = teapot(n)
    assert mesh.triangles == sum(sizes)
    return mesh, np.split(mesh.faces, np.cumsum(sizes)[:-1])


def make(text) -> Mesh:
    scene = parse_scene(text)
    assert isinstance(scene, BuiltInScene) and scene.built_in.mesh is not None
    return scene.built_in.mesh(**scene.arguments)


def test_listed_triangle_counts_are_those_of_the_scenes():
    listed = {line.name: line.triangles for line in list_scenes()}
    assert listed == {
        "teapot": 992, "sphereflake": 11648, "tetra": 1024, "spheres": 2048, "terrain": 1050,
        "head": 1152, "capsid": 4096, "random": 200, "three_cubes": 8228,
        "five_primitives": 3602, "thousand_spheres": 128_000, "crystals": 712, "colonnade": 8222,
    }  # fmt: skip
    for name in set(listed) - {"random", *EXAMPLES}:
        assert make(name).triangles == listed[name]


@pytest.mark.parametrize("text, triangles", [
    ("teapot:tessellation=2", 240),
    ("teapot:tessellation=10", 6320),
    ("sphereflake:depth=0,tessellation=0", 8),
    ("sphereflake:depth=3,tessellation=0", 820 * 8),
    ("tetra:depth=0", 4),
    ("tetra:depth=3", 256),
    ("spheres:count=5,depth=3", 5 * 512),
    ("terrain:step=7", 2 * 49 * 57),
    ("terrain:step=64,relief=0", 2 * 5 * 6),
    ("head:tessellation=1", 8),
    ("head:tessellation=86", 59_168),
    ("capsid:count=5,depth=3", 5 * 512),
])
def test_counts_with_arguments(text, triangles):
    scene = parse_scene(text)
    assert isinstance(scene, BuiltInScene)
    assert scene.name == text
    assert scene.triangles == make(text).triangles == triangles


# ---- terrain


def test_terrain_is_a_surface_over_the_plane_as_high_as_the_elevations():
    mesh = terrain(16, 3.0)
    assert (mesh.vertices[:, 2] * 1000 / 3).reshape(22, 26) == pytest.approx(
        elevations()[::16, ::16])
    assert elevations().min() == 236 and elevations().max() == 1076
    assert len(open_edges(mesh.faces)) == 2 * (21 + 25)  # its border, and no other edge
    corners = mesh.corners()
    assert cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2].min() > 0
    east_west, south_north, _ = mesh.vertices.max(axis=0) - mesh.vertices.min(axis=0)
    assert east_west == pytest.approx(29.76) and south_north == pytest.approx(31.08)
    assert mesh.vertices[0, 1] > mesh.vertices[-1, 1]  # from the far side to the near one


# ---- head and capsid


@pytest.mark.parametrize("tessellation", [1, 2, 7, 30])
def test_head_is_closed_and_faces_outwards(tessellation):
    mesh = make(f"head:tessellation={tessellation}")
    assert len(open_edges(mesh.faces)) == 0 and not mesh.degenerate().any()
    assert len(mesh.vertices) == mesh.triangles // 2 + 2  # as Euler has it of a sphere
    corners = mesh.corners()
    volume = (cross(corners[:, 0], corners[:, 1]) * corners[:, 2]).sum(axis=1)
    assert (volume > 0).all()  # seen from its middle, every face turns its back


def test_head_is_like_itself_in_a_mirror_and_has_a_nose():
    vertices = make("head:tessellation=24").vertices
    there = {tuple(point) for point in (vertices * [-1, 1, 1]).round(9) + 0.0}
    assert there == {tuple(point) for point in vertices.round(9) + 0.0}
    front = vertices[vertices[:, 1].argmin()]
    assert abs(front[0]) < 0.05 and -0.3 < front[2] < 0.1


def test_balls_of_a_capsid_lie_on_a_sphere_and_run_into_each_other():
    mesh = make("capsid:count=40,depth=1")
    centers = mesh.vertices.reshape(40, -1, 3).mean(axis=1)
    assert np.linalg.norm(centers, axis=1) == pytest.approx(np.ones(40))
    apart = np.linalg.norm(centers[:, None] - centers, axis=2) + 9 * np.eye(40)
    size = np.linalg.norm(mesh.vertices.reshape(40, -1, 3) - centers[:, None], axis=2)
    assert apart.min(axis=1).max() < 2 * size.min() and apart.min() > size.max()


# ---- teapot


def test_teapot_has_the_32_patches_of_newell():
    body, handle, spout, lid = teapot_parts()
    assert [len(part) for part in (body, handle, spout, lid)] == [16, 4, 4, 8]
    points = np.concatenate([p.reshape(-1, 3) for p in (body, handle, spout, lid)])
    assert points.min(axis=0).tolist() == [-3.0, -2.0, 0.0]
    assert points.max(axis=0).tolist() == [3.525, 2.0, 3.15]
    for part in (body, handle, spout, lid):  # mirrored in the plane y = 0
        there = {tuple(p) for p in part.reshape(-1, 3)}
        assert there == {(x, -y, z) for x, y, z in there}


@pytest.mark.parametrize("tessellation", [2, 3, 4, 7])
def test_teapot_parts_are_watertight_but_for_their_openings(tessellation):
    mesh, (body, handle, spout, lid) = teapot_part_faces(tessellation)
    n = tessellation
    assert not mesh.degenerate().any()
    rim = mesh.vertices[np.unique(open_edges(body))]
    assert len(open_edges(body)) == 4 * n and np.all(rim[:, 2] == 2.4)
    lower = mesh.vertices[np.unique(open_edges(lid))]
    assert len(open_edges(lid)) == 4 * n and np.all(lower[:, 2] == 2.4)
    for tube in (handle, spout):  # open at both ends
        assert len(open_edges(tube)) == 4 * n


def test_teapot_bounding_box_and_symmetry():
    mesh = teapot(8)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert low[2] == 0.0 and high[2] == 3.15
    assert low[1] == -high[1] == -2.0
    assert low[0] == -3.0 and 3.433 < high[0] < 3.434  # the tip lies inside its controls
    vertices = teapot(3).vertices
    apart = np.abs(vertices[:, None] * [1, -1, 1] - vertices[None]).max(axis=2)
    assert apart.min(axis=1).max() < 1e-12  # each has its mirror image


def test_teapot_normals_are_those_of_the_surface_and_point_outward():
    mesh, parts = teapot_part_faces(16)
    for faces in parts:
        corners = mesh.vertices[faces]
        inside = corners.reshape(-1, 3).mean(axis=0)
        assert signed_volume(corners - inside) > 0
    normals = corner_normals(mesh)
    assert np.allclose(dot(normals, normals), 1.0)
    facing = dot(normals, np.repeat(face_normals(mesh)[:, None], 3, axis=1))
    assert facing.min() > 0.3 and np.median(facing) > 0.99
    pole = np.flatnonzero((mesh.vertices[:, :2] == 0.0).all(axis=1))
    by_height = {float(mesh.vertices[i, 2]): mesh.normals[i].tolist() for i in pole}
    assert by_height == {0.0: [0.0, 0.0, -1.0], 3.15: [0.0, 0.0, 1.0]}


# ---- spheres


@pytest.mark.parametrize("depth", [0, 1, 4])
def test_subdivided_octahedron(depth):
    vertices, faces = unit_sphere(depth)
    assert len(faces) == 8 * 4**depth
    assert len(vertices) == 2 + 4 * 4**depth  # Euler: v - e + f = 2, e = 3f/2
    assert open_edges(faces) == []
    assert np.allclose(dot(vertices, vertices), 1.0, rtol=0, atol=1e-15)
    volume = signed_volume(vertices[faces])
    assert volume > 0
    if depth == 0:
        assert volume == pytest.approx(4 / 3)
    if depth == 4:
        assert volume == pytest.approx(4 / 3 * np.pi, rel=0.01)


def test_sphereflake_children_touch_their_parents():
    centers, radii = sphereflake_layout(2)
    assert len(centers) == 1 + 9 + 81
    assert np.allclose(np.unique(np.round(radii, 12)), [0.5 / 9, 0.5 / 3, 0.5])
    for first, count, parents in ((1, 9, 0), (10, 81, 1)):
        parent = parents + np.arange(count) // 9
        child = first + np.arange(count)
        apart = np.linalg.norm(centers[child] - centers[parent], axis=1)
        assert np.allclose(apart, radii[child] + radii[parent])
        assert np.allclose(radii[child] * 3, radii[parent])


def test_sphereflake_grows_away_from_its_parent():
    directions = child_directions()
    assert np.allclose(np.linalg.norm(directions, axis=1), 1)
    assert np.allclose(sorted(directions[:, 2]), [0] * 6 + [np.sqrt(2 / 3)] * 3)
    equator = np.degrees(np.arctan2(*directions[np.abs(directions[:, 2]) < 0.1, 1::-1].T))
    assert np.allclose(np.sort(equator % 60), 15)
    assert np.allclose(np.diff(np.sort(equator % 360)), 60)
    centers, _ = sphereflake_layout(2)
    for parent in range(9):
        own = centers[1 + parent]
        grown = centers[10 + 9 * parent : 19 + 9 * parent] - own
        heights = np.sort(grown @ own / np.linalg.norm(own)) / np.linalg.norm(grown[0])
        assert np.allclose(heights, [0] * 6 + [np.sqrt(2 / 3)] * 3)


def test_sphereflake_mesh_stands_on_its_layout():
    mesh = sphereflake(1, 1)
    centers, radii = sphereflake_layout(1)
    vertices = mesh.vertices.reshape(10, -1, 3)
    away = np.linalg.norm(vertices - centers[:, None], axis=2)
    assert np.allclose(away, radii[:, None])
    assert open_edges(mesh.faces) == []


def test_random_spheres_are_reproducible_and_of_one_size():
    mesh, again, other = spheres(20, 1, 0.15, 3), spheres(20, 1, 0.15, 3), spheres(20, 1, 0.15, 4)
    assert np.array_equal(mesh.vertices, again.vertices)
    assert np.array_equal(mesh.colors, again.colors)
    assert not np.array_equal(mesh.vertices, other.vertices)
    vertices = mesh.vertices.reshape(20, -1, 3)
    centers = vertices.mean(axis=1)
    assert np.allclose(np.linalg.norm(vertices - centers[:, None], axis=2), 0.15)
    assert np.abs(centers).max() <= 1.0 and np.abs(centers).max() > 0.8
    assert len(np.unique(mesh.colors.reshape(20, -1, 3)[:, 0], axis=0)) == 20


# ---- tetra


@pytest.mark.parametrize("depth", [0, 1, 3])
def test_tetra_is_made_of_regular_tetrahedra(depth):
    mesh = tetra(depth)
    assert mesh.triangles == 4 * 4**depth
    assert open_edges(mesh.faces) == []
    edges = edge_vectors(mesh.corners())
    assert np.all(dot(edges, edges) == 8.0 / 4**depth)
    assert signed_volume(mesh.corners()) == pytest.approx(8 / 3 / 2**depth)
    assert mesh.vertices.min() == -1.0 and mesh.vertices.max() == 1.0
    if depth:  # touching at corners: 4 outer ones, the others shared by two
        assert len(np.unique(mesh.vertices, axis=0)) == 2 * 4**depth + 2


# ---- random


def random_list(seed=1, n=500, size=12.0, gouraud=True, width=64, height=48):
    picture = PictureFormat(width, height)
    return random_display_list(
        picture, (0, 0, 0), gouraud=gouraud, n=n, size=size, seed=seed
    )


def test_random_triangles_are_reproducible_and_of_the_size_asked_for():
    one, again, other = random_list(), random_list(), random_list(seed=2)
    assert np.array_equal(one.position, again.position)
    assert np.array_equal(one.depth, again.depth)
    assert np.array_equal(one.color, again.color)
    assert not np.array_equal(one.position, other.position)
    extent = np.ptp(one.position, axis=1)
    assert extent.max() <= 12 * 256 and extent.max() > 11 * 256
    assert one.position.min() >= 0
    assert np.all(one.position.max(axis=(0, 1)) <= np.array([64, 48]) * 256)
    assert len(np.unique(one.position & 255)) > 200  # sub-pixel positions
    assert one.depth.max() > 0.99 * 2**24 and one.depth.min() < 0.01 * 2**24
    assert not one.flat
    assert random_list(gouraud=False).flat


def test_random_triangles_larger_than_the_screen_are_kept_in_the_guard_band():
    assert random_list(size=127.0, n=50).position.max() > 64 * 256
    with pytest.raises(InputError, match=r"^random: size: 128 pixels .* at most 127$"):
        random_list(size=128.0)


def test_random_numbers_never_change():
    numbers = RandomNumbers(7)
    assert numbers.integers(1000, 4).tolist() == [625, 897, 775, 225]
    assert 0 <= numbers.uniform(1000).min() < 0.01 < 0.99 < numbers.uniform(1000).max() < 1


# ---- scene names


@pytest.mark.parametrize("text, message", [
    ("teapto", "scene: 'teapto' is neither a built-in scene nor a file; did you mean teapot?"),
    ("Sphere_flake:depth=2", "did you mean sphereflake?"),
    ("", "choose one of teapot, sphereflake, tetra, spheres, terrain, head, capsid, random"),
    ("xyzzy", "choose one of teapot, sphereflake, tetra, spheres, terrain, head, capsid, random"),
    ("tetra:depth=x", "tetra: depth: 'x' is not a whole number from 0 to 9"),
    ("tetra:depth=2.5", "tetra: depth: '2.5' is not a whole number from 0 to 9"),
    ("tetra:depth=-1", "tetra: depth: '-1' is not a whole number from 0 to 9"),
    ("tetra:depth=10", "tetra: depth: '10' is not a whole number from 0 to 9"),
    ("tetra:dept=2", "tetra: dept: no such parameter; use depth (whole number from 0 to 9)"),
    ("tetra:depth", "tetra: parameters: 'depth' is not of the form name=value"),
    ("tetra:", "tetra: parameters: '' is not of the form name=value"),
    ("tetra:depth=1,depth=2", "tetra: depth: given twice; keep one"),
    ("random:n=0", "random: n: '0' is not a whole number from 1 to 1000000"),
    ("random:size=nan", "random: size: 'nan' is not a number from 0.125 to 8191.0"),
    ("random:n=9999999999", "random: n: '9999999999' is not a whole number"),
    ("random:seed=x", "random: seed: 'x' is not a whole number from 0 to 4294967295"),
    ("teapot:tessellation=x", "'x' is not a whole number from 2 to 128"),
    ("sphereflake:depth=x", "'x' is not a whole number from 0 to 6"),
    ("sphereflake:tessellation=x", "'x' is not a whole number from 0 to 8"),
    ("spheres:count=x", "'x' is not a whole number from 1 to 2048"),
    ("spheres:depth=x", "'x' is not a whole number from 0 to 8"),
    ("spheres:radius=x", "'x' is not a number from 0.001 to 2.0"),
    ("sphereflake:depth=6,tessellation=8",
     "sphereflake: depth, tessellation: makes 313456590848 triangles, more than 4000000"),
])
def test_bad_scene_names(text, message):
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_files_are_told_from_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert parse_scene("dragon.PLY") == MeshFileScene(Path("dragon.PLY"))
    assert parse_scene("out/teapot") == MeshFileScene(Path("out/teapot"))
    assert parse_scene("dragon.fbx") == MeshFileScene(Path("dragon.fbx"))
    assert parse_scene("old.npz") == DisplayListScene(Path("old.npz"))
    assert parse_scene(Path("teapot")) == MeshFileScene(Path("teapot"))
    (tmp_path / "dragon").write_text("x")
    assert parse_scene("dragon") == MeshFileScene(Path("dragon"))


@settings(deadline=None)
@given(st.text(max_size=40) | st.builds("{}:{}".format, st.sampled_from([*BUILT_INS]), st.text()))
def test_any_text_is_a_scene_or_an_input_error(text):
    try:
        scene = parse_scene(text)
    except InputError as error:
        assert str(error)
    else:
        assert scene.name is not None
