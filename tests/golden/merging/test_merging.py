"""However the triangles are shared, and in whatever order pictures merge, one picture comes of it:
that of the exact reference."""

from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
import pytest

from cardcage.golden.merging.binary_swap import merge_binary_swap
from cardcage.golden.merging.chain import merge_chain
from cardcage.golden.merging.node_picture import merged, nearer, node_pictures
from cardcage.golden.merging.snoop import merge_snoop
from cardcage.golden.merging.ties import order_matters
from cardcage.golden.merging.tree import merge_tree, tree_pairs
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.display_list import DisplayList

WIDTH, HEIGHT = 37, 23
MERGES = {"chain": merge_chain, "tree": merge_tree, "binary swap": merge_binary_swap,
          "snoop": merge_snoop}


def all_tied(triangles=40, seed=5):
    """Coplanar triangles of different colours: every pixel is a tie of all that cover it."""
    random = np.random.default_rng(seed)
    return DisplayList(
        width=WIDTH, height=HEIGHT, background=(9, 8, 7),
        position=random.integers(0, 36 << 8, (triangles, 3, 2)).astype(np.int32),
        depth=np.full((triangles, 3), 1000, np.int64),
        color=np.repeat(random.integers(0, 256, (triangles, 1, 3)), 3, axis=1).astype(np.uint8))


def few_depths(seed):
    """Triangles at few depths, so that some tie and some hide."""
    tied = all_tied(60, seed)
    depth = np.random.default_rng(seed).integers(0, 4, (60, 1)).repeat(3, axis=1)
    return replace(tied, depth=depth.astype(np.int64))


LISTS = {
    "all tied": all_tied(),
    "few depths": few_depths(11),
    "random": make_display_list("random:n=80,size=9,seed=3", width=WIDTH,
                                height=HEIGHT).display_list,
    "fewer triangles than nodes": all_tied(3),
    "none": replace(all_tied(1), position=np.zeros((0, 3, 2), np.int32),
                    depth=np.zeros((0, 3), np.int64), color=np.zeros((0, 3, 3), np.uint8)),
}


