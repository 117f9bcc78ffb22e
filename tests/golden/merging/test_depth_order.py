"""What is sent on a snooped bus, counted from fragments, against the nodes' own pictures."""

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.merging.depth_order import DepthOrder
from cardcage.golden.merging.node_picture import node_pictures
from cardcage.golden.merging.snoop import merge_snoop
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.reference.exact import depth_complexity, draw
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.picture import NO_PRIMITIVE

SCENES = ("spheres:count=30,depth=1", "tetra:depth=3", "random:n=90,size=14,seed=4",
          "random:n=1,size=3")


def listed(scene, size=48):
    return make_display_list(scene, width=size, height=size, shading="flat").display_list


def tied(display_list):
    """Depths of which many are equal, on every pixel."""
    coarse = display_list.depth.mean(axis=1).astype(np.int64) >> 21 << 21
    return replace(display_list, depth=np.repeat(coarse[:, None], 3, axis=1))


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("change", [lambda same: same, tied], ids=["as it is", "tied"])
def test_as_the_pictures_of_the_nodes_say(scene, change):
    display_list = change(listed(scene))
    order = DepthOrder.of(display_list)
    for nodes in (1, 2, 3, 8, 64):
        for packet in (1, 3, 20, "contiguous"):
            shares = Shares(nodes, display_list.triangles, packet)
            pictures = node_pictures(display_list, shares)
            _, traffic = merge_snoop(pictures)
            assert order.sent_by(shares.node, nodes).tolist() == traffic.sent, (nodes, packet)
            drawn = [int(depth_complexity(display_list.chosen(shares.of_node(node))).sum())
                     for node in range(nodes)]
            assert order.drawn_by(shares.node, nodes).tolist() == drawn


def test_any_assignment_pixel_by_pixel():
    """Node after node, with a loop, and without any packets."""
    display_list = tied(listed("random:n=60,size=20,seed=9", 24))
    order = DepthOrder.of(display_list)
    for seed in range(20):
        random = np.random.default_rng(seed)
        node = np.sort(random.integers(5, size=display_list.triangles))  # lists in their order
        sent, heard = [0] * 5, np.full((24, 24), display_list.depth_limit + 1)
        for own in range(5):
            picture = draw(display_list.chosen(np.flatnonzero(node == own)))
            for row in range(24):
                for column in range(24):
                    if picture.depth[row, column] < heard[row, column]:
                        heard[row, column] = picture.depth[row, column]
                        sent[own] += 1
        assert order.sent_by(node, 5).tolist() == sent, seed


def test_fragments_pixels_and_depths():
    display_list = listed(SCENES[0])
    order = DepthOrder.of(display_list)
    complexity = depth_complexity(display_list).reshape(-1)
    assert order.depths.tolist() == complexity[complexity > 0].tolist()
    assert order.fragments == complexity.sum()
    winner = draw(display_list).winner
    assert order.pixels == np.count_nonzero(winner != NO_PRIMITIVE)
    assert order.primitive[order.first].tolist() == winner[winner != NO_PRIMITIVE].tolist()
    assert order.fragments_of_triangle.sum() == order.fragments


def test_nothing_drawn():
    display_list = listed(SCENES[-1]).chosen(np.zeros(0, np.int64))
    order = DepthOrder.of(display_list)
    assert order.fragments == order.pixels == 0
    assert order.sent_by(np.zeros(0, np.int64), 4).tolist() == [0] * 4
    assert order.drawn_by(np.zeros(0, np.int64), 4).tolist() == [0] * 4
