"""A memory unit card against a model of its ports, its tags, its registers and its bus driver."""

import random
from collections import deque

import pytest
from amaranth.hdl import Shape
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, pauses
from suite.cases import EVERY

from cardcage.golden.specification.interlace import interlace_for
from cardcage.hdl.memory_unit.memory_unit import MemoryUnit

WORDS, TAG_BITS = 16, 3
CONFIGURATIONS = {ports: small_machine("PM", 8, 6, maximum_units=8, words=WORDS,
                                       tag_bits=TAG_BITS, memory_ports=ports) for ports in (1, 2)}
CONFIGURATION = CONFIGURATIONS[1]
EMPTY = {"valid": 0, "x": 0, "y": 0}
BACKGROUND = (1 << CONFIGURATION.depth_bits) - 1


class Card(Agent):
    """Random life in a slot: scan addresses, requests, other units' answers, new numbers, frames.

    Each clock is checked against what the card owes: its one port goes to a scan
    fetch announced in the clock before, else to a write, else to a read; of two
    ports each has its share, and what is read of a word in the clock of its write
    is unknown.  Memory is random to begin with, then initialised.
    Frames start with tags that no word has, as far as can be known from outside.
    """

    finished = False

    def __init__(self, dut, seed, clocks, *, renumber=0.0, period=2, gaps=0.0, traffic=0.5):
        self.dut = dut
        self.ports = dut.configuration.memory_ports
        self.pick = random.Random(f"card {seed}")
        self.clocks = clocks
        self.renumber, self.period, self.gaps, self.traffic = renumber, period, gaps, traffic
        # What is seen of each part; None is background.
        self.depth, self.color = [None] * WORDS, [[None] * WORDS, [None] * WORDS]
        self.front = 0
        self.tags = [1, 1, 1]  # current ones: depth, colours
        self.held = [set(), set(), set()]  # those that some word may have besides
        self.since = None  # the same, of a pass that goes on
        self.total, self.id = 4, 2
        self.scan = self.scan_addresses()
        self.fetches = deque([EMPTY] * 3, maxlen=3)  # of the last three clocks, oldest first
        self.scan_address = None  # whose slot this clock is
        self.captures = deque([None, None], maxlen=2)  # what becomes of the scan reads
        self.bus = (0, 0)  # in this clock
        self.output = (0, 0)  # whether it has been drawn, and its colour if so
        self.answer = 0  # depth, None where it is unknown
        self.idle = True
        self.clock = 0
        self.counts = dict.fromkeys(("scan", "write", "read", "write_busy", "read_busy", "shown",
                                     "background", "swaps", "numbers", "answers", "frames",
                                     "passes", "met"), 0)

    # What goes in

    def scan_addresses(self):
        """Pixel after pixel, line after line, now and then a pause and a jump to another line."""
        while True:
            start = self.pick.randrange(CONFIGURATION.height)
            for y in range(start, CONFIGURATION.height):
                for x in range(CONFIGURATION.width):
                    yield {"valid": 1, "x": x, "y": y}
                    for _ in range(self.period - 1):
                        yield {"valid": 0, "x": x, "y": y}
                    if self.gaps and self.pick.random() < self.gaps:
                        yield from [{"valid": 0, "x": x, "y": y}] * 4
                if self.pick.random() < 0.3:
                    break
            yield from [EMPTY] * 8

    def interlace(self):
        return interlace_for(CONFIGURATION.width, CONFIGURATION.height,
                             words=CONFIGURATION.words, units=self.total)

    def power_on(self, ctx):
        for storage in self.dut.memory.storages:
            shape = storage.data.shape
            bits = Shape.cast(shape).width
            for address in range(WORDS):
                ctx.set(storage.data[address], shape.from_bits(self.pick.getrandbits(bits)))

    def pictures(self, ctx, quiet):
        """Frames start, pictures are swapped and old tags are swept out."""
        pick, lines = self.pick, self.dut.pictures
        swept = ctx.get(lines.swept)
        if self.since is not None and swept and self.clock > self.began + 1:
            self.held, self.since = self.since, None
            self.counts["passes"] += 1
        back = 2 - self.front
        fresh = set(range(1, 1 << TAG_BITS)) - self.held[0] - self.held[back] - set(self.tags)
        if fresh and self.idle and pick.random() < 0.1:
            tag = pick.choice(sorted(fresh))
            for part in (0, back):
                self.held[part].add(self.tags[part])
                if self.since is not None:
                    self.since[part].add(self.tags[part])
                self.tags[part] = tag
            self.depth, self.color[back - 1] = [None] * WORDS, [None] * WORDS
            self.counts["frames"] += 1
        if quiet and pick.random() < 0.2:
            self.front ^= 1
            self.counts["swaps"] += 1
        sweep = self.since is None and swept and self.booted and pick.random() < 0.1
        if sweep:
            self.since, self.began = [set(), set(), set()], self.clock
        ctx.set(lines.sweep, sweep)
        ctx.set(lines.initialise, self.clock == 0)
        ctx.set(lines.front, self.front)
        ctx.set(lines.depth_tag, self.tags[0])
        for line, tag in zip(lines.color_tag, self.tags[1:], strict=True):
            ctx.set(line, tag)

    def drive(self, ctx):
        pick, dut = self.pick, self.dut
        if self.clock == 0:
            self.power_on(ctx)
        self.booted = self.clock > WORDS
        quiet = not any(fetch["valid"] for fetch in self.fetches)
        if pick.random() < self.renumber:
            self.total = pick.choice((1, 2, 4, 8))
            self.id = pick.randrange(self.total)
            self.counts["numbers"] += 1
        self.fetch = next(self.scan)
        self.show = self.fetches[0]
        units = [self.id, self.id, self.id, pick.randrange(8)]
        words = self.interlace().words
        near = pick.randrange(words)
        self.write = {
            "valid": self.booted and pick.random() < self.traffic, "unit": pick.choice(units),
            "address": pick.choice((near, pick.randrange(words))),
            "depth": pick.getrandbits(CONFIGURATION.depth_bits), "color": pick.getrandbits(24)}
        self.read = {"valid": self.booted and pick.random() < self.traffic,
                     "unit": pick.choice(units),
                     "address": pick.choice((near, pick.randrange(words)))}
        if not self.booted:
            self.fetch = EMPTY
        self.onward = {"write_busy": pick.random() < 0.1, "read_busy": pick.random() < 0.1,
                       "read_data": pick.choice((0, 0, 0, pick.getrandbits(8))),
                       "scanned": pick.choice((0, 0, 1, 2))}
        ctx.set(dut.left.id, self.id)
        ctx.set(dut.total, self.total)
        self.pictures(ctx, quiet)
        ctx.set(dut.scan.fetch, self.fetch)
        ctx.set(dut.scan.show, self.show)
        ctx.set(dut.left.lines.write, self.write)
        ctx.set(dut.left.lines.read, self.read)
        for name, value in self.onward.items():
            ctx.set(getattr(dut.right.lines, name), value)

    # What must come out

    def sample(self, ctx):
        dut, lines, counts = self.dut, self.dut.left.lines, self.counts
        right = ctx.get(dut.right.id)
        assert right == self.id + 1, (
            f"memory unit board: ID {self.id} comes in and {right} leaves, not {self.id + 1}; "
            "its ID increment is hdl/backplane/id_increment.py")
        for name in ("write", "read"):
            passed = ctx.get(getattr(dut.right.lines, name))
            assert {field: passed[field] for field in getattr(self, name)} == getattr(self, name)

        scanning = self.scan_address is not None
        writing = self.write["valid"] and self.write["unit"] == self.id
        reading = self.read["valid"] and self.read["unit"] == self.id
        one = self.ports == 1
        write_busy = one and writing and scanning
        read_busy = one and reading and (scanning or writing)
        assert ctx.get(lines.write_busy) == (write_busy or self.onward["write_busy"])
        assert ctx.get(lines.read_busy) == (read_busy or self.onward["read_busy"])
        mine = (1 << (self.id & 1)) * (one and scanning)
        assert ctx.get(lines.scanned) == mine | self.onward["scanned"]
        read_data, others = ctx.get(lines.read_data), self.onward["read_data"]
        if self.answer is None:
            assert read_data & others == others
        else:
            assert read_data == self.answer | others
            counts["answers"] += self.answer != 0
        counts["write_busy"] += write_busy
        counts["read_busy"] += read_busy

        # The bus: what was captured for the fetch of four clocks ago or before.
        assert (ctx.get(dut.scan.drawn), ctx.get(dut.scan.video)) == self.bus
        captured = self.captures[0]
        if captured is not None:
            self.output = captured
        interlace = self.interlace()
        x, y = self.show["x"] >> interlace.x_shift, self.show["y"] >> interlace.y_shift
        mine = interlace.unit(x, y) == self.id
        self.bus = self.output if mine else (0, 0)
        counts["shown"] += self.bus[0]
        counts["background"] += mine and not self.bus[0]

        self.idle = not reading
        self.step(scanning, writing and not write_busy, reading and not read_busy)

    def step(self, scanning, writing, reading):
        """The clock edge."""
        self.answer, capture = 0, None
        if scanning:
            self.counts["scan"] += 1
            color = self.color[self.front][self.scan_address]
            capture = (0, 0) if color is None else (1, color)
        if writing:
            self.counts["write"] += 1
            address = self.write["address"]
            self.depth[address] = self.write["depth"]
            self.color[1 - self.front][address] = self.write["color"]
        if reading:
            self.counts["read"] += 1
            depth = self.depth[self.read["address"]]
            self.answer = BACKGROUND if depth is None else depth
            if writing and self.read["address"] == address:
                self.answer = None
                self.counts["met"] += 1
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


