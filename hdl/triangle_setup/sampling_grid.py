"""Where the machine samples a display list, from the number of units in the cage."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration

__all__ = ["SamplingGrid", "grid_layout"]


def grid_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """The machine's own resolution, as ``golden.specification.sampling_grid.Grid`` has it.

    ``width``, ``height``    in pixels
    ``x_shift``, ``y_shift`` log2 of a pixel of it in pixels of the highest resolution
    """
    grids = configuration.pictures()
    return data.StructLayout({
        "width": configuration.x_bits,
        "height": configuration.y_bits,
        "x_shift": range(max(grid.x_shift for grid in grids) + 1),
        "y_shift": range(max(grid.y_shift for grid in grids) + 1),
    })


class SamplingGrid(wiring.Component):
    """The resolution that the memory of so many units holds.

    Latency: one clock.

    Members
    -------
    total: In(id_bits)
    grid: Out(grid_layout)
        Means nothing for a number of units that is not supported.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "grid": Out(grid_layout(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        with m.Switch(self.total):
            for picture in self.configuration.pictures():
                with m.Case(picture.units):
                    m.d.sync += [self.grid[name].eq(getattr(picture, name))
                                 for name in self.grid.shape().members]
        return m
