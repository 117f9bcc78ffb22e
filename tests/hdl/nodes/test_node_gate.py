"""What of the broadcast reaches a node, and the list that it draws, against lists in Python."""

import random
from collections import deque

import pytest
from amaranth.hdl import ClockDomain, Module
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation, prepared_triangle_layout
from cardcage.hdl.nodes.node_gate import NodeGate

LATE = BroadcastLines.settle_clocks
TRIANGLES = (Operation.DRAW, Operation.LOAD)
OF_LISTS = (Operation.LOAD, Operation.DRAW_LISTS, Operation.CLEAR_LISTS)


def machine(list_words=0):
    return small_machine("5x(PMC)", list_words=list_words, order_bits=3)


class Elements(Agent):
    """A node's processing elements as one: packets are taken while there is room, and show in
    ``done`` as late as the controller has to bear with.  ``slow``: they work on each a while."""

    def __init__(self, dut, seed, *, slow):
        self.dut, self.slow = dut, slow
        self.pick = random.Random(f"elements {seed}")
        self.queue = deque()
        self.left = self.late = self.clock = 0
        self.taken, self.clocks = [], []  # (operation, body)
        layout = prepared_triangle_layout(dut.configuration)
        self.body_bits = layout.size - dut.configuration.node_bits  # all but the node

    @property
    def finished(self):
        return not self.queue and not self.left

    def drive(self, ctx):
        own = self.dut.own
        self.ready = not self.slow or (len(self.queue) < 2 and self.pick.random() < 0.7)
        ctx.set(own.ready, self.ready)
        ctx.set(own.done, self.finished or self.late > 0)

    def sample(self, ctx):
        own = self.dut.own
        self.late = max(0, self.late - 1)
        if self.left:
            self.left -= 1
        elif self.queue:
            self.queue.popleft()
            self.left = self.pick.randrange(9) if self.slow else 0
        if ctx.get(own.strobe):
            assert self.ready, f"clock {self.clock}: a strobe while the elements are not ready"
            body = ctx.get(own.packet.body.as_value()) & (1 << self.body_bits) - 1
            self.taken.append((ctx.get(own.packet.operation), body))
            self.clocks.append(self.clock)
            self.queue.append(body)
            self.late = LATE
        self.clock += 1


class Host(Agent):
    """The controller: offers (operation, node, body), and strobes as soon as the gate is ready.

    ``expected``: what the elements have to get for it.  ``strobes``: its clocks.  ``done`` has to
    be low until all of that has come and is worked on, from the clock on in which it counts.
    """

    def __init__(self, dut, number, packets, elements, *, seed=None):
        self.dut, self.number, self.elements = dut, number, elements
        self.packets = deque(packets)
        self.pick = None if seed is None else random.Random(f"host {seed}")
        self.room = dut.configuration.list_words
        self.list, self.full, self.expected = [], False, []
        self.strobes, self.fulls, self.clock = [], [], 0
        self.offer = None
        self.done = False

    @property
    def finished(self):
        return not self.packets and self.offer is None and self.done

    def drive(self, ctx):
        lines = self.dut.broadcast
        ctx.set(self.dut.number, self.number)
        if self.offer is None and self.packets and not (self.pick and self.pick.random() < 0.3):
            self.offer = self.packets.popleft()
        operation, node, body = self.offer or (Operation.DRAW, self.number, 0)
        node_bits = self.dut.configuration.node_bits
        ctx.set(lines.packet.operation, operation)
        ctx.set(lines.packet.body.as_value(),
                node << len(lines.packet.body.as_value()) - node_bits | body)
        self.strobe = self.offer is not None and bool(ctx.get(lines.ready))
        ctx.set(lines.strobe, self.strobe)

    def sample(self, ctx):
        if self.room:
            assert ctx.get(self.dut.lists_full) == self.full
        counts = not self.strobes or self.clock > self.strobes[-1] + LATE
        self.done = counts and not self.strobe and bool(ctx.get(self.dut.broadcast.done))
        if self.done:
            assert self.elements.taken == self.expected, f"clock {self.clock}: done too soon"
            assert self.elements.finished or self.elements.late
        if self.offer and not self.elements.ready and self.elsewhere(self.offer):
            assert self.strobe, f"clock {self.clock}: another node's triangle waits"
        if self.strobe:
            self.strobes.append(self.clock)
            self.take(*self.offer)
            self.offer = None
        self.clock += 1

    def elsewhere(self, packet):
        return packet[0] in TRIANGLES and packet[1] != self.number

    def take(self, operation, node, body):
        if operation in TRIANGLES and node != self.number:
            return
        if operation == Operation.LOAD:
            self.full |= len(self.list) == self.room
            self.list += [body] * (len(self.list) < self.room)
            self.fulls.append(self.full)
        elif operation == Operation.DRAW_LISTS:
            self.expected += [(Operation.DRAW, kept) for kept in self.list]
        elif operation == Operation.CLEAR_LISTS:
            self.list, self.full = [], False
        elif operation != Operation.READ_DEPTH or self.number == 0:
            self.expected.append((operation, body))


