"""Which of the broadcast triangles meet a region of a processing element's own."""

from typing import NamedTuple

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from .own_regions import OwnRegions
from .region_box import cut, region_box

__all__ = ["RegionFilter", "RegionShare"]


class RegionShare(NamedTuple):
    """What a ``RegionFilter`` finds of a triangle, ``RegionFilter.latency`` clocks later.

    ``own``, ``large``  as in ``walked_outline_layout``
    ``keep``            it is to be kept
    """

    own: Value
    large: Value
    keep: Value


class RegionFilter:
    """Takes the place of the ``ShareFilter`` where regions are dealt out, and is used like it.

    A triangle whose box meets at most 2 × 2 regions is kept if one of them is the processing
    element's own.  One whose box meets more is always kept; whether it visits any is found later.
    A box without a pixel is dropped.

    Latency: ``latency`` clock, for which the queue holds the triangle in a register.
    Throughput: a triangle a clock.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that the processing element has in these.
    """

    latency = OwnRegions.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What it has to be told, besides the triangle."""
        return {"regions": In(RegionLines(self.configuration)),
                "element": In(self.configuration.element_bits)}

    def add_to(self, m: Module, triangle: data.View, inputs) -> RegionShare:
        """Put the filter into ``m``.

        ``triangle`` is a prepared triangle that may be another one in every clock; ``inputs`` has
        the ``members`` as attributes.
        """
        m.submodules.own_regions = own = OwnRegions(configuration=self.configuration)
        wiring.connect(m, wiring.flipped(inputs.regions), own.regions)
        box = region_box(triangle, self.configuration)
        m.d.comb += [
            own.element.eq(inputs.element),
            own.column.eq(cut(box.left, len(own.column))),
            own.row.eq(cut(box.top, len(own.row))),
        ]
        # "large" is a word of Verilog's own.
        filled, wide, tall, large, taken = (Signal(name=name) for name in (
            "filled_box", "wide_box", "tall_box", "large_box", "taken_box"))
        m.d.comb += [
            filled.eq((triangle.left < triangle.right) & (triangle.top < triangle.bottom)),
            wide.eq(box.left != box.right),
            tall.eq(box.top != box.bottom),
            # Where the box ends, the bits beyond it are those of other regions, or of none.
            own.asked.eq(Mux(filled, Cat(C(1), wide, tall, wide & tall), 0)),
        ]
        wider, taller = box.right - box.left > 1, box.bottom - box.top > 1
        m.d.sync += [large.eq(wider | taller), taken.eq(filled & (wider | taller))]
        return RegionShare(own.own, large, taken | own.some)

    def known(self, m: Module, share: RegionShare, kept: data.View, inputs) -> Value:
        """What goes with the outline ``kept`` into the queue, as in ``walked_outline_layout``."""
        return Cat(share.own, share.large)
