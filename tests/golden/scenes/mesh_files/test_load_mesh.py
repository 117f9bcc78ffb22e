"""Mesh files: five formats, one mesh; and every way in which a file can be bad."""

import dataclasses
import json

import numpy as np
import pytest
import trimesh

from cardcage.golden.scene_display_list import display_list_of_mesh, make_display_list
from cardcage.golden.scenes.mesh import BASE_COLOR, UP_Y, UP_Z, Mesh, corner_normals, face_normals
from cardcage.golden.scenes.mesh_files.load_mesh import MESH_EXTENSIONS, load_mesh
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.specification.errors import InputError

# Coordinates that every format, also those of 32 bits, holds exactly.
VERTICES = np.array([[0, 0, 0], [1, 0.25, 0], [0, 1.5, 0.125], [0.5, 0.5, -1.75]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
COLORS = np.array([[250, 10, 20], [30, 240, 50], [60, 70, 230], [90, 100, 110]], np.uint8)


def write(path, mesh):
    if path.suffix == ".gltf":
        for name, data in trimesh.exchange.gltf.export_gltf(trimesh.Scene(mesh)).items():
            (path if name == "model.gltf" else path.parent / name).write_bytes(data)
    else:
        mesh.export(path)
    return path


def plain():
    return trimesh.Trimesh(VERTICES.copy(), FACES.copy(), process=False)


def same(a, b):
    names = ("position", "depth", "color")
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names)


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
@pytest.mark.parametrize("extension", MESH_EXTENSIONS)
def test_every_format_gives_the_display_list_of_the_mesh(tmp_path, extension, shading):
    path = write(tmp_path / f"thing{extension}", plain())
    up = UP_Z if extension == ".stl" else UP_Y
    expected = display_list_of_mesh(Mesh(VERTICES, FACES, up=up), PictureFormat(), shading=shading)
    result = make_display_list(path, shading=shading)
    assert result.name == path.name and result.notes == ()
    assert result.display_list.triangles == 4
    assert same(result.display_list, expected)


@pytest.mark.parametrize("extension", [".obj", ".ply", ".glb", ".gltf"])
def test_vertex_colors_are_kept(tmp_path, extension):
    mesh = plain()
    mesh.visual.vertex_colors = np.column_stack([COLORS, np.full(4, 255)])
    loaded = load_mesh(write(tmp_path / f"thing{extension}", mesh))
    assert np.array_equal(loaded.colors, COLORS[FACES])


def test_face_colors_are_kept(tmp_path):
    header = (
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    )
    body = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2 255 0 0\n3 0 1 3 0 0 255\n"
    (tmp_path / "a.ply").write_text(header + body)
    loaded = load_mesh(tmp_path / "a.ply")
    assert loaded.colors.tolist() == [[[255, 0, 0]] * 3, [[0, 0, 255]] * 3]


def test_material_colors_are_kept(tmp_path):
    mesh = plain()
    material = trimesh.visual.material.PBRMaterial(baseColorFactor=[255, 128, 0, 255])
    mesh.visual = trimesh.visual.TextureVisuals(uv=np.zeros((4, 2)), material=material)
    loaded = load_mesh(write(tmp_path / "a.glb", mesh))
    assert np.all(loaded.colors == [255, 128, 0])

    (tmp_path / "m.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n")
    (tmp_path / "a.obj").write_text(
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
        "usemtl red\nf 1 3 2\nusemtl blue\nf 1 2 4\nf 2 3 4\n"
    )
    loaded = load_mesh(tmp_path / "a.obj")
    assert sorted(map(tuple, loaded.colors[:, 0].tolist())) == [(0, 0, 255)] * 2 + [(255, 0, 0)]

    (tmp_path / "m.mtl").unlink()  # no stated colour: ours
    assert np.all(load_mesh(tmp_path / "a.obj").corner_colors() == BASE_COLOR)


def test_transforms_of_the_scene_graph_are_applied(tmp_path):
    scene = trimesh.Scene()
    scene.add_geometry(plain(), transform=trimesh.transformations.translation_matrix([2, 0, 0]))
    scene.add_geometry(plain(), transform=np.diag([-1.0, 1.0, 1.0, 1.0]))
    scene.export(tmp_path / "two.glb")
    loaded = load_mesh(tmp_path / "two.glb")
    assert loaded.triangles == 8 and len(loaded.vertices) == 8
    moved, mirrored = sorted((loaded.corners()[:4], loaded.corners()[4:]), key=lambda c: -c.max())
    assert np.array_equal(moved, VERTICES[FACES] + [2, 0, 0])
    # Mirrored and turned round: the outside stays outside.
    assert np.array_equal(mirrored, (VERTICES * [-1, 1, 1])[FACES[:, ::-1]])


def test_polygons_become_triangles(tmp_path):
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    assert load_mesh(tmp_path / "quad.obj").triangles == 2


# ---- bad files


def obj(vertices="v 0 0 0\nv 1 0 0\nv 0 1 0\n", faces="f 1 2 3\n"):
    return (vertices + faces).encode()


def ply_with_face(indices):
    return (
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        f"0 0 0\n1 0 0\n0 1 0\n3 {indices}\n"
    ).encode()


def complain(path, capfd):
    """The message of the InputError; nothing may be printed or warned about."""
    with pytest.raises(InputError) as caught:
        load_mesh(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message and message.isprintable() and len(message) < 200 + len(str(path))
    assert caught.value.__cause__ is None
    assert capfd.readouterr() == ("", "")
    return message.removeprefix(f"{path}: ")


@pytest.mark.parametrize("extension", MESH_EXTENSIONS)
def test_missing_directory_empty(tmp_path, capfd, extension):
    path = tmp_path / f"a{extension}"
    assert complain(path, capfd) == "file: no such file; check the path"
    path.mkdir()
    assert complain(path, capfd).startswith("file: is a directory;")
    path.rmdir()
    path.write_bytes(b"")
    assert complain(path, capfd).startswith("contents: the file is empty;")


@pytest.mark.parametrize("extension", MESH_EXTENSIONS)
@pytest.mark.parametrize("length", [1, 10, 83, 84, 500, 5000])
def test_binary_garbage(tmp_path, capfd, extension, length):
    path = tmp_path / f"a{extension}"
    path.write_bytes(np.random.default_rng(length).bytes(length))
    assert complain(path, capfd).split(":")[0] in ("contents", "faces")


@pytest.mark.parametrize("extension", [".stl", ".ply", ".glb", ".gltf"])
def test_truncated(tmp_path, capfd, extension):
    path = write(tmp_path / f"a{extension}", plain())
    data = path.read_bytes()
    for end in (len(data) // 3, len(data) - 20):
        path.write_bytes(data[:end])
        assert complain(path, capfd).split(":")[0] in ("contents", "faces")


def test_truncated_in_the_middle_of_a_face(tmp_path, capfd):
    # Text of whole lines cannot show that lines are missing; half a line does.
    (tmp_path / "a.obj").write_bytes(obj(faces="f 1 2"))
    assert complain(tmp_path / "a.obj", capfd).startswith("faces: there are none")


def test_missing_buffer_of_a_gltf(tmp_path, capfd):
    path = write(tmp_path / "a.gltf", plain())
    for buffer in json.loads(path.read_text())["buffers"]:
        (tmp_path / buffer["uri"]).unlink()
    assert complain(path, capfd).startswith("contents: ")


@pytest.mark.parametrize("name", ["a.fbx", "a", "a.obj.txt", "a.OBJX"])
def test_unknown_extension(tmp_path, capfd, name):
    (tmp_path / name).write_bytes(obj())
    message = complain(tmp_path / name, capfd)
    assert message.startswith("extension: ") and ".obj .stl .ply .glb .gltf" in message


def test_extension_in_capitals(tmp_path):
    (tmp_path / "A.OBJ").write_bytes(obj())
    assert load_mesh(tmp_path / "A.OBJ").triangles == 1


@pytest.mark.parametrize("name, data", [
    ("a.obj", obj(faces="")),
    ("a.obj", obj(faces="l 1 2\n")),
    ("a.obj", b"# nothing here\n"),
    ("a.stl", b"solid empty\nendsolid empty\n"),
    ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
              b"property float z\nend_header\n0 0 0\n"),
    ("a.gltf", b'{"asset": {"version": "2.0"}}'),
])
def test_no_faces(tmp_path, capfd, name, data):
    (tmp_path / name).write_bytes(data)
    assert complain(tmp_path / name, capfd).split(":")[0] in ("faces", "contents")


@pytest.mark.parametrize("bad", ["nan", "inf", "-inf", "1e999"])
def test_coordinates_that_are_no_numbers(tmp_path, capfd, bad):
    (tmp_path / "a.obj").write_bytes(obj(f"v 0 0 0\nv 1 {bad} 0\nv 0 1 0\n"))
    message = complain(tmp_path / "a.obj", capfd)
    assert message == "vertices: vertex 1 is not a number or infinite; repair the mesh"


def test_coordinates_too_large(tmp_path, capfd):
    (tmp_path / "a.obj").write_bytes(obj("v 0 0 0\nv 1 1e200 0\nv 0 1 0\n"))
    assert complain(tmp_path / "a.obj", capfd).startswith("vertices: coordinates beyond 1e+30")


def test_nan_in_a_binary_format(tmp_path, capfd):
    mesh = plain()
    mesh.vertices[2, 1] = np.nan
    data = trimesh.exchange.ply.export_ply(mesh)
    (tmp_path / "a.ply").write_bytes(data)
    assert complain(tmp_path / "a.ply", capfd).startswith("vertices: vertex 2 is not a number")


@pytest.mark.parametrize("name, data", [
    ("a.obj", obj(faces="f 1 2 9\n")),
    ("a.ply", ply_with_face("0 1 3")),
    ("a.ply", ply_with_face("0 1 -1")),
])
def test_face_index_out_of_range(tmp_path, capfd, name, data):
    (tmp_path / name).write_bytes(data)
    assert complain(tmp_path / name, capfd).split(":")[0] in ("faces", "contents")


def test_the_mesh_itself_names_the_bad_face():
    with pytest.raises(InputError, match=r"^mesh: faces: face 1 names vertex 4, but there are 4 "):
        Mesh(VERTICES, np.array([[0, 1, 2], [0, 4, 1]]))
    with pytest.raises(InputError, match=r"^mesh: faces: face 0 names vertex -1, "):
        Mesh(VERTICES, np.array([[0, -1, 2]]))
    with pytest.raises(InputError, match=r"^mesh: colors: is uint8 of shape \(4, 3\), "):
        Mesh(VERTICES, FACES, COLORS)


# ---- degenerate faces


@pytest.mark.parametrize("vertices", [
    "v 1 2 3\n" * 3,
    "v 0 0 0\nv 1 1 1\nv 3 3 3\n",
    "v 0 0 0\nv 1e-20 0 0\nv 1e20 0 0\n",
    "v 5e6 0 0\nv 5e6 0 0\nv 5e6 1e-9 0\n",
])
def test_degenerate_faces_only(tmp_path, vertices):
    (tmp_path / "a.obj").write_bytes(obj(vertices, "f 1 2 3\nf 1 1 2\n"))
    result = make_display_list(tmp_path / "a.obj")
    assert result.notes == ("all 2 faces are degenerate: the picture is empty",)
    assert result.display_list.triangles == 0


def test_some_degenerate_faces(tmp_path):
    (tmp_path / "a.obj").write_bytes(obj(faces="f 1 2 3\nf 1 1 2\n"))
    result = make_display_list(tmp_path / "a.obj")
    assert result.notes == ("1 of 2 faces are degenerate and draw nothing",)
    assert result.display_list.triangles == 1


@pytest.mark.parametrize("scale", [1e-25, 1e-6, 1e6, 1e29])
def test_units_do_not_matter(scale):
    small = display_list_of_mesh(Mesh(VERTICES, FACES), PictureFormat())
    power = 2.0 ** round(np.log2(scale))
    assert same(display_list_of_mesh(Mesh(VERTICES * power, FACES), PictureFormat()), small)
    assert not Mesh(VERTICES * scale, FACES).degenerate().any()


# ---- normals


def test_normals_do_not_depend_on_shared_vertices():
    box = trimesh.creation.icosphere(subdivisions=2)
    mesh = Mesh(np.array(box.vertices), np.array(box.faces, np.int64))
    apart = Mesh(mesh.corners().reshape(-1, 3), np.arange(3 * mesh.triangles).reshape(-1, 3))
    assert np.array_equal(corner_normals(mesh), corner_normals(apart))
    outward = mesh.corners() / np.linalg.norm(mesh.corners(), axis=2, keepdims=True)
    assert np.allclose(corner_normals(mesh), outward, atol=0.02)


def test_edges_stay_sharp_and_facets_flat():
    box = trimesh.creation.box()
    mesh = Mesh(np.array(box.vertices), np.array(box.faces, np.int64))
    of_face = np.repeat(face_normals(mesh)[:, None], 3, axis=1)
    assert np.allclose(corner_normals(mesh), of_face)
    ball = trimesh.creation.icosphere(subdivisions=1)
    smooth = Mesh(np.array(ball.vertices), np.array(ball.faces, np.int64))
    faceted = dataclasses.replace(smooth, smooth=False)
    of_face = np.repeat(face_normals(smooth)[:, None], 3, axis=1)
    assert np.array_equal(corner_normals(faceted), of_face)
    assert not np.allclose(corner_normals(smooth), of_face, atol=0.1)


@pytest.mark.parametrize("corner", range(3))
def test_the_normal_of_a_corner_is_the_mean_by_the_angles_there(corner):
    """Of a face with 90 degrees and one with 30, at either end of the fold between them."""
    cosine, sine = np.sqrt(3) / 2, 0.5
    across = np.array([0, cosine, sine])  # from the fold, along x, up the second face
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, -1, 0], [cosine, *(sine * across[1:])]])
    faces = np.array([np.roll([0, 2, 1], corner), np.roll([0, 1, 3], corner)])
    level, raised = [0.0, 0.0, 1.0], [0.0, -sine, cosine]
    assert np.allclose(face_normals(Mesh(vertices, faces)), [level, raised])
    wanted = 90 * np.array(level) + 30 * np.array(raised)
    found = corner_normals(Mesh(vertices, faces))[[0, 1], [corner, corner]]
    assert np.allclose(found, wanted / np.linalg.norm(wanted))


# ---- what is left out


def test_what_is_left_out_is_a_warning_of_the_display_list(tmp_path):
    (tmp_path / "a.obj").write_bytes(obj(faces="f 1 2 3\nf 1 1 2\nl 1 2\n"))
    assert make_display_list(tmp_path / "a.obj").notes == (
        "1 element of lines is left out: only faces are drawn",
        "1 of 2 faces are degenerate and draw nothing")


def test_nothing_but_what_is_left_out(tmp_path, capfd):
    (tmp_path / "a.obj").write_bytes(obj(faces="l 1 2\n"))
    assert complain(tmp_path / "a.obj", capfd) == (
        "faces: there are none (1 element of lines is left out: only faces are drawn); export the "
        "mesh with its triangles")
