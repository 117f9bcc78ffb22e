"""The RAM of a memory unit against an array."""

import random

import pytest
from hdl_bench.bench import Agent, rejects, simulate

from cardcage.hdl.one_port_memory import OnePortMemory


class Accesses(Agent):
    """Random accesses, one a clock, and what must come of them one clock later."""

    finished = False

    def __init__(self, dut, seed, clocks):
        self.dut = dut
        self.source = random.Random(f"accesses {seed}")
        self.left = clocks
        self.words = [None] * dut.words  # (depth, color, color), unknown at first
        self.data = None
        self.checked = self.held = 0

    def drive(self, ctx):
        pick, dut = self.source, self.dut
        self.access = {
            "address": pick.randrange(dut.words),
            "read": pick.getrandbits(1),
            "write": pick.choice((0, 0, 0, 0, pick.getrandbits(3), pick.getrandbits(3))),
            "depth_in": pick.getrandbits(dut.depth_bits),
            "color_in": pick.getrandbits(24),
        }
        for name, value in self.access.items():
            ctx.set(getattr(dut, name), value)

    def sample(self, ctx):
        access, dut = self.access, self.dut
        # Before the edge: the data of the last read.
        if self.data is not None:
            shown = ctx.get(dut.depth), ctx.get(dut.color[0]), ctx.get(dut.color[1])
            for got, expected in zip(shown, self.data, strict=True):
                if expected is not None:
                    assert got == expected
                    self.checked += 1
        word = self.words[access["address"]] or (None, None, None)
        lanes = [access["write"] >> lane & 1 for lane in range(3)]
        values = (access["depth_in"], access["color_in"], access["color_in"])
        if any(lanes):
            self.held += access["read"]
            self.words[access["address"]] = tuple(
                value if lane else old
                for lane, value, old in zip(lanes, values, word, strict=True))
        elif access["read"]:
            self.data = word
        self.left -= 1
        self.finished = self.left == 0


@pytest.mark.parametrize(("words", "depth_bits", "seed"),
                         [(1, 3, 0), (2, 8, 1), (13, 24, 2), (16, 32, 3)])
def test_random_accesses(words, depth_bits, seed):
    dut = OnePortMemory(words=words, depth_bits=depth_bits)
    assert dut.latency == 1
    accesses = Accesses(dut, seed, 500)
    simulate(dut, accesses)
    assert accesses.checked > 500
    assert accesses.held > 50  # reads at the same time as writes: the data hold


@pytest.mark.parametrize(("words", "depth_bits"), [(0, 8), (-1, 8), (1 << 21, 8), (4, 0), (4, 33)])
def test_bad_sizes(words, depth_bits):
    rejects(OnePortMemory, "words" if depth_bits == 8 else "depth_bits", words=words,
            depth_bits=depth_bits)
