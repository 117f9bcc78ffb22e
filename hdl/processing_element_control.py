"""What a processing element does with each operation it was told."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.commands import ResponseKind
from ..golden.configuration import MachineConfiguration
from .layouts import Operation, operation_layout, response_layout, walked_outline_layout

__all__ = ["ProcessingElementControl"]


class ProcessingElementControl(wiring.Component):
    """Takes operations in order: triangles flow on to the datapath, one behind the other;
    anything else waits until the datapath is empty.  Control only: it moves no pixel.

    Latency: a triangle passes in the same clock; another operation starts one
    clock after the datapath is empty.

    Members
    -------
    operations: In(stream of operation_layout)
    triangles: Out(stream of walked_outline_layout)
    drawing: In(1)
        The datapath behind ``triangles`` holds something.
    survey_start, read_back_start: Out(1)
    survey_done, read_back_done: In(1)
        The two services.
    surveying, reading: Out(1)
        Who has the memory lines; the datapath when neither is high.
    frame_start: Out(1)
        Count from the next clock on.
    first, end: In(id_bits)
        The domain, for the report.
    depths: In(stream of depth words)
    fragments, busy_cycles: In(32)
        The counts to report.
    responses: Out(stream of response_layout)
    idle: Out(1)
        No operation here or in the datapath.
    working: Out(1)
        Drawing: what counts as a busy cycle.

    Fuchs & Johnson, the steps after figure 12.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "operations": In(stream.Signature(operation_layout(configuration))),
            "triangles": Out(stream.Signature(walked_outline_layout(configuration))),
            "drawing": In(1),
            **{f"{service}_{when}": flow(1) for service in ("survey", "read_back")
               for when, flow in (("start", Out), ("done", In))},
            "surveying": Out(1),
            "reading": Out(1),
            "frame_start": Out(1),
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "depths": In(stream.Signature(configuration.depth_bits)),
            "fragments": In(32),
            "busy_cycles": In(32),
            "responses": Out(stream.Signature(response_layout())),
            "idle": Out(1),
            "working": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        operations, response = self.operations, self.responses.payload
        operation = operations.payload.operation
        is_draw = operation == Operation.DRAW
        m.d.comb += self.triangles.payload.eq(operations.payload.triangle)

        def report(kind, value, then):
            m.d.comb += [
                self.responses.valid.eq(1),
                response.kind.eq(kind),
                response.value.eq(value),
            ]
            with m.If(self.responses.ready):
                then()

        def finish():
            m.d.comb += operations.ready.eq(1)
            m.next = "DRAW"

        def go(state):
            m.next = state

        with m.FSM():
            with m.State("DRAW"):
                m.d.comb += [
                    self.triangles.valid.eq(operations.valid & is_draw),
                    operations.ready.eq(self.triangles.ready & is_draw),
                    self.idle.eq(~operations.valid & ~self.drawing),
                    self.working.eq(self.triangles.valid | self.drawing),
                ]
                with m.If(operations.valid & ~is_draw & ~self.drawing), m.Switch(operation):
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
                    with m.Default():  # a newer controller's operation: not for this card
                        m.d.comb += operations.ready.eq(1)
            with m.State("SURVEY"):
                m.d.comb += self.surveying.eq(1)
                with m.If(self.survey_done):
                    m.next = "REPORT_DOMAIN"
            with m.State("REPORT_DOMAIN"):
                units = Signal(16)
                m.d.comb += units.eq(self.end - self.first)
                report(ResponseKind.DOMAIN, Cat(units, self.first), finish)
            with m.State("READ_BACK"):
                m.d.comb += [
                    self.reading.eq(1),
                    self.responses.valid.eq(self.depths.valid),
                    response.kind.eq(ResponseKind.DEPTH),
                    response.value.eq(self.depths.payload),
                    self.depths.ready.eq(self.responses.ready),
                ]
                with m.If(self.read_back_done):
                    finish()
            with m.State("REPORT_FRAGMENTS"):
                report(ResponseKind.FRAGMENTS, self.fragments, lambda: go("REPORT_BUSY"))
            with m.State("REPORT_BUSY"):
                report(ResponseKind.BUSY, self.busy_cycles, finish)
        return m
