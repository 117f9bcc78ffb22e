"""Takes tables of regions, and refuses those that are none."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.regions import Regions
from ..backplane.region_lines import RegionLines
from ..backplane.words import struct_layout

__all__ = ["RegionTable", "after", "region_layout"]


def region_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A region and its processing element: the body of ``REGION``."""
    return struct_layout(commands.region_layout(configuration))


def after(regions: Regions, column: Value, row: Value) -> tuple[Value, Value, Value]:
    """Column and row of the next region, of the first one after the last, and whether this is the
    last one."""
    end_of_row = column == regions.columns - 1
    last = end_of_row & (row == regions.rows - 1)
    return Mux(end_of_row, 0, column + 1), Mux(last, 0, row + end_of_row), last


class RegionTable(wiring.Component):
    """Has a table filled region by region while another one is in use.

    A table comes row by row from region (0, 0) on, which always begins a new one.  Whoever gives
    it need not know of slots: a region's is the number of lower ones that its processing element
    has, and is counted here.  A table that has come whole waits until ``take`` takes it into use;
    one that is begun in the meantime takes its place.  Of a table that is refused the rest is
    passed over.

    Latency: a clock from a region to ``lines``, and from ``take`` to ``lines.table``.  Throughput:
    a region a clock.

    Members
    -------
    elements: In(element_bits)
        How many processing elements there are.
    offer: In(1), region: In(region_layout)
        A region is given away in this clock.
    late: In(1)
        That is too late: a frame has begun.
    next_column: Out, next_row: Out
        The region that is expected; where none is begun, (0, 0).
    fault: Out(range of Fault)
        What is wrong with the region offered; 0 where nothing is, or it is passed over.
    start: In(1)
        A frame begins, and what has not come whole never will.
    unfinished: Out(1)
        Some regions of a table have come, and not all.
    whole: Out(1)
        A table waits for ``take``.
    take: In(1)
        Take it into use, if there is one; not in the clock of an offer.
    swap: In(1)
        The picture that is drawn by the table in use is shown.
    lines: Out(RegionLines)
    shown: Out(1)
        The table of the picture shown, from the clock after ``swap`` on.

    Ellsworth 1994: the assignment that is sent to all processors before a frame.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        layout = region_layout(configuration)
        super().__init__({
            "elements": In(configuration.element_bits),
            "offer": In(1),
            "region": In(layout),
            "late": In(1),
            "next_column": Out(layout["column"].shape),
            "next_row": Out(layout["row"].shape),
            "fault": Out(range(max(Fault) + 1)),
            "start": In(1),
            "unfinished": Out(1),
            "whole": Out(1),
            "take": In(1),
            "swap": In(1),
            "lines": Out(RegionLines(configuration)),
            "shown": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        regions, region, lines = self.configuration.dealt_regions, self.region, self.lines
        refused = Signal()  # and said so
        first, wrong = Signal(), Signal(self.fault.shape())
        # Regions of the table that each processing element has so far.
        held = Array(Signal(range(self.configuration.slots + 1), name=f"held_{element}")
                     for element in range(self.configuration.maximum_units
                                          >> self.configuration.share_bits))
        slot = Signal.like(held[0], name="slot")
        place = Cat(region.column, region.row)
        expected = Cat(self.next_column, self.next_row)
        m.d.comb += [
            first.eq(place == 0),
            slot.eq(Mux(first, 0, held[region.element])),
            self.unfinished.eq(expected != 0),
        ]
        with m.If(self.late):
            m.d.comb += wrong.eq(Fault.TABLE_LATE)
        with m.Elif(~first & (self.whole | (place < expected))):
            m.d.comb += wrong.eq(Fault.REGION_TWICE)
        with m.Elif((~first & (place != expected)) | (region.element >= self.elements)):
            m.d.comb += wrong.eq(Fault.REGION_TO_NOBODY)
        with m.Elif(slot == self.configuration.slots):
            m.d.comb += wrong.eq(Fault.NO_SLOT)

        passed_over = refused & ~first
        given = self.offer & ~passed_over & (wrong == 0)
        next_column, next_row, last = after(regions, region.column, region.row)
        m.d.comb += self.fault.eq(Mux(self.offer & ~passed_over, wrong, 0))
        m.d.sync += [
            lines.valid.eq(given),
            lines.bank.eq(~lines.table),
            lines.column.eq(region.column),
            lines.row.eq(region.row),
            lines.element.eq(region.element),
            lines.slot.eq(slot),
        ]
        with m.If(self.take & self.whole):
            m.d.sync += [lines.table.eq(~lines.table), self.whole.eq(0)]
        with m.If(given):
            m.d.sync += [
                refused.eq(0),
                self.whole.eq(last),
                self.next_column.eq(next_column),
                self.next_row.eq(next_row),
            ]
            with m.If(first):
                m.d.sync += [counter.eq(0) for counter in held]
            m.d.sync += held[region.element].eq(slot + 1)
        with m.If((self.fault != 0) | (self.start & self.unfinished)):
            m.d.sync += [refused.eq(1), self.whole.eq(0),
                         self.next_column.eq(0), self.next_row.eq(0)]
        with m.If(self.swap):
            m.d.sync += self.shown.eq(lines.table)
        return m
