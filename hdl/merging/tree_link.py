"""What a node does in a step of a tree merge, and its place in the chain between nodes."""

from amaranth.hdl import *
from amaranth.lib import fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ..rasteriser.interpolator import fragment_layout
from .tree_words import TreeLines, tree_word_layout

__all__ = ["TreeLink"]


class TreeLink(wiring.Component):
    """Sends, receives or passes on, as the step and the node's number say.

    ::

         step   node  0   1   2   3   4   5
          0           ◀───1   2───3   4───5     a node whose number is a multiple of
                      ◀───    ◀───    ◀───      2 · 2**step receives from the one that
          1           ◀───────2       4         is 2**step further right, if there is one;
                      ◀───────                  those between them pass on
          2           ◀───────────────4

    The pieces of the chain that a pair needs are nobody else's in that step, so all pairs work
    at the same time (Blazek 1991, chapter V, algorithm 4 and figure 10).

    Words wait in one queue, whatever the node does; of two, so that ``ready`` does not run through
    the chain within a clock.

    Latency: ``latency`` clock from a word to the next node, or to ``received``.  Throughput: a word
    a clock.

    Parameters
    ----------
    id_bits, address_bits, depth_bits: int, positive
        Those of ``MemoryBus``.
    node_bits: int, positive
        Node lines on the backplane.

    Members
    -------
    number: In(node_bits)
        This node's.
    nodes: In(node_bits)
        How many there are.
    lines: In(TreeLines)
    sends: Out(1)
        In this step the node sends; from the clock of ``start`` on.
    own: In(stream of tree_word_layout)
        What it sends; only then.
    right: In(stream of tree_word_layout), left: Out(stream of tree_word_layout)
        The neighbours.
    received: Out(stream of fragment_layout)
        The pixels that this node receives.

    Raises ``ValueError`` where a number of bits is not positive.
    """

    latency = 1

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int, node_bits: int):
        bits = {"id_bits": id_bits, "address_bits": address_bits, "depth_bits": depth_bits}
        for name, value in bits.items():
            if value < 1:
                raise ValueError(f"{name} must be positive, not {value!r}")
        word = stream.Signature(tree_word_layout(**bits))
        lines = TreeLines(node_bits=node_bits)
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        self.node_bits = node_bits
        self._waiting = fifo.SyncFIFO(width=tree_word_layout(**bits).size, depth=2)
        super().__init__({
            "number": In(node_bits),
            "nodes": In(node_bits),
            "lines": In(lines),
            "sends": Out(1),
            "own": In(word),
            "right": In(word),
            "left": Out(word),
            "received": Out(stream.Signature(fragment_layout(**bits))),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.waiting = waiting = self._waiting
        lines = self.lines
        distance = Signal(self.node_bits)
        receives = Signal()
        m.d.comb += [
            distance.eq(1 << lines.step),
            self.sends.eq((self.number & ((distance << 1) - 1)) == distance),
            receives.eq((self.number & ((distance << 1) - 1)) == 0),
        ]

        word = tree_word_layout(id_bits=self.id_bits, address_bits=self.address_bits,
                                depth_bits=self.depth_bits)(waiting.r_data)
        source = Mux(self.sends, Value.cast(self.own.payload), Value.cast(self.right.payload))
        m.d.comb += [
            waiting.w_data.eq(source),
            waiting.w_en.eq(Mux(self.sends, self.own.valid, self.right.valid)),
            self.own.ready.eq(waiting.w_rdy & self.sends),
            self.right.ready.eq(waiting.w_rdy & ~self.sends),

            self.left.valid.eq(waiting.r_rdy & ~receives),
            self.left.payload.eq(word),
            self.received.valid.eq(waiting.r_rdy & receives & ~word.last),
            self.received.payload.eq(word.pixel),
            waiting.r_en.eq(Mux(receives, self.received.ready | word.last, self.left.ready)),
        ]
        with m.If(lines.start):
            m.d.sync += lines.busy.eq(receives & (self.number + distance < self.nodes))
        with m.Elif(waiting.r_rdy & receives & word.last):
            m.d.sync += lines.busy.eq(0)
        return m