@pytest.mark.parametrize(("seed", "ports", "arguments"), [
    (0, 1, {}), (1, 2, {"renumber": 0.03}), (2, 1, {"renumber": 0.03, "gaps": 0.2, "period": 3}),
    (3, 1, {"gaps": 0.3, "traffic": 0.9}), (3, 2, {"gaps": 0.3, "traffic": 0.9}),
    pytest.param(4, 2, {"traffic": 0.2, "gaps": 0.3}, marks=EVERY),
    pytest.param(5, 1, {"period": 1, "renumber": 0.02}, marks=EVERY)], ids=str)
def test_a_slot_at_random(seed, ports, arguments):
    dut = MemoryUnit(configuration=CONFIGURATIONS[ports])
    card = Card(dut, seed, 1500, **arguments)
    simulate(dut, card)
    print(card.counts)
    for name, count in card.counts.items():
        if name == "numbers":
            assert count > 5 or not arguments.get("renumber")
        elif name == "swaps":
            assert count > 5
        elif name.endswith("busy") and ports == 2:
            assert count == 0
        elif name == "met":
            assert count > 1 if ports == 2 else count == 0
        elif name in ("passes", "frames"):  # while it is busy all the time, idle clocks are rare
            assert count > 2 or arguments.get("traffic") == 0.9
        else:
            assert count > 2, name


