"""The Z-buffer comparison: read, compare, write, without a lost update (figure 3)."""

from amaranth.hdl import *
from amaranth.lib import wiring

from .signature import DepthTestSignature

__all__ = ["OnePortLane"]


class OnePortLane(wiring.Component):
    """A fragment strictly nearer than what is stored replaces it; one after the other, in order.

    Four stages: *read* asks the memory unit, *answer* takes the stored depth
    into a register, *compare* decides, *write* holds a winner until its unit
    takes it.  A fragment in *compare* whose pixel is in *write*, or was written
    last, compares with that winner instead of its stale answer; so primitives
    may hit one pixel in consecutive clocks.  No older write can be missing from
    the answer: when a fragment is read at most two before it are still on their way,
    and it is compared no later than in the clock in which the second one is written.

    A write is offered three clocks after its read.  Three is odd on purpose: on
    one unit reads and writes then take turns, so that its port is never idle.

    Latency: ``latency`` clocks from a fragment's read to its write.  Throughput:
    a fragment a clock while its unit has the port: on one unit each visible
    fragment takes two accesses, two units in turn take one a clock.

    Parameters and members: those of ``DepthTestSignature``.
    """

    latency = 3

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
        answer = Signal(layout)
        compare = Signal(layout)
        write = Signal(layout)
        written = Signal(layout)
        answering = Signal()
        comparing = Signal()
        winning = Signal()
        has_written = Signal()
        fresh = Signal()  # the answer is on the memory bus in this clock only
        held = Signal(self.depth_bits)
        stored = Signal(self.depth_bits)

        # Each stage moves on when the next one is empty or moves on itself.
        write_moves = ~winning | ~memory.write_busy
        compare_moves = ~comparing | write_moves
        answer_moves = ~answering | compare_moves
        taken = self.fragments.valid & self.fragments.ready
        m.d.comb += [
            memory.read.valid.eq(self.fragments.valid & answer_moves),
            memory.read.unit.eq(fragment.unit),
            memory.read.address.eq(fragment.address),
            self.fragments.ready.eq(answer_moves & ~memory.read_busy),
            self.busy.eq(answering | comparing | winning),
        ]
        m.d.sync += fresh.eq(taken)
        with m.If(answer_moves):
            m.d.sync += [answering.eq(taken), answer.eq(fragment)]
        with m.If(fresh):
            m.d.sync += held.eq(memory.read_data)
        with m.If(compare_moves):
            m.d.sync += [
                comparing.eq(answering),
                compare.eq(answer),
                stored.eq(Mux(fresh, memory.read_data, held)),
            ]

        def same_pixel(valid, other):
            return (valid & (other.unit == compare.unit) & (other.address == compare.address))

        waiting = Signal()
        done = Signal()
        nearest = Signal.like(stored)
        m.d.comb += [
            waiting.eq(same_pixel(winning, write)),
            done.eq(same_pixel(has_written, written)),
            nearest.eq(Mux(waiting, write.depth, Mux(done, written.depth, stored))),
            self.forwarded.eq(comparing & compare_moves & (waiting | done)),
        ]
        with m.If(write_moves):
            m.d.sync += [winning.eq(comparing & (compare.depth < nearest)), write.eq(compare)]
            with m.If(~comparing):  # the idle bus has address 0, as the signature says
                m.d.sync += write.address.eq(0)
            with m.If(winning):
                m.d.sync += [has_written.eq(1), written.eq(write)]
        with m.If(~self.busy):
            # Every later read sees the write in memory.  It must be forgotten here: a new frame,
            # which starts when nothing is busy, makes the word background.
            m.d.sync += has_written.eq(0)
        m.d.comb += [
            memory.write.valid.eq(winning),
            memory.write.unit.eq(write.unit),
            memory.write.address.eq(write.address),
            memory.write.depth.eq(write.depth),
            memory.write.color.eq(write.color),
        ]
        return m
