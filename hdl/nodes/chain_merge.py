"""The merge card C: while the screen is scanned it passes on the nearer pixel."""

from amaranth.hdl import *
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS
from ..backplane.connectors import ScanLines
from ..backplane.scan_chain import ScanChain
from ..merging.nearest_word import NearestWord
from .merge_card import MergeCard

__all__ = ["ChainMerge"]


class ChainMerge(MergeCard):
    """Compares each pixel that its node shows with that from its left, and sends the nearer one to
    its right, a clock later; the last one's go to the pins.

    Where the node has not drawn, or as near as the nodes with lower numbers, what comes from the
    left stays: it begins as the background.  Nothing is drawn or moved for it, so merging takes
    no clock of a frame.

    Latency: one clock.  Throughput: a pixel a clock.

    Members
    -------
    scan_left: In(ScanChain), scan_right: Out(ScanChain)
        Scan lines: those from the left are also the node's.
    scan: Out(ScanLines)
        To the node's memory units, with their wired answers.

    ``sent`` is the pixels of the picture that passed in the last whole scan.
    """

    latency = 1

    @property
    def members(self):
        chain = ScanChain(self.configuration)
        return {
            "scan_left": In(chain),
            "scan_right": Out(chain),
            "scan": Out(ScanLines(self.configuration)),
        }

    def merge(self, m):
        configuration, arriving, leaving = self.configuration, self.scan_left, self.scan_right
        m.submodules.nearest = nearest = NearestWord(depth_bits=configuration.depth_bits,
                                                     order_bits=configuration.order_bits)
        m.d.comb += [
            nearest.lower.eq(arriving.pixel.rank),
            nearest.higher.eq(self.scan.rank),
            self.scan.fetch.eq(arriving.fetch),
            self.scan.show.eq(arriving.show),
        ]
        m.d.sync += [
            leaving.fetch.eq(arriving.fetch),
            leaving.show.eq(arriving.show),
            leaving.front.eq(arriving.front),
            leaving.pixel.eq(arriving.pixel),
        ]
        # Outside the picture the scan address may be that of any pixel.
        with m.If(arriving.pixel.active & self.scan.drawn & nearest.higher_stays):
            m.d.sync += [leaving.pixel.rank.eq(self.scan.rank),
                         leaving.pixel.color.eq(self.scan.video)]
        # As they arrive: so all of a scan is counted before the host knows that the next one began.
        self._count(m, arriving.pixel)

    def _count(self, m, pixel):
        """Pixels of the picture, from one vertical sync to the next."""
        count = Signal(RESPONSE_VALUE_BITS)
        in_sync = Signal()
        syncs = pixel.vertical_sync == self.configuration.timing.vertical_sync_positive
        m.d.sync += in_sync.eq(syncs)
        with m.If(syncs & ~in_sync):
            m.d.sync += [self.sent.eq(count), count.eq(0)]
        with m.Elif(pixel.begin & pixel.active):
            m.d.sync += count.eq(count + 1)