def test_the_port_is_never_idle_while_something_asks():
    """One access in every clock: the scan, or else the write, or else the read."""
    class Always(Card):
        def drive(self, ctx):
            super().drive(ctx)
            if not self.booted:
                return
            # Writes and reads of this one; the scan besides.
            self.write["unit"], self.write["valid"] = self.id, self.clock % 3 == 0
            self.read["unit"], self.read["valid"] = self.id, 1
            ctx.set(self.dut.left.lines.write, self.write)
            ctx.set(self.dut.left.lines.read, self.read)

    dut = MemoryUnit(configuration=CONFIGURATION)
    card = Always(dut, "busy", 600 + WORDS + 1)
    simulate(dut, card)
    assert sum(card.counts[kind] for kind in ("scan", "write", "read")) == 600
    assert min(card.counts[kind] for kind in ("scan", "write", "read")) > 50


class Interference(Agent):
    """All words are written with a tag that then is stale; while a pass takes it out, the first
    read of each word is followed by a write: to the word whose number differs in the bits of
    ``PLAN``, and while the scan asks, too, or not.

    ``reads``: the words that the pass reads.  ``expected``: what it has to read.
    """

    PLAN = ((0, False), (1, False), (2, False), (4, False), (8, False), (16, False), (32, False),
            (0, True), (48, False), (16, True), (24, False))

    def __init__(self, dut):
        self.dut = dut
        self.words = dut.configuration.words
        self.clock = 0
        self.finished = False
        self.write = None
        self.reads, self.expected, self.tried, self.current = [], [], set(), set()

    def drive(self, ctx):
        dut, access = self.dut, self.dut.memory.access
        began = 2 * self.words + 20
        fetch, write = False, self.write
        self.write = None
        if self.clock <= began:
            place = self.clock - self.words - 10
            write = place if 0 <= place < self.words else None
            ctx.set(dut.total, 1)
            ctx.set(dut.pictures.initialise, self.clock == 0)
            ctx.set(dut.pictures.sweep, self.clock == began)
            for tag in (dut.pictures.depth_tag, *dut.pictures.color_tag):
                ctx.set(tag, 2 if self.clock == began else 1)
        else:
            ctx.set(dut.pictures.sweep, 0)
            self.finished = bool(ctx.get(dut.pictures.swept))
            if ctx.get(access.sweep):
                fetch = self.visit(ctx.get(access.sweep_address))
        ctx.set(dut.left.lines.write, {"valid": write is not None, "address": write or 0})
        ctx.set(dut.scan.fetch, {"valid": fetch})
        self.clock += 1

    def visit(self, address):
        """A word is read; returns whether the scan asks in the next clock."""
        self.reads.append(address)
        if address in self.reads[:-1]:
            return False
        different, scan = self.PLAN[address % len(self.PLAN)]
        self.write = address ^ different
        takes_place = not scan or self.dut.configuration.memory_ports == 2
        self.expected.append(address)
        if address not in self.current:
            self.tried.add((different, scan))
            if takes_place and different % 16 == 0:
                self.expected.append(address)
        if takes_place:
            self.current.add(self.write)
        return scan


@pytest.mark.parametrize("ports", [1, 2])
def test_a_pass_reads_again_what_may_have_been_written(ports):
    """The word itself or, as it looks at four bits only, one in sixteen; a write that waits for
    the scan has not changed anything."""
    dut = MemoryUnit(configuration=small_machine("PM", 8, 8, memory_ports=ports))
    life = Interference(dut)
    simulate(dut, life)
    assert life.words == 64 and life.tried == set(life.PLAN)
    assert life.reads == life.expected


def test_responses_pass_through_at_once():
    dut = MemoryUnit(configuration=CONFIGURATION)
    words = [{"kind": number % 10, "value": number * 77} for number in range(30)]
    source = Source(dut.right.response, words, pauses("in"))
    sink = Sink(dut.left.response, len(words), pauses("out"))
    simulate(dut, source, sink, after=3)
    assert [{"kind": item.kind, "value": item.value} for item in sink.items] == words
    assert sink.clocks == source.taken
