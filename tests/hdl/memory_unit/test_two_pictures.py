"""Memory units of nodes that merge while they are scanned: each picture has its depths.

While one picture is drawn the scan shows colours and ranks of the other one, as they were drawn;
one tag is for both.  What any memory unit does is ``test_memory_unit.py``'s.
"""

import random
from collections import deque

import pytest
from amaranth.hdl import Value
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.hdl.memory_unit.memory_unit import MemoryUnit

WORDS, TAG_BITS, ORDER_BITS = 16, 2, 3
NOTHING = {"valid": 0, "x": 0, "y": 0}


class Life(Agent):
    """Frames: writes and reads at random while the scan goes on, then the pictures are exchanged.

    ``each`` clocks go to a frame.  Its unit is number ``number`` of two, which share a picture of
    8 by 4 pixels by rows.
    """

    def __init__(self, dut, seed, frames, each, number=1):
        self.dut, self.number, self.each = dut, number, each
        self.pick = random.Random(f"two pictures {seed}")
        self.interlace = dut.configuration.interlace
        self.end = WORDS + 4 + frames * each
        self.clock = 0
        self.front = 0
        self.pictures = [[None] * WORDS, [None] * WORDS]  # (rank, colour) of each word
        self.tags, self.held = [1, 1], set()  # current ones; those that some word may have
        self.depth_tag = 1
        self.place = 0  # of the scan
        self.fetches = deque([NOTHING] * 3, maxlen=3)
        self.captures = deque([None, None, None], maxlen=3)
        self.bus = self.output = None  # what the scan shows in this clock; read last
        self.wanted = {"write": None, "read": None}
        self.answers = None
        self.counts = dict.fromkeys(("shown", "background", "kept", "old", "waits", "sweeps"), 0)
        self.overwritten = set()  # words whose front picture is shown, and whose back was written

    @property
    def finished(self):
        return self.clock >= self.end

    def power_on(self, ctx):
        for storage in self.dut.memory.storages:
            for address in range(WORDS):
                word = Value.cast(storage.data[address])
                ctx.set(word, self.pick.getrandbits(len(word)))

    def frames(self, ctx):
        """A new frame begins in a clock in which nothing is on its way, but the scan."""
        lines = self.dut.pictures
        since = self.clock - WORDS - 4
        begins = since >= 0 and since % self.each == 0
        sweep = since >= 0 and since % self.each == 1
        if begins and since:
            self.front ^= 1
        if begins:
            back = 1 - self.front
            fresh = set(range(1, 1 << TAG_BITS)) - {self.tags[self.front]} - {self.tags[back]}
            self.depth_tag = self.tags[back] = self.pick.choice(sorted(fresh))
            self.pictures[back] = [None] * WORDS
            self.overwritten.clear()
        self.counts["sweeps"] += sweep
        ctx.set(lines.initialise, self.clock == 0)
        ctx.set(lines.sweep, sweep)
        ctx.set(lines.front, self.front)
        ctx.set(lines.depth_tag, self.depth_tag)
        for line, tag in zip(lines.color_tag, self.tags, strict=True):
            ctx.set(line, tag)
        # Before a swap, and until an old tag has been taken out of all words, all is quiet.
        return since >= 0 and 2 < since % self.each < self.each - 8

    def scan(self, drawing):
        """A pixel every other clock; none while the pictures may be exchanged."""
        if not drawing or self.clock % 2:
            return NOTHING
        self.place = (self.place + 1) % 32
        return {"valid": 1, "x": self.place % 8, "y": self.place // 8}

    def ask(self, drawing):
        busy = self.clock % self.each < self.each // 2  # the other half is for the sweep
        for name, chance in (("write", 0.5), ("read", 0.5)):
            if self.wanted[name] is None and drawing and busy and self.pick.random() < chance:
                self.wanted[name] = self.pick.randrange(WORDS), self.pick.randrange(
                    self.dut.configuration.rank_background)

    def drive(self, ctx):
        if self.clock == 0:
            self.power_on(ctx)
        dut, lines = self.dut, self.dut.left.lines
        ctx.set(dut.left.id, self.number)
        ctx.set(dut.total, 2)
        drawing = self.frames(ctx)
        self.fetch = self.scan(drawing)
        self.show = self.fetches[0]
        self.ask(drawing)
        ctx.set(dut.scan.fetch, self.fetch)
        ctx.set(dut.scan.show, self.show)
        write, read = self.wanted["write"], self.wanted["read"]
        ctx.set(lines.write, {"valid": write is not None, "unit": self.number,
                              "address": write[0] if write else 0,
                              "depth": write[1] if write else 0,
                              "color": (write[1] * 4001 & 0xFFFFFF) if write else 0})
        ctx.set(lines.read, {"valid": read is not None, "unit": self.number,
                             "address": read[0] if read else 0})

    def sample(self, ctx):
        dut, lines, counts = self.dut, self.dut.left.lines, self.counts
        rank, color = self.bus or (0, 0)
        assert (ctx.get(dut.scan.drawn), ctx.get(dut.scan.rank), ctx.get(dut.scan.video)) == (
            self.bus is not None, rank, color), f"clock {self.clock}"
        if self.answers is not None:
            assert ctx.get(lines.read_data) == self.answers, f"clock {self.clock}"
        mine = self.show["valid"] and self.interlace.unit(self.show["x"],
                                                          self.show["y"]) == self.number
        if self.captures[0] is not None:
            self.output = self.captures[0][1]
        if self.show["valid"]:
            self.bus = self.output if mine else None
            counts["shown"] += self.bus is not None
            counts["background"] += mine and self.bus is None
            counts["kept"] += (self.bus is not None and self.interlace.address(
                self.show["x"], self.show["y"]) in self.overwritten)
        else:
            self.bus = self.shown_again()
        self.step(ctx, lines, counts)

    def shown_again(self):
        """Between two pixels the address is (0, 0), which belongs to unit 0."""
        return self.output if self.number == self.interlace.unit(0, 0) else None

    def step(self, ctx, lines, counts):
        """The clock edge: what is served, and what is read for the scan."""
        back = self.pictures[1 - self.front]
        waits = {name: bool(ctx.get(getattr(lines, f"{name}_busy"))) for name in self.wanted}
        write, read = self.wanted["write"], self.wanted["read"]
        self.answers = None
        if read is not None and not waits["read"]:
            far = self.dut.configuration.rank_background
            served = write is not None and not waits["write"] and write[0] == read[0]
            self.answers = None if served else (back[read[0]] or (far,))[0]
            counts["old"] += back[read[0]] is None
            self.wanted["read"] = None
        if write is not None and not waits["write"]:
            back[write[0]] = write[1], write[1] * 4001 & 0xFFFFFF
            self.overwritten.add(write[0])
            self.wanted["write"] = None
        counts["waits"] += waits["write"] or waits["read"]
        x, y = self.fetch["x"], self.fetch["y"]
        capture = None
        if self.fetch["valid"] and self.interlace.unit(x, y) == self.number:
            capture = (True, self.pictures[self.front][self.interlace.address(x, y)])
        self.captures.append(capture)
        self.fetches.append(self.fetch)
        self.clock += 1


@pytest.mark.parametrize("ports", [1, 2])
@pytest.mark.parametrize("order_bits", [0, ORDER_BITS])
def test_the_front_depth_survives_while_the_back_is_drawn(ports, order_bits):
    configuration = small_machine("2x(PMMC)", 8, 4, tag_bits=TAG_BITS, order_bits=order_bits,
                                  memory_ports=ports)
    assert configuration.words == WORDS
    dut = MemoryUnit(configuration=configuration)
    life = Life(dut, f"{ports} {order_bits}", frames=11, each=130)
    simulate(dut, life)
    print(life.counts)
    assert (life.counts.pop("waits") > 10) == (ports == 1)
    assert min(life.counts.values()) > 10, life.counts
