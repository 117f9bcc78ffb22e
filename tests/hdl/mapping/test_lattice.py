"""Steps along a lattice, square by square, for every distance between the squares."""

from itertools import pairwise

import pytest
from amaranth.hdl import Module, Signal
from hdl_bench.bench import evaluate

from cardcage.hdl.mapping.lattice import first_owned, next_owned

SIZE = 64
MASK_BITS = 3


@pytest.mark.parametrize("square_bits", range(4))
def test_the_first_owned_from_a_position_on_and_the_next_one(square_bits):
    m = Module()
    position, offset = Signal(range(SIZE)), Signal(MASK_BITS)
    mask, first, following = Signal(MASK_BITS), Signal(8), Signal(8)
    m.d.comb += [first.eq(first_owned(position, offset, mask, square_bits)),
                 following.eq(next_owned(position, mask, square_bits))]

    def steps(ctx):
        for distance in (1, 2, 4, 8):
            ctx.set(mask, distance - 1)
            for number in range(distance):
                ctx.set(offset, number)
                owned = [at for at in range(2 * SIZE + 64)
                         if (at >> square_bits) % distance == number]
                for at in range(SIZE):
                    ctx.set(position, at)
                    assert ctx.get(first) == next(each for each in owned if each >= at)
                for at, after in pairwise(each for each in owned if each < SIZE + 64):
                    if at < SIZE:
                        ctx.set(position, at)
                        assert ctx.get(following) == after

    evaluate(m, steps)
