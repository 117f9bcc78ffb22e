"""Bits changed one a clock, and words taken, against a list; whatever a word reads as in the clock
of its write."""

import random

import pytest
from hdl_bench.accesses import careless_memory
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.hdl.merging import bit_memory
from cardcage.hdl.merging.bit_memory import BitMemory


class Changes(Agent):
    """Changes random bits in three of four clocks, near each other, from the clock on in which the
    first words have been taken; and looks what has landed."""

    def __init__(self, dut, seed, clocks, words, begin):
        self.dut, self.words, self.begin = dut, words, begin
        self.pick = random.Random(f"changes {seed}")
        self.left = clocks
        self.clock = 0
        self.landing = {}
        self.finished = False

    def drive(self, ctx):
        dut, pick = self.dut, self.pick
        change = self.begin() and self.left and pick.random() < 0.75
        place = pick.choice((0, dut.words - 1, pick.randrange(dut.words)))
        bit, value = pick.choice((0, pick.randrange(dut.word_bits))), pick.getrandbits(1)
        for name, now in (("change", change), ("place", place), ("bit", bit), ("value", value)):
            ctx.set(getattr(dut, name), now)
        self.left -= bool(self.begin() and self.left)
        if change:
            self.words[place] = self.words[place] & ~(1 << bit) | value << bit
            self.landing[self.clock + dut.latency] = place, self.words[place] != 0

    def sample(self, ctx):
        dut, clock = self.dut, self.clock
        landed = self.landing.get(clock)
        assert ctx.get(dut.landed) == (landed is not None)
        if landed:
            assert (ctx.get(dut.landed_place), ctx.get(dut.landed_any)) == landed
        if self.begin() and not ctx.get(dut.taken.valid):
            assert ctx.get(dut.busy) == (clock + 1 in self.landing)
        self.clock += 1
        self.finished = not self.left


class AfterChanges(Source):
    """A second round of words is taken when all changes are written."""

    def __init__(self, stream, items, pause, changes, first):
        super().__init__(stream, items, pause)
        self.changes, self.first = changes, first

    def drive(self, ctx):
        waits = len(self.taken) == self.first and not self._offering and (
            not self.changes.finished or ctx.get(self.changes.dut.busy))
        if waits:
            ctx.set(self._stream.valid, 0)
        else:
            super().drive(ctx)


@pytest.mark.parametrize("kind", ["old", "new", "garbage"])
@pytest.mark.parametrize(("words", "word_bits", "pause"), [
    (2, 4, no_pause), (3, 2, pauses("bits")), (9, 64, pauses("more bits")), (40, 8, no_pause)])
def test_random_changes_and_all_words_taken(monkeypatch, kind, words, word_bits, pause):
    """All words are taken to clear them, bits are changed, and all are taken with what they have;
    and once more, to see 0."""
    monkeypatch.setattr(bit_memory, "memory", careless_memory(kind))
    dut = BitMemory(words=words, word_bits=word_bits)
    model = [0] * words
    places = list(range(words))
    sink = Sink(dut.taken, 3 * words, pause)
    changes = Changes(dut, f"{words} {kind}", 400, model,
                      lambda: len(sink.items) >= words)
    source = AfterChanges(dut.takes, 3 * places, pause, changes, words)
    pick = random.Random(f"power-on {words}")

    class PowerOn(Agent):
        def drive(self, ctx):
            if changes.clock == 0:
                for place in places:
                    ctx.set(dut.storage.data[place], pick.getrandbits(word_bits))

    simulate(dut, PowerOn(), changes, source, sink, after=3)
    assert any(model) and len(changes.landing) > 250
    assert [item.place for item in sink.items] == 3 * places
    assert [item.bits for item in sink.items[words:]] == model + [0] * words


def test_latency_and_throughput_of_taking():
    dut = BitMemory(words=20, word_bits=8)
    source = Source(dut.takes, range(20))
    sink = Sink(dut.taken, 20)
    simulate(dut, source, sink)
    assert source.taken == list(range(20))
    assert sink.clocks == [clock + 1 for clock in source.taken]


@pytest.mark.parametrize(("name", "wrong"), [("words", 0), ("word_bits", 1), ("word_bits", 24)])
def test_bad_sizes(name, wrong):
    rejects(BitMemory, name, **{"words": 4, "word_bits": 8} | {name: wrong})
