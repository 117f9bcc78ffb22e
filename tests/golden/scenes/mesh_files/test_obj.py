"""OBJ as people and programs write it: white space, comments, indices, materials, colours."""

import os

import numpy as np
import pytest
from mesh_texts import FACES, OBJ, VERTICES

from cardcage.golden.scenes.mesh import BASE_COLOR
from cardcage.golden.scenes.mesh_files.load_mesh import load_mesh
from cardcage.golden.scenes.mesh_files.text_lines import STRETCH
from cardcage.golden.specification.errors import InputError

CORNERS = VERTICES[FACES].astype(np.float64)


def load(tmp_path, data, name="a.obj"):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return load_mesh(path)


def refusal(tmp_path, data):
    with pytest.raises(InputError) as caught:
        load(tmp_path, data)
    message = str(caught.value)
    assert "\n" not in message
    return message.removeprefix(f"{tmp_path / 'a.obj'}: ")


def each_line(change):
    return "".join(change(line) + "\n" for line in OBJ.splitlines())


@pytest.mark.parametrize("text", [
    OBJ.replace(" ", "\t"),
    OBJ.replace(" ", "  \t "),
    each_line(lambda line: "  " + line),
    each_line(lambda line: "\t" + line + " \t"),
    each_line(lambda line: line + " # side"),
    each_line(lambda line: line + "# f 1 2 3"),
    each_line(lambda line: line + "\n# v 9 9 9\n   # f 1 1 1\n"),
    OBJ.replace("v 2 0 0", "v 2 0 0 # tip"),
    OBJ.replace("f 2 3 4", "f 2 \\\n3 4"),
    OBJ.replace("f 2 3 4", "f 2 \\ \n3 4"),
    OBJ.replace("f 2 3 4", "f \\\t \n 2 3\\\n  4"),
    OBJ.replace("v 2 0 0", "v \\\n2\\\n 0 \\ \n0"),
    "# C:\\models\\\n" + OBJ,
    OBJ.replace("f 2 3 4", "f 2 3 4 # D:\\"),
    OBJ.replace("\n", "\r\n"),
    OBJ.replace("\n", "\r"),
    OBJ.replace("f 2 3 4", "f 2 \\\n3 4").replace("\n", "\r\n"),
    OBJ.replace("\n", "\n\n \n"),
    "\ufeff" + OBJ,
    "\ufeff".encode("utf-16-le") + OBJ.encode("utf-16-le"),
    "\ufeff".encode("utf-16-be") + OBJ.encode("utf-16-be"),
    "# Würfel\n".encode("latin-1") + OBJ.encode() + b"o \xff\xfe\n",
    OBJ.replace("f 1 3 2", "f 1/1 3/2 2/3").replace("f 1 2 4", "f 1//1 2//1 4//1"),
    OBJ.replace("f 1 3 2", "f 1/1/1 3/2/1 2/3/1").replace("f 2 3 4", "f 2/ 3/ 4/"),
    OBJ.replace("f 1 3 2", "f -4 -2 -3"),
    OBJ.replace("f 1 3 2", "f -4 3 -3"),
    OBJ.replace("f 1 3 2", "f -4//-1 -2//-1 -3//-1"),
    OBJ.replace("f 1 3 2", "f -4/-1/-1 -2/7/-1 -3/-2/-1"),
    "v 0 0 0\nv 2 0 0\nv 0 3 0\nf -3 -1 -2\nv 0 0 4\nf -4 -3 -1\nf 2 3 4\nf 1 4 3\n",
    "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nv 0 0 4\n",
    OBJ.replace("v 2 0 0", "v 2 0 0 1.0"),
    OBJ.replace("v 2 0 0", "v +2.0e0 -0. .0"),
    "vt 0 0\nvn 0 0 1\nvp 1\no part\ng a b\ns off\n" + OBJ,
])
def test_the_same_tetrahedron(tmp_path, text):
    mesh = load(tmp_path, text)
    assert np.array_equal(mesh.corners(), CORNERS)
    assert mesh.colors is None and mesh.notes == ()


