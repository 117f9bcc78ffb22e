"""What a processing element without memory units does with each operation it was told."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS, ResponseKind
from ..backplane.words import Operation, response_layout, response_value

__all__ = ["DirectElementControl"]


class DirectElementControl(wiring.Component):
    """Takes the operations that are no triangles, each when nothing is drawn any more: begins to
    count, and reports, at boot the node, later what was counted.

    Latency: a clock from the operation to its first word, once nothing is drawn.

    Parameters
    ----------
    id_bits, node_bits: int, positive
        ID and node lines of the backplane.

    Members
    -------
    operations: In(stream of Operation)
        After the triangles before it have been taken; none follow until it is taken.
    drawing: In(1)
        The pipeline holds something, or did a clock ago.
    frame_start: Out(1)
        Count from the next clock on.
    node: In(node_bits), total: In(id_bits)
        The element's number as a node, and the memory units that it draws into.
    fragments, busy_cycles: In(RESPONSE_VALUE_BITS)
        The counts to report.
    responses: Out(stream of response_layout)
        0 while not valid.
    idle: Out(1)
        No operation here, and nothing is drawn.

    Raises ``ValueError`` where a number of bits is not positive.
    """

    def __init__(self, *, id_bits: int, node_bits: int):
        for name, bits in (("id_bits", id_bits), ("node_bits", node_bits)):
            if bits < 1:
                raise ValueError(f"{name} must be positive, not {bits!r}")
        super().__init__({
            "operations": In(stream.Signature(Operation, payload_init=Operation.SURVEY)),
            "drawing": In(1),
            "frame_start": Out(1),
            "node": In(node_bits),
            "total": In(id_bits),
            "fragments": In(RESPONSE_VALUE_BITS),
            "busy_cycles": In(RESPONSE_VALUE_BITS),
            "responses": Out(stream.Signature(response_layout())),
            "idle": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        operations, response = self.operations, self.responses.payload
        node = response_value(ResponseKind.NODE, units=self.total, node=self.node)
        reports = (("NODE", node, "DRAW"), ("FRAGMENTS", self.fragments, "BUSY"),
                   ("BUSY", self.busy_cycles, "DRAW"))
        with m.FSM():
            with m.State("DRAW"):
                m.d.comb += self.idle.eq(~operations.valid & ~self.drawing)
                with m.If(operations.valid & ~self.drawing), m.Switch(operations.payload):
                    with m.Case(Operation.SURVEY):
                        m.next = "NODE"
                    with m.Case(Operation.READ_COUNTERS):
                        m.next = "FRAGMENTS"
                    with m.Case(Operation.FRAME_START):
                        m.d.comb += [self.frame_start.eq(1), operations.ready.eq(1)]
                    with m.Default():  # not for this card
                        m.d.comb += operations.ready.eq(1)
            for kind, value, following in reports:
                with m.State(kind):
                    m.d.comb += [
                        self.responses.valid.eq(1),
                        response.kind.eq(ResponseKind[kind]),
                        response.value.eq(value),
                    ]
                    with m.If(self.responses.ready):
                        m.d.comb += operations.ready.eq(following == "DRAW")
                        m.next = following
        return m
