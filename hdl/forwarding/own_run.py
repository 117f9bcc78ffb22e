"""Which run of regions a processing element has."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from .reach import run_layout

__all__ = ["OwnRun"]


class OwnRun(wiring.Component):
    """Listens while a table comes, region by region, and keeps where its own run begins and ends.

    The table's elements ascend, so two places are all that has to be known of it: before the one
    lie only regions of earlier elements, after the other only those of later ones.

    Latency: a clock from a region on the lines.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        A table that comes once, before the first frame; the number that it has in that.
    run: Out(run_layout)

    Blazek 1991, chapter V: a node knows which part of the screen is its own.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "run": Out(run_layout(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        lines, run = self.regions, self.run
        place = Cat(lines.column, lines.row)
        # Some region so far is its own or a later element's; its own or an earlier one's.
        begun, ended = Signal(), Signal()
        m.d.comb += [run.none_from.eq(~begun), run.none_to.eq(~ended)]
        with m.If(lines.valid):
            starts = place == 0  # a new table
            m.d.sync += [begun.eq((begun & ~starts) | (lines.element >= self.element)),
                         ended.eq((ended & ~starts) | (lines.element <= self.element))]
            with m.If(~begun | starts):
                m.d.sync += Value.cast(run.first).eq(place)
            with m.If(lines.element <= self.element):
                m.d.sync += Value.cast(run.last).eq(place)
        return m