@pytest.mark.parametrize("text, reason", [
    (OBJ.replace("f 2 3 4", "f 0 3 4"), "faces: line 7: names vertex 0, but OBJ counts"),
    (OBJ.replace("f 2 3 4", "f 2/1 0/1 4/1"), "faces: line 7: names vertex 0, "),
    (OBJ.replace("v 2 0 0", "v 2 \\\n 0 0").replace("f 2 3 4", "f 0 3 4"), "faces: line 8: "),
    (OBJ.replace("f 2 3 4", "f 2 3 5"), "faces: line 7: names vertex 5, but there are 4 vertices"),
    (OBJ.replace("f 2 3 4", "f 2 3 -5"),
     "faces: line 7: names vertex -5, but there are 4 vertices before it"),
    (OBJ.replace("f 2 3 4", "f 2 3 x"),
     "contents: line 7: cannot read the vertex numbers in '2 3 x'"),
    (OBJ.replace("f 2 3 4", "f 2 3.5 4"), "contents: line 7: cannot read the vertex numbers"),
    (OBJ.replace("f 2 3 4", "f /1 3 4"), "contents: line 7: cannot read the vertex numbers"),
    (OBJ.replace("v 2 0 0", "v 2 0,5 0"),
     "contents: line 2: cannot read the coordinates in '2 0,5 0'"),
    (OBJ.replace("v 2 0 0", "v 2 1-1 0 0"), "contents: line 2: cannot read the coordinates"),
    (OBJ.replace("v 2 0 0", "v 2 0"), "contents: line 2: a vertex of 2 numbers"),
    (OBJ.replace("v 2 0 0", "v 2 0 0 1 1"), "contents: line 2: a vertex of 5 numbers"),
    (OBJ.encode() + b"\0\0\0", "contents: line 9: a zero byte"),
    ("\ufeff".encode("utf-16-le") + OBJ.encode("utf-16-le")[:-1], "contents: UTF-16 text that"),
    (OBJ.encode("utf-16-le"), "contents: line 1: a zero byte in a text"),
])
def test_refused_with_the_line(tmp_path, text, reason):
    assert refusal(tmp_path, text).startswith(reason)


def test_a_far_line_is_named_and_stretches_leave_no_seam(tmp_path):
    count = 3 * STRETCH // 40
    text = "".join(f"v {i} {i % 5}.25 0\n# {i}\n" for i in range(count))
    text += "".join(f"f {i + 1} {i + 2} -1\n" for i in range(count - 2))
    mesh = load(tmp_path, text)
    index = np.arange(count)
    assert np.array_equal(mesh.vertices, np.stack([index, index % 5 + 0.25, 0 * index], axis=1))
    assert np.array_equal(mesh.faces, np.stack(
        [index[:-2], index[1:-1], np.full(count - 2, count - 1)], axis=1))
    message = refusal(tmp_path, text + f"f 1 2 {count + 1}\n")
    assert message.startswith(f"faces: line {3 * count - 1}: names vertex {count + 1}, ")


@pytest.mark.parametrize("line, note", [
    ("l 1 2 3", "1 element of lines is left out: only faces are drawn"),
    ("p 1\np 2", "2 elements of points are left out: only faces are drawn"),
    ("surf 0 1 0 1 1 2", "1 element of surfaces is left out: only faces are drawn"),
    ("F 1 2 3", "1 line is left out: line 9 starts with 'F', which OBJ does not know"),
    ("f 1 2", "1 of 5 faces has fewer than three corners and is left out"),
    ("f", "1 of 5 faces has fewer than three corners and is left out"),
])
def test_left_out_with_one_line(tmp_path, line, note):
    mesh = load(tmp_path, OBJ + line + "\n")
    assert np.array_equal(mesh.corners(), CORNERS) and mesh.notes == (note,)


# ---- colours


