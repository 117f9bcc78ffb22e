"""Frame units side by side, against a model of the screen: what nodes send is scanned."""

import random
from collections import deque

import numpy as np
import pytest
from amaranth.hdl import Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import Out
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.hdl.lines_to_all import connect_pictures, connect_scan
from cardcage.hdl.snooping.frame_unit import FrameUnit

SCAN_LATENCY = 4  # of ``ScanPart``


class FrameUnits(wiring.Component):
    """All frame units of a cage, from left to right, with the lines they share."""

    def __init__(self, configuration):
        self.configuration = configuration
        self.units = [FrameUnit(configuration=configuration)
                      for _ in range(configuration.frame_units)]
        members = self.units[0].signature.members
        super().__init__({
            **{name: members[name] for name in ("node_total", "pictures", "bus", "scan")},
            "ended": Out(1),
            "total": Out(configuration.id_bits),
        })

    def elaborate(self, platform):
        m = Module()
        for number, unit in enumerate(self.units):
            m.submodules[f"unit_{number}"] = unit
            m.d.comb += [unit.node_total.eq(self.node_total), unit.bus.eq(self.bus),
                         unit.total.eq(self.units[-1].right.id)]
        for left, right in zip(self.units, self.units[1:], strict=False):
            wiring.connect(m, left.right, right.left)
        connect_pictures(m, self.pictures, self.units)
        connect_scan(m, self.scan, self.units)
        m.d.comb += [self.ended.eq(self.units[0].ended), self.total.eq(self.units[-1].right.id)]
        return m


class Screen(Agent):
    """Picture after picture is sent, in random pixels with ends in between, while the one before is
    scanned; then they change places.

    ``busy``: how likely a word is on the bus.
    """

    def __init__(self, dut, pictures, *, seed, busy=0.7):
        self.dut, self.left, self.busy = dut, pictures, busy
        self.pick = random.Random(f"screen {seed}")
        self.interlace = dut.configuration.interlace
        self.clock, self.began = 0, None
        self.front, self.tags, self.tag = 0, [1, 1], 1
        shape = (self.interlace.height, self.interlace.width)
        self.pictures = [np.full(shape, -1), np.full(shape, -1)]
        self.writes = deque([None] * FrameUnit.latency, maxlen=FrameUnit.latency)
        ends = FrameUnit.latency + 1  # that of this clock included
        self.ends = deque([False] * ends, maxlen=ends)
        self.shows = deque([None] * SCAN_LATENCY, maxlen=SCAN_LATENCY)
        self.fetched = deque([{"valid": 0, "x": 0, "y": 0}] * 3, maxlen=3)
        self.shown = 0

    @property
    def finished(self):
        return self.left == 0

    def power_on(self, ctx):
        for unit in self.dut.units:
            for storage in unit.storages:
                for place in range(storage.depth):
                    word = Value.cast(storage.data[place])
                    ctx.set(word, self.pick.getrandbits(len(word)))

    def drive(self, ctx):
        dut, pictures = self.dut, self.dut.pictures
        if self.clock == 0:
            self.power_on(ctx)
        ctx.set(dut.node_total, self.interlace.units)
        ctx.set(pictures.initialise, self.clock == 2)
        if self.clock > 3 and self.began is None and ctx.get(pictures.swept):
            self.began = self.clock
            assert ctx.get(dut.total) == dut.configuration.frame_units
        self.frame(ctx)
        self.word, end = None, False
        if self.began is not None and self.since < 2 * self.pixels:
            if self.pick.random() < self.busy:
                x, y = (self.pick.randrange(size) for size in (self.interlace.width,
                                                               self.interlace.height))
                self.word = x, y, self.pick.getrandbits(24)
            elif self.pick.random() < 0.3:
                end = True
        self.bus(ctx, end)
        self.scan(ctx)

    @property
    def pixels(self):
        return self.dut.configuration.width * self.dut.configuration.height

    @property
    def since(self):
        return self.clock - self.began

    def frame(self, ctx):
        """A picture lasts a scan of a pixel every other clock, and some clocks."""
        if self.began is not None and self.since == 2 * self.pixels + 12:
            self.left -= 1
            self.front ^= 1
            self.tag = self.tag % 15 + 1
            self.tags[1 - self.front] = self.tag
            self.pictures[1 - self.front][:] = -1
            self.began = self.clock
        ctx.set(self.dut.pictures.front, self.front)
        for line, tag in zip(self.dut.pictures.color_tag, self.tags, strict=True):
            ctx.set(line, tag)

    def bus(self, ctx, end):
        bus = {"valid": self.word is not None or end,
               "word": {"last": end, "pixel": dict.fromkeys(("unit", "address", "depth", "color"),
                                                            0)}}
        if self.word is not None:
            x, y, color = self.word
            bus["word"]["pixel"] = {
                "unit": self.interlace.unit(x, y), "address": self.interlace.address(x, y),
                "depth": self.pick.getrandbits(8), "color": color}
        ctx.set(self.dut.bus, bus)
        self.ends.append(end)

    def scan(self, ctx):
        fetch = {"valid": 0, "x": 0, "y": 0}
        if self.began is not None and self.since < 2 * self.pixels and self.since % 2 == 0:
            y, x = divmod(self.since // 2, self.dut.configuration.width)
            fetch = {"valid": 1, "x": x, "y": y}
        ctx.set(self.dut.scan.fetch, fetch)
        ctx.set(self.dut.scan.show, self.fetched[0])
        self.fetched.append(fetch)
        self.fetch = fetch

    def sample(self, ctx):
        expected = self.shows[0]
        if expected is not None:
            drawn = expected >= 0
            assert (ctx.get(self.dut.scan.drawn), ctx.get(self.dut.scan.video)) == (
                drawn, max(0, expected)), f"clock {self.clock}"
            self.shown += drawn
        assert ctx.get(self.dut.ended) == self.ends[0]
        written = self.writes[0]
        if written is not None:
            x, y, color = written
            self.pictures[1 - self.front][y, x] = color
        self.writes.append(self.word)
        pixel = None
        if self.fetch["valid"]:
            pixel = int(self.pictures[self.front][self.fetch["y"] >> self.interlace.y_shift,
                                                  self.fetch["x"] >> self.interlace.x_shift])
        self.shows.append(pixel)
        self.clock += 1


def machine(cards, size, **changes):
    return small_machine(cards, *size, packet="contiguous", **changes)


MACHINES = {
    "one, shifts": ("PMMSF", (8, 4), {}),
    "two, odd": ("PMSFF", (7, 5), {}),
    "four of another interlace": ("PMMSFFFF", (9, 5), {}),
    "more than there are pixels": ("PMSFFFF", (1, 2), {}),
    "coarser nodes": ("PMMSFF", (11, 6), {"words": 10}),
    "skewed nodes": ("PMMSF", (9, 5), {"skew": True}),
}


@pytest.mark.parametrize("name", MACHINES)
def test_what_is_sent_is_scanned(name):
    cards, size, changes = MACHINES[name]
    dut = FrameUnits(machine(cards, size, **changes))
    screen = Screen(dut, 9, seed=name)
    simulate(dut, screen, limit=40_000)
    assert screen.shown > 5


def test_a_pixel_a_clock():
    dut = FrameUnits(machine("PMSFF", (7, 5)))
    simulate(dut, Screen(dut, 5, seed=1, busy=1.0))
