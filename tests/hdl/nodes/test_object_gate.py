"""What of the broadcast reaches a node that makes triangles of objects, and what its elements get,
against ``prepare``."""

import random
from collections import deque

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import prepare
from object_bench.objects import object_commands, object_machine, object_word, random_objects

from cardcage.golden.objects.making import made_at_nodes
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference import triangle_words
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation, prepared_triangle_layout
from cardcage.hdl.nodes.object_gate import ObjectGate

LATE = BroadcastLines.settle_clocks


class Elements(Agent):
    """A node's processing elements as one, which take packets at random, and show them in ``done``
    as late as the controller has to bear with."""

    def __init__(self, dut, seed):
        self.dut, self.pick = dut, random.Random(f"elements {seed}")
        self.late = self.work = 0
        self.taken = []

    def drive(self, ctx):
        self.ready = self.pick.random() < 0.6
        ctx.set(self.dut.own.ready, self.ready)
        ctx.set(self.dut.own.done, not self.work or self.late > 0)

    def sample(self, ctx):
        own = self.dut.own
        self.late, self.work = max(0, self.late - 1), max(0, self.work - 1)
        if ctx.get(own.strobe):
            assert self.ready, "a strobe while the elements are not ready"
            draws = ctx.get(own.packet.operation) == Operation.DRAW
            body = ctx.get(own.packet.body.draw.as_value())
            self.taken.append((ctx.get(own.packet.operation), body if draws else None))
            self.late, self.work = LATE, LATE + self.pick.randrange(9)


class Host(Agent):
    """The controller: strobes each packet, (operation, its body as a number), as soon as the gate
    is ready; ``here``: it is for this node.  Packets that are not of triangles wait for ``done``,
    as the controller has them do."""

    def __init__(self, dut, number, packets, elements, expected):
        self.dut, self.number, self.elements, self.expected = dut, number, elements, expected
        self.packets = deque(packets)
        self.done, self.quiet, self.held = False, LATE + 1, 0

    @property
    def finished(self):
        return not self.packets and self.done

    def drive(self, ctx):
        lines = self.dut.broadcast
        ctx.set(self.dut.number, self.number)
        ctx.set(self.dut.total, self.dut.configuration.units)
        self.strobe = False
        if self.packets:
            operation, body, here = self.packets[0]
            ctx.set(lines.packet.operation, operation)
            ctx.set(lines.packet.body.as_value(), body)
            ready = ctx.get(lines.ready)
            if not here:
                assert ready, "what is for another node waits"
            self.held += not ready
            waits = operation not in (Operation.MAKE, Operation.DRAW)
            self.strobe = bool(ready) and not (waits and not self.done)
        ctx.set(lines.strobe, self.strobe)

    def sample(self, ctx):
        self.quiet = 0 if self.strobe else self.quiet + 1
        self.done = self.quiet > LATE and bool(ctx.get(self.dut.broadcast.done))
        if self.strobe:
            self.packets.popleft()
        if self.done and not self.packets:
            assert self.elements.taken == self.expected, "done too soon"


def packets(configuration, words, number):
    """Of commands, as the controller broadcasts them."""
    found = []
    for word in words:
        opcode, body = Opcode(commands.opcode_of(word)), word >> commands.BODY_OFFSET
        if opcode == Opcode.FRAME_START:
            found.append((Operation.FRAME_START, 0, True))
            continue
        if opcode == Opcode.PREPARED_TRIANGLE:
            node = body >> prepared_triangle_layout(configuration).size - configuration.node_bits
            found.append((Operation.DRAW, body, node == number))
            continue
        layout = {Opcode.OBJECT: commands.object_layout,
                  Opcode.TRIANGLE: commands.triangle_layout}.get(opcode)
        here = layout is None or commands.unpack(layout(configuration), body)["node"] == number
        found.append((Operation.MAKE, object_word(word), here))
    return found


def prepared_words(configuration, listed):
    """The triangles of a list as the host sends them when it sets them up, and those of a node as
    they are broadcast."""
    shares = organisation_of(configuration).shares(listed)
    prepared = prepare(configuration, listed)
    words = triangle_words.prepared_triangles(
        configuration, prepared, {"node": shares.node, "round": shares.round})
    place = shares.host_place[prepared.primitive].argsort()
    node = shares.node[prepared.primitive][place]
    return list(words[place]), node


@pytest.mark.parametrize("number", [0, 2])
def test_objects_and_prepared_triangles(number):
    """In order; the counts are golden's, since the frame's start between two lists."""
    configuration = object_machine("3x(PMC)", packet=1, setup_interval=8, shading="flat",
                                   sub_bits=3, fraction_bits=8)
    lists = [random_objects(configuration, 60, seed, (0, 2, 3), wide=True) for seed in (3, 4)]
    words, expected = [commands.command(Opcode.CLEAR_LISTS)], []
    start = commands.command(Opcode.FRAME_START)
    for objects in lists:
        listed = objects.display_list()
        load, draw = object_commands(configuration, objects)
        sent, node = prepared_words(configuration, listed)
        own = [(Operation.DRAW, int(word) >> commands.BODY_OFFSET)
               for word, place in zip(sent, node, strict=True) if place == number]
        words += [start, *load, *draw, *sent, commands.command(Opcode.CLEAR_LISTS)]
        expected += [(Operation.FRAME_START, None), *own, *own]
    dut = ObjectGate(configuration=configuration)
    elements = Elements(dut, number)
    host = Host(dut, number, packets(configuration, words, number), elements, expected)
    counts = []

    class Counts(Agent):
        def sample(self, ctx):
            counts[:] = [ctx.get(dut.made), ctx.get(dut.dropped), ctx.get(dut.lists_full)]

    simulate(dut, elements, host, Counts(), after=5)
    assert elements.taken == expected
    made = made_at_nodes(configuration, lists[-1].display_list())[number]
    assert counts == [made.made, made.dropped, 0] and min(counts[:2]) > 5
    assert host.held > 50  # by the queue that was full, and by prepared triangles
