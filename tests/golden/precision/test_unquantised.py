"""The picture before quantisation, against a slow one in fractions."""

from fractions import Fraction

import numpy as np
import pytest

from cardcage.golden.precision.unquantised import (
    ScreenTriangles,
    UnquantisedScene,
    draw,
    unquantised_scene,
)
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.scenes.camera import View
from cardcage.golden.scenes.lighting import Lighting

SIZE = 9


def slow(triangles):
    """Pixel → (depth, primitive): every triangle at every pixel, by barycentric weights."""
    winners = {}
    for primitive in range(len(triangles.position)):
        (ax, ay), (bx, by), (cx, cy) = [
            [Fraction(number) for number in vertex]
            for vertex in triangles.position[primitive].tolist()]
        double_area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if double_area == 0:
            continue
        for y in range(triangles.height):
            for x in range(triangles.width):
                px, py = Fraction(2 * x + 1, 2), Fraction(2 * y + 1, 2)
                u = ((bx - px) * (cy - py) - (cx - px) * (by - py)) / double_area
                v = ((cx - px) * (ay - py) - (ax - px) * (cy - py)) / double_area
                weights = {0: u, 1: v, 2: 1 - u - v}
                if min(weights.values()) < 0:
                    continue
                corners = [(ax, ay), (bx, by), (cx, cy)]
                if not all(weight > 0 or owns(corners, corner)
                           for corner, weight in weights.items()):
                    continue
                depth = sum(weight * Fraction(triangles.depth[primitive, corner])
                            for corner, weight in weights.items())
                best = winners.get((x, y))
                if best is None or (depth, primitive) < best:
                    winners[x, y] = depth, primitive
    return winners


def owns(corners, corner):
    """Whether centres on the edge opposite to ``corner`` belong to the triangle: it is level with
    the corner below it, or the corner lies to its right."""
    (x, y), (ax, ay), (bx, by) = corners[corner], corners[corner - 2], corners[corner - 1]
    if ay == by:
        return y > ay
    return x > ax + (bx - ax) * (y - ay) / (by - ay)


def triangles(position, depth):
    color = np.arange(9 * len(position)).reshape(-1, 3, 3) % 256.0
    return ScreenTriangles(np.array(position, float), np.array(depth, float), color, SIZE, SIZE,
                           (1, 2, 3))


def check(scene):
    picture, wanted = draw(scene), slow(scene)
    for y in range(SIZE):
        for x in range(SIZE):
            depth, primitive = wanted.get((x, y), (None, -1))
            assert picture.winner[y, x] == primitive, (x, y)
            if depth is not None:
                assert abs(Fraction(float(picture.depth[y, x])) - depth) < Fraction(1, 2**42)
    return len(wanted)


@pytest.mark.parametrize("kind", ["anywhere", "half-pixels", "slivers", "one sliver twice"])
def test_against_fractions(kind):
    random = np.random.default_rng(5)
    print("seed 5")
    position = random.uniform(-4, SIZE + 4, (14, 3, 2))
    depth = random.uniform(0, 1, (14, 3))
    if kind == "half-pixels":
        position = np.round(position * 2) / 2
        depth = np.round(depth * 4) / 4
    elif kind == "slivers":
        # Corners on pixel centres, the third a few roundings beside the line between them.
        position = np.floor(position) + 0.5
        position[:, 2] = position[:, :2].mean(axis=1) * (1 + random.integers(-3, 4, (14, 1))
                                                         * 2.0**-52)
    elif kind == "one sliver twice":
        position[7:], depth[7:] = position[:7, [1, 2, 0]], depth[:7, [1, 2, 0]]
    drawn = check(triangles(position, depth))
    assert drawn > (0 if kind == "slivers" else 20)


def test_ties_that_float64_cannot_see():
    """One plane through different vertices: depths are equal in fractions alone."""
    plane = np.array([0.1, 0.03, -0.02])

    def depth(corners):
        return [float(Fraction(x) * Fraction(3, 128) + Fraction(y) * Fraction(5, 128))
                for x, y in corners]

    one = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]]
    two = [[8.0, 8.0], [0.0, 8.0], [8.0, 0.0]]
    whole = [[-3.0, -1.0], [17.0, -1.0], [-3.0, 17.0]]
    shift = [[0.25, 0.125], [8.25, 0.125], [0.25, 8.125]]
    scene = triangles([whole, one, two, shift], [depth(c) for c in (whole, one, two, shift)])
    scene.depth[:] = np.clip(scene.depth + plane[0], 0, 1)
    check(scene)


def test_degenerate_and_empty():
    scene = triangles([[[1, 1], [5, 5], [3, 3]], [[2, 2], [2, 2], [2, 2]]], np.zeros((2, 3)))
    assert (draw(scene).winner == -1).all()
    empty = triangles(np.zeros((0, 3, 2)), np.zeros((0, 3)))
    assert (draw(empty).winner == -1).all() and (draw(empty).color == (1, 2, 3)).all()


@pytest.mark.parametrize(("scene", "shifts"), [
    ("teapot:tessellation=3", (0, 0)), ("random:n=300,size=20", (0, 1)),
    ("hard:sliver-fan", (1, 1)), ("hard:guard-band-cover", (0, 0)), ("hard:one-pixel", (0, 0))])
def test_a_display_list_as_it_is(scene, shifts):
    """The integers taken as they are: the exact picture, but for the rounding of depths."""
    listed = make_display_list(scene).display_list
    x_shift, y_shift = shifts
    wanted = exact.draw(listed, x_shift=x_shift, y_shift=y_shift)
    got = draw(UnquantisedScene.of_display_list(listed).on_screen(x_shift, y_shift))
    assert np.array_equal(got.winner >= 0, wanted.winner >= 0)
    right = (got.winner == wanted.winner) & (got.winner >= 0)
    # A rounded depth hides which of two is nearer only where they are within one LSB.
    assert right.sum() >= 0.99 * (wanted.winner >= 0).sum()
    assert abs(got.depth * listed.depth_limit - wanted.depth)[right].max() <= 0.5 + 1e-5
    assert abs(got.color - wanted.color)[right].max() <= 0.5 + 1e-5


@pytest.mark.parametrize("scene", ["teapot:tessellation=3", "sphereflake:depth=1"])
@pytest.mark.parametrize("looking", [{}, {"view": View((200.0, 45.0), 2.5)}, {"cull": True}, {
    "lighting": Lighting(direction=(0.0, 0.0, 1.0)), "view": View(zoom=0.3), "cull": True}])
@pytest.mark.parametrize(("sub_bits", "depth_bits"), [(8, 24), (2, 16), (1, 8)])
def test_quantising_it_makes_the_display_list(scene, sub_bits, depth_bits, looking):
    listed = make_display_list(scene, width=48, height=40, sub_bits=sub_bits,
                               depth_bits=depth_bits, shading="flat", **looking).display_list
    again = unquantised_scene(scene, listed, "flat", **looking).display_list(sub_bits, depth_bits)
    for field in ("position", "depth", "color"):
        assert np.array_equal(getattr(again, field), getattr(listed, field))


def test_a_scene_without_a_mesh_is_its_list():
    listed = make_display_list("random:n=9,seed=4").display_list
    again = unquantised_scene("random:n=9,seed=4", listed).display_list(8, 24)
    assert np.array_equal(again.position, listed.position)
    assert np.array_equal(again.depth, listed.depth)
