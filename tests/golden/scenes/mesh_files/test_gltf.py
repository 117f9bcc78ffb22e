"""glTF: primitives, accessors, nodes, colours, buffers, and what a document demands."""

import struct

import numpy as np
import pytest
from mesh_texts import FACES, VERTICES, Gltf, tetrahedron

from cardcage.golden.scenes.mesh import BASE_COLOR
from cardcage.golden.scenes.mesh_files.load_mesh import load_mesh
from cardcage.golden.specification.errors import InputError

CORNERS = VERTICES[FACES].astype(np.float64)


def load(tmp_path, made, name="a.glb"):
    path = tmp_path / name
    data = made if isinstance(made, bytes) else made.glb() if name == "a.glb" else made.gltf()
    path.write_bytes(data)
    return load_mesh(path)


def refusal(tmp_path, made, name="a.glb"):
    with pytest.raises(InputError) as caught:
        load(tmp_path, made, name)
    message = str(caught.value)
    assert "\n" not in message
    return message.removeprefix(f"{tmp_path / name}: ")


# ---- primitives


@pytest.mark.parametrize("mode, indices, faces", [
    (4, [0, 1, 2, 0, 2, 3], [[0, 1, 2], [0, 2, 3]]),
    (5, [0, 1, 2, 3], [[0, 1, 2], [2, 1, 3]]),
    (5, [0, 1, 2, 2, 3, 1], [[0, 1, 2], [3, 2, 1]]),
    (6, [0, 1, 2, 3], [[0, 1, 2], [0, 2, 3]]),
    (5, None, [[0, 1, 2], [2, 1, 3]]),
    (6, None, [[0, 1, 2], [0, 2, 3]]),
])
def test_modes_of_triangles(tmp_path, mode, indices, faces):
    made = Gltf()
    made.primitive(indices=indices, mode=mode)
    mesh = load(tmp_path, made)
    turned = [sorted((f[i:] + f[:i]) for i in range(3))[0] for f in mesh.faces.tolist()]
    assert turned == [sorted((f[i:] + f[:i]) for i in range(3))[0] for f in faces]
    assert mesh.notes == ()


@pytest.mark.parametrize("mode, what", [(0, "points"), (1, "lines"), (2, "line loops"),
                                        (3, "line strips")])
def test_points_and_lines_are_left_out_with_one_line(tmp_path, mode, what):
    made = tetrahedron()
    made.primitive(mode=mode)
    mesh = load(tmp_path, made)
    assert np.array_equal(mesh.corners(), CORNERS)
    assert mesh.notes == (f"mesh 0, primitive 1: {what} are left out: only triangles are drawn",)
    only = Gltf()
    only.primitive(mode=mode)
    assert refusal(tmp_path, only).startswith(f"faces: there are none (mesh 0, primitive 0: {what}")


def test_odd_primitives(tmp_path):
    made = tetrahedron()
    made.primitive(indices=[0, 1, 2, 3])
    made.json["meshes"][0]["primitives"].append({"attributes": {}})
    mesh = load(tmp_path, made)
    assert mesh.triangles == 5
    assert mesh.notes == (
        "mesh 0, primitive 1: 1 of 4 corners make no whole triangle and are left out",
        "mesh 0, primitive 2 has no positions and is left out")
    made.primitive(indices=[0, 1, 4])
    assert refusal(tmp_path, made).startswith("faces: a face names vertex 4, but there are 4")
    made.json["meshes"][0]["primitives"][-1]["mode"] = 7
    assert "has mode 7, which glTF does not know" in refusal(tmp_path, made)


# ---- accessors


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2"])
@pytest.mark.parametrize("normalized", [False, True])
def test_integer_positions(tmp_path, dtype, normalized):
    made = Gltf()
    full = np.iinfo(dtype).max
    positions = VERTICES.astype(dtype)
    if normalized:
        positions = (VERTICES / 4 * full).astype(dtype)
        positions[0, 0] = np.iinfo(dtype).min  # -1 for a signed type, although it lies below
    padded = np.zeros((4, 4), dtype)  # rows of a multiple of four bytes
    padded[:, :3] = positions
    stride = 4 * np.dtype(dtype).itemsize
    view = made.view(padded.tobytes(), byteStride=stride)
    index = made.accessor(positions, bufferView=view, normalized=normalized)
    made.primitive(index)
    made.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    expected = positions.astype(float)
    if normalized:
        expected = np.maximum(expected / full, -1.0)
    assert np.array_equal(load(tmp_path, made).vertices, expected)


