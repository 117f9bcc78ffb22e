"""Bit for bit the table of ``packed_table``, whatever is counted and however late it comes."""

import random
from itertools import product

import numpy as np
import pytest
from amaranth.hdl import Fragment
from amaranth.sim import Simulator
from hdl_bench.bench import rejects
from suite.cases import EVERY

from cardcage.golden.balancing.balancer_clocks import balancer_clocks
from cardcage.golden.organisations.region_table import packed_table, slots_of, static_table
from cardcage.hdl.balancing.balancer import Balancer
from cardcage.hdl.balancing.least_loaded import LeastLoaded
from cardcage.hdl.balancing.merge_sorter import MergeSorter
from cardcage.hdl.balancing.region_order import RegionOrder


class Cage:
    """What is around a balancer: deals a table out, sends what was counted in a picture that was
    drawn by it, and reads the next table, which is dealt out then.

    ``clocks``  of each packing from its first count to its end, both included
    """

    def __init__(self, *, columns, rows, elements, slots, count_bits=32, seed=None):
        self.dut = Balancer(columns=columns, rows=rows, elements=elements, slots=slots,
                            count_bits=count_bits)
        self.columns, self.count, self.slots = columns, columns * rows, slots
        self.count_bits = count_bits
        self.pick = random.Random(f"cage {seed}")
        self.stalls = seed is not None
        self.clocks = []

    def show(self, pictures):
        """``pictures``: of each the processing elements there are, and the counts of all regions.
        A static table is dealt where there are others than before."""
        simulator = Simulator(self.dut)
        simulator.add_clock(1e-6)

        async def bench(ctx):
            before = None
            for elements, counts in pictures:
                if elements != before:
                    before, table = elements, static_table(self.count, elements)
                    ctx.set(self.dut.elements, elements)
                await self.deal(ctx, table)
                assert await self.read(ctx) == table.tolist()
                await self.pack(ctx, elements, table, counts)
                table = packed_table(np.array(counts), elements, self.slots)
                assert await self.read(ctx) == table.tolist(), f"{elements} elements: {counts}"

        simulator.add_testbench(bench)
        simulator.run()

    async def wait(self, ctx):
        if self.stalls:
            for _ in range(self.pick.choice((0, 0, 0, 1, 7))):
                await ctx.tick()

    async def deal(self, ctx, table):
        dealt = self.dut.dealt
        for region, slot in enumerate(slots_of(table).tolist()):
            ctx.set(dealt.valid, 1)
            ctx.set(dealt.column, region % self.columns)
            ctx.set(dealt.row, region // self.columns)
            ctx.set(dealt.element, int(table[region]))
            ctx.set(dealt.slot, slot)
            await ctx.tick()
            ctx.set(dealt.valid, 0)
            await self.wait(ctx)

    async def read(self, ctx):
        table = []
        for region in range(self.count):
            ctx.set(self.dut.column, region % self.columns)
            ctx.set(self.dut.row, region // self.columns)
            await ctx.tick()
            table.append(ctx.get(self.dut.element))
        return table

    async def pack(self, ctx, elements, table, counts):
        dut, pick = self.dut, self.pick
        # In slots without a region there may be anything.
        sent = [pick.getrandbits(self.count_bits) for _ in range(elements * self.slots)]
        for place, count in zip((table * self.slots + slots_of(table)).tolist(), counts,
                                strict=True):
            sent[place] = int(count)
        assert not ctx.get(dut.busy) and not ctx.get(dut.counts.ready)
        ctx.set(dut.start, 1)
        await ctx.tick()
        ctx.set(dut.start, 0)
        clocks = 0
        for count in sent:
            ctx.set(dut.counts.valid, 0)
            await self.wait(ctx)
            ctx.set(dut.counts.valid, 1)
            ctx.set(dut.counts.payload, count)
            assert ctx.get(dut.counts.ready) and ctx.get(dut.busy) and not ctx.get(dut.done)
            await ctx.tick()
            clocks += 1
        ctx.set(dut.counts.payload, pick.getrandbits(self.count_bits))
        assert ctx.get(dut.busy) and not ctx.get(dut.counts.ready)
        while not ctx.get(dut.done):
            await ctx.tick()
            clocks += 1
        assert ctx.get(dut.busy) and not ctx.get(dut.counts.ready)
        await ctx.tick()
        assert not ctx.get(dut.done) and not ctx.get(dut.busy)
        ctx.set(dut.counts.valid, 0)
        self.clocks.append(clocks + 1)


@pytest.mark.parametrize(("columns", "rows", "elements", "slots", "count_bits"), [
    (1, 1, 1, 1, 3), (2, 1, 3, 1, 2), (2, 2, 3, 2, 1), (1, 3, 2, 2, 2), (3, 2, 2, 4, 1),
    (5, 1, 4, 3, 1)])
def test_all_counts_of_small_widths(columns, rows, elements, slots, count_bits):
    """With every number of processing elements that has room."""
    regions = columns * rows
    Cage(columns=columns, rows=rows, elements=elements, slots=slots, count_bits=count_bits).show(
        [(there, counts) for there in range(-(-regions // slots), elements + 1)
         for counts in product(range(1 << count_bits), repeat=regions)])


def counted(pick, regions):
    """Counts of all regions, in one of the ways in which they are hard."""
    most = (1 << 32) - 1
    few = [pick.randrange(1 << 20) for _ in range(3)]
    one = pick.choice((0, 1, most - 1, most, few[0]))
    return pick.choice((
        lambda: [one] * regions,
        lambda: [pick.choice((0, 0, most)) for _ in range(regions)],
        lambda: [pick.choice((0, *few, most)) for _ in range(regions)],
        lambda: [pick.getrandbits(pick.randrange(1, 33)) for _ in range(regions)],
        lambda: sorted((pick.getrandbits(24) for _ in range(regions)), reverse=pick.random() < 0.5),
    ))()


@pytest.mark.parametrize(("columns", "rows", "elements", "slots"), [
    (5, 3, 4, 5), (1, 17, 17, 1), (4, 4, 1, 16), (5, 13, 3, 64),
    pytest.param(16, 8, 16, 10, marks=EVERY), pytest.param(7, 5, 64, 1, marks=EVERY)])
def test_random_counts_at_random_times(columns, rows, elements, slots):
    """Ties, nothing counted, and the highest counts among them; all elements, or fewer."""
    seed = f"{columns}x{rows} in {elements}x{slots}"
    print("seed", seed)
    pick = random.Random(f"counts {seed}")
    fewest = -(-columns * rows // slots)
    Cage(columns=columns, rows=rows, elements=elements, slots=slots, seed=seed).show(
        [(there, counted(pick, columns * rows))
         for there in (elements, fewest, pick.randint(fewest, elements)) for _ in range(2)])


@pytest.mark.parametrize(("columns", "rows", "elements", "slots", "there"), [
    (1, 1, 1, 1, 1), (1, 1, 9, 1, 9), (3, 1, 2, 2, 2), (5, 3, 4, 5, 3), (16, 8, 16, 10, 16),
    (16, 8, 16, 10, 13), (8, 8, 64, 2, 64), (3, 43, 2, 129, 2), (32, 32, 1, 1024, 1),
    pytest.param(32, 32, 16, 80, 16, marks=EVERY)])
def test_clocks(columns, rows, elements, slots, there):
    """As stated where no count is waited for, whatever is counted."""
    cage = Cage(columns=columns, rows=rows, elements=elements, slots=slots)
    pick = random.Random("clocks")
    regions = columns * rows
    cage.show([(there, [pick.getrandbits(32) for _ in range(regions)])])
    assert cage.clocks == [balancer_clocks(regions, there, slots)]


@pytest.mark.parametrize(("regions", "elements", "slots"), [(1, 1, 1), (7, 3, 4), (128, 16, 10)])
def test_the_clocks_are_those_that_the_parts_state(regions, elements, slots):
    sorter = MergeSorter(items=regions, weight_bits=1, label=1)
    Fragment.get(sorter, None)  # Amaranth wants each elaborated
    # Clocks are numbered from that of the first count on.
    last_put = elements * slots - 1 + RegionOrder.latency + regions - 1
    last_given = last_put + sorter.latency + (regions - 1) * (elements + LeastLoaded.overhead)
    assert balancer_clocks(regions, elements, slots) == last_given + 1


def test_128_regions_in_16_elements_take_at_most_6000_clocks():
    assert balancer_clocks(128, 16, 10) <= 6000


@pytest.mark.parametrize("name", ["columns", "rows", "elements", "slots", "count_bits"])
def test_sizes_are_positive(name):
    rejects(Balancer, name, **{"columns": 2, "rows": 2, "elements": 2, "slots": 2} | {name: 0})


def test_there_must_be_room():
    rejects(Balancer, "slots: 2 in each of 4 elements are too few for 9 regions",
            columns=3, rows=3, elements=4, slots=2)
