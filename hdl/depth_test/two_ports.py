"""The Z-buffer comparison on units with two ports, where nothing ever waits (figure 3)."""

from amaranth.hdl import *
from amaranth.lib import wiring

from .signature import DepthTestSignature

__all__ = ["TwoPortDepthTest"]


class TwoPortDepthTest(wiring.Component):
    """A fragment strictly nearer than what is stored replaces it.

    Four stages, moving on in every clock: *read* asks the memory unit, *answer*
    receives the stored depth, *compare* decides, *write* sends a winner.  A read
    sees the writes of earlier clocks, and what it sees of one in its own clock is
    unknown: so the winners that the three fragments before it may be are looked at
    in its place.  Those two and three clocks ahead are in *write*, or written in the
    last clock, while it is in *answer*; the one a clock ahead is in *write* while it
    is in *compare*.  The pixels are compared a clock before their depths are needed.

    Latency: ``latency`` clocks from a fragment's read to its write.  Throughput:
    a fragment a clock, visible or not.

    Parameters and members: those of ``DepthTestSignature``.  ``fragments`` is always ready, and
    the busy signals of the memory bus are not looked at.
    """

    latency = 3
    waiting = 0  #: Clocks from a fragment to its read.

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        super().__init__(DepthTestSignature(id_bits=id_bits, address_bits=address_bits,
                                            depth_bits=depth_bits))

    def elaborate(self, platform):
        m = Module()
        memory, fragment = self.memory, self.fragments.payload
        layout = fragment.shape()
        answer = Signal(layout, reset_less=True)
        compare = Signal(layout, reset_less=True)
        write = Signal(layout, reset_less=True)
        written = Signal(layout, reset_less=True)
        answering = Signal()
        comparing = Signal()
        winning = Signal()
        was_winning = Signal()
        stored = Signal(self.depth_bits, reset_less=True)
        nearest = Signal(self.depth_bits, reset_less=True)
        follows = Signal()  # compare's pixel is that of the fragment a clock ahead

        m.d.comb += [
            self.fragments.ready.eq(1),
            memory.read.valid.eq(self.fragments.valid),
            memory.read.unit.eq(fragment.unit),
            memory.read.address.eq(fragment.address),
            memory.write.valid.eq(winning),
            *(memory.write[name].eq(write[name]) for name in ("unit", "address", "depth", "color")),
            self.busy.eq(answering | comparing | winning),
        ]

        def same_pixel(other):
            return (other.unit == answer.unit) & (other.address == answer.address)

        writing, wrote = Signal(), Signal()
        m.d.comb += [
            writing.eq(winning & same_pixel(write)),
            wrote.eq(was_winning & same_pixel(written)),
            nearest.eq(Mux(follows & winning, write.depth, stored)),
            self.forwarded.eq((answering & (writing | wrote)) | (comparing & follows & winning)),
        ]
        m.d.sync += [
            answering.eq(self.fragments.valid),
            answer.eq(fragment),
            comparing.eq(answering),
            compare.eq(answer),
            stored.eq(Mux(writing, write.depth, Mux(wrote, written.depth, memory.read_data))),
            follows.eq(same_pixel(compare)),
            winning.eq(comparing & (compare.depth < nearest)),
            write.eq(compare),
            was_winning.eq(winning),
            written.eq(write),
        ]
        with m.If(~comparing):  # the idle bus has address 0, as the signature says
            m.d.sync += write.address.eq(0)
        return m