def run(configuration, number, packets, *, seed=None):
    dut = NodeGate(configuration=configuration)
    elements = Elements(dut, seed, slow=seed is not None)
    host = Host(dut, number, packets, elements, seed=seed)
    m = Module()
    m.domains.sync = ClockDomain()  # without a list the gate has no register
    m.submodules.dut = dut
    simulate(m, elements, host, after=20)
    assert elements.taken == host.expected
    return host, elements


def random_packets(configuration, seed, number, count):
    """Half of the triangles for this node; operations that only lists have only where there are."""
    pick = random.Random(f"packets {seed} {number}")
    kinds = [Operation.DRAW] * 6 + [Operation.READ_DEPTH, Operation.READ_COUNTERS,
                                    Operation.FRAME_START, Operation.SURVEY]
    if configuration.list_words:
        kinds += [Operation.LOAD] * 8 + [Operation.DRAW_LISTS] * 2 + [Operation.CLEAR_LISTS]
    bits = prepared_triangle_layout(configuration).size - configuration.node_bits
    packets = []
    for _ in range(count):
        operation = pick.choice(kinds)
        node = pick.choice((number, pick.randrange(8)))
        packets.append((operation, node if operation in TRIANGLES else 0, pick.getrandbits(bits)))
    return packets


@pytest.mark.parametrize("list_words", [0, 1, 5, 30])
@pytest.mark.parametrize("number", [0, 4])
def test_random_packets(list_words, number):
    """Every one once, in order, and in the clock in which it is broadcast, if it is not replayed;
    those of other nodes are not seen and wait for nothing."""
    configuration = machine(list_words)
    for seed in range(2):
        packets = random_packets(configuration, f"{list_words} {seed}", number, 150)
        host, elements = run(configuration, number, packets, seed=f"{list_words} {number} {seed}")
        assert len(elements.taken) > 20 and len(host.strobes) == len(packets)
        at_once = set(host.strobes)
        if not list_words:
            assert set(elements.clocks) <= at_once
        elif list_words < 30:
            assert {False, True} == set(host.fulls)


@pytest.mark.parametrize("list_words", [0, 9])
def test_a_triangle_a_clock(list_words):
    """Whoever it is for; those of other nodes even while no element is ready (``run``)."""
    packets = [(Operation.DRAW, place % 3, place) for place in range(30)]
    host, elements = run(machine(list_words), 1, packets)
    assert host.strobes == list(range(30))
    assert elements.clocks == [clock for clock in host.strobes if clock % 3 == 1]


def test_lists_are_drawn_as_often_as_asked_for():
    """A triangle a clock of each, and other nodes' triangles do not wait for them."""
    count = 9
    configuration = machine(count)
    loads = [(Operation.LOAD, 2, 100 + place) for place in range(count)]
    draws = [(Operation.DRAW_LISTS, 0, 0)]
    host, elements = run(configuration, 2, [*loads, *draws * 3, (Operation.DRAW, 2, 7)])
    assert host.strobes[:count] == list(range(count))
    drawn = host.strobes[count:count + 3]
    first = [elements.clocks[count * place] for place in range(3)]
    assert [clock - begun for clock, begun in zip(first, drawn, strict=True)] == (
        [NodeGate.list_latency] * 3)
    for place in range(3):
        clocks = elements.clocks[count * place:count * (place + 1)]
        assert clocks == list(range(clocks[0], clocks[0] + count))
    # What follows is let through when the last triangle is known to be under way.
    assert drawn[1] == elements.clocks[count - 1] + LATE + 1
    assert elements.taken[-1] == (Operation.DRAW, 7)

    others = [(Operation.DRAW, 3, place) for place in range(5)]
    host, elements = run(configuration, 2, [*loads, *draws, *others])
    assert host.strobes[count:] == list(range(count, count + 6))


@pytest.mark.parametrize("number", range(3))
def test_only_node_0_reads_depths(number):
    _, elements = run(machine(), number, [(Operation.READ_DEPTH, 0, 0),
                                          (Operation.READ_COUNTERS, 0, 0)])
    assert [operation for operation, _ in elements.taken] == (
        [Operation.READ_DEPTH] * (number == 0) + [Operation.READ_COUNTERS])
