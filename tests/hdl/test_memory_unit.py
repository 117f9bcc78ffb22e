"""A memory unit card against a model of its port, its registers and its bus driver."""

import random
from collections import deque

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, pauses

from cardcage.golden.interlace import interlace_for
from cardcage.hdl.backplane import Lane
from cardcage.hdl.memory_unit import MemoryUnit

CONFIGURATION = small_machine("PM", 8, 6, maximum_units=8, words=16)
EMPTY = {"valid": 0, "x": 0, "y": 0}


class Card(Agent):
    """Random life in a slot: scan addresses, requests, other units' answers, new numbers.

    Each clock is checked against what the card owes: its port goes to a scan
    fetch announced in the clock before, else to a write, else to a read.
    """

    finished = False

    def __init__(self, dut, seed, clocks, *, renumber=0.0, period=2, gaps=0.0, traffic=0.5):
        self.dut = dut
        self.pick = random.Random(f"card {seed}")
        self.clocks = clocks
        self.renumber, self.period, self.gaps, self.traffic = renumber, period, gaps, traffic
        words = CONFIGURATION.words
        self.depth, self.color = [0] * words, [[0] * words, [0] * words]
        self.front = 0
        self.total, self.id = 4, 2
        self.scan = self.scan_addresses()
        self.fetches = deque([EMPTY] * 3, maxlen=3)  # of the last three clocks, oldest first
        self.scan_address = None  # whose slot this clock is
        self.captures = deque([None, None], maxlen=2)  # what becomes of the scan reads
        self.output = 0
        self.answer = 0
        self.clock = 0
        self.counts = dict.fromkeys(("scan", "write", "read", "write_busy", "read_busy", "shown",
                                     "swaps", "numbers", "answers"), 0)

    # What goes in

    def scan_addresses(self):
        """Pixel after pixel, line after line, now and then a jump to the start of a line."""
        while True:
            start = self.pick.randrange(CONFIGURATION.height)
            for y in range(start, CONFIGURATION.height):
                for x in range(CONFIGURATION.width):
                    yield {"valid": 1, "x": x, "y": y}
                    for _ in range(self.period - 1):
                        yield {"valid": 0, "x": x, "y": y}
                    if self.gaps and self.pick.random() < self.gaps:
                        yield from ({"valid": 0, "x": x, "y": y} for _ in range(4))
                if self.pick.random() < 0.3:
                    break

    def interlace(self):
        return interlace_for(CONFIGURATION.width, CONFIGURATION.height,
                             words=CONFIGURATION.words, units=self.total)

    def drive(self, ctx):
        pick, dut = self.pick, self.dut
        quiet = not any(fetch["valid"] for fetch in self.fetches)
        if pick.random() < self.renumber:
            self.total = pick.choice((1, 2, 4, 8))
            self.id = pick.randrange(self.total)
            self.counts["numbers"] += 1
        elif quiet and pick.random() < 0.2:
            self.front ^= 1
            self.counts["swaps"] += 1
        self.fetch = next(self.scan)
        self.show = self.fetches[0]
        units = [self.id, self.id, self.id, pick.randrange(8)]
        words = self.interlace().words
        filling = self.clock < CONFIGURATION.words  # first of all every word is written once
        self.write = {
            "valid": filling or pick.random() < self.traffic,
            "every": filling or pick.random() < 0.1,
            "unit": pick.choice(units),
            "address": self.clock if filling else pick.randrange(words),
            "lanes": 7 if filling else pick.randrange(1, 8),
            "depth": pick.getrandbits(CONFIGURATION.depth_bits), "color": pick.getrandbits(24)}
        self.read = {"valid": pick.random() < self.traffic, "unit": pick.choice(units),
                     "address": pick.randrange(words)}
        if filling:
            self.fetch = EMPTY
        self.onward = {"write_busy": pick.random() < 0.1, "read_busy": pick.random() < 0.1,
                       "read_data": pick.choice((0, 0, 0, pick.getrandbits(8)))}
        ctx.set(dut.left.id, self.id)
        ctx.set(dut.total, self.total)
        ctx.set(dut.front, self.front)
        ctx.set(dut.scan.fetch, self.fetch)
        ctx.set(dut.scan.show, self.show)
        ctx.set(dut.left.lines.write, self.write)
        ctx.set(dut.left.lines.read, self.read)
        for name, value in self.onward.items():
            ctx.set(getattr(dut.right.lines, name), value)

    # What must come out

    def sample(self, ctx):
        dut, lines, counts = self.dut, self.dut.left.lines, self.counts
        assert ctx.get(dut.right.id) == self.id + 1
        for name in ("write", "read"):
            passed = ctx.get(getattr(dut.right.lines, name))
            assert {field: passed[field] for field in getattr(self, name)} == getattr(self, name)

        scanning = self.scan_address is not None
        writing = self.write["valid"] and (self.write["every"] or self.write["unit"] == self.id)
        reading = self.read["valid"] and self.read["unit"] == self.id
        write_busy = writing and scanning
        read_busy = reading and (scanning or writing)
        assert ctx.get(lines.write_busy) == (write_busy or self.onward["write_busy"])
        assert ctx.get(lines.read_busy) == (read_busy or self.onward["read_busy"])
        assert ctx.get(lines.read_data) == self.answer | self.onward["read_data"]
        counts["answers"] += self.answer != 0
        counts["write_busy"] += write_busy
        counts["read_busy"] += read_busy

        # The bus: what was captured for the fetch of three clocks ago or before.
        captured = self.captures[0]
        if captured is not None:
            self.output = captured
        interlace = self.interlace()
        x, y = self.show["x"] >> interlace.x_shift, self.show["y"] >> interlace.y_shift
        mine = interlace.unit(x, y) == self.id
        assert ctx.get(dut.scan.video) == (self.output if mine else 0)
        counts["shown"] += mine and self.output != 0

        self.step(scanning, writing, reading)

    def step(self, scanning, writing, reading):
        """The clock edge."""
        self.answer, capture = 0, None
        if scanning:
            self.counts["scan"] += 1
            capture = self.color[self.front][self.scan_address]
        elif writing:
            self.counts["write"] += 1
            lanes, address = self.write["lanes"], self.write["address"]
            if lanes & Lane.DEPTH:
                self.depth[address] = self.write["depth"]
            if lanes & Lane.FRONT:
                self.color[self.front][address] = self.write["color"]
            if lanes & Lane.BACK:
                self.color[1 - self.front][address] = self.write["color"]
        elif reading:
            self.counts["read"] += 1
            self.answer = self.depth[self.read["address"]]
        self.captures.append(capture)
        self.scan_address = self.due()
        self.fetches.append(self.fetch)
        self.clock += 1
        self.finished = self.clock == self.clocks

    def due(self):
        """The word this unit reads in the next clock for what is announced in this one."""
        interlace = self.interlace()
        group = 1 << (interlace.x_unit_bits + interlace.x_shift)
        if not self.fetch["valid"] or self.fetch["x"] % group:
            return None
        x, y = self.fetch["x"] >> interlace.x_shift, self.fetch["y"] >> interlace.y_shift
        units = {interlace.unit(x + step, y) for step in range(1 << interlace.x_unit_bits)}
        return interlace.address(x, y) if self.id in units else None


