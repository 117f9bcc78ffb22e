"""Values some clocks later, counting only the clocks that are to count."""

import random

import pytest
from amaranth.hdl import Fragment, Module, Signal
from hdl_bench.bench import Drive, Watch, simulate

from cardcage.hdl.arithmetic.delay import delayed

CLOCKS = 60


@pytest.mark.parametrize("clocks", [1, 2, 5])
@pytest.mark.parametrize("stalls", [False, True])
def test_a_value_as_it_was_so_many_clocks_ago(clocks, stalls):
    pick = random.Random(f"{clocks} {stalls}")
    m, value, enable = Module(), Signal(8), Signal()
    later = (delayed(m, value, clocks, "later", enable=enable) if stalls
             else delayed(m, value, clocks, "later"))
    inputs = [(pick.getrandbits(8), pick.randrange(2) if stalls else 1) for _ in range(CLOCKS)]
    counted = [0] * clocks
    wanted, found = [], []
    for number, counts in inputs:
        wanted.append(counted[-clocks])
        counted += [number] * counts

    def drive(ctx, clock):
        ctx.set(value, inputs[clock][0])
        ctx.set(enable, inputs[clock][1])

    simulate(m, Drive(drive, CLOCKS), Watch(lambda ctx, clock: found.append(ctx.get(later))))
    assert found == wanted


def test_none_is_the_value_itself():
    m, value = Module(), Signal()
    assert delayed(m, value, 0, "value") is value
    Fragment.get(m, None)


def test_what_says_whether_others_count_is_reset():
    m, value = Module(), Signal()
    assert delayed(m, value, 1, "value").reset_less
    assert not delayed(m, value, 1, "counts", reset_less=False).reset_less
    Fragment.get(m, None)
