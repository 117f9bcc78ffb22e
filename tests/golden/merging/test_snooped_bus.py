"""Nodes on a bus, word by word as the paper has it (Cox and Hanrahan 1993, sections 7 and 8)."""

import random

import numpy as np
import pytest

from cardcage.golden.merging.node_picture import node_pictures
from cardcage.golden.merging.snoop import merge_snoop
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list


def lists(seed, depths):
    """Triangles at so many depths; the fewer, the more tie."""
    source = np.random.default_rng(seed)
    listed = make_display_list(f"random:n={int(source.integers(1, 60))},size=11,seed={seed}",
                               width=23, height=17).display_list
    listed.depth[:] = source.integers(0, depths, (listed.triangles, 1))
    return listed


def broadcast(pictures, hides):
    """The frame units' words and how many each node sends, where a node deletes its own word when
    ``hides(received, own)``."""
    nodes = []
    for picture in pictures:
        rank = list(zip(picture.picture.depth.ravel().tolist(), picture.order.ravel().tolist(),
                        strict=True))
        drawn = picture.drawn.ravel()
        nodes.append({place: rank[place] for place in np.flatnonzero(drawn).tolist()})
    frame, sent = {}, []
    for number, own in enumerate(nodes):
        sent.append(len(own))
        for place, received in own.items():
            frame[place] = number  # always overwritten
            for later in nodes[number + 1:]:
                if place in later and hides(received, later[place]):
                    del later[place]
    return frame, sent


@pytest.mark.parametrize("seed", range(12))
def test_what_is_sent_is_what_the_algorithm_sends(seed):
    print("seed", seed)
    pick = random.Random(seed)
    listed = lists(seed, pick.choice((1, 3, 50, 1 << 24)))
    whole = exact.draw(listed)
    for packet in (1, pick.randint(2, 9), "contiguous"):
        shares = Shares(pick.choice((1, 2, 3, 5, 8, 16)), listed.triangles, packet)
        pictures = node_pictures(listed, shares)
        frame, sent = broadcast(pictures, lambda received, own: received <= own)
        merged, traffic = merge_snoop(pictures)
        assert traffic.sent == sent and [send.step for send in traffic.sends] == list(
            range(shares.nodes))
        np.testing.assert_array_equal(traffic.pieces, [sum(sent)] * shares.nodes)
        assert traffic.busiest_piece == traffic.pixels == sum(sent)
        # What is sent last of a pixel is what is seen, although nothing compares it.
        winner = whole.winner.ravel()
        assert sorted(frame) == np.flatnonzero(winner >= 0).tolist()
        for name in ("color", "depth", "winner"):
            kept = getattr(whole, name).reshape(winner.size, -1)
            np.testing.assert_array_equal(getattr(merged.picture, name), getattr(whole, name))
            for place, number in frame.items():
                of_node = getattr(pictures[number].picture, name).reshape(winner.size, -1)
                assert (of_node[place] == kept[place]).all()


def test_ties_must_be_deleted_too():
    """Were they not, the last of the nodes that tie would be seen."""
    listed = lists(3, 1)
    pictures = node_pictures(listed, Shares(4, listed.triangles, "contiguous"))
    whole = exact.draw(listed).winner.ravel()
    for hides, right in ((lambda received, own: received <= own, True),
                         (lambda received, own: received < own, False)):
        frame, _ = broadcast(pictures, hides)
        seen = [pictures[number].picture.winner.ravel()[place] == whole[place]
                for place, number in frame.items()]
        assert all(seen) == right


def test_traffic_is_between_what_is_seen_and_what_is_drawn():
    for seed in range(6):
        listed = lists(seed, 1000)
        pictures = node_pictures(listed, Shares(6, listed.triangles))
        pixels = merge_snoop(pictures)[1].pixels
        drawn = [int(picture.drawn.sum()) for picture in pictures]
        assert int((exact.draw(listed).winner >= 0).sum()) <= pixels <= sum(drawn)
        assert merge_snoop(pictures[:1])[1].pixels == drawn[0]
