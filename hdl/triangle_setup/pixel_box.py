"""The rows and columns of pixel centres that a triangle may cover."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["PixelBox", "box_layout"]


def box_layout(grid: data.StructLayout) -> data.StructLayout:
    """Rows and columns of pixels, as in ``golden.reference.triangle_setup.PreparedTriangles``.

    ``grid``: as ``grid_layout`` gives it.
    """
    rows, columns = grid["height"].width, grid["width"].width
    return data.StructLayout({"top": rows, "middle": rows, "bottom": rows,
                              "left": columns, "right": columns})


class PixelBox(wiring.Component):
    """For each of five coordinates the first pixel whose centre is not before it.

    Pixels are held to the screen: 0 … width or height.

    Latency: ``latency`` clocks.  Throughput: a triangle a clock; nothing stalls.

    Parameters
    ----------
    grid: StructLayout
        As ``grid_layout`` gives it.
    coordinate_bits, sub_bits: int, positive
        Bits of a vertex coordinate, and how many of them are sub-pixel bits.

    Members
    -------
    grid: In(grid_layout)
    top, middle, bottom, left, right: In(signed(coordinate_bits))
        Coordinates, in sub-pixel units.
    box: Out(box_layout)
        The pixels.
    empty: Out(1)
        No centre lies in the box.

    Raises ``ValueError`` where a number of bits is not positive.
    """

    latency = 3

    def __init__(self, *, grid: data.StructLayout, coordinate_bits: int, sub_bits: int):
        for name, bits in (("coordinate_bits", coordinate_bits), ("sub_bits", sub_bits)):
            if bits < 1:
                raise ValueError(f"{name} must be positive, not {bits!r}")
        self.coordinate_bits = coordinate_bits
        self.sub_bits = sub_bits
        self._box = box_layout(grid)
        coordinate = signed(coordinate_bits)
        super().__init__({
            "grid": In(grid),
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
            half = C(1 << (self.sub_bits - 1)) << shift
            moved = coordinate + half - 1
            pixel = Signal((moved >> self.sub_bits).shape(), name=f"{name}_pixel",
                           reset_less=True)
            m.d.sync += [
                pixel.eq(moved >> self.sub_bits >> shift),
                held[name].eq(Mux(pixel < 0, 0, Mux(pixel > limit, limit, pixel))),
            ]
        m.d.sync += [
            self.box.eq(held),
            self.empty.eq((held.top >= held.bottom) | (held.left >= held.right)),
        ]
        return m