@pytest.mark.parametrize(("seed", "arguments"), [
    (0, {}), (1, {"renumber": 0.03}), (2, {"renumber": 0.03, "gaps": 0.2, "period": 3}),
    (3, {"gaps": 0.3, "traffic": 0.9}), (4, {"traffic": 0.1, "gaps": 0.3}),
    (5, {"period": 1, "renumber": 0.01})], ids=str)
def test_a_slot_at_random(seed, arguments):
    dut = MemoryUnit(configuration=CONFIGURATION)
    card = Card(dut, seed, 1200, **arguments)
    simulate(dut, card)
    for name, count in card.counts.items():
        if name == "numbers":
            assert count > 5 or not arguments.get("renumber")
        elif name == "swaps":
            assert count > 5 or not arguments.get("gaps")
        else:
            assert count > 3, name


def test_the_port_is_never_idle_while_something_asks():
    """One access in every clock: the scan, or else the write, or else the read."""
    class Always(Card):
        def drive(self, ctx):
            super().drive(ctx)
            # Writes to every unit and reads of this one; the scan besides.
            self.write["every"] = self.clock % 3 == 0
            self.write["valid"] = self.write["every"]
            self.read["unit"], self.read["valid"] = self.id, 1
            ctx.set(self.dut.left.lines.write, self.write)
            ctx.set(self.dut.left.lines.read, self.read)

    dut = MemoryUnit(configuration=CONFIGURATION)
    card = Always(dut, "busy", 600)
    card.clock = CONFIGURATION.words  # the words need not be known
    simulate(dut, card)
    assert sum(card.counts[kind] for kind in ("scan", "write", "read")) == (
        600 - CONFIGURATION.words)
    assert min(card.counts[kind] for kind in ("scan", "write", "read")) > 50


def test_responses_pass_through_at_once():
    dut = MemoryUnit(configuration=CONFIGURATION)
    words = [{"kind": number % 10, "value": number * 77} for number in range(30)]
    source = Source(dut.right.response, words, pauses("in"))
    sink = Sink(dut.left.response, len(words), pauses("out"))
    simulate(dut, source, sink, after=3)
    assert [{"kind": item.kind, "value": item.value} for item in sink.items] == words
    assert sink.clocks == source.taken
