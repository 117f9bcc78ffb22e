"""The part of a board with pixels that the screen is scanned from."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import ScanLines
from ..mapping.interlace import ScanAddress
from ..mapping.region_scan import RegionScanAddress
from ..wires import wires
from .word_parts import pixel_layout

__all__ = ["ScanPart"]


class ScanPart:
    """Fetch, read, capture, drive: one clock each.

    The scan's pixel goes into an output register, so that others have the RAM in the meantime;
    while the scan shows a pixel of this board it goes on to the registers that drive the video bus.

    This is no component, but adds its signals to the module of a board with ``memory``, ``total``
    and ``pictures``.

    Latency: a scan fetch is on the video bus four clocks later.

    Members
    -------
    scan: In(ScanLines)
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What the board has to be told, and tells."""
        return {"scan": In(ScanLines(self.configuration))}

    def add_to(self, m: Module, unit: wiring.PureInterface, number: Value, current: list[Value],
               *, fetch: data.View, show: data.View):
        """Put it into ``m``, the module of ``unit``, whose number is ``number``; ``fetch``,
        ``show``: as of ``ScanLines``, ``current`` of both pictures: what was just read is of the
        frame shown."""
        kind = ScanAddress if self.configuration.regions is None else RegionScanAddress
        m.submodules.fetch = fetched = kind(configuration=self.configuration)
        m.submodules.show = shows = kind(configuration=self.configuration)
        access, pictures = unit.memory.access, unit.pictures
        captured = Signal()
        pictures_read = access.pixel if self.configuration.scans_rank else access.color
        output = Signal(len(pictures_read[0].value))
        drawn = Signal()
        scan = wires(m, "scan_wires")
        for address, asked in ((fetched, fetch), (shows, show)):
            told = {"id": number, "x": asked.x, "y": asked.y}
            if self.configuration.regions is None:
                told = {"total": unit.total, **told}
            else:
                told |= {"element": asked.element, "slot": asked.slot}
            scan.d.comb += [getattr(address, name).eq(value) for name, value in told.items()]
        shown = shows.selected & drawn
        color = output
        if self.configuration.scans_rank:
            pixel = data.View(pixel_layout(self.configuration.rank_bits), output)
            color = pixel.color
            scan.d.sync += unit.scan.rank.eq(Mux(shown, pixel.depth, 0))
        scan.d.sync += [unit.scan.drawn.eq(shown), unit.scan.video.eq(Mux(shown, color, 0))]
        scan_read = Signal()
        scan_address = Signal(self.configuration.address_bits)
        m.d.sync += [
            scan_read.eq(fetch.valid & fetched.fetch),
            scan_address.eq(fetched.address),
            captured.eq(scan_read),
        ]
        m.d.comb += [access.scan.eq(scan_read), access.scan_address.eq(scan_address)]
        with m.If(captured):
            m.d.sync += [
                output.eq(Mux(pictures.front, pictures_read[1].value, pictures_read[0].value)),
                drawn.eq(Mux(pictures.front, current[1], current[0])),
            ]
