"""Which node draws which triangle, and in which order the host sends them."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from cardcage.golden.organisations.shares import Shares, triangle_work
from cardcage.golden.planning.scene_needs import with_sub_bits
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.errors import InputError

CASES = [(nodes, triangles, packet) for nodes in (1, 2, 3, 5, 16)
         for triangles in (0, 1, 7, 64, 101) for packet in (1, 2, 10, 100, "contiguous")]


@pytest.mark.parametrize(("nodes", "triangles", "packet"), CASES)
def test_shares_are_packets_dealt_out_in_turn(nodes, triangles, packet):
    """As one deals cards: packet after packet, node after node, round after round."""
    shares = Shares(nodes=nodes, triangles=triangles, packet=packet)
    size = max(1, -(-triangles // nodes)) if packet == "contiguous" else packet
    waiting, dealt, rounds = list(range(triangles)), {}, 0
    while waiting:
        for node in range(nodes):
            dealt |= dict.fromkeys(waiting[:size], (node, rounds))
            waiting = waiting[size:]
        rounds += 1
    assert list(zip(shares.node.tolist(), shares.round.tolist(), strict=True)) == [
        dealt[triangle] for triangle in range(triangles)]
    assert shares.rounds == max(1, rounds)
    assert 2 ** shares.order_bits >= shares.rounds > 2 ** shares.order_bits // 2
    owned = [triangle for node in range(nodes) for triangle in shares.of_node(node).tolist()]
    assert sorted(owned) == list(range(triangles))
    if packet == "contiguous":
        assert shares.rounds == 1 and shares.order_bits == 0


@pytest.mark.parametrize(("nodes", "triangles", "packet"), CASES)
def test_the_host_alternates_nodes(nodes, triangles, packet):
    shares = Shares(nodes=nodes, triangles=triangles, packet=packet)
    order = shares.host_order.tolist()
    assert sorted(order) == list(range(triangles))
    for node in range(nodes):  # each node gets its own in the list's order
        own = [triangle for triangle in order if shares.node[triangle] == node]
        assert own == shares.of_node(node).tolist()
    # A whole round goes to all nodes in turn, whatever the packet is.
    for place in range(triangles // (nodes * shares.packet_triangles)):
        whole = order[place * nodes * shares.packet_triangles:][:nodes * shares.packet_triangles]
        assert [shares.node[triangle] for triangle in whole] == (
            list(range(nodes)) * shares.packet_triangles)


@pytest.mark.parametrize(("wrong", "message"), [
    ({"nodes": 0}, "^nodes: 0 is less than 1"), ({"packet": 0}, "^packet: 0 is less than 1; take"),
    ({"packet": -3}, "^packet: -3"),
])
def test_what_makes_no_shares(wrong, message):
    with pytest.raises(InputError, match=message):
        Shares(**{"nodes": 2, "triangles": 5} | wrong)


WORK_LISTS = [make_display_list(scene, width=61, height=47).display_list for scene in (
    "random:n=300,size=30,seed=4", "teapot:tessellation=2", "tetra:depth=2")]


@pytest.mark.parametrize("listed", WORK_LISTS)
def test_work_is_counted_pixel_by_pixel(listed):
    """Against the centres of pixels that lie in each box, and rational areas."""
    unit = 1 << listed.sub_bits
    for corners, work in zip(listed.position.tolist(), triangle_work(listed), strict=True):
        xs, ys = zip(*corners, strict=True)
        columns = sum(min(xs) <= x * unit + unit // 2 < max(xs) for x in range(listed.width))
        rows = sum(min(ys) <= y * unit + unit // 2 < max(ys) for y in range(listed.height))
        (ax, ay), (bx, by) = ((x - xs[0], y - ys[0]) for x, y in corners[1:])
        area = abs(Fraction(ax * by - ay * bx, 2 * unit * unit))
        expected = max(rows, min(int(area), rows * columns)) if rows * columns else 0
        assert work == expected


@pytest.mark.parametrize("nodes", [1, 2, 3, 7, 16])
@pytest.mark.parametrize("listed", WORK_LISTS)
def test_equal_work(listed, nodes):
    shares, work = Shares.of(listed, nodes, "work"), triangle_work(listed)
    assert (shares.rounds, shares.order_bits, shares.round.max()) == (1, 0, 0)
    assert (np.diff(shares.node) >= 0).all() and shares.node.max() < nodes  # runs of the list
    total = int(work.sum())
    of_nodes = np.bincount(shares.node, work, minlength=nodes)
    # As even as whole triangles allow.
    assert (abs(of_nodes - total / nodes) <= work.max()).all()
    order = shares.host_order
    assert sorted(order.tolist()) == list(range(listed.triangles))
    assert (shares.host_place[order] == np.arange(listed.triangles)).all()
    done = np.zeros(nodes, int)
    sent = []
    for triangle in order:  # by what its node has done before, so that all are as far at any time
        node = shares.node[triangle]
        sent.append(done[node])
        done[node] += work[triangle]
    assert (np.diff(sent) >= 0).all()
    for node in range(nodes):
        own = order[shares.node[order] == node]
        assert (np.diff(own) > 0).all()


def test_work_does_not_depend_on_the_units_of_a_list():
    listed = WORK_LISTS[0]
    coarse = replace(listed, position=listed.position & -64)
    finer = with_sub_bits(coarse, 2)
    assert finer.sub_bits == 2
    np.testing.assert_array_equal(triangle_work(finer), triangle_work(coarse))


def test_no_work_at_all():
    listed = replace(WORK_LISTS[0], position=WORK_LISTS[0].position * 0 - 5)
    shares = Shares.of(listed, 4, "work")
    assert set(shares.node.tolist()) == {0} and len(shares.host_order) == listed.triangles


def test_work_is_for_packets_of_equal_work():
    with pytest.raises(ValueError, match="work is for packets of equal work"):
        Shares(2, 3, "work")
    with pytest.raises(ValueError, match="work is for packets of equal work"):
        Shares(2, 3, 1, np.ones(3, np.int64))
