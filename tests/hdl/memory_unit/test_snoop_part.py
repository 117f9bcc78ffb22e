"""A memory unit of a node on a bus: it draws one picture, and deletes from and sends the other."""

import random
from typing import NamedTuple

import pytest
from amaranth.hdl import Shape, Value
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import no_pause, pauses

from cardcage.hdl.memory_unit.memory_unit import MemoryUnit
from cardcage.hdl.memory_unit.snoop_part import SnoopPart
from cardcage.hdl.merging.picture_maps import PictureMaps
from cardcage.hdl.merging.picture_sender import PictureSender

WORDS, TAG_BITS = 70, 6
NUMBER, TOTAL = 2, 4
SILENCE = {"valid": 0, "unit": NUMBER, "address": 0, "depth": 0}


class Turn(NamedTuple):
    """What is written into a picture, in (address, rank), None where its frame starts anew; and
    what is heard when it has come to the front, likewise."""

    written: list
    heard: list


class Slot(Agent):
    """Boots the unit from random memory, then picture after picture: its element's writes go into
    the back one; of the front one the node hears pixels, and then sends what is left.  When both
    are done the pictures change places.

    ``words``: of each picture address → (rank, colour), as a model has them; ``sent``: the clock in
    which each pixel was, ``settling``: clocks of each picture from the last pixel heard until the
    unit was settled.
    """

    def __init__(self, dut, turns, *, seed=0, pause=no_pause):
        self.dut, self.turns, self.pause = dut, [*turns, Turn([], [])], pause
        self.pick = random.Random(f"slot {seed}")
        self.clock = self.wait = 0
        self.front, self.tag = 0, 1
        self.tags, self.words = [1, 1], [{}, {}]
        self.write = self.hears = None
        self.queue, self.heard, self.following, self.taken = [], [], [], []
        self.sent, self.settling, self.deletions = [], [], 0
        self.do = self.boot

    @property
    def finished(self):
        return self.do is None

    def boot(self, ctx):
        dut = self.dut
        if self.clock == 0:
            for storage in dut.storages:
                shape = storage.data.shape
                for address in range(storage.depth):
                    value = self.pick.getrandbits(Shape.cast(shape).width)
                    ctx.set(storage.data[address],
                            shape.from_bits(value) if hasattr(shape, "from_bits") else value)
            ctx.set(dut.left.id, NUMBER)
            ctx.set(dut.total, TOTAL)
        if self.clock == 1:  # a survey
            self.write = 0, 3
        ctx.set(dut.pictures.initialise, self.clock == 5)
        if self.clock > 6 and ctx.get(dut.pictures.swept):
            self.words = [{}, {}]
            self.do = self.change_places

    def change_places(self, ctx):
        if self.queue:
            return
        if not self.turns:
            self.do = None
            return
        turn = self.turns.pop(0)
        self.front ^= 1
        self.queue, self.heard, self.following = turn.written, self.following, turn.heard
        self.start_frame()
        self.last_heard = self.clock
        self.do = self.listen

    def start_frame(self):
        self.tag += 1
        self.tags[1 - self.front], self.words[1 - self.front] = self.tag, {}

    def listen(self, ctx):
        if self.wait:
            self.wait -= 1
        elif self.heard:
            self.hears = self.heard.pop(0)
            self.wait, self.last_heard = self.pause(), self.clock
        else:
            self.do = self.settle

    def settle(self, ctx):
        if ctx.get(self.dut.merge.settled):
            ctx.set(self.dut.merge.start, 1)
            self.settling.append(self.clock - self.last_heard)
            self.began, self.wait, self.do = self.clock, 0, self.send

    def send(self, ctx):
        ctx.set(self.dut.merge.ready, self.wait == 0)

    def drive(self, ctx):
        dut = self.dut
        ctx.set(dut.merge.start, 0)
        ctx.set(dut.merge.ready, 0)
        ctx.set(dut.merge.unit, NUMBER)
        self.hears = None
        if self.do is not None:
            self.do(ctx)
        if self.do not in (None, self.boot):
            if self.write is None and self.queue:
                self.write = self.queue.pop(0)
                if self.write is None:
                    self.start_frame()
            self.lines(ctx)
        self.bus(ctx)

    def lines(self, ctx):
        pictures = self.dut.pictures
        ctx.set(pictures.front, self.front)
        ctx.set(pictures.depth_tag, self.tags[1 - self.front])
        for line, tag in zip(pictures.color_tag, self.tags, strict=True):
            ctx.set(line, tag)

    def bus(self, ctx):
        """The element's writes, and what is heard; or what is for other units."""
        pick, other = self.pick, self.pick.choice((NUMBER + 1, 0))
        self.color = pick.getrandbits(24)
        address, rank = self.write or (pick.randrange(WORDS), pick.getrandbits(8))
        ctx.set(self.dut.left.lines.write, {
            "valid": self.write is not None or pick.getrandbits(1), "address": address,
            "unit": other if self.write is None else NUMBER, "depth": rank, "color": self.color})
        heard = SILENCE
        if self.hears is not None:
            heard = SILENCE | {"valid": 1, "address": self.hears[0], "depth": self.hears[1]}
        elif self.do == self.listen:
            heard = {"valid": 1, "unit": other, "address": address, "depth": rank}
        ctx.set(self.dut.heard, heard)

    def sample(self, ctx):
        lines, front = self.dut.merge, self.words[self.front]
        if self.write is not None and not ctx.get(self.dut.left.lines.write_busy):
            self.words[1 - self.front][self.write[0]] = self.write[1], self.color
            self.write = None
        elif self.write is not None:
            assert self.dut.configuration.memory_ports == 1
        if self.hears is not None and self.hears[0] in front and (
                self.hears[1] <= front[self.hears[0]][0]):
            del front[self.hears[0]]
            self.deletions += 1
        if self.do == self.send and self.clock > self.began:
            self.take(ctx, lines, front)
        self.clock += 1

    def take(self, ctx, lines, front):
        valid = ctx.get(lines.valid)
        taken = valid and self.wait == 0
        if taken:
            pixel = ctx.get(lines.pixel)
            self.taken.append((pixel.address, (pixel.depth, pixel.color)))
            self.sent.append(self.clock)
            self.wait = self.pause()
        elif self.wait:
            self.wait -= 1
        assert valid or not ctx.get(Value.cast(lines.pixel))
        if not ctx.get(lines.more) and (not valid or taken):
            assert self.taken == sorted(front.items())
            self.taken, self.wait, self.do = [], 0, self.change_places


