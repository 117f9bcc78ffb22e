"""What a processing element does with each operation it was told."""

from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import (
    RESPONSE_FIELDS,
    RESPONSE_VALUE_BITS,
    ResponseKind,
)
from ..backplane.words import Operation, response_layout, struct_layout

__all__ = ["ProcessingElementControl"]


class ProcessingElementControl(wiring.Component):
    """Takes the operations that are no triangles, each when the datapath is empty.
    Control only: it moves no pixel, and triangles do not pass through it.

    Latency: an operation starts in the clock in which it comes, or the datapath is empty.

    Parameters
    ----------
    id_bits, depth_bits: int, positive
        As of ``MemoryBus``.
    order_bits: int
        The low bits of a depth word that are no depth, and not reported.
    counts_regions: bool
        Regions are dealt out, and what they cost is counted.
    counts_objects: bool
        Objects are passed on, and what becomes of them is counted.

    Members
    -------
    operations: In(stream of Operation)
        After the triangles before it have been taken; none follow until it is taken.
    drawing: In(1)
        The datapath holds something, or did a clock ago: once it is low, the depth test has been
        idle for a clock and its write address is 0, as a survey needs it (``DepthTestSignature``).
    survey_start, read_back_start: Out(1)
    survey_done, read_back_done: In(1)
        The two services.
    surveying, reading: Out(1)
        Who has the memory bus; the depth test when neither is high.
    frame_start: Out(1)
        Count from the next clock on.
    first, end: In(id_bits)
        The domain, for the report.
    depths: In(stream of depth words)
        0 while not valid.
    fragments, busy_cycles: In(RESPONSE_VALUE_BITS)
        The counts to report.
    responses: Out(stream of response_layout)
        0 while not valid.
    idle: Out(1)
        No operation here, and the datapath is empty.
    counts_start: Out(1), counts_done: In(1), counts: In(stream of RESPONSE_VALUE_BITS)
        A third service, of ``RegionCounts``, only if it ``counts_regions``; 0 while not valid.
    made, dropped, forwarded: In(RESPONSE_VALUE_BITS)
        Further counts to report, only if it ``counts_objects``.

    Fuchs & Johnson, the steps after figure 12.  Raises ``ValueError`` where a number of bits is
    not positive.
    """

    def __init__(self, *, id_bits: int, depth_bits: int, order_bits: int = 0,
                 counts_regions: bool = False, counts_objects: bool = False):
        for name, bits in (("id_bits", id_bits), ("depth_bits", depth_bits)):
            if bits < 1:
                raise ValueError(f"{name} must be positive, not {bits!r}")
        if not 0 <= order_bits < depth_bits:
            raise ValueError(f"order_bits must be 0 to {depth_bits - 1}, not {order_bits!r}")
        self.id_bits = id_bits
        self.depth_bits = depth_bits
        self.order_bits = order_bits
        self.counts_regions = counts_regions
        # What is reported after the work, and with which member.
        self._further = {kind: kind.name.lower() for kind in (
            ResponseKind.MADE, ResponseKind.DROPPED, ResponseKind.FORWARDED)[:3 * counts_objects]}
        super().__init__({
            "operations": In(stream.Signature(Operation, payload_init=Operation.SURVEY)),
            "drawing": In(1),
            **{f"{service}_{when}": flow(1) for service in ("survey", "read_back")
               for when, flow in (("start", Out), ("done", In))},
            "surveying": Out(1),
            "reading": Out(1),
            "frame_start": Out(1),
            "first": In(id_bits),
            "end": In(id_bits),
            "depths": In(stream.Signature(depth_bits)),
            "fragments": In(RESPONSE_VALUE_BITS),
            "busy_cycles": In(RESPONSE_VALUE_BITS),
            "responses": Out(stream.Signature(response_layout())),
            "idle": Out(1),
            **({"counts_start": Out(1), "counts_done": In(1),
                "counts": In(stream.Signature(RESPONSE_VALUE_BITS))} if counts_regions else {}),
            **dict.fromkeys(self._further.values(), In(RESPONSE_VALUE_BITS)),
        })

    @property
    def _depth(self):
        return self.depths.payload[self.order_bits:] if self.order_bits else self.depths.payload

    def elaborate(self, platform):
        m = Module()
        operations, response = self.operations, self.responses.payload

        with m.FSM() as state:
            with m.State("DRAW"):
                m.d.comb += self.idle.eq(~operations.valid & ~self.drawing)
                with m.If(operations.valid & ~self.drawing), m.Switch(operations.payload):
                    with m.Case(Operation.SURVEY):
                        m.d.comb += self.survey_start.eq(1)
                        m.next = "SURVEY"
                    with m.Case(Operation.FRAME_START):
                        m.d.comb += [self.frame_start.eq(1), operations.ready.eq(1)]
                    with m.Case(Operation.READ_DEPTH):
                        m.d.comb += self.read_back_start.eq(1)
                        m.next = "READ_BACK"
                    with m.Case(Operation.READ_COUNTERS):
                        m.next = "REPORT_FRAGMENTS"
                    if self.counts_regions:
                        with m.Case(Operation.READ_REGIONS):
                            m.d.comb += self.counts_start.eq(1)
                            m.next = "REPORT_REGIONS"
                    with m.Default():  # a newer controller's operation: not for this card
                        m.d.comb += operations.ready.eq(1)
            with m.State("SURVEY"):
                m.d.comb += self.surveying.eq(1)
                with m.If(self.survey_done):
                    m.next = "REPORT_DOMAIN"
            with m.State("READ_BACK"):
                m.d.comb += [
                    self.reading.eq(1),
                    self.responses.valid.eq(self.depths.valid),
                    self.depths.ready.eq(self.responses.ready),
                ]
                with m.If(self.read_back_done):
                    m.d.comb += operations.ready.eq(1)
                    m.next = "DRAW"
            order = ["FRAGMENTS", "BUSY", *(kind.name for kind in self._further)]
            after = [*(f"REPORT_{kind}" for kind in order[1:]), "DRAW"]
            for kind, following in (("DOMAIN", "DRAW"), *zip(order, after, strict=True)):
                with m.State(f"REPORT_{kind}"):
                    m.d.comb += self.responses.valid.eq(1)
                    with m.If(self.responses.ready):
                        m.d.comb += operations.ready.eq(following == "DRAW")
                        m.next = following

            if self.counts_regions:
                with m.State("REPORT_REGIONS"):
                    m.d.comb += [
                        self.responses.valid.eq(self.counts.valid),
                        self.counts.ready.eq(self.responses.ready),
                    ]
                    with m.If(self.counts_done):
                        m.d.comb += operations.ready.eq(1)
                        m.next = "DRAW"

        # Whoever has nothing to say says 0, so that an or of all is enough, here and in the link.
        units = Signal.like(self.first)
        m.d.comb += units.eq(self.end - self.first)
        first = struct_layout(RESPONSE_FIELDS[ResponseKind.DOMAIN])["first"]  # above ``units``
        reports = {
            ResponseKind.DOMAIN: (state.ongoing("REPORT_DOMAIN"),
                                  self.first << first.offset | units),
            ResponseKind.DEPTH: (self.depths.valid & state.ongoing("READ_BACK"), C(0)),
            ResponseKind.FRAGMENTS: (state.ongoing("REPORT_FRAGMENTS"), self.fragments),
            ResponseKind.BUSY: (state.ongoing("REPORT_BUSY"), self.busy_cycles),
        }
        if self.counts_regions:
            reports[ResponseKind.REGION_COUNT] = self.counts.valid, self.counts.payload
        reports |= {kind: (state.ongoing(f"REPORT_{kind.name}"), getattr(self, member))
                    for kind, member in self._further.items()}
        kind_bits = max(reports).bit_length()  # other boards say greater ones
        kinds = [Mux(now, C(kind, kind_bits), 0) for kind, (now, _) in reports.items()]
        values = [Mux(now, value, 0) for now, value in reports.values()]
        m.d.comb += [
            response.kind.eq(reduce(or_, kinds)),
response.value.eq(reduce(or_, values) | self._depth),
        ]
        return m
