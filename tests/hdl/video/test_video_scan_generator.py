"""Every figure of a timing, measured on the pins."""

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.golden.specification.video_timing import STANDARD_TIMINGS, VideoTiming, compact_timing
from cardcage.hdl.video.video_scan_generator import VideoScanGenerator

BACKGROUND = 0x123456


def color_at(x, y):
    """What is drawn at a scan address, never black; None where nothing is."""
    return None if (x + y) % 3 == 1 else 0x800001 | x << 8 | (y & 0x7F) << 16


class Screen(Agent):
    """Answers on the video bus and writes down every clock: scan lines, start and pins."""

    finished = False

    def __init__(self, dut, clocks):
        self.dut = dut
        self.clocks = clocks
        self.start, self.fetch, self.show, self.pins = [], [], [], []
        self.color = None

    def drive(self, ctx):
        scan = self.dut.scan
        show = ctx.get(scan.show)
        # Outside the picture the bus may carry anything: nothing of it may get out.
        ctx.set(scan.drawn, self.color is not None)
        ctx.set(scan.video, self.color or 0)
        self.color = color_at(show.x, show.y)
        ctx.set(self.dut.background, BACKGROUND)

    def sample(self, ctx):
        dut = self.dut
        fetch, show = ctx.get(dut.scan.fetch), ctx.get(dut.scan.show)
        self.start.append(ctx.get(dut.start))
        self.fetch.append((fetch.x, fetch.y) if fetch.valid else None)
        self.show.append((show.x, show.y) if show.valid else None)
        names = ("pixel", "active", "horizontal_sync", "vertical_sync", "red", "green", "blue")
        self.pins.append(dict(zip(names, (ctx.get(getattr(dut.pins, name)) for name in names),
                                  strict=True)))
        self.finished = len(self.pins) == self.clocks


def scan(timing, clocks_per_pixel, clocks):
    configuration = small_machine("PM", timing.horizontal_active, timing.vertical_active,
                                  timing=timing, clocks_per_pixel=clocks_per_pixel)
    dut = VideoScanGenerator(configuration=configuration)
    screen = Screen(dut, clocks)
    simulate(dut, screen, limit=clocks + 1)
    return screen


def runs(values):
    """(value, length) of each run."""
    found = []
    for value in values:
        if found and found[-1][0] == value:
            found[-1][1] += 1
        else:
            found.append([value, 1])
    return [tuple(run) for run in found]


TIMINGS = {
    "compact": (compact_timing(8, 5), 2),
    "compact, slow": (compact_timing(5, 3), 5),
    "one pixel": (compact_timing(1, 1), 4),
    "every figure different": (VideoTiming(7, 3, 2, 4, 6, 5, 1, 8), 3),
    "positive sync": (VideoTiming(7, 2, 5, 3, 4, 2, 3, 1, True, True), 2),
    "horizontal positive": (VideoTiming(6, 1, 1, 1, 4, 1, 1, 1, True, False), 2),
    "lines of 640x480": (VideoTiming(640, 16, 96, 48, 2, 1, 1, 1), 2),
    "height of 640x480": (VideoTiming(1, 1, 1, 1, 480, 10, 2, 33), 2),
}


@pytest.mark.parametrize("name", TIMINGS)
def test_two_scans_pin_by_pin(name):
    timing, period = TIMINGS[name]
    kinds = set()  # of the colours shown: background or not
    line = timing.horizontal_total * period
    whole = line * timing.vertical_total
    latency = VideoScanGenerator.latency
    scans = 2 if whole < 10_000 else 1
    screen = scan(timing, period, scans * whole + latency)
    pins = screen.pins[latency:]  # from here on the pins show scan after scan

    # Vertical: sync, back porch, active, front porch, in lines.
    high = int(timing.vertical_sync_positive)
    vertical = [(high, timing.vertical_sync * line),
                (1 - high, (timing.vertical_total - timing.vertical_sync) * line)]
    assert runs(pin["vertical_sync"] for pin in pins) == vertical * scans
    active_lines = [any(pin["active"] for pin in pins[start: start + line])
                    for start in range(0, len(pins), line)]
    assert runs(active_lines) == [
        (False, timing.vertical_sync + timing.vertical_back), (True, timing.vertical_active),
        *[(False, timing.vertical_front + timing.vertical_sync + timing.vertical_back),
          (True, timing.vertical_active)] * (scans - 1), (False, timing.vertical_front)]

    # Horizontal, in pixels, in every line; the pixel pulse in the first clock of each.
    high = int(timing.horizontal_sync_positive)
    level = {True: 1, False: 0}
    sync = ([high] * timing.horizontal_sync
            + [1 - high] * (timing.horizontal_total - timing.horizontal_sync))
    left = timing.horizontal_sync + timing.horizontal_back
    active = [level[left <= column < left + timing.horizontal_active]
              for column in range(timing.horizontal_total)]
    for number, start in enumerate(range(0, len(pins), line)):
        pixels = pins[start: start + line]
        assert [pin["pixel"] for pin in pixels] == ([1] + [0] * (period - 1)) * len(sync)
        assert [pin["horizontal_sync"] for pin in pixels[::period]] == sync
        shown = active if active_lines[number] else [0] * len(active)
        for column, pin in enumerate(pixels[::period]):
            # Nothing changes within a pixel.
            for later in pixels[column * period + 1: (column + 1) * period]:
                assert later | {"pixel": 1} == pin
            assert pin["active"] == shown[column]
            y = number % timing.vertical_total - timing.vertical_sync - timing.vertical_back
            color = 0
            if shown[column]:
                color = color_at(column - left, y)
                color = BACKGROUND if color is None else color
                kinds.add(color == BACKGROUND)
            assert pin["red"] | pin["green"] << 8 | pin["blue"] << 16 == color

    assert kinds == ({False} if name == "one pixel" else {False, True})

    # The scan lines: one announcement a pixel, shown three clocks later, on the pins five.
    show = VideoScanGenerator.show_latency
    assert (show, VideoScanGenerator.bus_latency, latency) == (3, 4, 5)
    assert screen.show[show:] == screen.fetch[:-show]
    for clock, pin in enumerate(pins):
        assert (screen.fetch[clock] is not None) == bool(pin["active"] and pin["pixel"])
    wanted = [(x, y) for y in range(timing.vertical_active)
              for x in range(timing.horizontal_active)]
    assert [pixel for pixel in screen.fetch if pixel] == wanted * scans

    # The start: one clock, with the sync, a line or more before the first announcement.
    starts = [clock for clock, start in enumerate(screen.start) if start]
    assert starts == [whole * number for number in range(len(starts))]
    assert len(starts) == scans + 1
    for start in starts[:scans]:
        assert all(pixel is None for pixel in screen.fetch[start: start + line])


def test_standard_lines():
    """The first lines of 640x480 at 60 Hz, blank as they are, have the standard's length."""
    timing = STANDARD_TIMINGS[640, 480]
    line = 800 * 2
    screen = scan(timing, 2, 4 * line + VideoScanGenerator.latency)
    pins = screen.pins[VideoScanGenerator.latency:]
    assert runs(pin["horizontal_sync"] for pin in pins) == [(0, 96 * 2), (1, 704 * 2)] * 4
    assert runs(pin["vertical_sync"] for pin in pins) == [(0, 2 * line), (1, 2 * line)]
