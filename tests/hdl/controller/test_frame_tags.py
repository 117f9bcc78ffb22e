"""Which tag a frame gets, against a memory that remembers every one that was current."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, Watch, rejects, simulate

from cardcage.hdl.controller.frame_tags import FrameTags


class Memory(Agent):
    """Parts that may hold every tag they were ever given, until a pass takes it out.

    Frames start at random, and the picture is swapped at random, seldom or often; a pass takes
    ``length()`` clocks.
    """

    def __init__(self, dut, seed, frames, *, swap, length, start=0.5):
        self.dut = dut
        self.pick = random.Random(f"tags {seed}")
        self.swap, self.length, self.start = swap, length, start
        self.frames = frames
        self.front = 0
        self.current = [1, 1, 1]  # depth, colours
        self.held = [{0, 1}, {0, 1}, {0, 1}]
        self.left = 0
        self.renewed = ()
        self.passes = self.waits = self.started = 0
        self.used = set()

    @property
    def finished(self):
        return self.started == self.frames and not self.renewed

    def drive(self, ctx):
        dut, pick = self.dut, self.pick
        if pick.random() < self.swap:
            self.front ^= 1
        self.asks = self.started < self.frames and pick.random() < self.start
        ctx.set(dut.back, 1 - self.front)
        ctx.set(dut.swept, self.left == 0)
        self.starts = self.asks and ctx.get(dut.ready)
        ctx.set(dut.start, self.starts)

    def sample(self, ctx):
        dut = self.dut
        assert [ctx.get(dut.depth), *map(ctx.get, dut.color)] == self.current[:3]
        self.waits += self.asks and not self.starts
        if self.left:
            self.left -= 1
            if self.left == 0:
                for part, held in enumerate(self.held):
                    held -= self.stale[part] - {self.current[part]}
        if ctx.get(dut.sweep):
            assert self.left == 0
            self.passes += 1
            self.left = self.length()
            self.stale = [held - {0, tag} for held, tag in zip(self.held, self.current,
                                                               strict=True)]
        self.renewed = (0, 2 - self.front) if self.starts else ()
        self.started += bool(self.starts)

    def after(self, ctx):
        """The new tag is one that the parts that get it do not hold."""
        for part in self.renewed:
            tag = ctx.get((self.dut.depth, *self.dut.color)[part])
            assert tag not in self.held[part], f"tag {tag} is still in part {part}"
            self.current[part] = tag
            self.held[part].add(tag)
            self.used.add(tag)
        self.renewed = ()


class After(Agent):
    def __init__(self, memory):
        self.memory = memory

    def drive(self, ctx):
        self.memory.after(ctx)


class WithFrameUnits(Memory):
    """Frames are handed over to frame units, whose colours are swapped when each is merged, which
    may take long after the next one started."""

    def __init__(self, dut, seed, frames, **arguments):
        super().__init__(dut, seed, frames, **arguments)
        self.current, self.held = [1] * 5, [{0, 1} for _ in range(5)]
        self.shown = 0
        self.drawn = self.merging = False

    def drive(self, ctx):
        chance, self.swap = self.swap, 0.0  # only what is handed over changes places
        super().drive(ctx)
        self.swap = chance
        self.hands = self.drawn and not self.merging and self.pick.random() < chance
        ctx.set(self.dut.hand_over, self.hands)
        ctx.set(self.dut.frame_back, 1 - self.shown)
        if self.hands:
            ctx.set(self.dut.start, 0)
            self.starts = False

    def sample(self, ctx):
        super().sample(ctx)
        assert [ctx.get(tag) for tag in self.dut.frame_color] == self.current[3:]
        self.drawn = (self.drawn or self.starts) and not self.hands
        if self.merging and self.pick.random() < self.swap:  # the picture is merged and shown
            self.merging, self.shown = False, 1 - self.shown
        if self.hands:
            tag, part = self.current[2 - self.front], 4 - self.shown
            assert tag not in self.held[part], f"tag {tag} is still in part {part}"
            self.current[part] = tag
            self.held[part].add(tag)
            self.front, self.merging = 1 - self.front, True


def frames(tag_bits, seed, count=200, memory=Memory, **arguments):
    dut = FrameTags(tag_bits=tag_bits, frame_units=memory is WithFrameUnits)
    memory = memory(dut, seed, count, **arguments)
    simulate(dut, After(memory), memory)
    return memory


@pytest.mark.parametrize("tag_bits", [2, 3, 4])
@pytest.mark.parametrize("swap", [0.0, 0.05, 0.5, 1.0])
@pytest.mark.parametrize("seed", range(2))
def test_no_tag_is_given_out_that_a_word_may_have(tag_bits, swap, seed):
    """Frames that are never shown, shown late, and several times started again."""
    pick = random.Random(f"passes {seed}")
    memory = frames(tag_bits, f"{tag_bits} {swap} {seed}", swap=swap,
                    length=lambda: pick.choice((1, 2, 20, 60)))
    # And all of them are used, but one that is shown all the time.
    assert memory.used == set(range(2 if swap == 0 else 1, 1 << tag_bits))
    assert memory.waits > 0


@pytest.mark.parametrize("tag_bits", [3, 4])
@pytest.mark.parametrize("swap", [0.05, 0.5, 1.0])
@pytest.mark.parametrize("seed", range(2))
def test_nor_one_that_a_word_of_a_frame_unit_may_have(tag_bits, swap, seed):
    """While one picture is shown, another merged, and a third drawn."""
    pick = random.Random(f"units {seed}")
    memory = frames(tag_bits, f"{tag_bits} {swap} {seed}", memory=WithFrameUnits, swap=swap,
                    length=lambda: pick.choice((1, 2, 20, 60)))
    assert memory.used == set(range(1, 1 << tag_bits))
    assert memory.waits > 0


@pytest.mark.parametrize(("tag_bits", "most"), [(2, 1.0), (3, 0.5), (4, 0.2)])
def test_a_pass_for_every_half_of_the_tags(tag_bits, most):
    memory = frames(tag_bits, "often", swap=0.5, length=lambda: 3, start=0.2)
    print(f"{tag_bits} bits: {memory.passes} passes for {memory.started} frames")
    assert 0.02 < memory.passes / memory.started <= most
    # With room to spare they are over before they are needed.
    assert tag_bits < 4 or not memory.waits


def test_while_a_pass_does_not_end_each_tag_is_given_out_once():
    memory = frames(3, "never", 6, swap=0.5, length=lambda: 10**9, start=1.0)
    assert memory.used == set(range(2, 8))
    with pytest.raises(AssertionError, match="no end"):
        frames(3, "never", 7, swap=0.5, length=lambda: 10**9, start=1.0)


@pytest.mark.parametrize("wrong", [1, 7])
def test_bad_widths(wrong):
    rejects(FrameTags, "tag_bits", tag_bits=wrong)
    rejects(FrameTags, "tag_bits must be 3", tag_bits=2, frame_units=True)


def test_latency():
    """The clock after a start has the new tag."""
    dut = FrameTags(tag_bits=4)
    tags = []

    def start(ctx, clock):
        ctx.set(dut.swept, 1)
        ctx.set(dut.start, clock == 3)

    simulate(dut, Drive(start, 8), Watch(lambda ctx, clock: tags.append(ctx.get(dut.depth))))
    assert tags.index(tags[-1]) == 3 + dut.latency + 1
