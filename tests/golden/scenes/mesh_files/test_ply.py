"""PLY: text and both byte orders, any list and number types, strips, colours."""

import numpy as np
import pytest
from mesh_texts import FACES, VERTICES, ply

from cardcage.golden.scenes.mesh_files.load_mesh import load_mesh
from cardcage.golden.specification.errors import InputError

CORNERS = VERTICES[FACES].astype(np.float64)
KINDS = ("ascii", "binary_little_endian", "binary_big_endian")
COLORS = np.array([[255, 0, 51], [0, 255, 102], [102, 51, 255], [204, 204, 204]])


def load(tmp_path, data):
    path = tmp_path / "a.ply"
    path.write_bytes(data)
    return load_mesh(path)


def refusal(tmp_path, data):
    with pytest.raises(InputError) as caught:
        load(tmp_path, data)
    return str(caught.value).removeprefix(f"{tmp_path / 'a.ply'}: ")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("list_type, vertex_type, name", [
    (("uchar", "int"), "float", "vertex_indices"),
    (("uchar", "uint"), "double", "vertex_index"),
    (("int", "uchar"), "short", "vertex_indices"),
    (("ushort", "short"), "float", "vertex_index"),
    (("char", "ushort"), "int", "vertex_indices"),
])
def test_the_same_tetrahedron(tmp_path, kind, list_type, vertex_type, name):
    vertices = VERTICES if vertex_type in ("float", "double") else VERTICES.astype(int)
    data = ply(kind, vertices, list_type=list_type, vertex_type=vertex_type, name=name)
    mesh = load(tmp_path, data)
    assert np.array_equal(mesh.corners(), CORNERS) and mesh.notes == () and mesh.colors is None
    assert np.array_equal(load(tmp_path, data + b"\n").corners(), CORNERS)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_ends_of_lines_and_marks(tmp_path, kind, end):
    data = ply(kind, end=end)
    assert np.array_equal(load(tmp_path, data).corners(), CORNERS)
    assert np.array_equal(load(tmp_path, b"\xef\xbb\xbf" + data).corners(), CORNERS)
    textured = data.replace(b"comment made for a test", b"comment TextureFile missing \xfc.png")
    assert load(tmp_path, textured).notes == ()
    if kind == "ascii":
        wide = "\ufeff".encode("utf-16-le") + data.decode().encode("utf-16-le")
        assert np.array_equal(load(tmp_path, wide).corners(), CORNERS)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("count", ["uchar", "int"])
def test_triangles_and_polygons_mixed(tmp_path, kind, count):
    vertices = [(0, 0, 0), (3, 0, 0), (3, 1, 0), (1, 1, 0), (1, 3, 0), (0, 3, 0)]
    faces = [[0, 1, 2], [0, 2, 3, 5], [0, 1, 2, 3, 4, 5], [3, 4, 5]]
    mesh = load(tmp_path, ply(kind, vertices, faces, list_type=(count, "int")))
    assert mesh.triangles == 1 + 2 + 4 + 1
    areas = np.cross(*np.moveaxis(mesh.corners()[:, 1:] - mesh.corners()[:, :1], 1, 0))[:, 2] / 2
    assert areas[3:7].sum() == 5.0 and (areas > 0).all()
    assert mesh.faces[0].tolist() == [0, 1, 2] and mesh.faces[-1].tolist() == [3, 4, 5]


@pytest.mark.parametrize("kind", KINDS)
def test_edges_and_other_elements_are_passed_over(tmp_path, kind):
    order = ">" if "big" in kind else "<"
    body = (b"0 1\n1 2\n" if kind == "ascii" else np.array([0, 1, 1, 2], order + "i4").tobytes())
    header = "element edge 2\nproperty int vertex1\nproperty int vertex2"
    mesh = load(tmp_path, ply(kind, extra=(header, body)))
    assert np.array_equal(mesh.corners(), CORNERS)
    assert mesh.notes == ("2 edges are left out: only faces are drawn",)
    body = (b"2 5 6 0.5\n0 1.5\n" if kind == "ascii" else
            b"\2" + np.array([5, 6], order + "i2").tobytes()
            + np.array([0.5], order + "f4").tobytes()
            + b"\0" + np.array([1.5], order + "f4").tobytes())
    header = "element other 2\nproperty list uchar short numbers\nproperty float weight"
    mesh = load(tmp_path, ply(kind, extra=(header, body)))
    assert np.array_equal(mesh.corners(), CORNERS) and mesh.notes == ()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("strip_type", ["int", "uint"])
