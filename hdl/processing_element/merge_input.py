"""Pixels of other nodes on their way into the depth test of a processing element."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..rasteriser.interpolator import fragment_layout

__all__ = ["MergeInput"]


class MergeInput(wiring.Component):
    """Gives the depth test what the element draws, or what its node receives when all is drawn.

    A received pixel is offered to all elements of the node.  The one whose domain holds its unit
    takes it, as a fragment; the others let it pass, and where it is nobody's it is dropped.  What
    is stored is of the node with the lower number, and stays unless what comes is nearer.

    Latency: none.  Throughput: a fragment a clock.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    first, end: In(id_bits)
        The domain, ``end`` excluded.
    drawn: In(stream of fragment_layout)
    received: In(stream of fragment_layout)
        Not while anything is drawn.  What is ready is the wired and of all elements.
    fragments: Out(stream of fragment_layout)
    frame_start: In(1)
        A new picture is drawn from now on.
    merging: Out(1)
        From the clock after the first pixel of a picture that is received until the next one
        starts: the depth test has nothing to do with drawing.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        fragments = stream.Signature(fragment_layout(id_bits=id_bits, address_bits=address_bits,
                                                     depth_bits=depth_bits))
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        super().__init__({
            "first": In(id_bits),
            "end": In(id_bits),
            "drawn": In(fragments),
            "received": In(fragments),
            "fragments": Out(fragments),
            "frame_start": In(1),
            "merging": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        drawn, received, fragments = self.drawn, self.received, self.fragments
        unit = received.payload.unit
        mine = Signal()
        m.d.comb += [
            mine.eq((unit >= self.first) & (unit < self.end)),
            fragments.valid.eq(drawn.valid | (received.valid & mine)),
            Value.cast(fragments.payload).eq(
                Mux(drawn.valid, Value.cast(drawn.payload), Value.cast(received.payload))),
            drawn.ready.eq(fragments.ready),
            received.ready.eq(~mine | (fragments.ready & ~drawn.valid)),
        ]
        with m.If(self.frame_start):
            m.d.sync += self.merging.eq(0)
        with m.Elif(received.valid):
            m.d.sync += self.merging.eq(1)
        return m
