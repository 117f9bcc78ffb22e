"""A memory unit behind a direct merge tests depths itself, against a model of its words."""

import random

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import no_pause, pauses

from cardcage.hdl.depth_test.two_ports import TwoPortDepthTest
from cardcage.hdl.memory_unit.memory_unit import MemoryUnit

WORDS, NUMBER, TOTAL = 16, 2, 4


class Lines(Agent):
    """Boots the unit, then frame after frame: fragments, and when they are done a read-back of
    every word.

    ``scan``: how likely a fetch is.  ``taken`` lists the clocks of each frame.
    """

    def __init__(self, dut, frames, *, seed=0, scan=0.0, pause=no_pause):
        self.dut, self.frames, self.scan, self.pause = dut, list(frames), scan, pause
        self.pick = random.Random(f"lines {seed}")
        self.background = dut.configuration.rank_background
        self.clock = self.tag = self.wait = 0
        self.state, self.fragments, self.address = "boot", [], 0
        self.taken, self.followed, self.done = [], [], 0

    @property
    def finished(self):
        return self.state == "end"

    def drive(self, ctx):
        dut = self.dut
        if self.clock == 0:
            ctx.set(dut.left.id, NUMBER)
            ctx.set(dut.total, TOTAL)
        ctx.set(dut.pictures.initialise, self.clock == 1)
        ctx.set(dut.scan.fetch, {"valid": self.pick.random() < self.scan,
                                 "x": self.pick.randrange(8), "y": self.pick.randrange(8)})
        ctx.set(dut.left.lines.read, {"valid": self.state == "read", "unit": NUMBER,
                                      "address": self.address % WORDS})
        fragments = dut.direct.fragments
        self.offers = self.state == "draw" and bool(self.fragments) and not self.wait
        self.wait = max(0, self.wait - 1)
        ctx.set(fragments.valid, self.offers)
        if self.offers:
            ctx.set(fragments.payload, self.fragments[0])

    def sample(self, ctx):
        dut = self.dut
        if self.state == "boot":
            if self.clock > 2 and ctx.get(dut.pictures.swept):
                self.start(ctx)
        elif self.state == "draw":
            self.draw(ctx)
        elif self.state == "read":
            if not ctx.get(dut.left.lines.read_busy):
                self.state = "answer"
        elif self.state == "answer":
            assert ctx.get(dut.left.lines.read_data) == self.words.get(
                self.address, (self.background, 0))[0]
            self.address += 1
            self.state = "read"
            if self.address == WORDS:
                self.start(ctx)
        self.clock += 1

    def start(self, ctx):
        """The next frame, on words that are background."""
        if not self.frames:
            self.state = "end"
            return
        self.fragments, self.words, self.address = list(self.frames.pop(0)), {}, 0
        self.tag += 1
        self.state = "draw"
        self.taken.append([])
        self.followed.append(0)

    def draw(self, ctx):
        lines = self.dut.direct
        self.followed[-1] += ctx.get(lines.followed)
        if self.offers and ctx.get(lines.fragments.ready):
            fragment = self.fragments.pop(0)
            address, depth = fragment["address"], fragment["depth"]
            if depth < self.words.get(address, (self.background,))[0]:
                self.words[address] = depth, fragment["color"]
            self.taken[-1].append(self.clock)
            self.wait = self.pause()
        elif not self.fragments and not ctx.get(lines.busy):
            self.state = "read"


class Tags(Agent):
    """Gives each frame its tag, as the controller does."""

    def __init__(self, dut, lines):
        self.dut, self.lines = dut, lines

    def drive(self, ctx):
        ctx.set(self.dut.pictures.depth_tag, max(1, self.lines.tag))
        for tag in self.dut.pictures.color_tag:
            ctx.set(tag, max(1, self.lines.tag))


def fragments_of(seed, count, addresses, order_bits=4):
    """Few pixels, and few depths, so that the order decides."""
    pick = random.Random(f"fragments {seed}")
    return [{"address": pick.randrange(addresses),
             "depth": pick.randrange(6) << order_bits | pick.getrandbits(order_bits),
             "color": pick.getrandbits(24)} for _ in range(count)]


def run(ports, frames, **settings):
    configuration = small_machine("PPDMMMM", 8, 8, memory_ports=ports, order_bits=4)
    assert configuration.words == WORDS
    dut = MemoryUnit(configuration=configuration)
    lines = Lines(dut, frames, **settings)
    simulate(dut, Tags(dut, lines), lines, after=2)
    return lines


@pytest.mark.parametrize("ports", [1, 2])
@pytest.mark.parametrize("seed", range(3))
def test_random_fragments(ports, seed):
    lines = run(ports, [fragments_of(f"{seed} {frame}", 60, 2 + 7 * (frame % 3)) for frame in
                        range(6)], seed=seed, scan=0.2 * seed, pause=pauses(seed))
    assert sum(lines.followed)


@pytest.mark.parametrize("addresses", [1, WORDS])
def test_a_fragment_a_clock_with_two_ports(addresses):
    """Also all to one pixel; whoever comes just behind another one sees what that left."""
    lines = run(2, [fragments_of("fast", 40, addresses)])
    [clocks] = lines.taken
    assert clocks == list(range(clocks[0], clocks[0] + 40))
    assert TwoPortDepthTest.latency == 3
    assert addresses > 1 or lines.followed[0] > 4


def test_two_accesses_of_a_visible_fragment_with_one_port():
    """Each nearer than the one before it, once no more can wait."""
    nearer = [{"address": place % WORDS, "depth": 200 - place, "color": place}
              for place in range(60)]
    [clocks] = run(1, [nearer]).taken
    assert 2 * 20 <= clocks[-1] - clocks[39] <= 2 * 20 + 1
