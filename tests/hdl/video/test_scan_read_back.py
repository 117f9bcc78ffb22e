"""Depths of scanned pixels on their way to the host, whoever is faster."""

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, no_pause, once, pauses

from cardcage.golden.specification.video_timing import VideoTiming
from cardcage.hdl.video.scan_read_back import DEPTHS_WAITING, ScanReadBack


class Screen(Agent):
    """Scans pictures, one after another, and says ``start`` in the clocks of ``starts``.

    ``depth(scan, place)`` is what pixel ``place`` of a scan has.  ``clocks``: of each place of
    each scan; ``done``: clocks in which that was said, with how many depths had been taken then.
    """

    def __init__(self, dut, sink, depth, starts, ends=1):
        self.dut, self.sink, self.depth = dut, sink, depth
        self.starts, self.ends = set(starts), ends
        self.clock = 0
        self.clocks, self.done = {}, []
        self.events = self.scans()

    @property
    def finished(self):
        return len(self.done) == self.ends

    def scans(self):
        configuration = self.dut.configuration
        timing, bits = configuration.timing, configuration.order_bits
        left = timing.horizontal_sync + timing.horizontal_back
        top = timing.vertical_sync + timing.vertical_back
        scan = 0
        while True:
            place = 0
            for line in range(timing.vertical_total):
                for column in range(timing.horizontal_total):
                    active = (left <= column < left + timing.horizontal_active
                              and top <= line < top + timing.vertical_active)
                    rank = active and self.depth(scan, place) << bits | (place & (1 << bits) - 1)
                    pixel = {"active": active, "rank": rank,
                             "vertical_sync": (line < timing.vertical_sync)
                             == timing.vertical_sync_positive}
                    yield pixel | {"begin": 1}, (scan, place) if active else None
                    place += active
                    for _ in range(configuration.clocks_per_pixel - 1):
                        yield pixel | {"begin": 0}, None
            scan += 1

    def drive(self, ctx):
        pixel, place = next(self.events)
        ctx.set(self.dut.pixel, pixel)
        ctx.set(self.dut.start, self.clock in self.starts)
        if place is not None:
            self.clocks[place] = self.clock

    def sample(self, ctx):
        if ctx.get(self.dut.done):
            self.done.append((self.clock, len(self.sink.items)))
        self.clock += 1


def run(configuration, depth, starts, pause=no_pause, **ends):
    dut = ScanReadBack(configuration=configuration)
    sink = Sink(dut.depths, pause=pause)
    screen = Screen(dut, sink, depth, starts, **ends)
    simulate(dut, sink, screen, after=3 * configuration.cycles_per_scan, limit=200_000)
    return screen, sink


def machine(width, height, **changes):
    return small_machine("3x(PMC)", width, height, **changes)


MACHINES = {
    "8 by 8": machine(8, 8, order_bits=3),
    "odd, three clocks a pixel": machine(13, 7, clocks_per_pixel=3, order_bits=0),
    "a pixel": machine(1, 1),
    "positive sync, much blanking": machine(9, 10, timing=VideoTiming(9, 2, 5, 3, 10, 2, 3, 1,
                                                                   True, True)),
}


@pytest.mark.parametrize("name", MACHINES)
def test_each_pixel_once_and_in_order(name):
    """A host that waits now and then; the picture stays the same from scan to scan."""
    configuration = MACHINES[name]
    pixels = configuration.width * configuration.height
    picture = [37 * place % 251 for place in range(pixels)]
    start = 17 % configuration.cycles_per_scan
    screen, sink = run(configuration, lambda scan, place: picture[place], [start],
                       pauses(f"depths {name}"))
    assert sink.items == picture
    [(_, taken)] = screen.done
    assert taken == pixels


@pytest.mark.parametrize("name", MACHINES)
def test_the_next_scan_two_clocks_behind_its_pixels(name):
    """Where the host does not wait: all of one scan, the one after that in which it was asked."""
    configuration = MACHINES[name]
    pixels = configuration.width * configuration.height
    start = configuration.cycles_per_scan + configuration.cycles_per_scan // 2
    screen, sink = run(configuration, lambda scan, place: (3 * scan + place) % 255, [start])
    assert sink.items == [(6 + place) % 255 for place in range(pixels)]
    assert sink.clocks == [screen.clocks[2, place] + 2 for place in range(pixels)]
    [(done, _)] = screen.done
    assert sink.clocks[-1] < done <= sink.clocks[-1] + 2


@pytest.mark.parametrize("clocks", [5, 20])
def test_a_slower_host_takes_more_scans(clocks):
    """What finds the queue full comes with a later scan, after what came before."""
    configuration = machine(13, 11)
    pixels = 13 * 11
    screen, sink = run(configuration, lambda scan, place: place % 255, [5], lambda: clocks)
    assert sink.items == [place % 255 for place in range(pixels)]
    [(done, _)] = screen.done
    scans = done // configuration.cycles_per_scan
    # Of each scan so many at most as the host takes in it and as then wait.
    assert scans > 1 and pixels < DEPTHS_WAITING + 2 + scans * (
        configuration.cycles_per_scan // clocks + 1)


def test_a_host_that_takes_nothing_for_scans():
    configuration = machine(13, 11)
    wait = 5 * configuration.cycles_per_scan
    screen, sink = run(configuration, lambda scan, place: place % 255, [5], once(wait, no_pause))
    assert sink.items == [place % 255 for place in range(13 * 11)]
    assert screen.done[0][0] > wait


def test_one_after_the_other():
    """A start while one goes on is ignored; nothing comes without one.  The scan whose sync goes on
    has not begun."""
    configuration = machine(8, 8)
    scan = configuration.cycles_per_scan
    screen, sink = run(configuration, lambda scan, place: (scan + place) % 255,
                       [scan // 2, scan, scan + scan // 2, 5 * scan + 7], ends=2)
    assert sink.items == [(scan + place) % 255 for scan in (1, 5) for place in range(64)]
    assert [taken for _, taken in screen.done] == [64, 128]
