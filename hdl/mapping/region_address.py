"""Pixel → unit arithmetic where regions of the screen are dealt out."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from .interlace import unit_number, without

__all__ = ["RegionAddress", "visited_layout"]


def visited_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """The region in which a row is walked.

    ``column``  its column, by which the row's ends are cut
    ``slot``    where it lies in its processing element's units
    ``ends``    this is the last row that the triangle has there
    """
    return data.StructLayout({
        "column": configuration.dealt_regions.column_bits,
        "slot": configuration.table_bits,
        "ends": 1,
    })


class RegionAddress(wiring.Component):
    """Where a pixel of a region lies, whose processing element and slot are known.  Combinational,
    and without arithmetic: the bits of all numbers are only put side by side.

    Members
    -------
    x, y: In
        A pixel; only its place within its region matters.
    element: In(element_bits), slot: In(table_bits)
        Where the region lies.
    unit: Out(id_bits)
        Number of the unit that holds the pixel.
    address: Out(address_bits)
        Its word there: the slot, and below it the place within the region.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "x": In(configuration.x_bits),
            "y": In(configuration.y_bits),
            "element": In(configuration.element_bits),
            "slot": In(configuration.table_bits),
            "unit": Out(configuration.id_bits),
            "address": Out(configuration.address_bits),
        })

    def elaborate(self, platform):
        m = Module()
        regions, inside = self.configuration.dealt_regions, self.configuration.interlace
        # Pictures may be smaller than one region.
        x, y = (Cat(value, C(0, bits))[:bits] for value, bits in (
            (self.x, regions.x_bits), (self.y, regions.y_bits)))
        m.d.comb += [
            self.unit.eq(Cat(unit_number(inside, x, y)[:inside.unit_bits], self.element)),
            self.address.eq(Cat(without(x, inside.unit_mask("x")),
                                without(y, inside.unit_mask("y")), self.slot)),
        ]
        return m
