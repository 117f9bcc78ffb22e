"""Boxes of pixel centres for every coordinate, by looking at the centres."""

import pytest
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.pictures import small_machine

from cardcage.hdl.triangle_setup.pixel_box import PixelBox
from cardcage.hdl.triangle_setup.sampling_grid import grid_layout

SIDES = ("top", "middle", "bottom", "left", "right")


class Boxes(Agent):
    """All five coordinates the same or one apart, through the whole range."""

    def __init__(self, dut, configuration):
        self.dut, self.interlace = dut, configuration.interlace
        self.sub_bits = configuration.sub_bits
        limit = 1 << (configuration.coordinate_bits - 1)
        self.cases = [(low, min(low + apart, limit - 1)) for low in range(-limit, limit)
                      for apart in (0, 1, 3, 20)]
        self.clock = 0

    @property
    def finished(self):
        return self.clock >= len(self.cases) + self.dut.latency

    def first(self, coordinate, size, shift):
        unit = 1 << (self.sub_bits + shift)
        return next((pixel for pixel in range(size) if pixel * unit + unit // 2 >= coordinate),
                    size)

    def drive(self, ctx):
        interlace = self.interlace
        ctx.set(self.dut.grid, {name: getattr(interlace, name)
                                for name in ("width", "height", "x_shift", "y_shift")})
        if self.clock < len(self.cases):
            low, high = self.cases[self.clock]
            for side in SIDES:
                ctx.set(getattr(self.dut, side), low if side in ("top", "left") else high)

    def sample(self, ctx):
        due = self.clock - self.dut.latency
        self.clock += 1
        if not 0 <= due < len(self.cases):
            return
        low, high = self.cases[due]
        expected = {side: self.first(low if side in ("top", "left") else high, *(
            (self.interlace.width, self.interlace.x_shift) if side in ("left", "right") else
            (self.interlace.height, self.interlace.y_shift))) for side in SIDES}
        box = ctx.get(self.dut.box)
        assert {side: box[side] for side in SIDES} == expected
        assert ctx.get(self.dut.empty) == (expected["left"] == expected["right"]
                                           or expected["top"] == expected["bottom"])


@pytest.mark.parametrize("changes", [
    {}, {"sub_bits": 1, "width": 5}, {"words": 16}, {"words": 32}, {"words": 1, "sub_bits": 3}])
def test_every_coordinate(changes):
    configuration = small_machine("PM", **changes)
    dut = PixelBox(grid=grid_layout(configuration), sub_bits=configuration.sub_bits,
                   coordinate_bits=configuration.coordinate_bits)
    assert dut.latency == 3
    simulate(dut, Boxes(dut, configuration))


@pytest.mark.parametrize("name", ["coordinate_bits", "sub_bits"])
def test_bad_widths(name):
    grid = grid_layout(small_machine("PM"))
    rejects(PixelBox, name, **{"grid": grid, "coordinate_bits": 8, "sub_bits": 2} | {name: 0})
