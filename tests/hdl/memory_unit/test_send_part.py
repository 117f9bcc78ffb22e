"""A memory unit of a tree's node sends what its frame drew, against a model of its words."""

import random

import pytest
from amaranth.hdl import Fragment, Shape, Value
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import no_pause, pauses

from cardcage.hdl.memory_unit.memory_unit import MemoryUnit
from cardcage.hdl.merging.picture_sender import PictureSender

WORDS = 70
NUMBER, TOTAL = 2, 4


def configuration(ports):
    return small_machine("PMMMMT", 16, 16, words=WORDS, memory_ports=ports, packet="contiguous")


class Slot(Agent):
    """Boots the unit from random memory, then frame after frame: writes, and the merge card's
    lines.

    ``frames``: (words written, whether another frame starts over it before it is sent) each.
    ``scan``: how likely a fetch is.  Pictures are swapped now and then.
    """

    finished = False

    def __init__(self, dut, frames, *, seed=0, scan=0.0, pause=no_pause):
        self.dut, self.frames, self.scan, self.pause = dut, list(frames), scan, pause
        self.pick = random.Random(f"slot {seed}")
        self.clock = self.wait = 0
        self.tag, self.front = 1, 0
        self.queue, self.words = [], {}
        self.sent, self.clocks = [], []
        self.state = "boot"

    def boot(self, ctx):
        dut = self.dut
        if self.clock == 0:
            for storage in (*dut.memory.storages, *dut._besides.sender.map.storages):
                shape = storage.data.shape
                for address in range(storage.depth):
                    value = self.pick.getrandbits(Shape.cast(shape).width)
                    ctx.set(storage.data[address],
                            shape.from_bits(value) if hasattr(shape, "from_bits") else value)
            ctx.set(dut.left.id, NUMBER)
            ctx.set(dut.total, TOTAL)
        # A survey writes before anything is initialised.
        self.write(ctx, 0 if self.clock == 1 else None)
        ctx.set(dut.pictures.initialise, self.clock == 5)
        if self.clock > 6 and ctx.get(dut.pictures.swept):
            self.state = "start"

    def start(self):
        """A new frame, on words that are background."""
        self.words = {}
        self.tag = 1 + self.tag % 15
        self.queue, self.abandoned = self.frames.pop(0)
        self.queue = list(self.queue)
        self.front ^= self.pick.getrandbits(1)
        self.state = "draw"

    def write(self, ctx, address):
        depth, color = self.pick.getrandbits(8), self.pick.getrandbits(24)
        unit = NUMBER if address is not None else self.pick.choice((NUMBER + 1, 0))
        valid = address is not None or self.pick.getrandbits(1)
        if address is None:
            address = self.pick.randrange(WORDS)
        ctx.set(self.dut.left.lines.write, {"valid": valid, "unit": unit, "address": address,
                                            "depth": depth, "color": color})
        self.writing = (address, depth, color) if unit == NUMBER else None

    def drive(self, ctx):
        dut = self.dut
        if self.state == "boot":
            self.boot(ctx)
            return
        if self.state == "start":
            self.start()
        ctx.set(dut.pictures.initialise, 0)
        ctx.set(dut.pictures.front, self.front)
        for tag in (dut.pictures.depth_tag, *dut.pictures.color_tag):
            ctx.set(tag, self.tag)
        ctx.set(dut.scan.fetch, {"valid": self.pick.random() < self.scan,
                                 "x": self.pick.randrange(16), "y": self.pick.randrange(16)})
        self.write(ctx, self.queue[0] if self.queue else None)
        going = self.state == "send" and self.clock > self.began
        ready = going and self.wait == 0
        ctx.set(dut.merge.ready, ready)
        # Another unit's turn, from which nothing may come.
        self.mine = going and (self.scan == 0 or self.pick.random() < 0.8)
        ctx.set(dut.merge.unit, NUMBER if self.mine else NUMBER ^ 1)
        begins = self.state == "settle" and ctx.get(dut.merge.settled)
        ctx.set(dut.merge.start, begins)
        if begins:
            self.state, self.began = "send", self.clock

    def sample(self, ctx):
        dut, lines = self.dut, self.dut.merge
        if self.state not in ("boot", "start") and self.queue and self.writing:
            if not ctx.get(dut.left.lines.write_busy):
                address, depth, color = self.writing
                self.words[address] = (depth, color)
                self.queue.pop(0)
        elif self.state == "draw":
            self.state = "start" if self.abandoned else "settle"
        valid, more = ctx.get(lines.valid), ctx.get(lines.more)
        if not self.mine_now():
            assert not valid and not more and not ctx.get(Value.cast(lines.pixel))
        else:
            self.take(ctx, valid, more)
        self.clock += 1

    def mine_now(self):
        return self.state == "send" and self.clock > self.began and self.mine

    def take(self, ctx, valid, more):
        lines = self.dut.merge
        taken = valid and self.wait == 0
        if taken:
            pixel = ctx.get(lines.pixel)
            self.sent.append((pixel.address, pixel.depth, pixel.color))
            self.clocks.append(self.clock)
            self.wait = self.pause()
        elif not valid:
            assert not ctx.get(Value.cast(lines.pixel))
        if self.wait and not taken:
            self.wait -= 1
        if not more and (not valid or taken):
            assert self.sent == [(address, *word) for address, word in sorted(self.words.items())]
            self.sent.clear()
            self.state = "start"
            self.finished = not self.frames


def frames(pick, count):
    for number in range(count):
        abandoned = number < count - 1 and pick.random() < 0.3
        yield [pick.randrange(WORDS) for _ in range(pick.choice((0, 2, 30, 90)))], abandoned


@pytest.mark.parametrize(("ports", "scan"), [(1, 0.0), (1, 0.3), (2, 0.0)])
def test_random_frames(ports, scan):
    """Frames that nobody ended are not sent; with one port the scan may take it at any time."""
    pick = random.Random(f"frames {ports} {scan}")
    dut = MemoryUnit(configuration=configuration(ports))
    slot = Slot(dut, frames(pick, 14), seed=scan, scan=scan, pause=pauses(f"slot {scan}"))
    simulate(dut, slot)
    assert len(slot.clocks) > 60


@pytest.mark.parametrize("ports", [1, 2])
def test_a_pixel_a_clock(ports):
    dut = MemoryUnit(configuration=configuration(ports))
    slot = Slot(dut, [(range(WORDS), False), (range(0, WORDS, 2), True), ((3, 69), False)])
    simulate(dut, slot)
    first = slot.clocks[0]
    assert slot.clocks[:WORDS] == list(range(first, first + WORDS))
    assert len(slot.clocks) == WORDS + 2
    # Words 0 and 2 are of the frame that nobody ended.
    assert slot.clocks[-2] == slot.began + PictureSender.latency + 2


def test_only_units_of_a_tree_have_it():
    """Elaborated, since Amaranth wants what is begun to be used."""
    dut = MemoryUnit(configuration=small_machine("PM"))
    Fragment.get(dut, None)
    assert "merge" not in dut.signature.members
