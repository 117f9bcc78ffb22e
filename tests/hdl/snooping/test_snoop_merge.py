"""A snoop merge card alone: units to its left, the bus, and a controller's merges."""

import random

import pytest
from amaranth.hdl import Value
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.sending_units import Units, in_turn, random_pixels
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.snooping.snoop_merge import SnoopMerge

NODES, UNITS = 5, 3
FIELDS = ("unit", "address", "depth", "color")


class Bus(Agent):
    """Starts a merge, in which each lower node sends its pixels and ends, and then the higher ones;
    asks for the counters at the end.

    ``heard``: (clock, unit, address, depth) of each pixel that the card gives its units; ``said``:
    (clock, pixel as a tuple or None at the end) of each word on the bus of its own.
    """

    def __init__(self, dut, number, lower, higher, *, pause=no_pause):
        self.dut, self.number, self.pause = dut, number, pause
        self.lower = [word for pixels in lower for word in [*pixels, None]]
        self.higher = [word for pixels in higher for word in [*pixels, None]]
        self.words = list(self.lower)
        self.clock, self.wait = 0, 0
        self.heard, self.said, self.spoken = [], [], []
        self.ended = self.asked = None

    @property
    def finished(self):
        return self.asked is not None

    def drive(self, ctx):
        dut = self.dut
        ctx.set(dut.left.node, self.number)
        ctx.set(dut.left.id, UNITS)
        ctx.set(dut.own.ready, 1)
        ctx.set(dut.own.done, 1)
        ctx.set(dut.snoop.start, self.clock == 3)
        speak = self.clock > 3 and self.words and not self.wait
        self.word = self.words[0] if speak else None
        if speak:
            self.spoken.append((self.clock, self.words.pop(0)))
            self.wait = self.pause()
        elif self.wait:
            self.wait -= 1
        # Other cards drive 0, and this one's own word is heard as well: wired or.
        own = ctx.get(Value.cast(dut.said))
        layout = dut.bus.shape()
        ctx.set(Value.cast(dut.bus), own | (layout.const({
            "valid": 1, "word": {"last": self.word is None,
                                 "pixel": self.word or dict.fromkeys(FIELDS, 0)},
        }).as_bits() if speak else 0))
        asks = self.ended is not None and not self.words and self.clock > self.ended + 20
        ctx.set(dut.broadcast.strobe, asks and self.asked is None)
        ctx.set(dut.broadcast.packet.operation, Operation.READ_COUNTERS)
        if asks and self.asked is None:
            self.asked = self.clock

    def sample(self, ctx):
        dut = self.dut
        heard, said = ctx.get(dut.heard), ctx.get(dut.said)
        if heard.valid:
            self.heard.append((self.clock, heard.unit, heard.address, heard.depth))
        if said.valid:
            assert not self.words or self.ended is not None, "it sends before its turn"
            pixel = None if said.word.last else tuple(said.word.pixel[name] for name in FIELDS)
            self.said.append((self.clock, pixel))
            if said.word.last:
                assert self.ended is None
                self.ended, self.words = self.clock, list(self.higher)
        else:
            assert not ctx.get(Value.cast(dut.said))
        self.clock += 1


def run(number, pixels, *, seed, stall=False, settle=no_pause):
    pick = random.Random(f"bus {seed}")
    dut = SnoopMerge(configuration=small_machine(f"{NODES}x(PMMMMS)F", packet="contiguous"))
    others = [[{"unit": pick.randrange(UNITS), **pixel}
               for pixel in random_pixels(pick, 9, address_bits=4, depth_bits=8)]
              for _ in range(NODES - 1)]
    pause = pauses(f"bus {seed}") if stall else no_pause
    bus = Bus(dut, number, others[:number], others[number:], pause=pause)
    units = Units(dut.units, pixels, first=pause, gap=pause, settle=settle)
    count = Sink(dut.left.response, 1)
    simulate(dut, bus, units, count, after=5)
    [answer] = count.items
    assert answer.kind == ResponseKind.SENT
    return bus, units, answer.value, others[:number]


def all_units(seed, most=9):
    pick = random.Random(f"card {seed}")
    return [random_pixels(pick, most, address_bits=4, depth_bits=8) for _ in range(UNITS)]


@pytest.mark.parametrize("stall", [False, True])
@pytest.mark.parametrize("number", range(NODES))
def test_it_hears_lower_nodes_and_then_sends(number, stall):
    pixels = all_units(number)
    bus, _, sent, lower = run(number, pixels, seed=number, stall=stall)
    told = [(pixel["unit"], pixel["address"], pixel["depth"])
            for others in lower for pixel in others]
    assert [values for _, *values in bus.heard] == [list(values) for values in told]
    *own, (_, end) = bus.said
    assert [pixel for _, pixel in own] == [
        tuple({"unit": unit, **pixel}[name] for name in FIELDS)
        for unit, pixel in in_turn(pixels)]
    assert end is None
    assert sent == len(own) > 0


def test_latency_and_throughput():
    """A pixel is with the units a clock after the bus has it, each in the clock after the other;
    the last node's end starts the sending as soon as the units are settled."""
    pixels = [[{"address": place, "depth": 1, "color": 2} for place in range(12)]] * UNITS
    bus, units, _, _ = run(2, pixels, seed=1)
    spoken = [clock for clock, word in bus.spoken if word is not None][:len(bus.heard)]
    # One clock more lies between another card's pixel and the bus.
    assert [clock for clock, *_ in bus.heard] == [
        clock + SnoopMerge.latency - 1 for clock in spoken]
    clocks = [clock for clock, _ in bus.said]
    assert clocks == list(range(clocks[0], clocks[0] + 3 * 12 + 1))
    ends = [clock for clock, word in bus.spoken if word is None]
    # Taken into a register, counted; then asked whether the units are settled.
    assert units.started == ends[1] + 3


def test_it_waits_until_what_it_heard_is_deleted():
    bus, units, _, _ = run(1, all_units(3), seed=4, settle=lambda: 100)
    assert units.started == 100
    assert bus.said[0][0] > 100
