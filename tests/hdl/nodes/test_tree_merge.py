"""A tree merge card alone: units to its left, neighbours, and a controller's steps."""

import random

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.sending_units import Units, in_turn, random_pixels
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.nodes.tree_merge import TreeMerge

NODES, UNITS = 5, 3
FIELDS = ("unit", "address", "depth", "color")


def words(pixels):
    """What a node sends: its pixels, and the end."""
    return [*({"pixel": pixel, "last": 0} for pixel in pixels),
            {"pixel": dict.fromkeys(FIELDS, 0), "last": 1}]


def values(pixels):
    return [tuple(pixel[name] for name in FIELDS) for pixel in pixels]


class Controller(Agent):
    """A frame start, one step, and the counters when the card is done with it; then again a frame
    start, and the counters.

    ``ended()``: the others have seen the step end.
    """

    def __init__(self, dut, number, step, ended):
        self.dut, self.number, self.step, self.ended = dut, number, step, ended
        self.clock = 0
        self.asked = None

    def drive(self, ctx):
        dut = self.dut
        ctx.set(dut.left.node, self.number)
        ctx.set(dut.left.id, UNITS)
        ctx.set(dut.nodes, NODES)
        ctx.set(dut.own.ready, 1)
        ctx.set(dut.own.done, 1)
        ctx.set(dut.tree.step, self.step)
        ctx.set(dut.tree.start, self.clock == 5)
        if self.asked is None and self.clock > 7 and self.ended() and not ctx.get(dut.tree.busy):
            self.asked = self.clock
        since = -1 if self.asked is None else self.clock - self.asked
        operation = {0: Operation.READ_COUNTERS, 30: Operation.FRAME_START,
                     32: Operation.READ_COUNTERS}.get(since)
        if self.clock == 1:
            operation = Operation.FRAME_START
        ctx.set(dut.broadcast.strobe, operation is not None)
        ctx.set(dut.broadcast.packet.operation, operation or Operation.READ_COUNTERS)

    @property
    def finished(self):
        return self.asked is not None

    def sample(self, ctx):
        self.clock += 1


def run(number, step, *, pixels=(), arriving=(), stall=""):
    """One step; what goes to the left, what the node receives, and how much it says it sent."""
    configuration = small_machine(f"{NODES}x(PMMMMT)", packet="contiguous")
    dut = TreeMerge(configuration=configuration)
    pause = pauses if stall else lambda name: no_pause
    units = Units(dut.units, pixels, first=pause(f"{stall} first"), gap=pause(f"{stall} gap"))
    source = Source(dut.from_right, words(arriving) if arriving else [], pause(f"{stall} right"))
    left, received = (Sink(stream, 0, pause(f"{stall} {name}"))
                      for name, stream in (("left", dut.to_left), ("received", dut.received)))
    count = Sink(dut.left.response, 2)

    def ended():
        sent = not pixels or (units.finished and left.items and left.items[-1].last)
        return sent and source.finished

    agents = [Controller(dut, number, step, ended), source, left, received, count]
    simulate(dut, *agents, *([units] if pixels else []), after=12)
    answer, later = count.items
    assert answer.kind == later.kind == ResponseKind.SENT
    assert later.value == 0  # of a frame that has only begun
    return left, received, answer.value


def all_units(seed, most=9):
    pick = random.Random(f"card {seed}")
    return [random_pixels(pick, most, address_bits=4, depth_bits=8) for _ in range(UNITS)]


def of_the_right(seed):
    """As another node sends them."""
    return [{"unit": unit, **pixel} for unit, own in enumerate(all_units(seed)) for pixel in own]


@pytest.mark.parametrize("stall", ["", "stalls"])
@pytest.mark.parametrize(("number", "step"), [(1, 0), (3, 0), (2, 1), (4, 2)])
def test_a_sender_sends_its_pixels_and_counts_them(number, step, stall):
    pixels = all_units(number)
    left, received, sent = run(number, step, pixels=pixels, stall=stall)
    expected = [{"unit": unit, **pixel} for unit, pixel in in_turn(pixels)]
    *before, last = left.items
    assert values([word.pixel for word in before]) == values(expected)
    assert last.last and not any(word.last for word in before)
    assert not received.items
    assert sent == len(expected) > 0


@pytest.mark.parametrize("stall", ["", "stalls"])
@pytest.mark.parametrize(("number", "step"), [(0, 0), (2, 0), (0, 1), (0, 2)])
def test_a_receiver_gives_its_elements_what_arrives(number, step, stall):
    arriving = of_the_right(7)
    left, received, sent = run(number, step, arriving=arriving, stall=stall)
    assert values(received.items) == values(arriving)
    assert not left.items
    assert sent == 0


@pytest.mark.parametrize(("number", "step"), [(1, 1), (1, 2), (3, 2)])
def test_what_is_for_others_passes(number, step):
    arriving = of_the_right(9)
    left, received, sent = run(number, step, arriving=arriving, stall="stalls")
    assert values([word.pixel for word in left.items[:-1]]) == values(arriving)
    assert left.items[-1].last
    assert not received.items
    assert sent == 0
