"""Edges followed row by row, against the intercept as a rational number."""

import random
from fractions import Fraction
from math import ceil

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import prepare, prepared_values, random_triangles, small_machine

from cardcage.golden.grid import Grid
from cardcage.hdl.edge_walker import EdgeWalker


def first_column(begin, end, row, grid):
    """The first pixel whose sample is not left of the edge, on the sample line of ``row``."""
    y = Fraction(row * grid.unit_y + grid.unit_y // 2)
    x = begin[0] + (y - begin[1]) * Fraction(end[0] - begin[0], end[1] - begin[1])
    return ceil((x - grid.unit_x // 2) / grid.unit_x)


def parts(display_list, prepared, index):
    """(name, upper end, lower end, first row, row after the last) of each edge with rows."""
    corners = sorted(map(tuple, display_list.position[prepared.primitive[index]].tolist()),
                     key=lambda corner: corner[1])
    top, middle, bottom = (int(getattr(prepared, name)[index])
                           for name in ("top", "middle", "bottom"))
    for name, begin, end, first, after in (("long", 0, 2, top, bottom),
                                           ("upper", 0, 1, top, middle),
                                           ("lower", 1, 2, middle, bottom)):
        if first < after:
            yield name, corners[begin], corners[end], first, after


class Walks(Agent):
    """Loads each edge, takes up a lattice of rows as the span walker does, and follows it."""

    finished = False

    def __init__(self, dut, jobs, seed):
        self.dut = dut
        self.source = random.Random(f"walks {seed}")
        self.columns = 0
        self.actions = self._actions(jobs)
        self.expected = None

    def _actions(self, jobs):
        """Yield (load, advance, double, column afterwards or None), one a clock."""
        for edge, first, after, column_at, stride_bits, offset in jobs:
            self.edge = edge
            yield 1, 0, 0, column_at(first) if stride_bits == 0 else None
            row = first + offset
            for bit in range(stride_bits):
                last = bit == stride_bits - 1
                known = last and row < after
                yield 0, offset >> bit & 1, 1, column_at(row) if known else None
            while row < after:
                if self.source.random() < 0.3:  # nothing moves by itself
                    yield 0, 0, 0, column_at(row)
                row += 1 << stride_bits
                yield 0, 1, 0, column_at(row) if row < after else None

    def drive(self, ctx):
        action = next(self.actions, None)
        if action is None:
            self.finished = True
            return
        if action[0]:
            ctx.set(self.dut.edge, self.edge)
        for name, value in zip(("load", "advance", "double"), action, strict=False):
            ctx.set(getattr(self.dut, name), value)
        self.next_expected = action[3]

    def sample(self, ctx):
        # What the action of the clock before led to.
        if self.expected is not None:
            assert ctx.get(self.dut.column) == self.expected
            self.columns += 1
        self.expected = None if self.finished else self.next_expected


@pytest.mark.parametrize(("words", "shifts"), [(0, (0, 0)), (128, (0, 1)), (64, (1, 1))])
@pytest.mark.parametrize("seed", range(2))
def test_every_row_of_every_edge(seed, words, shifts):
    configuration = small_machine("PM", 16, 16, words=words, sub_bits=3)
    interlace = configuration.interlace
    assert (interlace.x_shift, interlace.y_shift) == shifts
    display_list = random_triangles(seed, 12, width=16, height=16, sub_bits=3, extreme=True)
    grid = Grid.of(display_list, *shifts)
    prepared = prepare(configuration, display_list)
    jobs = []
    for index, values in enumerate(prepared_values(configuration, prepared)):
        for name, begin, end, first, after in parts(display_list, prepared, index):
            def column_at(row, begin=begin, end=end):
                return first_column(begin, end, row, grid)

            jobs += [(values[name], first, after, column_at, stride_bits, offset)
                     for stride_bits in range(4) for offset in range(1 << stride_bits)]
    dut = EdgeWalker(configuration=configuration)
    walks = Walks(dut, jobs, seed)
    simulate(dut, walks)
    assert walks.columns > 200
