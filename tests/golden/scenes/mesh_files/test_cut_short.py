"""A file that is cut anywhere is refused, or a line says so; and nothing else is printed."""

import numpy as np
import pytest
from mesh_texts import FACES, OBJ, VERTICES, ply, stl_binary, stl_text, tetrahedron

from cardcage.golden.scenes.mesh_files.load_mesh import load_mesh
from cardcage.golden.specification.errors import InputError

MIXED = [[0, 2, 1], [0, 1, 3, 2], [1, 2, 3]]
COLORS = np.array([[250, 10, 20], [30, 240, 50], [60, 70, 230], [90, 100, 110]])


def colored_glb():
    made = tetrahedron()
    primitive = made.json["meshes"][0]["primitives"][0]
    primitive["attributes"]["COLOR_0"] = made.accessor((COLORS / 255).astype("f4"))
    made.json["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1]}}]
    primitive["material"] = 0
    return made


FILES = {
    "plain.obj": OBJ.encode(),
    "long.obj": "".join(f"v {i} {i * i % 7} {i % 3}\n" for i in range(60)).encode()
    + "".join(f"f {i + 1}//{i + 1} {i + 2}//{i} {i + 3}//1\n" for i in range(58)).encode(),
    "text.ply": ply(colors=COLORS),
    "mixed.ply": ply(faces=MIXED),
    "little.ply": ply("binary_little_endian", colors=COLORS),
    "big.ply": ply("binary_big_endian", faces=MIXED),
    "edges.ply": ply(extra=("element edge 1\nproperty int vertex1\nproperty int vertex2",
                            b"0 1\n")),
    "text.stl": stl_text().encode(),
    "two.stl": (stl_text("first part", FACES[:2]) + stl_text("second part", FACES[2:])).encode(),
    "binary.stl": stl_binary(),
    "binary.glb": colored_glb().glb(),
    "inside.gltf": colored_glb().gltf(),
}


def same(a, b):
    return (np.array_equal(a.vertices, b.vertices) and np.array_equal(a.faces, b.faces)
            and np.array_equal(a.corner_colors(), b.corner_colors()))


@pytest.mark.parametrize("name", FILES)
def test_no_cut_file_passes_for_a_whole_one(tmp_path, capfd, name):
    path = tmp_path / name
    data = FILES[name]
    path.write_bytes(data)
    whole = load_mesh(path)
    assert not [note for note in whole.notes if "cut short" in note]
    refused = 0
    for sixteenth in range(1, 16):
        cut = data[: len(data) * sixteenth // 16]
        path.write_bytes(cut)
        try:
            mesh = load_mesh(path)
        except InputError as error:
            assert "\n" not in str(error) and str(error).startswith(f"{path}: ")
            refused += 1
        else:
            # OBJ has no end: whole lines that use all vertices are an OBJ file.
            complete = name.endswith(".obj") and cut.endswith(b"\n")
            assert same(mesh, whole) or mesh.notes or complete, f"{sixteenth}/16 of {name}"
    assert refused >= 4
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", [name for name in FILES if not name.endswith(".obj")])
def test_a_cut_at_any_byte(tmp_path, name):
    """Formats that announce their end: whole, or refused, or a line says so."""
    path = tmp_path / name
    data = FILES[name]
    path.write_bytes(data)
    whole = load_mesh(path)
    # Behind the first solid of two a text STL is whole as far as anybody can tell.
    between = data.find(b"endsolid first part") + len(b"endsolid first part") if b"first part" in \
        data else -1
    ends = [*range(1, len(data), 11), *range(len(data) - 25, len(data))]
    for end in ends:
        if end in (between, between + 1):
            continue
        path.write_bytes(data[:end])
        try:
            mesh = load_mesh(path)
        except InputError:
            continue
        assert same(mesh, whole) or mesh.notes, f"{end} of {len(data)} bytes without a word"


def test_the_buffer_of_a_gltf_is_cut(tmp_path):
    made = colored_glb()
    (tmp_path / "a.gltf").write_bytes(made.gltf("a.bin"))
    for end in range(0, len(made.binary), 7):
        (tmp_path / "a.bin").write_bytes(made.binary[:end])
        with pytest.raises(InputError, match=rf"'a.bin' has {end} of the {len(made.binary)} bytes"):
            load_mesh(tmp_path / "a.gltf")
    (tmp_path / "a.bin").write_bytes(made.binary)
    assert load_mesh(tmp_path / "a.gltf").triangles == 4


def test_a_material_library_is_cut(tmp_path):
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nusemtl red\n" + OBJ)
    whole = "newmtl red\nKd 0.75 0.5 0.25\n"
    for end in range(1, len(whole)):
        (tmp_path / "a.mtl").write_text(whole[:end])
        mesh = load_mesh(tmp_path / "a.obj")
        # A material without Kd is legal: it may have a texture.
        assert mesh.notes or whole[:end] == "newmtl red\n", f"{whole[:end]!r} without a word"
    (tmp_path / "a.mtl").write_text(whole)
    mesh = load_mesh(tmp_path / "a.obj")
    assert mesh.notes == () and mesh.colors.reshape(-1, 3)[0].tolist() == [191, 128, 64]


def test_an_obj_that_ends_between_two_faces(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("".join(OBJ.splitlines(keepends=True)[:5]))
    assert load_mesh(path).notes == (
        "1 of 4 vertices is in no face: if that is not meant, the file is cut short",)
    path.write_text(OBJ.rstrip("\n"))
    assert load_mesh(path).notes == ("the last line has no end: the file may be cut short",)
    assert len(VERTICES) == 4
