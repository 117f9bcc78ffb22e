"""Blazek's primitives: closed at every recursion, round where they are round."""

import math
from collections import Counter

import numpy as np
import pytest

from cardcage.golden.scenes.mesh import cross, dot
from cardcage.golden.scenes.scene_files.language import KINDS
from cardcage.golden.scenes.scene_files.primitives import (
    USUAL_RECURSION,
    primitive,
    triangles_of,
)

VOLUMES = {"sphere": 4 / 3 * math.pi, "cube": 8.0, "cylinder": 2 * math.pi,
           "cone": 2 / 3 * math.pi, "pyramid": 8 / 3}


def test_there_are_five_and_meshes():
    assert sorted(KINDS) == sorted([*USUAL_RECURSION, "mesh"])


@pytest.mark.parametrize("recursion", range(5))
@pytest.mark.parametrize("kind", USUAL_RECURSION)
def test_each_is_closed_and_has_no_empty_face(kind, recursion):
    mesh = primitive(kind, recursion)
    assert mesh.triangles == triangles_of(kind, recursion)
    edges = Counter((face[side], face[(side + 1) % 3]) for face in mesh.faces.tolist()
                    for side in range(3))
    assert max(edges.values()) == 1
    assert all((b, a) in edges for a, b in edges)
    assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)
    assert not mesh.degenerate().any()
    assert (mesh.vertices.min(axis=0) == -1).all() and (mesh.vertices.max(axis=0) == 1).all()


@pytest.mark.parametrize("kind", USUAL_RECURSION)
def test_its_volume_is_that_of_the_body(kind):
    corners = primitive(kind, 5).corners()
    volume = float(dot(corners[:, 0], cross(corners[:, 1], corners[:, 2])).sum() / 6)
    assert volume == pytest.approx(VOLUMES[kind], rel=3e-3)
    if kind not in ("cube", "pyramid"):  # from inside the body, and nearer with every recursion
        coarser = primitive(kind, 3).corners()
        assert float(dot(coarser[:, 0], cross(coarser[:, 1], coarser[:, 2])).sum() / 6) < volume


@pytest.mark.parametrize(("kind", "radius"), [("cylinder", lambda y: 1.0 + 0 * y),
                                              ("cone", lambda y: (1 - y) / 2)])
def test_a_vertex_of_a_surface_of_revolution_lies_on_it_or_on_a_cap(kind, radius):
    vertices = primitive(kind, 4).vertices
    away = np.hypot(vertices[:, 0], vertices[:, 2])
    on_cap = np.abs(np.abs(vertices[:, 1]) - 1) < 1e-12
    on_side = np.abs(away - radius(vertices[:, 1])) < 1e-9
    assert (on_cap | on_side).all() and (away <= radius(vertices[:, 1]) + 1e-9).all()
