"""The map of drawn words against a set, frame after frame, from any contents at power-on."""

import random

import pytest
from amaranth.hdl import Fragment, ResetInserter, Signal
from hdl_bench.accesses import careless_memory
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses
from suite.cases import chosen

from cardcage.hdl.merging import bit_memory
from cardcage.hdl.merging.drawn_map import DrawnMap


class Frames(Agent):
    """Changes bits as a frame says, lists them, and goes on to the next frame.

    A frame is a list of (address, drawn).  Whenever nothing is on its way, map and summary are
    compared with the set; after each listing ``sink`` must have what was in it.  ``listed`` has the
    clocks from ``start`` to the end of each listing and how many addresses it gave.
    """

    def __init__(self, dut, frames, sink, *, seed=0, gap=no_pause):
        self.dut, self.sink, self.gap = dut, sink, gap
        self.frames = [list(frame) for frame in frames]
        self.pick = random.Random(f"frames {seed}")
        self.clock = self.wait = self.given = 0
        self.drawn = set()
        self.changed = None  # the clock of the last change
        self.started = None  # that of the start of a listing
        self.cleared = None  # when it was first ready
        self.listed, self.begins = [], []

    @property
    def finished(self):
        return not self.frames and self.started is None

    def drive(self, ctx):
        dut, pick = self.dut, self.pick
        if self.clock == 0:
            for storage in dut.storages:
                for place in range(storage.depth):
                    ctx.set(storage.data[place], pick.getrandbits(dut.word_bits))
        if self.started is not None and self.clock > self.started and not ctx.get(dut.listing):
            self.ended()
        change = start = False
        address, drawn = pick.randrange(dut.words), pick.getrandbits(1)
        if self.started is None and self.frames and ctx.get(dut.ready):
            if self.wait:
                self.wait -= 1
            elif self.frames[0]:
                change = True
                address, drawn = self.frames[0].pop(0)
                self.wait = self.gap()
            elif ctx.get(dut.settled):
                start = True
        for name, value in (("change", change), ("address", address), ("drawn", drawn),
                            ("start", start)):
            ctx.set(getattr(dut, name), value)
        self.change, self.start = (address, drawn) if change else None, start

    def sample(self, ctx):
        dut, clock = self.dut, self.clock
        ready, settled = ctx.get(dut.ready), ctx.get(dut.settled)
        if self.cleared is None and ready:
            self.cleared = clock
        if self.cleared is not None:
            going = self.started is not None
            assert ready == (not going) and ctx.get(dut.listing) == going
            if clock > self.cleared:
                recent = self.changed is not None and clock - self.changed < dut.settling
                assert settled == (ready and not recent), f"clock {clock}"
        if settled:
            self.compare(ctx)
        if self.change:
            address, drawn = self.change
            (self.drawn.add if drawn else self.drawn.discard)(address)
            self.changed = clock
        if self.start:
            self.started = clock
            self.begins.append(clock)
        self.clock += 1

    def compare(self, ctx):
        """The map and its summary are exact."""
        bits, level = self.dut.word_bits, self.drawn
        for storage in self.dut.storages:
            words = [0] * storage.depth
            for number in level:
                words[number // bits] |= 1 << number % bits
            assert [ctx.get(storage.data[place]) for place in range(storage.depth)] == words
            level = {number // bits for number in level}

    def ended(self):
        assert self.sink.items[self.given:] == sorted(self.drawn)
        self.listed.append((self.clock - self.started, len(self.drawn)))
        self.given = len(self.sink.items)
        self.drawn.clear()
        self.started = None
        self.frames.pop(0)


def run(words, word_bits, frames, *, pause=no_pause, **settings):
    dut = DrawnMap(words=words, word_bits=word_bits)
    sink = Sink(dut.addresses, 0, pause)
    agent = Frames(dut, frames, sink, **settings)
    simulate(dut, agent, sink, after=5, limit=100_000)
    assert len(sink.items) == agent.given
    return dut, agent, sink


def random_frames(pick, words, word_bits, frames):
    """Changes all over the map and of a few words that come again and again, within a few clocks;
    more clearings than drawing in some frames, and nothing at all in some."""
    for _ in range(frames):
        few = [pick.randrange(words) for _ in range(3)]
        near = [min(words - 1, max(0, address + pick.randint(-2, word_bits)))
                for address in few for _ in range(2)]
        likely = pick.choice((0.2, 0.5, 0.9, 1.0))
        yield [(pick.choice((pick.choice(few), pick.choice(near), pick.randrange(words))),
                int(pick.random() < likely)) for _ in range(pick.choice((0, 5, 40, 100)))]


@pytest.mark.parametrize(("words", "word_bits", "kind"), [
    *((words, word_bits, "garbage") for words, word_bits in (
        (1, 2), (1, 64), (2, 2), (37, 2), (64, 4), (65, 4), (63, 64), (130, 64), (333, 8))),
    (37, 2, "old"), (65, 4, "new"), (130, 64, "old"), (130, 64, "new")])
def test_random_changes_and_listings(monkeypatch, words, word_bits, kind):
    """Whatever a block RAM reads in the clock of a write, with pauses between changes and between
    addresses, or without any."""
    monkeypatch.setattr(bit_memory, "memory", careless_memory(kind))
    pick = random.Random(f"drawn {kind} {words} {word_bits}")
    for stall in (False, True):
        frames = list(random_frames(pick, words, word_bits, 8))
        _, agent, sink = run(words, word_bits, frames, seed=stall,
                             gap=pauses("gaps") if stall else no_pause,
                             pause=pauses("takes") if stall else no_pause)
        assert len(agent.listed) == 8
        assert sink.items


def bound(dut, addresses):
    """Clocks of a listing, at most."""
    return addresses + dut.summary_words + dut.overhead


PATTERNS = {
    "empty": lambda words, bits: (),
    "full": lambda words, bits: range(words),
    "one bit of every map word": lambda words, bits: range(bits // 2, words, bits),
    "the last bit alone": lambda words, bits: (words - 1,),
    "the first bit alone": lambda words, bits: (0,),
    "one bit of every summary word": lambda words, bits: range(0, words, bits * bits),
    "full map words and single bits in turn": lambda words, bits: (
        address for address in range(words)
        if address // bits % 2 == 0 or address % bits == bits - 1),
    "both ends of every summary word": lambda words, bits: (
        address for address in range(words) if address % (bits * bits) in (0, bits * bits - 1)),
    "full summary words and empty ones in turn": lambda words, bits: (
        address for address in range(words) if address // (bits * bits) % 2),
}


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("size", chosen(
    [(1, 64), (64, 64), (700, 64), (77, 4), (333, 8)], (1, 64), (700, 64), (77, 4)), ids=str)
def test_time_of_a_listing(pattern, size):
    """Two frames of it, and then nothing, which is what must be left."""
    words, word_bits = size
    addresses = list(PATTERNS[pattern](words, word_bits))
    mixed = random.Random(pattern).sample(addresses, len(addresses))
    frame = [(address, 1) for address in mixed]
    dut, agent, sink = run(words, word_bits, [frame, frame, []])
    assert agent.cleared == dut.map_words
    assert sink.items == 2 * addresses
    for clocks, given in agent.listed:
        assert clocks <= bound(dut, given)
    if addresses and addresses[0] < word_bits ** 2:
        assert sink.clocks[0] == agent.begins[0] + dut.latency


@pytest.mark.parametrize("seed", range(3))
def test_no_pattern_takes_longer(seed):
    """Blocks of random density, in a map of many small words."""
    pick = random.Random(f"density {seed}")
    frames = []
    for _ in range(8):
        frame = []
        for begin in range(0, 500, 16):
            likely = pick.choice((0, 0, 0.05, 0.3, 1))
            frame += [(address, 1) for address in range(begin, begin + 16)
                      if pick.random() < likely and address < 500]
        frames.append(frame)
    dut, agent, _ = run(500, 4, frames)
    for clocks, given in agent.listed:
        assert clocks <= bound(dut, given)


@pytest.mark.parametrize(("after", "ready", "listing"), [(5, 0, 0), (40, 1, 0), (110, 0, 1)])
def test_a_reset_at_any_time_clears_everything(after, ready, listing):
    """While it clears itself, while bits are changed and while they are listed."""
    words, bits = 60, 4
    dut = DrawnMap(words=words, word_bits=bits)
    reset = Signal()
    sink = Sink(dut.addresses)
    frame = [(address, 1) for address in range(words)]
    before = Frames(dut, [frame] * 2, sink)
    later = Sink(dut.addresses)
    agents = [before, sink]

    class Reset(Agent):
        """Once; then others go on with what is left, from contents that are no longer known."""

        clock = 0
        finished = False

        def drive(self, ctx):
            ctx.set(reset, self.clock == after)
            if self.clock == after + 1:
                agents[:] = [Frames(dut, [[(7, 1)], []], later), later]
            for agent in agents:
                agent.drive(ctx)

        def sample(self, ctx):
            if self.clock == after:
                assert (ctx.get(dut.ready), ctx.get(dut.listing)) == (ready, listing)
            for agent in agents if self.clock != after else ():
                agent.sample(ctx)
            self.clock += 1
            self.finished = self.clock > after + 1 and agents[0].finished

    simulate(ResetInserter(reset)(dut), Reset(), after=5)
    assert before.frames
    assert later.items == [7]


def test_a_picture_of_a_node(record_property):
    """Of 512 by 512 pixels on sixteen units: four words of the summary, each for 4096 pixels."""
    dut, agent, sink = run(16_384, 64, [[(16_383, 1)], [(0, 1)], [], [
        (address, 1) for address in range(4096, 4500)]])
    assert (dut.map_words, dut.summary_words) == (256, 4)
    assert agent.cleared == 256
    last, first, none, block = (clocks for clocks, _ in agent.listed)
    assert last == bound(dut, 1)  # no bound is less
    # Each empty word of the summary before a bit costs its clock.
    assert last - first <= 3
    assert none <= dut.summary_words + dut.overhead
    assert block <= bound(dut, 404)
    assert sink.clocks[-404:] == list(range(sink.clocks[-404], sink.clocks[-404] + 404))
    record_property("measured", f"drawn map of 16384 words: {last} clocks to list the last one "
                                f"alone, {none} to list none")


def test_the_largest_memory_unit():
    dut = DrawnMap(words=1 << 20)
    Fragment.get(dut, None)
    assert (dut.word_bits, dut.map_words, dut.summary_words) == (64, 16_384, 256)


@pytest.mark.parametrize(("name", "wrong"), [
    ("words", 0), ("words", (1 << 20) + 1), ("word_bits", 1), ("word_bits", 63)])
def test_bad_sizes(name, wrong):
    rejects(DrawnMap, name, **{"words": 4, "word_bits": 8} | {name: wrong})
