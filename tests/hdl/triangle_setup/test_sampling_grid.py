"""The resolution for every number of units."""

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.pictures import small_machine

from cardcage.golden.specification.interlace import interlace_for
from cardcage.hdl.triangle_setup.sampling_grid import SamplingGrid


@pytest.mark.parametrize(("width", "height", "words"), [(16, 16, 16), (5, 13, 3), (8, 8, 64)])
def test_every_number_of_units(width, height, words):
    configuration = small_machine("PM", width, height, words=words, maximum_units=16)
    dut = SamplingGrid(configuration=configuration)
    counts = [1, 16, 2, 8, 4]

    def look(ctx, clock):
        if clock:  # a clock after the number
            expected = interlace_for(width, height, words=words, units=counts[clock - 1])
            grid = ctx.get(dut.grid)
            assert all(grid[name] == getattr(expected, name)
                       for name in ("width", "height", "x_shift", "y_shift"))
        ctx.set(dut.total, counts[min(clock, len(counts) - 1)])

    simulate(dut, Watch(look, len(counts) + 1))
