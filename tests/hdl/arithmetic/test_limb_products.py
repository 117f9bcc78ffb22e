"""Products limb by limb, put together again."""

import random

import pytest
from amaranth.hdl import Module, Signal
from hdl_bench.bench import Drive, Watch, simulate

from cardcage.hdl.arithmetic.limb_products import LIMB_BITS, limb_products, side_by_side

CLOCKS = 40


@pytest.mark.parametrize("bits", [1, LIMB_BITS - 1, LIMB_BITS, LIMB_BITS + 1, 2 * LIMB_BITS, 50,
                                  3 * LIMB_BITS + 1, 100])
@pytest.mark.parametrize("count_bits", [1, 9, LIMB_BITS])
def test_the_words_add_up_to_the_product(bits, count_bits):
    """Modulo the width of the factor, of what was there when it last moved."""
    pick = random.Random(f"{bits} {count_bits}")
    m, factor, count, move = Module(), Signal(bits), Signal(count_bits), Signal()
    limbs = limb_products(m, factor, count, advance=move, name="product")
    words = side_by_side(limbs)
    assert len(limbs) == -(-bits // LIMB_BITS) and len(words) == min(2, len(limbs))
    total = Signal(bits)
    m.d.comb += total.eq(sum(words[1:], words[0]))
    inputs = [(pick.choice((pick.getrandbits(bits), (1 << bits) - 1)),
               pick.choice((pick.getrandbits(count_bits), (1 << count_bits) - 1)),
               pick.randrange(2)) for _ in range(CLOCKS)]
    wanted, found = [0], []
    for number, times, moves in inputs:
        wanted.append(number * times % (1 << bits) if moves else wanted[-1])

    def drive(ctx, clock):
        for signal, value in zip((factor, count, move), inputs[clock], strict=True):
            ctx.set(signal, value)

    simulate(m, Drive(drive, CLOCKS), Watch(lambda ctx, clock: found.append(ctx.get(total))))
    assert found == wanted[:-1]
