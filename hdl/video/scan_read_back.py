"""Sends the depths of the merged picture to the host, as they are scanned."""

from amaranth.hdl import *
from amaranth.lib import fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.scan_chain import scanned_pixel_layout

__all__ = ["DEPTHS_WAITING", "ScanReadBack"]

#: Depths that can wait for the host.
DEPTHS_WAITING = 64


class ScanReadBack(wiring.Component):
    """Takes the depth of each pixel of the picture once, in the order of the scan.

    Where pictures are merged as they are scanned, nowhere else is the merged depth.  A pixel that
    passes while ``DEPTHS_WAITING`` are still on offer is taken in the next scan.  So it takes the
    rest of a scan and a whole one where the host is not slower than the pixels come, and as many
    scans more as it has to where the host is slower.

    Latency: two clocks from a pixel to its word.  Throughput: a pixel of every pixel time.

    Members
    -------
    pixel: In(scanned_pixel_layout)
        From the last merge card.
    start: In(1)
        Begin with the next scan; ignored while one goes on.
    done: Out(1)
        High for one clock when the last word has been taken.
    depths: Out(stream of depth_bits)

    Not in the papers.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "pixel": In(scanned_pixel_layout(configuration)),
            "start": In(1),
            "done": Out(1),
            "depths": Out(stream.Signature(configuration.depth_bits)),
        })

    def elaborate(self, platform):
        m = Module()
        timing, pixel, depths = self.configuration.timing, self.pixel, self.depths
        pixels = timing.horizontal_active * timing.vertical_active
        m.submodules.queue = queue = fifo.SyncFIFOBuffered(width=len(depths.payload),
                                                           depth=DEPTHS_WAITING)
        scanned = Signal(range(pixels + 1))  # pixels of this scan before the one that comes
        taken = Signal(range(pixels + 1))
        begin, reading = Signal(), Signal()
        m.d.comb += [
            begin.eq(pixel.begin & (pixel.vertical_sync == timing.vertical_sync_positive)),
            queue.w_data.eq(pixel.rank[self.configuration.order_bits:]),
            queue.w_en.eq(reading & pixel.begin & pixel.active & queue.w_rdy
                          & (scanned == taken)),
            depths.valid.eq(queue.r_rdy),
            depths.payload.eq(queue.r_data),
            queue.r_en.eq(depths.ready),
        ]
        with m.If(begin):
            m.d.sync += scanned.eq(0)
        with m.Elif(pixel.begin & pixel.active):
            m.d.sync += scanned.eq(scanned + 1)
        with m.If(queue.w_en):
            m.d.sync += taken.eq(taken + 1)
        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += taken.eq(0)
                with m.If(self.start):
                    m.next = "NEXT_SCAN"
            with m.State("NEXT_SCAN"), m.If(begin):
                m.next = "READ"
            with m.State("READ"):
                m.d.comb += reading.eq(taken != pixels)
                with m.If((taken == pixels) & (queue.level == 0)):
                    m.d.comb += self.done.eq(1)
                    m.next = "IDLE"
        return m
