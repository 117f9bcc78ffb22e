"""The scan generator of machines whose nodes merge while they are scanned, against that of a
machine of one node."""

from collections import deque

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink

from cardcage.golden.specification.video_timing import VideoTiming, compact_timing
from cardcage.hdl.video.video_scan_generator import VideoScanGenerator

BACKGROUND = 0x123456
TIMINGS = {
    "compact": (compact_timing(8, 5), 2),
    "one pixel": (compact_timing(1, 1), 4),
    "every figure different": (VideoTiming(7, 3, 2, 4, 6, 5, 1, 8), 3),
    "positive sync": (VideoTiming(7, 2, 5, 3, 4, 2, 3, 1, True, True), 2),
}
PINS = ("pixel", "active", "horizontal_sync", "vertical_sync", "red", "green", "blue")


def color_at(place):
    return (place * 0x010307 + 1) & 0xFFFFFF


class Chain(Agent):
    """``cards`` registers from ``first`` to ``last``, the last of which draws over every active
    pixel; writes down pins and scan lines of each clock."""

    def __init__(self, dut, cards, clocks):
        self.dut, self.clocks = dut, clocks
        pixel = {**dict.fromkeys(("begin", "active", "horizontal_sync", "vertical_sync"), 0),
                 "rank": 0, "color": 0}
        self.cards = deque([pixel] * cards, maxlen=cards)
        self.pins, self.scan, self.first, self.place = [], [], [], 0

    @property
    def finished(self):
        return len(self.pins) == self.clocks

    def drive(self, ctx):
        ctx.set(self.dut.background, BACKGROUND)
        if self.dut.configuration.scans_rank:
            ctx.set(self.dut.last, self.cards[0])

    def sample(self, ctx):
        dut = self.dut
        pins = {name: ctx.get(getattr(dut.pins, name)) for name in PINS}
        pins["color"] = pins["red"] | pins["green"] << 8 | pins["blue"] << 16
        self.pins.append(pins)
        self.scan.append((ctx.get(dut.start), *(ctx.get(getattr(dut.scan, name).as_value())
                                                for name in ("fetch", "show"))))
        if dut.configuration.scans_rank:
            assert pins["color"] == self.cards[0]["color"]
            pixel = ctx.get(dut.first)
            fields = {name: pixel[name] for name in self.cards[0]}
            self.first.append(fields)
            assert fields["rank"] == dut.configuration.rank_background
            assert fields["color"] == (BACKGROUND if fields["active"] else 0)
            self.cards.append(self.drawn(fields))

    def drawn(self, pixel):
        """Every other pixel of the picture is drawn."""
        if pixel["begin"]:
            self.place += pixel["active"]
        if not pixel["active"] or self.place % 2:
            return pixel
        return pixel | {"color": color_at(self.place), "rank": 5}


def run(timing, period, cards, clocks):
    configuration = small_machine("PM" if cards == 0 else f"{cards}x(PMC)",
                                  timing.horizontal_active, timing.vertical_active, timing=timing,
                                  clocks_per_pixel=period)
    dut = VideoScanGenerator(configuration=configuration)
    chain = Chain(dut, max(1, cards), clocks)
    simulate(dut, chain, limit=clocks + 1)
    return chain


@pytest.mark.parametrize("name", TIMINGS)
@pytest.mark.parametrize("cards", [1, 4])
def test_pins_as_many_clocks_later_as_there_are_cards_less_one(name, cards):
    """Sync and picture together; addresses and start at the same time as ever."""
    timing, period = TIMINGS[name]
    clocks = min(2 * timing.pixels * period + 30, 2500)
    alone, chain = (run(timing, period, count, clocks) for count in (0, cards))
    assert chain.scan == alone.scan
    late = cards - 1
    begin = VideoScanGenerator.latency  # from here on the pins show the scan
    drawn = 0  # pixels that the last card drew over
    for place, pins in enumerate(alone.pins[begin:clocks - late], begin):
        got = chain.pins[place + late]
        assert [got[pin] for pin in PINS[:4]] == [pins[pin] for pin in PINS[:4]], place
        assert pins["color"] == (BACKGROUND if pins["active"] else 0)
        if not pins["active"]:
            assert got["color"] == 0
        drawn += got["color"] != pins["color"]
    assert drawn > 0 or name == "one pixel"


def test_depths_of_the_last_card():
    """What is read back is what is on the pins."""
    timing = compact_timing(6, 4)
    configuration = small_machine("2x(PMC)", 6, 4, timing=timing)
    dut = VideoScanGenerator(configuration=configuration)
    clocks = 3 * configuration.cycles_per_scan
    chain, sink = Chain(dut, 2, clocks), Sink(dut.depths)
    ended = []

    class Asks(Agent):
        clock = 0

        def drive(self, ctx):
            ctx.set(dut.read_back, self.clock == 3)

        def sample(self, ctx):
            if ctx.get(dut.read_back_done):
                ended.append(self.clock)
            self.clock += 1

    simulate(dut, Asks(), chain, sink)
    far = configuration.depth_background
    expected = [far if place % 2 else 5 >> configuration.order_bits for place in range(1, 25)]
    assert len(sink.items) == 24 and len(ended) == 1
    assert sink.items == expected