def test_triangle_strips(tmp_path, kind, strip_type):
    order = ">" if "big" in kind else "<"
    # Two strips with a restart between, a strip with a repeated vertex, one that is too short.
    strips = [[0, 1, 2, 3, -1, 3, 2, 1], [0, 1, 2, 2, 3, 0], [0, 1]]
    if kind == "ascii":
        shown = 4294967295 if strip_type == "uint" else -1
        body = "".join(f"{len(s)} {' '.join(str(shown if i == -1 else i) for i in s)}\n"
                       for s in strips).encode()
    else:
        body = b"".join(np.array([len(s)], order + "i4").tobytes()
                        + np.array(s, order + "i4").tobytes() for s in strips)
    header = f"element tristrips 3\nproperty list int {strip_type} vertex_indices"
    mesh = load(tmp_path, ply(kind, faces=[], extra=(header, body)))
    # In the second strip (1, 2, 2), (2, 2, 3) lead on; the triangle after them is an even one.
    assert mesh.faces.tolist() == [[0, 1, 2], [2, 1, 3], [3, 2, 1], [0, 1, 2], [3, 2, 0]]
    assert mesh.notes == ()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("color_type, scale", [
    ("uchar", 1), ("char", 1), ("short", 1), ("ushort", 257), ("int", 1), ("uint", 1),
    ("uint", 16843009), ("float", 1 / 255), ("double", 1 / 255), ("float", 1)])
def test_colors_of_any_width(tmp_path, kind, color_type, scale):
    colors = COLORS * scale
    if color_type == "char":
        colors = colors.astype(np.uint8).view(np.int8)
    elif color_type not in ("float", "double"):
        colors = colors.astype(np.int64)
    mesh = load(tmp_path, ply(kind, colors=colors, color_type=color_type))
    assert np.array_equal(mesh.colors, COLORS[FACES])


def test_vertex_colors_times_face_colors(tmp_path):
    properties = "".join(f"property float {name}\n" for name in ("red", "green", "blue"))
    data = ply(colors=COLORS).decode().replace(
        "vertex_indices\n", f"vertex_indices\n{properties}").splitlines()
    data = "\n".join([*data[:-4], *(line + " 0.2 1 0.5" for line in data[-4:])]) + "\n"
    expected = np.rint(COLORS[FACES] * [0.2, 1, 0.5])
    assert np.array_equal(load(tmp_path, data.encode()).colors, expected)


PLAIN = ply()
LINE = PLAIN.count(b"\n", 0, PLAIN.index(b"end_header")) + 2  # that of the first vertex


@pytest.mark.parametrize("data, reason", [
    (PLAIN.replace(b"3 0 2 1\n", b""), "contents: 4 rows of 'face' are announced and 3 are there"),
    (PLAIN.replace(b"element face 4", b"element face 3"), f"contents: line {LINE + 7} after"),
    (PLAIN.replace(b"3 0 2 1", b"3 0 2"), f"contents: line {LINE + 4}: 3 numbers do not"),
    (PLAIN.replace(b"3 0 2 1", b"3 0 2 1 0"), f"contents: line {LINE + 4}: 5 numbers do not make"),
    (PLAIN.replace(b"3 0 2 1", b"-1 0 2 1"), f"contents: line {LINE + 4}: 4 numbers do not make"),
    (PLAIN.replace(b"3 0 2 1", b"3 0 2 x"), f"contents: line {LINE + 4}: cannot read '3 0 2 x'"),
    (PLAIN.replace(b"2.0 0.0 0.0", b"2.0 0.0 0,0"), f"contents: line {LINE + 1}: cannot read"),
    (PLAIN.replace(b"3 0 2 1", b"3 0 2\x011"), f"contents: line {LINE + 4}: cannot read"),
    (PLAIN.replace(b"3 0 2 1", b"3 0 2 4"), "faces: a face names vertex 4, but there are 4"),
    (PLAIN.replace(b"3 0 2 1", b"3 0 2 -1"), "faces: a face names vertex -1, but"),
    (PLAIN.replace(b"property float y", b"property float t"), "contents: vertices have no prop"),
    (PLAIN.replace(b"property float y", b"property quad y"), "contents: line 6: cannot read"),
    (PLAIN.replace(b"vertex_indices", b"corners"), "faces: element 'face' has no list"),
    (PLAIN.replace(b"format ascii", b"format binary_middle"), "contents: line 2: cannot read"),
    (PLAIN.replace(b"element vertex 4", b"element vertex many"), "contents: line 4: cannot read"),
    (PLAIN[:60], "contents: the header has no end"),
    (PLAIN[1:], "contents: does not begin with 'ply'"),
    (ply("binary_little_endian", faces=[[0, 1, 2], [0, 1, 2, 3]])[:-1],
     "contents: 2 rows of 'face' are announced and 1 are there"),
    (ply("binary_little_endian")[:-1], "contents: 4 rows of 'face' are announced and 3 are there"),
    (ply("binary_big_endian", list_type=("int", "int"))[:-30], "contents: 4 rows of 'face' are"),
    (ply("binary_little_endian") + b"more", "contents: 4 bytes after the last row"),
])
def test_refused_with_a_reason(tmp_path, data, reason):
    assert data != PLAIN
    assert refusal(tmp_path, data).startswith(reason)
