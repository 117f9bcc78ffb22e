"""The Z-buffer comparison: read, compare, write, without a lost update (figure 3)."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .backplane import Lane, ProcessingElementLines
from .fragment_stepper import fragment_layout

__all__ = ["DepthTest"]


class DepthTest(wiring.Component):
    """A fragment strictly nearer than what is stored replaces it.

    Three stages: *read* asks the memory unit; *compare* takes the answer one
    clock later; *write* holds a winner until its unit takes it.  A fragment in
    *compare* whose pixel is in *write* compares with that winner instead of the
    stale answer, so two primitives may hit one pixel in consecutive clocks.  No
    older write can be further on: a unit's single port does not read while a
    write to it waits.

    Latency: a fragment taken in clock t is compared in t+1 and its write offered
    in t+2.  Throughput: a fragment a clock while its unit has the port; on a
    unit with one port each visible fragment takes two accesses.

    Members
    -------
    fragments: In(stream of fragment_layout)
    memory: Out(ProcessingElementLines)
    busy: Out(1)
        Holds a fragment.
    forwarded: Out(1)
        In this clock a comparison used a winner not yet in memory.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "fragments": In(stream.Signature(fragment_layout(configuration))),
            "memory": Out(ProcessingElementLines(configuration)),
            "busy": Out(1),
            "forwarded": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        memory, fragment = self.memory, self.fragments.payload
        layout = fragment_layout(self.configuration)
        comparing, winning = Signal(), Signal()
        compare, write = Signal(layout), Signal(layout)
        fresh = Signal()  # the answer is on the lines in this clock only
        held, stored = (Signal(self.configuration.depth_bits) for _ in range(2))
        same_pixel = Signal()

        write_moves = ~winning | ~memory.write_busy
        compare_moves = ~comparing | write_moves
        taken = self.fragments.valid & self.fragments.ready
        m.d.comb += [
            memory.read.valid.eq(self.fragments.valid & compare_moves),
            memory.read.unit.eq(fragment.unit),
            memory.read.address.eq(fragment.address),
            self.fragments.ready.eq(compare_moves & ~memory.read_busy),
            same_pixel.eq(winning & (write.unit == compare.unit)
                          & (write.address == compare.address)),
            stored.eq(Mux(same_pixel, write.depth, Mux(fresh, memory.read_data, held))),
            self.forwarded.eq(comparing & compare_moves & same_pixel),
            self.busy.eq(comparing | winning),
        ]
        m.d.sync += fresh.eq(taken)
        with m.If(fresh):
            m.d.sync += held.eq(memory.read_data)
        with m.If(compare_moves):
            m.d.sync += [comparing.eq(taken), compare.eq(fragment)]
        with m.If(write_moves):
            m.d.sync += [
                winning.eq(comparing & (compare.depth < stored)),
                write.eq(compare),
            ]
        m.d.comb += [
            memory.write.valid.eq(winning),
            memory.write.unit.eq(write.unit),
            memory.write.address.eq(write.address),
            memory.write.depth.eq(write.depth),
            memory.write.color.eq(write.color),
            memory.write.lanes.eq(Lane.DEPTH | Lane.BACK),
        ]
        return m
