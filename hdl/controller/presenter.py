"""Brings a drawn picture to the screen, while the controller takes commands again."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS, ResponseKind
from ..backplane.words import response_layout

__all__ = ["Presenter"]


class Presenter(wiring.Component):
    """What is left to be done for a picture that nodes have drawn: waits until it is merged, and
    says so; then waits for the next scan, has it shown by that, and says so.

    Latency: a clock from ``start``, or from ``merged`` where that is later, to the first response;
    none from ``scan_start`` to ``swap``; a clock from that, or none from ``shown`` where that is
    later, to the second response.

    Members
    -------
    start: In(1)
        A picture is drawn, and that has been said; only while ``idle``.
    idle: Out(1)
        No picture is on its way.
    merged: In(1)
        It can be scanned, and stays so.
    cycles: In(RESPONSE_VALUE_BITS)
        Clocks from the frame's start until then; they hold until ``idle``.
    scan_start: In(1)
        A scan begins.
    scans: In(RESPONSE_VALUE_BITS)
        Those that began before it since the frame's start.
    swap: Out(1)
        This scan is the first one to show the picture.
    shown: In(1)
        From the clock after ``swap`` on: no scan reads the picture shown before, and so it stays.
    responses: Out(stream of response_layout)
        ``MERGED`` and ``FRAME_SHOWN``.

    Not in the papers.
    """

    def __init__(self):
        super().__init__({
            "start": In(1),
            "idle": Out(1),
            "merged": In(1),
            "cycles": In(RESPONSE_VALUE_BITS),
            "scan_start": In(1),
            "scans": In(RESPONSE_VALUE_BITS),
            "swap": Out(1),
            "shown": In(1),
            "responses": Out(stream.Signature(response_layout())),
        })

    def elaborate(self, platform):
        m = Module()
        responses = self.responses
        repeated = Signal.like(self.scans)
        with m.FSM():
            with m.State("IDLE"):
                m.d.comb += self.idle.eq(1)
                with m.If(self.start):
                    m.next = "MERGING"
                    with m.If(self.merged):
                        m.next = "REPORT_MERGED"
            with m.State("MERGING"), m.If(self.merged):
                m.next = "REPORT_MERGED"
            with m.State("REPORT_MERGED"):
                m.d.comb += [responses.valid.eq(1),
                             responses.payload.kind.eq(ResponseKind.MERGED),
                             responses.payload.value.eq(self.cycles)]
                with m.If(responses.ready):
                    m.next = "SWAP"
            with m.State("SWAP"):
                # Every pixel of the scan that begins here is fetched after this edge.
                m.d.comb += self.swap.eq(self.scan_start)
                m.d.sync += repeated.eq(self.scans)
                with m.If(self.scan_start):
                    m.next = "REPORT_SHOWN"
            with m.State("REPORT_SHOWN"):
                m.d.comb += [responses.valid.eq(self.shown),
                             responses.payload.kind.eq(ResponseKind.FRAME_SHOWN),
                             responses.payload.value.eq(repeated)]
                with m.If(self.shown & responses.ready):
                    m.next = "IDLE"
        return m
