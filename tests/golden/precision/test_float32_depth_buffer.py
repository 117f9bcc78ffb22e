"""The ordinary float32 Z-buffer: every operation as a plain program would do it, one by one."""

import numpy as np
import pytest

from cardcage.golden.precision import float32_depth_buffer
from cardcage.golden.precision.unquantised import ScreenTriangles, UnquantisedScene
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list

F = np.float32


def plainly(triangles, depth_bits):
    """Winner and stored depth of every pixel, in a loop over triangles and pixels."""
    limit = 2**depth_bits - 2
    winner = np.full((triangles.height, triangles.width), -1)
    nearest = np.full(winner.shape, F(np.inf))
    for primitive, corners in enumerate(triangles.position.astype(F)):
        depth = triangles.depth[primitive].astype(F)

        def edge(a, b, p, corners=corners):
            (ax, ay), (bx, by) = corners[a], corners[b]
            return F(F(F(bx - ax) * F(p[1] - ay)) - F(F(by - ay) * F(p[0] - ax)))

        area = edge(1, 2, corners[0])
        if area == 0:
            continue
        sign = F(np.sign(area))
        for y in range(triangles.height):
            for x in range(triangles.width):
                at = F(x) + F(0.5), F(y) + F(0.5)
                edges = [edge(1, 2, at), edge(2, 0, at), edge(0, 1, at)]
                inside = True
                for k, value in enumerate(edges):
                    begin, end = corners[(k + 1) % 3], corners[(k + 2) % 3]
                    fall, run = (end[1] - begin[1]) * sign, (end[0] - begin[0]) * sign
                    owned = fall < 0 or (fall == 0 and run > 0)
                    inside &= bool(value * sign >= 0 if owned else value * sign > 0)
                if not inside:
                    continue
                weights = [F(value * F(F(1) / area)) for value in edges]
                value = F(F(F(weights[0] * depth[0]) + F(weights[1] * depth[1]))
                          + F(weights[2] * depth[2]))
                value = min(max(value, F(0)), F(1))
                if value < nearest[y, x]:
                    nearest[y, x], winner[y, x] = value, primitive
    stored = np.where(winner >= 0, np.floor(np.where(winner >= 0, nearest, 0).astype(float) * limit
                                            + 0.5), limit + 1)
    return winner, stored.astype(np.int64)


@pytest.mark.parametrize("kind", ["anywhere", "half-pixels"])
@pytest.mark.parametrize("depth_bits", [8, 24, 32])
def test_bit_for_bit(kind, depth_bits):
    random = np.random.default_rng(11)
    print("seed 11")
    position, depth = random.uniform(-3, 14, (12, 3, 2)), random.uniform(0, 1, (12, 3))
    if kind == "half-pixels":
        position, depth = np.round(position * 2) / 2, np.round(depth * 4) / 4
    triangles = ScreenTriangles(position, depth, random.uniform(0, 255, (12, 3, 3)), 11, 10,
                                (0, 0, 0))
    picture = float32_depth_buffer.draw(triangles, depth_bits)
    winner, stored = plainly(triangles, depth_bits)
    assert (winner >= 0).sum() > 40
    assert np.array_equal(picture.winner, winner)
    assert np.array_equal(picture.depth, stored)


def test_near_the_exact_picture_but_not_it():
    """On a screen of triangles with 24 depth bits it is off by some LSB; with 16 by one at most."""
    for depth_bits, most in ((16, 1), (24, 8)):
        listed = make_display_list("random:n=40,size=200,seed=2", width=128, height=128,
                                   depth_bits=depth_bits).display_list
        wanted = exact.draw(listed)
        got = float32_depth_buffer.draw(UnquantisedScene.of_display_list(listed).on_screen(),
                                      depth_bits)
        right = (got.winner == wanted.winner) & (wanted.winner >= 0)
        assert right.sum() > 0.99 * (wanted.winner >= 0).sum()
        error = abs(got.depth - wanted.depth)[right].max()
        assert 0 < error <= most
        assert abs(got.color.astype(int) - wanted.color)[right].max() <= 1


def test_no_area_draws_nothing():
    position = np.array([[[1, 1], [5, 5], [3, 3]], [[2, 2], [2, 2], [2, 2]]], float)
    triangles = ScreenTriangles(position, np.zeros((2, 3)), np.zeros((2, 3, 3)), 8, 8, (9, 8, 7))
    picture = float32_depth_buffer.draw(triangles, 24)
    assert (picture.winner == -1).all() and (picture.depth == 2**24 - 1).all()
    assert (picture.color == (9, 8, 7)).all()