def assert_same(one, other):
    for name in ("color", "depth", "winner"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


@pytest.mark.parametrize("packet", [1, 10, 100, "contiguous"])
@pytest.mark.parametrize("nodes", [1, 2, 3, 4, 7, 16])
@pytest.mark.parametrize("scene", LISTS)
def test_the_merged_picture_is_the_exact_one(scene, nodes, packet):
    display_list = LISTS[scene]
    whole = exact.draw(display_list)
    pictures = node_pictures(display_list, Shares(nodes=nodes, triangles=display_list.triangles,
                                                  packet=packet))
    for merge in MERGES.values():
        picture, traffic = merge(pictures)
        assert_same(picture.picture, whole)
        assert traffic.nodes == nodes


@pytest.mark.parametrize("seed", range(5))
def test_neighbours_merge_in_any_order(seed):
    random = np.random.default_rng(seed)
    print("seed", seed)
    display_list = few_depths(seed)
    nodes = int(random.integers(2, 9))
    pictures = node_pictures(display_list, Shares(nodes=nodes, triangles=60, packet=3))
    expected = merged(pictures)
    while len(pictures) > 1:
        place = int(random.integers(len(pictures) - 1))
        pictures[place:place + 2] = [nearer(*pictures[place:place + 2])]
    assert_same(pictures[0].picture, expected.picture)
    np.testing.assert_array_equal(pictures[0].order, expected.order)


def test_nothing_drawn_is_the_identity():
    display_list = few_depths(2)
    shares = Shares(nodes=2, triangles=60, packet=7)
    picture, _ = node_pictures(display_list, shares)
    nothing, _ = node_pictures(LISTS["none"], replace(shares, triangles=0),
                               order_bits=shares.order_bits)
    assert not nothing.drawn.any() and picture.drawn.any()
    nothing = replace(nothing, picture=replace(
        nothing.picture, color=np.full_like(nothing.picture.color, 0) + np.uint8([9, 8, 7])))
    for pair in ((picture, nothing), (nothing, picture)):
        both = nearer(*pair)
        assert_same(both.picture, picture.picture)
        np.testing.assert_array_equal(both.order, picture.order)


@pytest.mark.parametrize(("scene", "packet", "matters"), [
    ("all tied", 1, True), ("all tied", "contiguous", False), ("few depths", 10, True),
    ("few depths", 100, False), ("none", 1, False)])
def test_where_the_order_of_rounds_is_needed(scene, packet, matters):
    display_list = LISTS[scene]
    whole = exact.draw(display_list)
    shares = Shares(nodes=4, triangles=display_list.triangles, packet=packet)
    assert order_matters(display_list, shares) == matters
    without = merged(node_pictures(display_list, shares, order_bits=0))
    assert np.array_equal(without.picture.winner, whole.winner) != matters


def few_ties(seed, depths=60):
    """Triangles at many depths: on some lists two that tie meet, on some they do not."""
    listed = few_depths(seed)
    depth = np.random.default_rng(seed).integers(0, depths, (60, 1)).repeat(3, axis=1)
    return replace(listed, depth=depth.astype(np.int64))


def test_a_tie_more_or_less_is_found():
    """On lists of which some have a tie that matters, also where they are drawn coarser, and drawn
    with another precision."""
    found = []
    for seed in range(40):
        display_list = few_ties(seed)
        shares = Shares(nodes=3, triangles=60, packet=1 + seed % 4)
        for y_shift in (0, 1):
            whole = exact.draw(display_list, y_shift=y_shift)
            without = merged(node_pictures(display_list, shares, order_bits=0, y_shift=y_shift))
            found.append(not np.array_equal(without.picture.winner, whole.winner))
            assert order_matters(display_list, shares, partial(
                exact.draw, y_shift=y_shift)) == found[-1], seed
    assert 20 < sum(found) < 60


@pytest.mark.parametrize(("seed", "exactly"), [(43, True), (54, False)])
def test_too_few_fraction_bits_make_other_ties(seed, exactly):
    """So a machine's ties are asked of what it draws."""
    shares, level = Shares(nodes=3, triangles=60), few_ties(seed, depths=3000)
    sloping = replace(level, depth=level.depth + np.array([0, 5, 11]))
    assert order_matters(sloping, shares) == exactly
    assert order_matters(sloping, shares, partial(bit_true.draw, fraction_bits=30)) == exactly
    assert order_matters(sloping, shares, partial(bit_true.draw, fraction_bits=0)) != exactly


@pytest.mark.parametrize("nodes", [1, 2, 3, 5, 8, 13])
def test_a_tree_sends_each_nodes_pixels_once_and_pieces_are_disjoint(nodes):
    pairs = list(tree_pairs(nodes))
    assert sorted(sender for _, sender, _ in pairs) == list(range(1, nodes))
    for step in {step for step, _, _ in pairs}:
        spans = sorted((receiver, sender) for at, sender, receiver in pairs if at == step)
        for (_, end), (begin, _) in pairwise(spans):
            assert end <= begin


@pytest.mark.parametrize("merge", MERGES)
def test_traffic_is_what_passes_over_the_backplane(merge):
    """Counted pixel by pixel from who has drawn what, by the rule of each merge."""
    display_list = few_depths(8)
    nodes = 6
    pictures = node_pictures(display_list, Shares(nodes=nodes, triangles=60, packet=2))
    _, traffic = MERGES[merge](pictures)
    drawn = np.array([picture.drawn for picture in pictures])
    bus = merge == "snoop"  # all the way to the frame units
    pieces = np.zeros(nodes if bus else nodes - 1, int)
    for _, sender, receiver, pixels in traffic.sends:
        for piece in range(*((0, nodes) if bus else sorted((sender, receiver)))):
            pieces[piece] += pixels
    np.testing.assert_array_equal(traffic.pieces, pieces)
    assert traffic.busiest_piece == pieces.max()
    if merge == "chain":
        assert traffic.pixels == (nodes - 1) * WIDTH * HEIGHT
        assert traffic.steps == [WIDTH * HEIGHT]
    if merge == "tree":
        sent = [int(drawn[list(group)].any(axis=0).sum())
                for group in ([1], [3], [5], [2, 3], [4, 5])]
        assert [send.pixels for send in traffic.sends] == sent
        assert traffic.steps == [max(sent[:3]), sent[3], sent[4]]
    if merge == "snoop":
        # As the paper words it: whoever has not sent listens, and deletes what is hidden.
        left, sent = drawn.copy(), []
        rank = np.array([(picture.picture.depth << 16) + picture.order for picture in pictures])
        for node in range(nodes):
            sent.append(int(left[node].sum()))
            for listener in range(node + 1, nodes):
                left[listener] &= ~(left[node] & (rank[node] <= rank[listener]))
        assert traffic.sent == sent
        assert traffic.pixels == sum(sent) == traffic.busiest_piece
    if merge == "binary swap":
        first = [drawn[1].sum(), drawn[3].sum()]
        groups = [drawn[:2].any(axis=0).ravel(), drawn[2:4].any(axis=0).ravel(),
                  drawn[4].ravel(), drawn[5].ravel()]
        second = [groups[1][::2].sum(), groups[0][1::2].sum(),
                  groups[3][::2].sum(), groups[2][1::2].sum()]
        assert [send.pixels for send in traffic.sends[:6]] == [*first, *second]
        assert len(traffic.sends) == 10
