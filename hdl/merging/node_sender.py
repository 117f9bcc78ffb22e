"""Everything that was drawn into the units of a node, as one stream."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from .send_lines import SendLines
from .tree_words import tree_word_layout

__all__ = ["NodeSender"]


class NodeSender(wiring.Component):
    """Has all units of a node list at once, and takes two at a time, by their numbers.

    So only the listing of the first ones is waited for: the pixels of the others are ready
    when it is their turn, and a unit that has none takes a clock.  Of the two a pixel comes from
    each in turn: they are received by units of the same numbers, and where these have one port
    one reads while the other writes (``OnePortDepthTest``).

    Latency: none from a unit's pixel to ``words``.  Throughput: a pixel a clock, from unit to unit.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    total: In(id_bits)
        Number of memory units in the node.
    start: In(1)
        Send; ignored while sending.  Nothing is written until all is sent.
    units: Out(SendLines)
    words: Out(stream of tree_word_layout)
        The pixels of each unit in ascending order of their addresses, and ``last`` after all.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        bits = {"id_bits": id_bits, "address_bits": address_bits, "depth_bits": depth_bits}
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        super().__init__({
            "total": In(id_bits),
            "start": In(1),
            "units": Out(SendLines(**bits)),
            "words": Out(stream.Signature(tree_word_layout(**bits))),
        })

    def elaborate(self, platform):
        m = Module()
        units, word = self.units, self.words.payload
        following = Signal(self.id_bits + 1)  # the first of the next two
        finished = Signal(2)
        current = units.unit[0]
        ends, other_left = Signal(), Signal()
        m.d.comb += [
            word.pixel.unit.eq(units.unit),
            *(word.pixel[name].eq(units.pixel[name]) for name in units.pixel.shape().members),
            following.eq((units.unit | 1) + 1),
            ends.eq(~units.more & (~units.valid | self.words.ready)),
            other_left.eq(((units.unit ^ 1) < self.total)
                          & ~Mux(current, finished[0], finished[1])),
        ]
        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += units.unit.eq(0)
                with m.If(self.start):
                    m.next = "SETTLE"
            with m.State("SETTLE"), m.If(units.settled):
                m.d.comb += units.start.eq(1)
                m.next = "UNITS"
            with m.State("UNITS"):
                m.d.comb += [self.words.valid.eq(units.valid), units.ready.eq(self.words.ready)]
                with m.If(other_left & (ends | (self.words.valid & self.words.ready))):
                    m.d.sync += [current.eq(~current), finished.bit_select(current, 1).eq(ends)]
                with m.Elif(ends):
                    m.d.sync += [units.unit.eq(following), finished.eq(0)]
                    with m.If(following >= self.total):
                        m.next = "LAST"
            with m.State("LAST"):
                m.d.comb += [self.words.valid.eq(1), word.last.eq(1)]
                with m.If(self.words.ready):
                    m.next = "IDLE"
        return m
