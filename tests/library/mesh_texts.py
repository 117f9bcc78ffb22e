"""Mesh files for tests: a tetrahedron in every format, and glTF documents from arrays."""

import base64
import json
import struct

import numpy as np

VERTICES = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 4]], np.float32)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])

OBJ = "".join(f"v {x:g} {y:g} {z:g}\n" for x, y, z in VERTICES.tolist()) + "".join(
    f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES.tolist())

_COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Gltf:
    """A glTF document that grows array by array; change ``json`` as a test needs it."""

    def __init__(self):
        self.binary = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                     "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}], "accessors": [],
                     "bufferViews": []}

    def view(self, data, **more):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more})
        self.binary += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, array, **more):
        array = np.asarray(array)
        accessor = {"componentType": _COMPONENTS[array.dtype.str[1:]], "count": len(array),
                    "type": _TYPES[1 if array.ndim == 1 else array.shape[1]]}
        if "bufferView" not in more:
            accessor["bufferView"] = self.view(array.tobytes())
        self.json["accessors"].append({**accessor, **more})
        return len(self.json["accessors"]) - 1

    def primitive(self, positions=VERTICES, indices=FACES, mesh=0, **more):
        """One primitive; ``indices`` None: the vertices in turn."""
        primitive = {"attributes": {"POSITION": positions if isinstance(positions, int)
                                    else self.accessor(positions)}, **more}
        if indices is not None:
            primitive["indices"] = self.accessor(np.ravel(indices).astype("u2"))
        self.json["meshes"][mesh]["primitives"].append(primitive)
        return primitive

    def glb(self):
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        chunks = (struct.pack("<I4s", len(text), b"JSON") + text
                  + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def gltf(self, uri=None):
        data = "data:application/octet-stream;base64," + base64.b64encode(self.binary).decode()
        self.json["buffers"] = [{"byteLength": len(self.binary), "uri": uri or data}]
        return json.dumps(self.json).encode()


def tetrahedron():
    """A ``Gltf`` of the tetrahedron."""
    made = Gltf()
    made.primitive()
    return made


def ply(kind="ascii", vertices=VERTICES, faces=FACES, *, list_type=("uchar", "int"),
        vertex_type="float", colors=None, color_type="uchar", extra=("", b""),
        name="vertex_indices", end="\n"):
    """A PLY file of any lists of vertex numbers; ``extra``: header and body of another element."""
    numpy_types = {"uchar": "u1", "char": "i1", "short": "i2", "ushort": "u2", "int": "i4",
                   "uint": "u4", "float": "f4", "double": "f8"}
    head = ["ply", f"format {kind} 1.0", "comment made for a test",
            f"element vertex {len(vertices)}",
            *(f"property {vertex_type} {axis}" for axis in "xyz")]
    if colors is not None:
        head += [f"property {color_type} {channel}" for channel in ("red", "green", "blue")]
    head += [f"element face {len(faces)}", f"property list {list_type[0]} {list_type[1]} {name}"]
    if extra[0]:
        head.append(extra[0].replace("\n", end))
    header = (end.join(head) + end + "end_header" + end).encode()
    if kind == "ascii":
        more = [[]] * len(vertices) if colors is None else np.asarray(colors).tolist()
        rows = [[*np.asarray(v).tolist(), *more[i]] for i, v in enumerate(vertices)]
        rows += [[len(face), *np.asarray(face).tolist()] for face in faces]
        return header + "".join(" ".join(map(str, row)) + end for row in rows).encode() + extra[1]
    order = "<" if "little" in kind else ">"
    body = b""
    for i, vertex in enumerate(vertices):
        body += np.asarray(vertex, order + numpy_types[vertex_type]).tobytes()
        if colors is not None:
            body += np.asarray(colors[i], order + numpy_types[color_type]).tobytes()
    for face in faces:
        body += np.array([len(face)], order + numpy_types[list_type[0]]).tobytes()
        body += np.asarray(face, order + numpy_types[list_type[1]]).tobytes()
    return header + body + extra[1]


def stl_text(name="part", faces=FACES, number="{:.6e}"):
    """One solid of a text STL."""
    lines = [f"solid {name}"]
    for face in faces:
        lines += [" facet normal 0 0 0", "  outer loop"]
        lines += ["   vertex " + " ".join(number.format(x) for x in VERTICES[i].tolist())
                  for i in face]
        lines += ["  endloop", " endfacet"]
    return "\n".join([*lines, f"endsolid {name}"]) + "\n"


def stl_binary(announced=None, header=b"made for a test", faces=FACES, tail=b""):
    body = b"".join(np.concatenate([np.zeros(3), VERTICES[face].ravel()]).astype("<f4").tobytes()
                    + b"\0\0" for face in faces)
    count = len(faces) if announced is None else announced
    return header.ljust(80, b" ") + struct.pack("<I", count) + body + tail