def test_interleaved_with_offsets(tmp_path):
    made = Gltf()
    rows = np.zeros(4, [("normal", "<f4", 3), ("position", "<f4", 3), ("color", "<u1", 4)])
    rows["position"], rows["color"] = VERTICES, [[255, 51, 0, 255]] * 4
    view = made.view(b"lead" + rows.tobytes(), byteStride=28)
    position = made.accessor(VERTICES, bufferView=view, byteOffset=16)
    color = made.accessor(rows["color"], bufferView=view, byteOffset=28, normalized=True)
    made.primitive(position)["attributes"]["COLOR_0"] = color
    mesh = load(tmp_path, made)
    assert np.array_equal(mesh.corners(), CORNERS) and (mesh.colors == [255, 51, 0]).all()


@pytest.mark.parametrize("base", [True, False])
@pytest.mark.parametrize("where", ["u1", "u2", "u4"])
def test_sparse(tmp_path, base, where):
    made = Gltf()
    start = VERTICES.copy() if base else np.zeros((4, 3), np.float32)
    start[[1, 3]] = 0
    index = made.accessor(start)
    accessor = made.json["accessors"][index]
    if not base:
        del accessor["bufferView"]
    changed = [1, 3] if base else [1, 2, 3]
    accessor["sparse"] = {
        "count": len(changed),
        "indices": {"bufferView": made.view(np.array(changed, where).tobytes()),
                    "componentType": {"u1": 5121, "u2": 5123, "u4": 5125}[where]},
        "values": {"bufferView": made.view(VERTICES[changed].tobytes())},
    }
    made.primitive(index)
    assert np.array_equal(load(tmp_path, made).corners(), CORNERS)
    accessor["sparse"]["indices"]["bufferView"] = made.view(np.array([9] * 3, where).tobytes())
    assert "a sparse value for element 9 of 4" in refusal(tmp_path, made)


def test_of_no_sparse_values_it_does_not_matter_where_they_lie(tmp_path):
    made = Gltf()
    index = made.accessor(VERTICES)
    place = {"bufferView": made.view(b""), "byteOffset": 1 << 20}
    made.json["accessors"][index]["sparse"] = {
        "count": 0, "indices": {**place, "componentType": 5125}, "values": place}
    made.primitive(index)
    assert np.array_equal(load(tmp_path, made).corners(), CORNERS)


def test_accessors_that_leave_their_buffer(tmp_path):
    made = tetrahedron()
    made.json["accessors"][0]["count"] = 5
    assert "accessor 0 needs 60 bytes and its buffer view has 48" in refusal(tmp_path, made)
    made.json["bufferViews"][0]["byteLength"] = 4800
    assert "accessor 0 lies outside of its buffer of 72 bytes" in refusal(tmp_path, made)
    made.json["accessors"][0]["bufferView"] = 7
    assert "bufferViews[7] is named, but there are 2" in refusal(tmp_path, made)
    made.json["accessors"][0]["componentType"] = 1
    assert "accessor 0 is of type VEC3 of 1, which glTF does not know" in refusal(tmp_path, made)


# ---- nodes


def turn_of_y():
    """A quarter turn around y, as glTF writes it: columns first."""
    return [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1]


@pytest.mark.parametrize("more", [{}, {"camera": 0}, {"skin": 0}, {"extras": {}, "name": "x"},
                                  {"extensions": {"KHR_lights_punctual": {"light": 0}}}])
@pytest.mark.parametrize("node, expected", [
    ({"translation": [10, 0, 0]}, np.add(VERTICES, [10, 0, 0])),
    ({"scale": [2, 3, 4]}, VERTICES * [2, 3, 4]),
    ({"rotation": [0, 0.5**0.5, 0, 0.5**0.5]}, VERTICES[:, [2, 1, 0]] * [1, 1, -1]),
    ({"matrix": turn_of_y()}, VERTICES[:, [2, 1, 0]] * [1, 1, -1]),
    ({"translation": [1, 2, 3], "scale": [2, 2, 2], "rotation": [1, 0, 0, 0]},
     VERTICES * [2, -2, -2] + [1, 2, 3]),
])
def test_transforms_whatever_else_a_node_has(tmp_path, node, expected, more):
    made = tetrahedron()
    made.json["nodes"][0] |= node | more
    assert np.allclose(load(tmp_path, made).vertices, expected, atol=1e-12)


