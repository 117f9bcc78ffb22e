"""How long mesh files take to read: ``python -m testbenches.studies.mesh_reading``.

Makes a file of some 100 MB in each format in a temporary folder and reads it with
``load_mesh`` and with every other reader that is installed (none of them is needed by the
project: ``pip install tinyobjloader assimp-py plyfile pyminiply stl-reader numpy-stl pygltflib
meshio trimesh``), each in a process of its own.  Prints processor seconds, of which other
work on the machine takes little.
"""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray

from cardcage.golden.scenes.mesh_files.load_mesh import load_mesh

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]


def grid(side: int) -> Arrays:
    """A wavy surface of ``side`` × ``side`` vertices."""
    i, j = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    height = 0.1 * np.sin(i / 37.0) * np.cos(j / 23.0)
    vertices = np.stack([i / side, j / side, height], axis=-1).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
    faces = np.concatenate([np.stack([first, first + side, first + 1], axis=1),
                            np.stack([first + 1, first + side, first + side + 1], axis=1)])
    return vertices, faces


def write_obj(path: Path, side: int) -> None:
    vertices, faces = grid(side)
    with path.open("wb") as file:
        np.savetxt(file, vertices, "v %.7f %.7f %.7f")
        np.savetxt(file, faces + 1, "f %d %d %d")


def write_obj_with_normals(path: Path, side: int) -> None:
    vertices, faces = grid(side)
    with path.open("wb") as file:
        np.savetxt(file, vertices, "v %.6f %.6f %.6f")
        np.savetxt(file, vertices[:, :2], "vt %.6f %.6f")
        np.savetxt(file, vertices, "vn %.4f %.4f %.4f")
        np.savetxt(file, np.repeat(faces + 1, 3, axis=1), "f %d/%d/%d %d/%d/%d %d/%d/%d")


def write_ply(path: Path, side: int, text: bool) -> None:
    vertices, faces = grid(side)
    kind = "ascii" if text else "binary_little_endian"
    with path.open("wb") as file:
        file.write((f"ply\nformat {kind} 1.0\nelement vertex {len(vertices)}\nproperty float x\n"
                    f"property float y\nproperty float z\nelement face {len(faces)}\n"
                    "property list uchar int vertex_indices\nend_header\n").encode())
        if text:
            np.savetxt(file, vertices, "%.6f")
            np.savetxt(file, np.insert(faces, 0, 3, axis=1), "%d")
        else:
            rows = np.zeros(len(faces), [("count", "u1"), ("vertices", "<i4", 3)])
            rows["count"], rows["vertices"] = 3, faces
            file.write(vertices.astype("<f4").tobytes() + rows.tobytes())


def write_stl(path: Path, side: int, text: bool) -> None:
    vertices, faces = grid(side)
    corners = vertices[faces]
    with path.open("wb") as file:
        if text:
            file.write(b"solid big\n")
            vertex = "  vertex %.6e %.6e %.6e\n"
            facet = f"facet normal 0 0 1\n outer loop\n{3 * vertex} endloop\nendfacet"
            np.savetxt(file, corners.reshape(-1, 9), facet)
            file.write(b"endsolid big\n")
        else:
            rows = np.zeros(len(faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)),
                                         ("attribute", "<u2")])
            rows["corners"] = corners
            file.write(b" " * 80 + np.uint32(len(faces)).tobytes() + rows.tobytes())


def write_glb(path: Path, side: int) -> None:
    import json

    vertices, faces = grid(side)
    data = vertices.astype("<f4").tobytes() + faces.astype("<u4").tobytes()
    first = 12 * len(vertices)
    text = json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3",
             "min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()},
            {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": first},
                        {"buffer": 0, "byteOffset": first, "byteLength": len(data) - first}],
        "buffers": [{"byteLength": len(data)}]}).encode()
    text += b" " * (-len(text) % 4)
    sizes = np.array([2, 28 + len(text) + len(data), len(text)], "<u4").tobytes()
    path.write_bytes(b"glTF" + sizes + b"JSON" + text + np.uint32(len(data)).tobytes() + b"BIN\0"
                     + data)


