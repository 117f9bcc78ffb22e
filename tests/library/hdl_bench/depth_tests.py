"""What every depth test must do, and fragments that try it."""

import random

from .bench import Watch, simulate
from .memory import MemoryBusModel
from .streams import Source, no_pause


def fragment(unit, address, depth, color):
    return {"unit": unit, "address": address, "depth": depth, "color": color}


def on_few_pixels(seed, count, *, units, words):
    """Few places and few depths, so that pixels repeat at once and ties are common."""
    pick = random.Random(f"fragments {seed}")
    chosen = [(pick.randrange(units), pick.randrange(words)) for _ in range(2 * units)]
    return [fragment(*pick.choice(chosen), pick.randrange(256), number)
            for number in range(1, count + 1)]


def on_one_pixel_in_consecutive_clocks(seed, runs):
    """Runs that get nearer and nearer, then farther; ties within."""
    pick = random.Random(f"one pixel {seed}")
    fragments = []
    for _ in range(runs):
        top = pick.randrange(20, 256)
        fragments += [fragment(0, pick.randrange(2), max(0, top - pick.choice((0, 1, 2, 5)) * step),
                               pick.getrandbits(24)) for step in range(4)]
    return fragments + [fragment(0, 0, depth, depth + 1) for depth in reversed(range(20))]


def on_one_pixel_after(gap, between):
    """One pixel every ``gap`` clocks, ever nearer or farther: the fragments, and their pauses.

    In the clocks between, nothing, hidden fragments or winners of other pixels: ``between``
    is None, 0 or 1.
    """
    fragments, waits = [], [0]
    for step in range(30):
        depth = 250 - 8 * step if step < 20 else 8 * step
        fragments.append(fragment(0, 3, depth, 2 * step + 1))
        waits.append(0)
        for place in range(gap - 1):
            if between is None:
                waits[-1] += 1
            else:
                other = 250 - 4 * step - place if between else 254
                fragments.append(fragment(0, 4 + (place + step) % 2, other, 0x10000 + step))
                waits.append(0)
    return fragments, iter(waits).__next__


class DepthTestRun:
    """Draws ``fragments`` into the first ``units`` units of ``words`` words each, and compares all
    memory afterwards.

    ``background`` is in memory before, or random depths; ``settings`` are those of
    ``MemoryBusModel``.  Attributes: ``source``, ``memory``, the numbers of the ``winners``,
    ``busy`` by clock, how often a depth was ``forwarded``, and ``forwarded_in`` which clocks.
    """

    def __init__(self, dut, fragments, *, units, words, pause=no_pause, background=None, after=40,
                 **settings):
        self.memory = memory = MemoryBusModel(dut.memory, first=0, end=units, words=words,
                                           depth_bits=dut.depth_bits, **settings)
        if background is not None:
            memory.depth = dict.fromkeys(memory.depth, background)
        depth, color, self.winners = dict(memory.depth), dict(memory.back), []
        for number, item in enumerate(fragments):
            place = item["unit"], item["address"]
            if item["depth"] < depth[place]:
                depth[place], color[place] = item["depth"], item["color"]
                self.winners.append(number)
        self.source = Source(dut.fragments, fragments, pause)
        self.forwarded_in, self.busy = [], []

        def look(ctx, clock):
            self.forwarded_in += [clock] * ctx.get(dut.forwarded)
            self.busy.append(ctx.get(dut.busy))
            if clock > 1 and not any(self.busy[-2:]):
                assert ctx.get(dut.memory.write).address == 0

        simulate(dut, self.source, memory, Watch(look), after=after)
        self.forwarded = len(self.forwarded_in)
        assert memory.depth == depth
        assert memory.back == color


def keeps_the_first_of_ties(draw):
    """``draw`` makes a run of fragments on two units and a background."""
    run = draw([fragment(unit, 3, 77, color) for unit in (0, 1) for color in range(1, 9)], 255)
    assert run.memory.back[0, 3] == run.memory.back[1, 3] == 1
    assert run.forwarded > 0
    # Against what is stored already, too.
    assert not draw([fragment(0, 5, 77, 1)], 77).memory.writes


def sees_a_clear_in_between(dut, unit, gap, *, words):
    """Once it is not busy, what it wrote is forgotten: the memory may be cleared."""
    memory = MemoryBusModel(dut.memory, first=0, end=2, words=words, depth_bits=dut.depth_bits)
    memory.depth = dict.fromkeys(memory.depth, 255)
    source = Source(dut.fragments, [fragment(unit, 4, 10, 1), fragment(unit, 4, 200, 2)],
                    lambda: gap)
    idle = []

    def clear(ctx, clock):
        if len(memory.writes) == 1 and not ctx.get(dut.busy):
            if not idle:
                memory.depth[unit, 4] = 255
            idle.append(clock)

    simulate(dut, source, memory, Watch(clear), after=gap + 8)
    assert idle
    assert (memory.depth[unit, 4], memory.back[unit, 4]) == (200, 2)