def test_parents_instances_and_scenes(tmp_path):
    made = tetrahedron()
    made.json["nodes"] = [
        {"children": [1, 2], "translation": [0, 0, 5]},
        {"mesh": 0, "scale": [2, 2, 2]},
        {"mesh": 0, "camera": 0, "children": [3]},
        {"mesh": 0, "translation": [1, 0, 0]},
        {"mesh": 0},
    ]
    mesh = load(tmp_path, made)
    assert np.array_equal(mesh.vertices, np.concatenate([
        np.add(VERTICES * 2, [0, 0, 5]), np.add(VERTICES, [0, 0, 5]), np.add(VERTICES, [1, 0, 5])]))
    made.json["scenes"].append({"nodes": [4]})
    made.json["scene"] = 1
    mesh = load(tmp_path, made)
    assert np.array_equal(mesh.vertices, VERTICES) and mesh.notes == ("2 scenes: scene 1 is drawn",)
    del made.json["scene"]
    assert load(tmp_path, made).triangles == 12
    del made.json["scenes"]
    assert load(tmp_path, made).triangles == 16


def test_a_mirror_keeps_the_outside_outside(tmp_path):
    made = tetrahedron()
    made.json["nodes"][0]["scale"] = [-1, 1, 1]
    mesh = load(tmp_path, made)
    assert np.array_equal(mesh.corners(), (VERTICES * [-1, 1, 1])[FACES[:, ::-1]])


@pytest.mark.parametrize("nodes, reason", [
    ([{"children": [1]}, {"children": [0]}], "node 0 is reached twice"),
    ([{"children": [0]}], "node 0 is reached twice"),
    ([{"children": [1, 1]}, {"mesh": 0}], "node 1 is reached twice"),
    ([{"children": [3]}], "nodes[3] is named, but there are 1"),
    ([{"mesh": 4}], "meshes[4] is named, but there are 1"),
    ([{"mesh": 0, "matrix": [1, 2]}], "node 0: its matrix is not 16 numbers"),
])
def test_bad_nodes(tmp_path, nodes, reason):
    made = tetrahedron()
    made.json["nodes"] = nodes
    assert reason in refusal(tmp_path, made)


def test_a_circle_without_a_scene(tmp_path):
    made = tetrahedron()
    del made.json["scene"], made.json["scenes"]
    made.json["nodes"] = [{"children": [1]}, {"children": [0], "mesh": 0}]
    assert "round in a circle" in refusal(tmp_path, made)


def test_a_deep_chain_of_nodes(tmp_path):
    made = tetrahedron()
    made.json["nodes"] = [{"children": [i + 1], "translation": [1, 0, 0]} for i in range(3000)]
    made.json["nodes"].append({"mesh": 0})
    assert load(tmp_path, made).vertices[0].tolist() == [3000, 0, 0]


def test_what_moves_is_drawn_at_rest_and_said(tmp_path):
    made = tetrahedron()
    made.json["nodes"][0]["skin"] = 0
    made.json["meshes"][0]["weights"] = [0.5]
    assert load(tmp_path, made).notes == (
        "mesh 0 is drawn without its morph targets",
        "1 mesh has a skeleton and is drawn without it")


# ---- colours


@pytest.mark.parametrize("width", [3, 4])
@pytest.mark.parametrize("dtype, scale, more", [
    ("f4", 1, {}), ("u1", 255, {"normalized": True}), ("u2", 65535, {"normalized": True}),
    ("u1", 255, {})])
