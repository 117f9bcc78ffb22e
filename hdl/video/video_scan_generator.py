"""The video scan generator: addresses out, pixels back, sync to the screen."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS, COLOR_BITS
from ..arithmetic.delay import delayed
from ..backplane.connectors import ScanLines
from ..backplane.region_lines import RegionLines
from ..backplane.scan_chain import scanned_pixel_layout
from .region_places import RegionPlaces
from .scan_read_back import ScanReadBack

__all__ = ["VideoPins", "VideoScanGenerator"]


class VideoPins(wiring.Signature):
    """What leaves the machine for the screen.

    Members
    -------
    pixel: Out(1)
        High in the first clock of every pixel time, blanking included.
    active: Out(1)
        The pixel is in the picture; colours are 0 outside.
    horizontal_sync, vertical_sync: Out(1)
        With the polarity of the timing.
    red, green, blue: Out(8)
    """

    def __init__(self):
        super().__init__({
            "pixel": Out(1),
            "active": Out(1),
            "horizontal_sync": Out(1),
            "vertical_sync": Out(1),
            "red": Out(CHANNEL_BITS),
            "green": Out(CHANNEL_BITS),
            "blue": Out(CHANNEL_BITS),
        })


class VideoScanGenerator(wiring.Component):
    """Scans the picture out of the memory units, however many there are (figures 6 to 9).

    It counts through one standard scan at the highest resolution, and announces
    each pixel on the scan lines once: that is the scan's time slot, the other
    clocks of the pixel belong to the processing elements.  Which units read, and
    which of them drives the bus, they know themselves.

    Where regions are dealt out it looks each pixel's region up, a clock before it announces the
    pixel, so that no unit need have a table (``RegionPlaces``).

    Latency: a pixel is on the pins five clocks after its fetch was announced.
    Throughput: a pixel every ``clocks_per_pixel`` clocks.

    Members
    -------
    scan: Out(ScanLines)
    background: In(COLOR_BITS)
        Shown where nothing has been drawn: red in the low byte, then green, blue.
    start: Out(1)
        High for one clock when a scan begins, with its vertical sync; at least a line before
        its first fetch.
    pins: Out(VideoPins)
    first: Out(scanned_pixel_layout)
        What the first merge card compares with: background, and sync.
    last: In(scanned_pixel_layout)
        From the last merge card; on the pins in the same clock.
    read_back: In(1)
        Begin to send the depths of the next scan (``ScanReadBack``).
    read_back_done: Out(1)
        High for one clock when the last one has been taken.
    depths: Out(stream of depth words)
        In the order of the scan.

    These five only where pictures are merged as they are scanned: then a pixel passes through
    the merge cards, and is on the pins as many clocks later as there are of them, less one.

    regions: In(RegionLines)
        Only where regions are dealt out; with the table of the picture shown.
    """

    #: Clocks from the announcement to when it is shown, on to the video bus, and to the pins.
    show_latency = 3
    bus_latency = show_latency + 1
    latency = bus_latency + 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "scan": Out(ScanLines(configuration)),
            "background": In(COLOR_BITS),
            "start": Out(1),
            "pins": Out(VideoPins()),
            **(self._chain_members() if configuration.scans_rank else {}),
            **({"regions": In(RegionLines(configuration))}
               if configuration.regions is not None else {}),
        })

    def _chain_members(self):
        pixel = scanned_pixel_layout(self.configuration)
        return {
            "first": Out(pixel),
            "last": In(pixel),
            "read_back": In(1),
            "read_back_done": Out(1),
            "depths": Out(stream.Signature(self.configuration.depth_bits)),
        }

    def elaborate(self, platform):
        m = Module()
        timing, scan, pins = self.configuration.timing, self.scan, self.pins
        due, places = scan.fetch, None
        if self.configuration.regions is not None:
            places = RegionPlaces(configuration=self.configuration)
            due = Signal(data.StructLayout({"valid": 1, "x": len(places.x), "y": len(places.y)}))
        clock = Signal(range(self.configuration.clocks_per_pixel))
        column = Signal(range(timing.horizontal_total))
        line = Signal(range(timing.vertical_total))
        m.d.sync += clock.eq(clock + 1)
        with m.If(clock == self.configuration.clocks_per_pixel - 1):
            m.d.sync += [clock.eq(0), column.eq(column + 1)]
            with m.If(column == timing.horizontal_total - 1):
                m.d.sync += [column.eq(0), line.eq(line + 1)]
                with m.If(line == timing.vertical_total - 1):
                    m.d.sync += line.eq(0)

        # Both axes begin with the sync; back porch, picture and front porch follow.
        left = timing.horizontal_sync + timing.horizontal_back
        top = timing.vertical_sync + timing.vertical_back
        pixel = Signal()
        active = Signal()
        horizontal_sync = Signal()
        vertical_sync = Signal()
        m.d.comb += [
            pixel.eq(clock == 0),
            active.eq((column >= left) & (column < left + timing.horizontal_active)
                      & (line >= top) & (line < top + timing.vertical_active)),
            horizontal_sync.eq((column < timing.horizontal_sync)
                               == timing.horizontal_sync_positive),
            vertical_sync.eq((line < timing.vertical_sync) == timing.vertical_sync_positive),
            self.start.eq(pixel & (column == 0) & (line == 0)),
            due.valid.eq(pixel & active),
            due.x.eq(column - left),
            due.y.eq(line - top),
        ]
        if places is not None:
            m.submodules.places = places
            wiring.connect(m, wiring.flipped(self.regions), places.regions)
            m.d.comb += [places.x.eq(due.x), places.y.eq(due.y),
                         scan.fetch.element.eq(places.place.element),
                         scan.fetch.slot.eq(places.place.slot)]
            m.d.sync += [scan.fetch[name].eq(due[name]) for name in ("valid", "x", "y")]

        def when_on_bus(signal, name):
            """The signal when its pixel is on the video bus."""
            looking_up = 0 if places is None else places.latency
            return delayed(m, signal, looking_up + self.bus_latency, name, reset_less=False)

        on_bus = when_on_bus(active, "active")
        m.d.comb += scan.show.eq(
            delayed(m, scan.fetch, self.show_latency, "fetch", reset_less=False))
        if self.configuration.scans_rank:
            self._chain(m, begin=when_on_bus(pixel, "pixel"), active=on_bus,
                        horizontal_sync=when_on_bus(horizontal_sync, "horizontal_sync"),
                        vertical_sync=when_on_bus(vertical_sync, "vertical_sync"))
            return m
        color = Mux(scan.drawn, scan.video, self.background)
        m.d.sync += [
            pins.pixel.eq(when_on_bus(pixel, "pixel")),
            pins.active.eq(on_bus),
            pins.horizontal_sync.eq(when_on_bus(horizontal_sync, "horizontal_sync")),
            pins.vertical_sync.eq(when_on_bus(vertical_sync, "vertical_sync")),
            Cat(pins.red, pins.green, pins.blue).eq(Mux(on_bus, color, 0)),
        ]
        return m

    def _chain(self, m, **begins):
        """The pixels to the first merge card, and from the last one; ``begins``: what they have."""
        m.submodules.read_back = read_back = ScanReadBack(configuration=self.configuration)
        first, last, pins = self.first, self.last, self.pins
        m.d.comb += [first[name].eq(value) for name, value in begins.items()]
        m.d.comb += [
            first.rank.eq(self.configuration.rank_background),
            first.color.eq(Mux(begins["active"], self.background, 0)),
            pins.pixel.eq(last.begin),
            *(getattr(pins, name).eq(last[name])
              for name in ("active", "horizontal_sync", "vertical_sync")),
            Cat(pins.red, pins.green, pins.blue).eq(last.color),
            read_back.pixel.eq(last),
            read_back.start.eq(self.read_back),
            self.read_back_done.eq(read_back.done),
        ]
        wiring.connect(m, wiring.flipped(self.depths), read_back.depths)