def test_vertex_colors_times_those_of_materials(tmp_path):
    (tmp_path / "a.mtl").write_text("newmtl half\nKd 0.5 1 1\nnewmtl none\nNs 3\n")
    colored = each_line(lambda line: line + " 1 0.6 0.2" if line[0] == "v" else line)
    materials = "mtllib a.mtl\n" + colored.replace("f 1 2 4", "usemtl half\nf 1 2 4").replace(
        "f 2 3 4", "usemtl none\nf 2 3 4")
    plain, half = [255, 153, 51], [128, 153, 51]
    mesh = load(tmp_path, materials)
    assert mesh.colors[:, 0].tolist() == [plain, half, plain, plain]
    assert load(tmp_path, colored).colors[0, 0].tolist() == plain
    # Bytes, as some scanners write them, and a vertex that has none.
    scanned = each_line(lambda line: line + " 255 153 51" if line == "v 0 0 0" else line)
    assert load(tmp_path, scanned).colors[0].tolist() == [plain, list(BASE_COLOR), list(BASE_COLOR)]


@pytest.mark.parametrize("library, use", [
    ("mtllib a.mtl b.mtl", "usemtl red"),
    ("mtllib a.mtl\nmtllib b.mtl", "usemtl red"),
    ("mtllib b.mtl # both\nmtllib a.mtl", "usemtl red # the red one"),
    ("\tmtllib\t a.mtl \\\n b.mtl", " usemtl\tred"),
    ("mtllib in the folder.mtl", "usemtl red"),
    ("mtllib sub\\c.mtl", "usemtl red"),
    ("mtllib a.mtl b.mtl gone.mtl", "usemtl red"),
    ("mtllib b.mtl", "usemtl Material #25"),
])
def test_material_libraries(tmp_path, library, use):
    red = ("\ufeffnewmtl Material #25\r\nKd 1 0 0\r\nnewmtl Material #26\n Kd 0 1 0\n"
           "newmtl red\n\tKd 1 0 0 # r\n")
    (tmp_path / "a.mtl").write_text("newmtl blue\nKd 0 0 1\n")
    (tmp_path / "sub").mkdir()
    for name in ("b.mtl", "in the folder.mtl", "sub/c.mtl"):
        (tmp_path / name).write_text(red)
    mesh = load(tmp_path, f"{library}\n{use}\n{OBJ}")
    assert (mesh.colors == [255, 0, 0]).all()
    gone = ("material library 'gone.mtl': no such file; faces of its materials have the base "
            "colour",)
    assert mesh.notes == (gone if "gone" in library else ())


def test_materials_that_are_missing(tmp_path):
    mesh = load(tmp_path, "mtllib gone.mtl\nusemtl red\n" + OBJ)
    assert mesh.colors is None
    assert mesh.notes == ("material library 'gone.mtl': no such file; faces of its materials have "
                          "the base colour",)
    (tmp_path / "a.mtl").write_text(
        "newmtl blue\nKd 0 0 1\nnewmtl bad\nKd 1 2\nnewmtl gray\nKd 0.2\n")
    mesh = load(tmp_path, OBJ.replace("f 1 3 2", "mtllib a.mtl\nusemtl red\nf 1 3 2").replace(
        "f 2 3 4", "usemtl blue\nf 2 3 4").replace("f 1 4 3", "usemtl gray\nf 1 4 3"))
    assert mesh.colors[:, 0].tolist() == [list(BASE_COLOR)] * 2 + [[0, 0, 255], [51, 51, 51]]
    assert mesh.notes == (
        "material library 'a.mtl': line 4: Kd is not a colour of three numbers and is left out",
        "1 material is in no library: 'red'; its faces have the base colour",
    )


def test_names_that_are_not_utf8(tmp_path):
    name = b"W\xfcrfel"
    (tmp_path / os.fsdecode(name + b".mtl")).write_bytes(b"newmtl " + name + b"\nKd 0 1 0\n")
    data = b"mtllib " + name + b".mtl\nusemtl " + name + b"\n" + OBJ.encode()
    mesh = load(tmp_path, data, os.fsdecode(name + b".obj"))
    assert (mesh.colors == [0, 255, 0]).all() and mesh.notes == ()
