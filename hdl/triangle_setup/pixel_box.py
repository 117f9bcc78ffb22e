"""The rows and columns of pixel centres that a triangle may cover."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from .sampling_grid import grid_layout

__all__ = ["PixelBox", "box_layout"]


def box_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """As in ``golden.reference.triangle_setup.PreparedTriangles``."""
    rows, columns = configuration.y_bits, configuration.x_bits
    return data.StructLayout({"top": rows, "middle": rows, "bottom": rows,
                              "left": columns, "right": columns})


class PixelBox(wiring.Component):
    """For each of five coordinates the first pixel whose centre is not before it.

    Held to the screen: 0 … width or height.

    Latency: ``latency`` clocks.  Throughput: a triangle a clock; nothing stalls.

    Members
    -------
    grid: In(grid_layout)
    top, middle, bottom, left, right: In(signed(coordinate_bits))
        Coordinates, in sub-pixel units.
    box: Out(box_layout)
        The pixels.
    empty: Out(1)
        No centre lies in the box.
    """

    latency = 3

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._box = box_layout(configuration)
        coordinate = signed(configuration.coordinate_bits)
        super().__init__({
            "grid": In(grid_layout(configuration)),
            **dict.fromkeys(self._box.members, In(coordinate)),
            "box": Out(self._box),
            "empty": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        held = Signal(self._box, reset_less=True)
        for name in self._box.members:
            coordinate = getattr(self, name)
            shift, limit = ((self.grid.x_shift, self.grid.width) if name in ("left", "right") else
                            (self.grid.y_shift, self.grid.height))
            # ceil((c - unit/2) / unit) = floor((c + unit/2 - 1) / unit), unit a power of two.
            sub_bits = self.configuration.sub_bits
            half = C(1 << (sub_bits - 1)) << shift
            moved = coordinate + half - 1
            pixel = Signal((moved >> sub_bits).shape(), name=f"{name}_pixel", reset_less=True)
            m.d.sync += [
                pixel.eq(moved >> sub_bits >> shift),
                held[name].eq(Mux(pixel < 0, 0, Mux(pixel > limit, limit, pixel))),
            ]
        m.d.sync += [
            self.box.eq(held),
            self.empty.eq((held.top >= held.bottom) | (held.left >= held.right)),
        ]
        return m
