"""A processing element card: draws into the memory units to its right."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.queues import depth_lanes
from ..backplane.connectors import BroadcastLines, Connector, memory_bus_bits
from ..backplane.region_lines import RegionLines
from ..depth_test.one_port import OnePortDepthTest
from ..depth_test.two_ports import TwoPortDepthTest
from ..rasteriser.interpolator import fragment_layout
from ..regions.region_counts import RegionCounts
from ..wires import wires
from .control import ProcessingElementControl
from .depth_read_back import DepthReadBack
from .drawing_element import DrawingElement
from .memory_bus_selector import MemoryBusSelector
from .merge_input import MergeInput
from .survey import Survey

__all__ = ["ProcessingElement"]


def counts_regions(configuration: MachineConfiguration) -> bool:
    """Regions are dealt out by what they cost."""
    return configuration.regions is not None and configuration.balance != "static"


class ProcessingElement(DrawingElement):
    """Owns the memory units up to the next processing element (figure 12).

    ::

        broadcast ─▶ queue ─▶ control ─▶ TriangleSpans ─▶ FIFO ─▶ FragmentStepper ─▶ Interpolator
                                │                                                        │
                                │                                                   depth test
                                ├─▶ Survey, DepthReadBack ─────────────────────────────▶ ┤
                                ▼                                                        ▼
                          response link ◀── from the right       memory bus to the right

    It drives the memory bus to its right and ignores the one from its left; the ID and
    the responses pass through.

    Latency: from a triangle's strobe to the read of its first fragment ``latency``
    clocks.  Throughput: a fragment a clock while ports are free: rows are found
    ahead, at one a clock, triangle after triangle.  Units with two ports take a
    fragment a clock.  In units with one port a visible fragment takes two accesses, so
    two clocks on one unit; on two it takes one where fragments alternate between them,
    within the few that wait; these also bridge rows without pixels (``OnePortDepthTest``).

    Members
    -------
    left: In(Connector), right: Out(Connector)
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    merge: In(stream of fragment_layout)
        What its node receives, only where nodes merge in a tree; nothing is drawn then
        (``MergeInput``).
    regions: In(RegionLines)
        Which regions are its own, only where they are dealt out.
    activity: Out(4)
        What it does in this clock; only where the configuration says ``observe``.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        bits = memory_bus_bits(configuration)
        self.depth_test = (OnePortDepthTest(**bits, lanes=depth_lanes(configuration))
                           if configuration.memory_ports == 1 else TwoPortDepthTest(**bits))
        self._control = ProcessingElementControl(id_bits=configuration.id_bits,
                                                 depth_bits=configuration.rank_bits,
                                                 order_bits=configuration.order_bits,
                                                 counts_regions=counts_regions(configuration),
                                                 counts_objects=configuration.forwards_objects)
        self._survey = Survey(**bits)
        self._read_back = DepthReadBack(**bits)
        self._selector = MemoryBusSelector(**bits)
        self._merge = MergeInput(**bits) if configuration.sends_drawn else None
        self._counts = (RegionCounts(configuration=configuration)
                        if counts_regions(configuration) else None)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
            **({"merge": In(stream.Signature(fragment_layout(**bits)))}
               if self._merge is not None else {}),
            **({} if configuration.regions is None else
               {"regions": In(RegionLines(configuration))}),
            **self.members,
        }, configuration=configuration)

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What a card has besides that does more."""
        return {}

    @property
    def latency(self) -> int:
        return self.drawing_latency + self.depth_test.waiting

    def elaborate(self, platform):
        m = Module()
        self._add_pipeline(m)
        m.submodules.depth_test = self.depth_test
        m.submodules.survey = self._survey
        m.submodules.read_back = self._read_back
        m.submodules.link = self._link
        if self._picture is not None:
            m.submodules.picture = self._picture
        self._connect_broadcast(wires(m, "operation_wires"), self._heard)
        drawing = wires(m, "drawing_wires")
        self._connect_drawing(m, drawing, self.depth_test.busy)
        if self._merge is None:
            wiring.connect(drawing, self._interpolator.fragments, self.depth_test.fragments)
        else:
            self._connect_merge(m, drawing, self._merge)
        self._connect_domain(wires(m, "domain_wires"))
        if self.configuration.regions is not None:
            self._connect_regions(wires(m, "region_wires"))
        if self._counts is not None:
            m.submodules.counts = self._counts
        self._connect_services(wires(m, "service_wires"))
        m.submodules.selector = self._selector
        self._connect_memory_bus(wires(m, "line_wires"))
        self._count(m, self._drawn, self._drawing)
        if self.configuration.observe:
            scanned = self.right.lines.scanned
            self._observe(m, self._drawn, scanned.bit_select(self._drawn.payload.unit[0], 1))
        self._connect_responses(wires(m, "response_wires"), self._heard)
        return m

    @property
    def _heard(self):
        """The lines that tell it what to do."""
        return self.broadcast

    def _connect_merge(self, m, pipeline, merge):
        """What the node receives goes to the depth test when nothing is drawn."""
        m.submodules.merge_input = merge
        wiring.connect(pipeline, self._interpolator.fragments, merge.drawn)
        wiring.connect(pipeline, merge.fragments, self.depth_test.fragments)
        wiring.connect(pipeline, wiring.flipped(self.merge), merge.received)
        pipeline.d.comb += [
            merge.first.eq(self.left.id),
            merge.end.eq(self._survey.end),
            merge.frame_start.eq(self._control.frame_start),
        ]

    @property
    def _drawn(self):
        """The fragments that the element draws itself."""
        return self.depth_test.fragments if self._merge is None else self._merge.drawn

    @property
    def _drawing(self):
        """It draws, and does not merge."""
        drawing = self._control.drawing
        return drawing if self._merge is None else drawing & ~self._merge.merging

    def _connect_domain(self, m):
        """First unit from the ID lines, upper end from the survey."""
        if self.configuration.node_bits:
            m.d.comb += self.right.node.eq(self.left.node)
        rasteriser, interpolator, picture = self._rasteriser, self._interpolator, self._picture
        survey, read_back, control = self._survey, self._read_back, self._control
        first, end = self.left.id, survey.end
        m.d.comb += self.right.id.eq(first)
        if picture is None:
            walkers, drawers = (), ()
            last_word = self.configuration.words - 1
        else:
            m.d.comb += [picture.total.eq(self.total), rasteriser.width.eq(picture.width)]
            walkers, drawers = (rasteriser,), (rasteriser, interpolator)
            last_word = picture.last_word
        m.d.comb += [part.total.eq(self.total) for part in (*drawers, survey)]
        m.d.comb += [part.first.eq(first) for part in (*walkers, survey, read_back, control)]
        m.d.comb += [part.end.eq(end) for part in (*walkers, read_back, control)]
        m.d.comb += read_back.last_word.eq(last_word)

    def _connect_regions(self, m):
        """The tables, its number in them, and what it counts of its own."""
        queue, rasteriser = self._queue, self._rasteriser
        wiring.connect(m, wiring.flipped(self.regions), queue.regions, rasteriser.regions)
        element = self.left.id >> self.configuration.share_bits
        m.d.comb += [part.element.eq(element)
                     for part in (queue, rasteriser, self._interpolator)]
        counts, control = self._counts, self._control
        if counts is not None:
            m.d.comb += [
                counts.row.eq(rasteriser.row),
                counts.clear.eq(control.frame_start),
                counts.start.eq(control.counts_start),
                control.counts_done.eq(counts.done),
            ]
            wiring.connect(m, counts.counts, control.counts)

    def _connect_services(self, m):
        """Survey and read-back, and whether one of them has the memory bus."""
        control, selector = self._control, self._selector
        for name, part in (("survey", self._survey), ("read_back", self._read_back)):
            m.d.comb += [
                part.start.eq(getattr(control, f"{name}_start")),
                getattr(control, f"{name}_done").eq(part.done),
            ]
        wiring.connect(m, self._read_back.depths, control.depths)
        m.d.comb += [selector.surveying.eq(control.surveying),
                     selector.reading.eq(control.reading)]

    def _connect_memory_bus(self, m):
        selector = self._selector
        wiring.connect(m, self._survey.memory, selector.survey)
        wiring.connect(m, self._read_back.memory, selector.read_back)
        wiring.connect(m, self.depth_test.memory, selector.depth_test)
        wiring.connect(m, selector.lines, wiring.flipped(self.right.lines))