def unit(ports, order_bits=0):
    return MemoryUnit(configuration=small_machine(
        "PMMMMSF", 16, 16, words=WORDS, memory_ports=ports, order_bits=order_bits,
        tag_bits=TAG_BITS))


def turns(pick, count):
    """What is heard may be of any word, drawn or not."""
    for _ in range(count):
        written = [(pick.randrange(WORDS), pick.randrange(256))
                   for _ in range(pick.choice((0, 3, 40, 90)))]
        places = [*(address for address, _ in written), *range(WORDS)]
        if written and pick.random() < 0.3:
            written.insert(pick.randrange(len(written)), None)
        yield Turn(written, [(pick.choice(places), pick.randrange(256))
                             for _ in range(pick.choice((0, 2, 60)))])


@pytest.mark.parametrize("ports", [1, 2])
@pytest.mark.parametrize("stall", [False, True])
def test_random_pictures(ports, stall):
    pick = random.Random(f"snooped {ports} {stall}")
    dut = unit(ports)
    slot = Slot(dut, turns(pick, 20), seed=ports,
                pause=pauses(f"slot {ports}") if stall else no_pause)
    simulate(dut, slot)
    assert slot.deletions > 10 and len(slot.sent) > 60


@pytest.mark.parametrize("rank", [6, 7, 8])
def test_ties_are_deleted(rank):
    """A word of rank 7 is hidden by 6 and by 7, not by 8."""
    dut = unit(2)
    slot = Slot(dut, [Turn([(5, 7)], [(5, rank)])])
    simulate(dut, slot)
    assert slot.deletions == (rank <= 7)
    assert len(slot.sent) == (rank > 7)


def test_a_pixel_a_clock_heard_and_sent():
    """Every word but one is heard, each in the clock after the other, and deleted; then all are
    sent; and all the time the next picture is drawn."""
    def everything(first):
        return [(address, 9) for address in range(first, WORDS)]

    dut = unit(2)
    slot = Slot(dut, [Turn(everything(0), everything(1)), Turn(everything(0), []),
                      Turn(everything(0) * 2, [])])
    simulate(dut, slot)
    assert slot.deletions == WORDS - 1
    assert len(slot.sent) == 1 + WORDS + WORDS
    first = slot.sent[1]
    assert slot.sent[1:1 + WORDS] == list(range(first, first + WORDS))
    # It is settled when the last word is deleted and the map has learnt of it.
    assert slot.settling[1] == SnoopPart.latency + PictureMaps.settling
    assert slot.sent[-1] == slot.began + PictureSender.latency + WORDS - 1
