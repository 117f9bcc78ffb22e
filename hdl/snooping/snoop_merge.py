"""The merge card S: nodes send in turn what they have drawn, and delete what is hidden."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import memory_bus_bits
from ..merging.node_sender import NodeSender
from ..merging.send_lines import SendLines
from ..merging.snoop_words import SnoopLines, bus_word_layout, heard_pixel_layout
from ..nodes.merge_card import MergeCard

__all__ = ["SnoopMerge"]


class SnoopMerge(MergeCard):
    """Listens until all nodes with lower numbers have ended, then sends what is left of what its
    node has drawn; what comes after is of nodes that listened to it.

    While it listens its node's memory units delete words for which they hear one that is as near or
    nearer.  It begins to send when these deletions have been made.

    Nothing waits on the bus: all listen as fast as any sends.

    Latency: ``latency`` clocks from a pixel to the memory units of other nodes.  Throughput: a
    pixel a clock.

    Members
    -------
    snoop: In(SnoopLines)
        The controller's; what has ended is for the controller alone.
    bus: In(bus_word_layout), said: Out(bus_word_layout)
        What any node says (wired or), and what this one does: 0 while it does not send.
    units: Out(SendLines)
        To the node's memory units, with their wired answers.
    heard: Out(heard_pixel_layout)
        To them: what lower nodes have sent.

    ``sent`` is the pixels of this frame that were sent.  Cox & Hanrahan 1993, sections 7 and 8.
    """

    latency = 2

    @property
    def members(self):
        bits = memory_bus_bits(self.configuration)
        word = bus_word_layout(**bits)
        return {
            "snoop": In(SnoopLines()),
            "bus": In(word),
            "said": Out(word),
            "units": Out(SendLines(**bits)),
            "heard": Out(heard_pixel_layout(**bits)),
        }

    def merge(self, m):
        m.submodules.sender = sender = NodeSender(**memory_bus_bits(self.configuration))
        wiring.connect(m, sender.units, wiring.flipped(self.units))
        arrived, words, heard = Signal.like(self.bus), sender.words, self.heard
        listening = Signal()
        ended = Signal(self.configuration.node_bits)  # nodes that have sent everything
        m.d.comb += [
            sender.total.eq(self.left.id),
            words.ready.eq(1),
            heard.valid.eq(listening & arrived.valid & ~arrived.word.last),
            *(heard[name].eq(arrived.word.pixel[name]) for name in ("unit", "address", "depth")),
        ]
        m.d.sync += [
            arrived.eq(self.bus),
            self.said.valid.eq(words.valid),
            Value.cast(self.said.word).eq(
                Mux(words.valid, Value.cast(words.payload), 0)),
        ]
        with m.If(words.valid & ~words.payload.last):
            m.d.sync += self.sent.eq(self.sent + 1)
        with m.FSM():
            with m.State("IDLE"), m.If(self.snoop.start):
                m.d.sync += [ended.eq(0), self.sent.eq(0)]
                m.next = "LISTEN"
            with m.State("LISTEN"):
                m.d.comb += listening.eq(1)
                m.d.sync += ended.eq(ended + (arrived.valid & arrived.word.last))
                with m.If(ended == self.left.node):
                    m.d.comb += sender.start.eq(1)
                    m.next = "IDLE"
