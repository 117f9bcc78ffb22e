"""What a memory unit sends, frame after frame, against a model of its RAM."""

import random

import pytest
from amaranth.hdl import Fragment
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.merging.drawn_map import DrawnMap
from cardcage.hdl.merging.picture_sender import PictureSender

DEPTH_BITS = 13


class Unit(Agent):
    """Writes what the frames say and lists each of them; ``busy`` is how likely a read waits.

    A frame is a list of (address, abandoned): the words of an abandoned one are stale when they
    are read.  What is read is (address, depth, colour); in every other clock the lines from the RAM
    hold anything.  ``listings``: for each, clock of its start and of its end.
    """

    def __init__(self, dut, frames, sink, *, seed=0, busy=0.0, gap=no_pause):
        self.dut, self.sink, self.busy, self.gap = dut, sink, busy, gap
        self.frames = [list(frame) for frame in frames]
        self.pick = random.Random(f"unit {seed}")
        self.words = {}
        self.clock = self.wait = self.sent = 0
        self.started = self.answer = self.held = None
        self.listings = []

    @property
    def finished(self):
        return not self.frames

    def word(self, current):
        return current, self.pick.getrandbits(DEPTH_BITS), self.pick.getrandbits(24)

    def drive(self, ctx):
        dut = self.dut
        if self.clock == 0:
            for storage in dut.map.storages:
                for place in range(storage.depth):
                    ctx.set(storage.data[place], self.pick.getrandbits(64))
        write, start = None, False
        if self.started is None and self.frames and ctx.get(dut.map.ready):
            if self.wait:
                self.wait -= 1
            elif self.frames[0]:
                write, abandoned = self.frames[0].pop(0)
                self.words[write] = self.word(not abandoned)
                self.wait = self.gap()
            elif ctx.get(dut.settled):
                start = True
        ctx.set(dut.write, write is not None)
        ctx.set(dut.write_address,
                self.pick.randrange(dut.words) if write is None else write)
        ctx.set(dut.start, start)
        if start:
            self.started = self.clock
        ctx.set(dut.reads.ready, self.pick.random() >= self.busy)
        current, depth, color = self.answer or self.word(self.pick.getrandbits(1))
        ctx.set(dut.current, current)
        ctx.set(dut.depth, depth)
        ctx.set(dut.color, color)

    def sample(self, ctx):
        dut, reads = self.dut, self.dut.reads
        offered = ctx.get(reads.payload) if ctx.get(reads.valid) else None
        assert self.held in (None, offered), "an address is held until it is taken"
        taken = offered is not None and ctx.get(reads.ready)
        self.held = None if taken else offered
        self.answer = self.words.get(offered, self.word(0)) if taken else None
        waits = ctx.get(dut.pixels.valid) and not ctx.get(dut.pixels.ready)
        listing = self.started is not None and self.clock > self.started
        if listing and not ctx.get(dut.more) and not waits:
            self.ended(ctx)
        self.clock += 1

    def ended(self, ctx):
        """The pixel that is taken in this clock, if one is, is the last."""
        got = [(pixel.address, pixel.depth, pixel.color) for pixel in self.sink.items[self.sent:]]
        if ctx.get(self.dut.pixels.valid):
            pixel = ctx.get(self.dut.pixels.payload)
            got.append((pixel.address, pixel.depth, pixel.color))
        assert got == [(address, depth, color) for address, (current, depth, color)
                       in sorted(self.words.items()) if current]
        self.sent += len(got)
        self.words.clear()
        self.listings.append((self.started, self.clock))
        self.started = None
        self.frames.pop(0)


def run(words, frames, *, pause=no_pause, **settings):
    dut = PictureSender(words=words, depth_bits=DEPTH_BITS)
    sink = Sink(dut.pixels, 0, pause)
    unit = Unit(dut, frames, sink, **settings)
    simulate(dut, unit, sink, after=20)
    assert len(sink.items) == unit.sent
    return unit, sink


@pytest.mark.parametrize("words", [1, 2, 70, 333])
def test_random_frames(words):
    """Some of whose words are stale, some written again; nothing at all in some."""
    pick = random.Random(f"sender {words}")
    sent = 0
    for round_, (busy, stall) in enumerate(((0, False), (0.4, False), (0, True), (0.4, True))):
        frames = [[(pick.randrange(words), pick.random() < stale)
                   for _ in range(pick.choice((0, 3, 60)))] for stale in (0, 0.3, 1, 0.1, 0, 0.6)]
        unit, _ = run(words, frames, seed=round_, busy=busy,
                      pause=pauses(f"takes {words}") if stall else no_pause,
                      gap=pauses(f"gaps {words}") if stall else no_pause)
        assert len(unit.listings) == len(frames)
        sent += unit.sent
    assert sent > 4


@pytest.mark.parametrize("addresses", [range(200), range(5, 200, 3), (0,), ()], ids=len)
def test_a_pixel_a_clock(addresses):
    """Stale words besides, which take a clock each and are not sent."""
    stale = [address for address in range(200) if address in addresses and address % 7 == 6]
    unit, sink = run(200, [[(address, address in stale) for address in addresses]])
    (start, end), = unit.listings
    if addresses:
        assert sink.clocks[0] == start + PictureSender.latency + (addresses[0] in stale)
    clocks = len(addresses) + unit.dut.map.summary_words + DrawnMap.overhead + 2
    assert end - start <= clocks
    if len(addresses) == 200:
        assert sink.clocks[-1] - sink.clocks[0] == 199
    assert unit.sent == len(addresses) - len(stale)
    if addresses:  # nothing of it goes by after the last pixel
        assert end == sink.clocks[-1]


def test_the_least_sizes():
    Fragment.get(PictureSender(words=1, depth_bits=1), None)


@pytest.mark.parametrize(("name", "wrong"), [("words", 0), ("depth_bits", 0)])
def test_bad_sizes(name, wrong):
    rejects(PictureSender, name, **{"words": 4, "depth_bits": 8} | {name: wrong})
