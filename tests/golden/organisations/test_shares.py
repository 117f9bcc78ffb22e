"""Which node draws which triangle, and in which order the host sends them."""

import pytest

from cardcage.golden.organisations.shares import Shares
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