def test_vertex_colors_times_the_base_color(tmp_path, width, dtype, scale, more):
    shades = np.array([[1, 0.2, 0.4, 1], [0.6, 0.8, 1, 1], [0, 1, 0.2, 0], [1, 1, 1, 1]])
    made = tetrahedron()
    colors = (np.rint(shades * scale) if scale > 1 else shades)[:, :width].astype(dtype)
    primitive = made.json["meshes"][0]["primitives"][0]
    if colors.dtype.itemsize * width % 4:
        padded = np.zeros((4, 4), dtype)
        padded[:, :3] = colors
        more = more | {"bufferView": made.view(padded.tobytes(), byteStride=4 * colors.itemsize)}
    primitive["attributes"]["COLOR_0"] = made.accessor(colors, **more)
    assert np.array_equal(load(tmp_path, made).colors, np.rint(shades[FACES][..., :3] * 255))
    primitive["material"] = 0
    made.json["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.2, 1]}}]
    mesh = load(tmp_path, made)
    assert np.abs(mesh.colors - shades[FACES][..., :3] * [0.5, 1, 0.2] * 255).max() <= 0.5 + 1e-4


def test_parts_with_and_without_colors(tmp_path):
    made = tetrahedron()
    made.json["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.2, 0, 1]}}, {}]
    made.primitive(material=0)
    made.primitive(material=1)
    mesh = load(tmp_path, made)
    assert [mesh.colors[i, 0].tolist() for i in (0, 4, 8)] == [
        list(BASE_COLOR), [255, 51, 0], list(BASE_COLOR)]


# ---- the document and its buffers


@pytest.mark.parametrize("uri, file", [
    ("my%20buffer.bin", "my buffer.bin"), ("my buffer.bin", "my buffer.bin"),
    ("W%C3%BCrfel.bin", "Würfel.bin"), ("100%.bin", "100%.bin"), ("a%20b.bin", "a%20b.bin"),
    ("sub/./a.bin", "sub/a.bin")])
def test_buffers_beside_the_document(tmp_path, uri, file):
    made = tetrahedron()
    (tmp_path / "sub").mkdir()
    (tmp_path / file).write_bytes(made.binary + b"\0\0")
    assert np.array_equal(load(tmp_path, made.gltf(uri), "a.gltf").corners(), CORNERS)


@pytest.mark.parametrize("uri, reason", [
    ("gone.bin", "contents: buffer 'gone.bin' is missing: no such file"),
    ("https://example.com/a.bin", "contents: buffer 'https://example.com/a.bin' is not a file"),
    ("data:,abc", "contents: buffer 0 has 3 of the 72 bytes"),
    ("data:;base64,ab!c", "contents: buffer 0: no base64"),
    (".", "contents: buffer '.' cannot be read"),
])
def test_buffers_that_cannot_be_read(tmp_path, uri, reason):
    assert refusal(tmp_path, tetrahedron().gltf(uri), "a.gltf").startswith(reason)


@pytest.mark.parametrize("change", [
    lambda data: b"\xef\xbb\xbf" + data,
    lambda data: "\ufeff".encode("utf-16-le") + data.decode().encode("utf-16-le"),
    lambda data: data.replace(b", ", b",\r\n\t"),
    lambda data: data.replace(b"data:application/octet-stream", b"data:any/thing;charset=x"),
])
def test_spellings_of_the_document(tmp_path, change):
    assert np.array_equal(load(tmp_path, change(tetrahedron().gltf()), "a.gltf").corners(), CORNERS)


def test_the_content_decides_and_not_the_name(tmp_path):
    assert load(tmp_path, tetrahedron().glb(), "a.gltf").triangles == 4
    assert load(tmp_path, tetrahedron().gltf(), "a.glb").triangles == 4


def test_extensions_that_are_required(tmp_path):
    made = tetrahedron()
    made.json["extensionsRequired"] = ["KHR_materials_unlit", "KHR_mesh_quantization",
                                       "KHR_texture_transform"]
    assert load(tmp_path, made).triangles == 4
    for name in ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "VENDOR_new"):
        made.json["extensionsRequired"] = ["KHR_materials_unlit", name]
        assert refusal(tmp_path, made).startswith(f"contents: requires {name}, which cannot be")
    made.json["extensionsUsed"] = made.json.pop("extensionsRequired")
    assert load(tmp_path, made).triangles == 4


def test_chunks_of_a_glb(tmp_path):
    data = tetrahedron().glb()
    extra = data + struct.pack("<I4s", 4, b"MORE") + b"abcd"
    whole = data[:8] + struct.pack("<I", len(extra)) + extra[12:]
    assert load(tmp_path, whole).triangles == 4
    assert load(tmp_path, data + b"\n").triangles == 4
    assert refusal(tmp_path, extra).startswith("contents: 12 bytes after the")
    assert refusal(tmp_path, data[:-4]).startswith(
        f"contents: {len(data)} bytes are announced and {len(data) - 4} are there")
    short = data[:8] + struct.pack("<I", len(data) - 4) + data[12:-4]
    assert "a chunk of 72 bytes in the 68 that are left" in refusal(tmp_path, short)
    assert "version 1" in refusal(tmp_path, data[:4] + b"\1\0\0\0" + data[8:])
    assert refusal(tmp_path, data.replace(b"JSON", b"JSOX", 1)).startswith(
        "contents: a .glb without JSON")


@pytest.mark.parametrize("text, reason", [
    (b"[]", "contents: not a glTF"),
    (b'{"asset": {"version": "1.0"}}', "contents: glTF 1.0; export it as glTF 2.0"),
    (b'{"asset": {"version": "2.0"}', "contents: not a readable glTF"),
    (b'{"asset": {"version": "2.0"}, "nodes": 3}', "contents: 'nodes' is no array"),
    (b"[" * 100_000, "contents: not a readable glTF"),
])
def test_documents_that_are_none(tmp_path, text, reason):
    assert refusal(tmp_path, text, "a.gltf").startswith(reason)
