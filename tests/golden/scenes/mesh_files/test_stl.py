"""STL: which of the two kinds it is, how many triangles, and where a text is wrong."""

import numpy as np
import pytest
from mesh_texts import FACES, VERTICES, stl_binary, stl_text

from cardcage.golden.scenes.mesh_files.load_mesh import load_mesh
from cardcage.golden.scenes.mesh_files.text_lines import STRETCH
from cardcage.golden.specification.errors import InputError

CORNERS = VERTICES[FACES].astype(np.float64)
TEXT = stl_text()


def load(tmp_path, data):
    path = tmp_path / "a.stl"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return load_mesh(path)


def refusal(tmp_path, data):
    with pytest.raises(InputError) as caught:
        load(tmp_path, data)
    return str(caught.value).removeprefix(f"{tmp_path / 'a.stl'}: ")


@pytest.mark.parametrize("data", [
    stl_binary(),
    stl_binary(header=b"solid made by a program that does not know"),
    stl_binary(header=b"\xff\xfe"),
    stl_binary(tail=b"\n"),
    stl_binary(tail=b"\r\n"),
    stl_binary(tail=b"\0" * 100),
    stl_binary(header=b"solid \0", tail=b"\n"),
    TEXT,
    stl_text("vertex cube"),
    stl_text("normal part"),
    stl_text("endsolid facet normal outer loop"),
    stl_text("facet"),
    stl_text(""),
    stl_text("Würfel"),
    stl_text("W\xfcrfel").encode("latin-1"),
    TEXT.replace("endsolid part", "endsolid"),
    TEXT.replace("endsolid part", "endsolid another name"),
    TEXT.upper(),
    TEXT.replace("\n", "\r\n"),
    TEXT.replace("\n", "\r"),
    TEXT.replace("  ", "\t"),
    TEXT.replace(" facet", "facet").replace("\n", "\n\n"),
    "\n  " + TEXT,
    "\ufeff" + TEXT,
    "\ufeff".encode("utf-16-le") + TEXT.encode("utf-16-le"),
    TEXT.replace("normal 0 0 0", "normal -nan(ind) nan 1.#QNAN"),
    TEXT.replace("   vertex", " vertex").replace("\n  outer", " outer"),
    stl_text("one", FACES[:2]) + stl_text("two", FACES[2:]),
    stl_text("one", FACES[:0]) + "\n" + stl_text("vertex two", FACES[:1]) + stl_text("", FACES[1:]),
    stl_text(number="{:g}"),
    TEXT.rstrip("\n"),
])
def test_the_same_tetrahedron(tmp_path, capfd, data):
    mesh = load(tmp_path, data)
    assert np.array_equal(mesh.corners(), CORNERS)
    assert mesh.notes == () and mesh.colors is None
    assert capfd.readouterr() == ("", "")


def swapped(old, new, count=1):
    assert old in TEXT
    return TEXT.replace(old, new, count)


@pytest.mark.parametrize("data, reason", [
    (stl_binary(announced=9), "contents: 9 triangles are announced and 4 are there: "),
    (stl_binary(announced=3), "contents: 3 triangles are announced and 4 are there: "),
    (stl_binary(announced=0), "contents: 0 triangles are announced and 4 are there: "),
    (stl_binary()[:-1], "contents: 4 triangles are announced and 3 and 49 bytes are there: "),
    (stl_binary(tail=b"more"), "contents: 4 triangles are announced and 4 and 4 bytes are there: "),
    (stl_binary()[:50], "contents: 50 bytes: cut short within the header"),
    (swapped("2.000000e+00", "x2.0"), "contents: line 6: 'x2.0' is not a number"),
    (swapped("2.000000e+00", "2,0"), "contents: line 6: '2,0' is not a number"),
    (swapped("2.000000e+00", "1.0-1.0"), "contents: line 6: '1.0-1.0' is not a number"),
    (swapped("2.000000e+00 ", "2.000000e+00\x01"), "contents: line 6: '2.000000e+00\\x01"),
    (swapped("2.000000e+00 ", ""), "contents: line 8: 'endfacet' where 'endloop' is due"),
    (swapped("outer loop", "outer ring"), "contents: line 3: 'ring' where 'loop' is due"),
    (swapped(" endfacet\n", ""), "contents: line 8: 'facet' where 'endfacet' is due"),
    (swapped("endsolid part\n", ""), "contents: the last solid has no endsolid"),
    (stl_text("one", FACES[:2]) + stl_text("two").rsplit("endsolid", 1)[0],
     "contents: the last solid has no endsolid"),
    (stl_text("one", FACES[:2]).rsplit("endsolid", 1)[0] + stl_text("two"),
     "contents: line 16: a solid in a solid"),
    (TEXT + "endsolid part\n", "contents: line 31: an endsolid without its solid"),
    (TEXT + TEXT.split("\n", 1)[1].rsplit("endsolid", 1)[0],
     "contents: line 31: a facet outside of a solid"),
    (swapped("  endloop\n endfacet\nendsolid part", "endsolid part"),
     "contents: line 28: a facet is not ended"),
    ("solid part\nendsolid part\n", "faces: there are none"),
])
def test_refused_with_a_reason(tmp_path, data, reason):
    assert refusal(tmp_path, data).startswith(reason)


def test_colors_of_binary_dialects_are_passed_over(tmp_path):
    data = bytearray(stl_binary(header=b"COLOR=\xff\0\0\xff"))
    data[84 + 48 : 84 + 50] = b"\xff\xff"
    assert load(tmp_path, bytes(data)).colors is None


def test_a_far_line_is_named_and_stretches_leave_no_seam(tmp_path):
    count = 3 * STRETCH // 150
    faces = FACES[np.arange(count) % 4]
    text = stl_text("vertex", faces, "{:g}")
    assert len(text) > 2 * STRETCH
    assert np.array_equal(load(tmp_path, text).corners(), VERTICES[faces])
    cut = text.rsplit("   vertex", 1)
    end = "   vertex 1 2 3x\n  endloop\n endfacet\nendsolid vertex\n"
    message = refusal(tmp_path, cut[0] + end)
    assert message.startswith(f"contents: line {7 * count - 1}: '3x' is not a number")
