"""The merge card T: when all is drawn, nodes send their pictures to the left, pair by pair."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import memory_bus_bits
from ..backplane.words import Operation
from ..merging.node_sender import NodeSender
from ..merging.send_lines import SendLines
from ..merging.tree_link import TreeLink
from ..merging.tree_words import TreeLines, tree_word_layout
from ..rasteriser.interpolator import fragment_layout
from .merge_card import MergeCard

__all__ = ["TreeMerge"]


class TreeMerge(MergeCard):
    """Sends what its node has drawn, with what was merged into it, or has its processing elements
    draw what it receives; between the two it passes on (``TreeLink``).

    Only words that were drawn are sent.  After its step a node has nothing more to do.

    Latency: a clock from card to card.  Throughput: a pixel a clock.

    Members
    -------
    nodes: In(node_bits)
        How many there are.
    tree: In(TreeLines)
        The controller's.
    from_right: In(stream of tree_word_layout), to_left: Out(stream of tree_word_layout)
        The pieces of the chain between this card and its neighbours.
    units: Out(SendLines)
        To the node's memory units, with their wired answers.
    received: Out(stream of fragment_layout)
        To the node's processing elements; the wired and of all is ready.

    ``sent`` is the pixels of this frame that were sent.  Blazek 1991, chapter V, algorithm 4 and
    figure 10.
    """

    latency = TreeLink.latency

    @property
    def members(self):
        bits = memory_bus_bits(self.configuration)
        word = stream.Signature(tree_word_layout(**bits))
        return {
            "nodes": In(self.configuration.node_bits),
            "tree": In(TreeLines(node_bits=self.configuration.node_bits)),
            "from_right": In(word),
            "to_left": Out(word),
            "units": Out(SendLines(**bits)),
            "received": Out(stream.Signature(fragment_layout(**bits))),
        }

    def merge(self, m):
        bits = memory_bus_bits(self.configuration)
        m.submodules.sender = sender = NodeSender(**bits)
        m.submodules.chain = chain = TreeLink(**bits, node_bits=self.configuration.node_bits)
        wiring.connect(m, chain.lines, wiring.flipped(self.tree))
        wiring.connect(m, wiring.flipped(self.from_right), chain.right)
        wiring.connect(m, chain.left, wiring.flipped(self.to_left))
        wiring.connect(m, chain.received, wiring.flipped(self.received))
        wiring.connect(m, sender.words, chain.own)
        wiring.connect(m, sender.units, wiring.flipped(self.units))
        m.d.comb += [
            chain.number.eq(self.left.node),
            chain.nodes.eq(self.nodes),
            sender.total.eq(self.left.id),
            sender.start.eq(self.tree.start & chain.sends),
        ]
        broadcast, word = self.broadcast, chain.own
        with m.If(broadcast.strobe & (broadcast.packet.operation == Operation.FRAME_START)):
            m.d.sync += self.sent.eq(0)
        with m.Elif(word.valid & word.ready & ~word.payload.last):
            m.d.sync += self.sent.eq(self.sent + 1)
