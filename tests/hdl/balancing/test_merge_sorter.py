"""Sorted as Python sorts, whatever waits; every sequence of small weights, and long ones."""

import random
from itertools import product

import pytest
from hdl_bench.bench import Agent, Drive, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.balancing.merge_sorter import MergeSorter


class Sequences(Agent):
    """Sends one sequence after the other, each when the one before has been given back."""

    def __init__(self, dut, sequences, sink, pause):
        self.dut, self.sequences, self.sink, self.pause = dut, sequences, sink, pause
        self.sent = self.clock = self.wait = 0
        self.last = []  # the clock in which the last item of each sequence came

    @property
    def finished(self):
        return self.sent == len(self.sequences) * self.dut.items

    def drive(self, ctx):
        items, dut = self.dut.items, self.dut
        sequence, place = divmod(self.sent, items)
        waits = self.wait or (place == 0 and len(self.sink.items) < self.sent)
        self.wait = max(0, self.wait - 1)
        put = not waits and not self.finished
        ctx.set(dut.put, put)
        if put:
            ctx.set(dut.item, {"weight": self.sequences[sequence][place], "label": place})
            self.sent += 1
            self.wait = self.pause()
            if place == items - 1:
                self.last.append(self.clock)
        self.clock += 1


def check(items, weight_bits, sequences, *, sent=no_pause, taken=no_pause):
    dut = MergeSorter(items=items, weight_bits=weight_bits, label=range(max(2, items)))
    sink = Sink(dut.sorted, items * len(sequences), taken)
    source = Sequences(dut, sequences, sink, sent)

    def power_on(ctx, clock):
        """What is in the memory may be anything: the heaviest there is would be taken first."""
        for place in range(dut.storage.depth if clock == 0 else 0):
            ctx.set(dut.storage.data[place], {"weight": (1 << weight_bits) - 1, "label": 0})

    simulate(dut, Drive(power_on), source, sink, limit=2_000_000, after=3)
    got = [(item.weight, item.label, item.last) for item in sink.items]
    wanted = [(sequence[label], label, rank == items - 1) for sequence in sequences
              for rank, label in enumerate(sorted(range(items), key=lambda at: -sequence[at]))]
    assert got == wanted
    return dut, source, sink


@pytest.mark.parametrize(("items", "weight_bits"), [(1, 2), (2, 2), (3, 2), (4, 2), (5, 1), (6, 1)])
def test_every_sequence_of_small_weights(items, weight_bits):
    check(items, weight_bits, list(product(range(1 << weight_bits), repeat=items)))


@pytest.mark.parametrize("items", [7, 8, 9, 31, 32, 33, 70])
@pytest.mark.parametrize("weight_bits", [3, 32])
def test_random_weights_at_random_times(items, weight_bits):
    """Many equal, ends of the range among them."""
    pick = random.Random(f"weights {items} {weight_bits}")
    most = (1 << weight_bits) - 1
    few = [0, 1, most - 1, most]
    check(items, weight_bits,
          [[pick.choice((pick.choice(few), pick.randint(0, most))) for _ in range(items)]
           for _ in range(4)],
          sent=pauses(f"sent {items}"), taken=pauses(f"taken {items}"))


@pytest.mark.parametrize("items", [1, 2, 3, 5, 8, 60, 64, 65, 128])
def test_latency_and_throughput(items):
    pick = random.Random(f"speed {items}")
    dut, source, sink = check(items, 8, [[pick.randrange(256) for _ in range(items)]
                                         for _ in range(2)])
    for begins, last in zip(range(0, 2 * items, items), source.last, strict=True):
        clocks = sink.clocks[begins:begins + items]
        assert clocks == [last + dut.latency + 2 * rank for rank in range(items)]


@pytest.mark.parametrize("name", ["items", "weight_bits"])
def test_sizes_are_positive(name):
    rejects(MergeSorter, name, **{"items": 4, "weight_bits": 4, "label": 2} | {name: 0})