#: Name of the file, how it is written, and the side of the surface that makes some 100 MB.
FILES: dict[str, tuple[Callable[[Path, int], None], int]] = {
    "plain.obj": (write_obj, 1120),
    "normals.obj": (write_obj_with_normals, 700),
    "text.ply": (lambda path, side: write_ply(path, side, True), 1160),
    "binary.ply": (lambda path, side: write_ply(path, side, False), 1620),
    "text.stl": (lambda path, side: write_stl(path, side, True), 515),
    "binary.stl": (lambda path, side: write_stl(path, side, False), 1001),
    "binary.glb": (write_glb, 1670),
}


def _tinyobjloader(module: Any, path: str) -> Any:
    reader = module.ObjReader()
    reader.ParseFromFile(path, module.ObjReaderConfig())
    return reader.GetAttrib().numpy_vertices(), reader.GetShapes()


#: Reader, its module, the extensions it reads, and how.
READERS: list[tuple[str, str, str, Callable[[Any, str], Any]]] = [
    ("tinyobjloader", "tinyobjloader", ".obj", _tinyobjloader),
    ("plyfile", "plyfile", ".ply", lambda m, path: m.PlyData.read(path)),
    ("pyminiply", "pyminiply", ".ply", lambda m, path: m.read(path)),
    ("stl-reader", "stl_reader", ".stl", lambda m, path: m.read(path)),
    ("numpy-stl", "stl.mesh", ".stl", lambda m, path: m.Mesh.from_file(path)),
    ("pygltflib", "pygltflib", ".glb", lambda m, path: m.GLTF2().load(path)),
    ("assimp-py", "assimp_py", ".obj .ply .stl .glb",
     lambda m, path: m.import_file(path, m.Process_Triangulate)),
    ("trimesh", "trimesh", ".obj .ply .stl .glb", lambda m, path: m.load(path, process=False)),
    ("meshio", "meshio", ".obj .ply .stl", lambda m, path: m.read(path)),
]


def _timed(name: str, path: str, answer: Any) -> None:
    """Processor seconds of one reading, or why there is none."""
    try:
        if name == "load_mesh":
            read: Callable[[], Any] = lambda: load_mesh(path)  # noqa: E731
        else:
            module, how = next((m, h) for n, m, _, h in READERS if n == name)
            found = import_module(module)
            read = lambda: how(found, path)  # noqa: E731
        begin = time.process_time()
        read()
        answer.put(time.process_time() - begin)
    except ImportError:
        answer.put("not installed")
    except Exception as error:
        answer.put(f"{type(error).__name__}: {error}"[:60])


def measure(name: str, path: Path, tries: int) -> float | str:
    """The least of some tries, each in a new process."""
    context = multiprocessing.get_context("spawn")
    best: float | str = "no answer"
    for _ in range(tries):
        answer = context.Queue()
        process = context.Process(target=_timed, args=(name, str(path), answer))
        process.start()
        result = answer.get()
        process.join()
        if isinstance(result, str):
            return result
        best = result if isinstance(best, str) else min(best, result)
    return best


@click.command()
@click.option("--tries", default=3, show_default=True, help="Readings, of which the least counts.")
@click.option("--slow/--no-slow", default=False, help="Readers of more than ten seconds, too.")
def main(tries: int, slow: bool) -> None:
    """Read a file of some 100 MB in every format with every reader that is installed."""
    with tempfile.TemporaryDirectory() as folder:
        for file, (write, side) in FILES.items():
            path = Path(folder) / file
            write(path, side)
            click.echo(f"{file}, {path.stat().st_size / 1e6:.0f} MB")
            own = measure("load_mesh", path, tries)
            click.echo(f"  {'load_mesh':14} {own if isinstance(own, str) else f'{own:.2f} s'}")
            for name, _, extensions, _ in READERS:
                if path.suffix not in extensions.split() or (name in ("plyfile", "meshio")
                                                            and not slow):
                    continue
                result = measure(name, path, tries)
                shown = (result if isinstance(result, str) or isinstance(own, str)
                         else f"{result:.2f} s, load_mesh takes {own / result:.1f} times as long")
                click.echo(f"  {name:14} {shown}")
            path.unlink()


if __name__ == "__main__":
    main()
