"""Passes over a memory in which somebody else writes and others take the port."""

import random

import pytest
from hdl_bench.bench import Agent, rejects, simulate

from cardcage.hdl.memory_unit.tag_sweep import TagSweep

TAGS = 8


class Memory(Agent):
    """Words of three tags, a writer that knows the current ones, and a busy port.

    Tags become current at random; never one that is stale in a pass.
    """

    def __init__(self, dut, words, seed, *, passes, busy=0.0, write=0.0, change=0.0):
        self.dut, self.words = dut, words
        self.pick = random.Random(f"sweep {seed}")
        self.busy, self.write, self.change = busy, write, change
        self.tags = [[self.pick.randrange(TAGS) for _ in range(3)] for _ in range(words)]
        self.current = [1, 1, 1]
        self.dirty = sum(any(tag > 1 for tag in word) for word in self.tags)
        self.passes = passes
        self.begin = None  # clock of the pass's start
        self.stale = [set(), set(), set()]  # tags that were not current since then
        self.lengths = []
        self.cancelled = self.clock = 0
        self.answer = None

    @property
    def finished(self):
        return len(self.lengths) == self.passes

    def drive(self, ctx):
        pick, dut = self.pick, self.dut
        self.start = self.begin is None and not self.finished and pick.random() < 0.2
        ctx.set(dut.start, self.start)
        if pick.random() < self.change:
            # As the controller does: a tag that no word has.
            used = {tag for word in self.tags for tag in word} | set(self.current)
            fresh = [tag for tag in range(1, TAGS) if tag not in used]
            if fresh:
                part = pick.randrange(3)
                self.current[part] = pick.choice(fresh)
                self.stale[part].discard(self.current[part])
        self.other = pick.random() < self.busy
        self.written = None
        if pick.random() < self.write:
            near = min(ctx.get(dut.address), self.words - 1)
            self.written = (pick.choice((near, pick.randrange(self.words))),
                            pick.choice(((0, 1), (0, 2))))
        ctx.set(dut.busy, self.other or self.written is not None)
        stale = 0
        if self.answer is not None:
            stale = sum(1 << part for part, tag in enumerate(self.answer)
                        if tag not in (0, self.current[part]))
        ctx.set(dut.stale, stale)
        hit = self.written is not None and self.written[0] == ctx.get(dut.address)
        # Other words may be taken for it.
        ctx.set(dut.overwritten, hit or (self.written is not None and pick.random() < 0.1))
        self.cancelled += hit and self.begin is not None

    def sample(self, ctx):
        dut = self.dut
        assert ctx.get(dut.idle) == (self.begin is None)
        sweep, erase, address = ctx.get(dut.sweep), ctx.get(dut.erase), ctx.get(dut.address)
        assert not (sweep and erase)
        assert self.begin is not None or not (sweep or erase)
        served = not self.other and self.written is None
        self.answer = list(self.tags[address]) if sweep and served else None
        if self.written is not None:
            word, parts = self.written
            for part in parts:
                self.tags[word][part] = self.current[part]
        elif erase and served:
            for part in range(3):
                if erase >> part & 1:
                    # Only what is stale is ever erased.
                    assert self.tags[address][part] != self.current[part]
                    self.tags[address][part] = 0
        if self.start:
            self.begin = self.clock
            self.stale = [set(range(1, TAGS)) - {tag} for tag in self.current]
        self.clock += 1

    def ended(self, ctx):
        """Once the pass is over: nothing that was stale all the time is left."""
        if self.begin is not None and self.clock > self.begin + 1 and ctx.get(self.dut.idle):
            self.lengths.append(self.clock - 1 - self.begin)
            self.begin = None
            for word in self.tags:
                for part, tag in enumerate(word):
                    assert tag not in self.stale[part]


class Ends(Agent):
    """Looks for the end of a pass before anything else does."""

    def __init__(self, memory):
        self.memory = memory

    def drive(self, ctx):
        self.memory.ended(ctx)


def passes(words, seed, **arguments):
    dut = TagSweep(words=words, parts=3)
    memory = Memory(dut, words, seed, **arguments)
    simulate(dut, Ends(memory), memory)
    return memory


@pytest.mark.parametrize("words", [1, 2, 7, 16])
@pytest.mark.parametrize("seed", range(3))
def test_nothing_stale_is_left(words, seed):
    memory = passes(words, f"{words} {seed}", passes=20, busy=0.4, write=0.3, change=0.1)
    assert words == 16 or memory.cancelled > 10


def test_three_clocks_a_word_and_one_for_what_is_erased():
    """Read, check, erase; and a look whether that took place."""
    memory = passes(16, "length", passes=2)
    # The first pass finds random tags; of the second every word is clean.
    assert memory.lengths == [3 * 16 + memory.dirty, 3 * 16]
    assert memory.dirty > 8


def test_at_most_six_clocks_a_word_beside_the_scan():
    class EveryOther(Memory):
        def drive(self, ctx):
            self.busy = (self.clock + self.words) % 2
            super().drive(ctx)

    for offset in range(4):
        dut = TagSweep(words=16, parts=3)
        memory = EveryOther(dut, 16, offset, passes=2)
        memory.clock = offset
        simulate(dut, Ends(memory), memory)
        assert memory.lengths[0] <= 6 * 16
        # To erase nothing takes no port: of clean words only the read waits.
        assert memory.lengths[1] <= 4 * 16


@pytest.mark.parametrize("words", [1, 2, 16])
@pytest.mark.parametrize("parts", [1, 3, 5])
@pytest.mark.parametrize("scan", [0.0, 0.5])
def test_initialise_erases_every_part_of_every_word_without_a_look(words, parts, scan):
    pick = random.Random(f"initialise {words} {parts} {scan}")
    dut = TagSweep(words=words, parts=parts)
    erased = []

    class Boot(Agent):
        clock = 0
        finished = False

        def drive(self, ctx):
            ctx.set(dut.initialise, self.clock == 2)
            self.scan = pick.random() < scan
            ctx.set(dut.scan, self.scan)
            ctx.set(dut.busy, self.scan)
            ctx.set(dut.stale, pick.getrandbits(parts))  # what power-on left

        def sample(self, ctx):
            assert not ctx.get(dut.sweep)
            if ctx.get(dut.erase) and not ctx.get(dut.busy):
                assert ctx.get(dut.erase) == (1 << parts) - 1
                erased.append(ctx.get(dut.address))
            self.clock += 1
            self.finished = self.clock > 4 and bool(ctx.get(dut.idle))

    clocks = simulate(dut, Boot())
    assert erased == list(range(words))
    assert scan or clocks == max(2 + words + 2, 5)


@pytest.mark.parametrize(("name", "wrong"), [("words", 0), ("words", 1 << 21), ("parts", 0)])
def test_bad_sizes(name, wrong):
    rejects(TagSweep, name, **{"words": 4, "parts": 3} | {name: wrong})
