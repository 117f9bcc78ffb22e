"""The regions that a triangle's box meets, and its rows in each row of regions."""

from typing import NamedTuple

from amaranth.hdl import *
from amaranth.lib import data

from ...golden.specification.configuration import MachineConfiguration

__all__ = ["RegionBox", "band_rows", "region_box"]


class RegionBox(NamedTuple):
    """Columns and rows of regions, the last ones included."""

    left: Value
    right: Value
    top: Value
    bottom: Value


def cut(value: Value, bits: int) -> Value:
    """``value`` with so many bits: those above are left out, those missing are 0."""
    return Cat(value, C(0, bits))[:bits]


def region_box(box: data.View, configuration: MachineConfiguration) -> RegionBox:
    """Of a box that has a pixel; ``box`` has the fields ``left``, ``right``, ``top``, ``bottom``
    of a prepared triangle, in which what is right and at the bottom is excluded.

    The numbers have all bits that the box's have, so any two of them can be compared.
    """
    regions = configuration.dealt_regions
    x_bits, y_bits = configuration.x_bits, configuration.y_bits
    return RegionBox(
        left=box.left[regions.x_bits:],
        right=(box.right - 1)[regions.x_bits:x_bits],
        top=box.top[regions.y_bits:],
        bottom=(box.bottom - 1)[regions.y_bits:y_bits],
    )


def band_rows(row: Value, top: Value, bottom: Value,
              configuration: MachineConfiguration) -> tuple[Value, Value]:
    """First and last row of pixels that a box has in a row of regions, which is one that it meets;
    ``top`` and ``bottom`` are the box's first row and its last one.  Nothing is added: the one is
    the box's or a region's first, the other the box's or a region's last."""
    inside, bits = configuration.dealt_regions.y_bits, configuration.y_bits
    first = Mux(row == top[inside:], top, Cat(C(0, inside), row))
    last = Mux(row == bottom[inside:], bottom, Cat(C((1 << inside) - 1, inside), row))
    return first[:bits], last[:bits]
