"""Words that are stored, given again and again, and forgotten, against a list in Python."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.golden.specification.ranges import MAXIMUM_WORDS
from cardcage.hdl.nodes.list_memory import ListMemory

SIZES = [1, 2, 3, 5, 8, 13]
BITS = 9


class Keeper(Agent):
    """Does one of ``operations`` after the other, each when nothing is given: a word to store,
    ``"clear"`` or ``"start"``.  ``giving`` and ``full`` are checked in every clock.

    ``sink`` comes before it among the agents.  ``wanted``: the words that have to be given.
    ``started``: the clock of each start, ``stored`` of each word.
    """

    def __init__(self, dut, operations, sink, gap=no_pause):
        self.dut, self.sink, self.gap = dut, sink, gap
        self.operations = list(operations)
        self.wait = gap()
        self.kept, self.wanted = [], []
        self.full = self.giving = False
        self.doing = None
        self.clock = 0
        self.started, self.stored, self.fulls = [], [], 0

    @property
    def finished(self):
        return not self.operations and not self.giving and self.doing is None

    def drive(self, ctx):
        dut = self.dut
        self.doing = None
        if self.wait:
            self.wait -= 1
        elif self.operations and not self.giving:
            self.doing = self.operations.pop(0)
            self.wait = self.gap()
        word = self.doing if isinstance(self.doing, int) else None
        ctx.set(dut.store, word is not None)
        ctx.set(dut.word, self.clock % (1 << BITS) if word is None else word)
        ctx.set(dut.clear, self.doing == "clear")
        ctx.set(dut.start, self.doing == "start")

    def sample(self, ctx):
        assert ctx.get(self.dut.giving) == self.giving, f"clock {self.clock}"
        assert ctx.get(self.dut.full) == self.full, f"clock {self.clock}"
        if self.giving:
            self.giving = len(self.sink.items) < len(self.wanted)
        if self.doing == "clear":
            self.kept, self.full = [], False
        elif self.doing == "start":
            self.wanted += self.kept
            self.giving = True
            self.started.append(self.clock)
        elif self.doing is not None:
            self.stored.append(self.clock)
            if len(self.kept) == self.dut.words:
                self.full = True
                self.fulls += 1
            else:
                self.kept.append(self.doing)
        self.clock += 1


def run(words, operations, *, gap=no_pause, pause=no_pause):
    dut = ListMemory(words=words, word_bits=BITS)
    sink = Sink(dut.given, pause=pause)
    keeper = Keeper(dut, operations, sink, gap)
    simulate(dut, sink, keeper, after=4)
    assert sink.items == keeper.wanted
    return keeper, sink


@pytest.mark.parametrize("words", SIZES)
@pytest.mark.parametrize("seed", range(2))
def test_random_lists(words, seed):
    """Empty ones, ones that just fit and ones that do not, given not at all or several times."""
    pick = random.Random(f"lists {words} {seed}")
    operations = []
    for _ in range(25):
        count = pick.choice((0, words, words + 1, pick.randrange(2 * words + 1)))
        operations += [pick.getrandbits(BITS) for _ in range(count)]
        operations += ["start"] * pick.choice((0, 1, 1, 3))
        operations += ["clear"] * pick.randrange(2)
    keeper, sink = run(words, operations, gap=pauses(f"gap {words} {seed}"),
                       pause=pauses(f"takes {words} {seed}"))
    assert keeper.fulls > 2 and len(keeper.started) > 10 and len(sink.items) > 10


@pytest.mark.parametrize("words", SIZES)
def test_a_list_that_just_fits(words):
    """It is not full, and a word more is lost, and known to be; it stays so until it is cleared."""
    own = [7 * place % 512 for place in range(words)]
    keeper, _ = run(words, [*own, "start", "start", "start"])
    assert keeper.wanted == own * 3 and not keeper.full
    keeper, _ = run(words, [*own, 500, "start", 501, "start"])
    assert keeper.wanted == own * 2 and keeper.full
    keeper, _ = run(words, [*own, 500, "clear", "start", 3, "start"])
    assert keeper.wanted == [3] and not keeper.full


@pytest.mark.parametrize("words", SIZES)
def test_latency_and_a_word_a_clock(words):
    own = list(range(words))
    keeper, sink = run(words, [*own, "start", "start"])
    assert ListMemory.latency == 2
    assert keeper.stored == list(range(words))
    assert sink.clocks == [start + ListMemory.latency + place for start in keeper.started
                           for place in range(words)]
    # The next start may be in the clock after the last word was taken.
    first, second = keeper.started
    assert (first, second) == (words, sink.clocks[words - 1] + 1)


def test_clocks_in_which_nothing_is_asked_for_change_nothing():
    """Whatever word is on the lines, and however long the list is kept."""
    dut = ListMemory(words=4, word_bits=BITS)
    sink = Sink(dut.given, 4)

    def drive(ctx, clock):
        ctx.set(dut.word, clock)
        ctx.set(dut.store, clock % 5 == 0 and clock < 20)
        ctx.set(dut.start, clock == 40)

    simulate(dut, sink, Drive(drive), after=5)
    assert sink.items == [0, 5, 10, 15]


def test_bad_sizes():
    rejects(ListMemory, "words", words=0, word_bits=3)
    rejects(ListMemory, "words", words=MAXIMUM_WORDS + 1, word_bits=3)
    rejects(ListMemory, "word_bits", words=3, word_bits=0)
