"""What a scan address means to a memory unit where regions of the screen are dealt out."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from .interlace import group_mask
from .region_address import RegionAddress

__all__ = ["RegionScanAddress"]


class RegionScanAddress(wiring.Component):
    """What a scan address means to one memory unit, which has no table: where the pixel's region
    lies comes with it.  Combinational.

    Members
    -------
    id: In(id_bits)
        This unit's number.
    x, y: In
        Scan address.
    element: In(element_bits), slot: In(table_bits)
        Where its region lies.
    selected: Out(1)
        This unit holds the pixel.
    fetch: Out(1)
        The address is the first of a group of pixels of a region that lie in different units, one
        of them in this unit: the time to read ``address`` for the whole group.
    address: Out(address_bits)
        This unit's word of that group.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "id": In(configuration.id_bits),
            "x": In(configuration.x_bits),
            "y": In(configuration.y_bits),
            "element": In(configuration.element_bits),
            "slot": In(configuration.table_bits),
            "selected": Out(1),
            "fetch": Out(1),
            "address": Out(configuration.address_bits),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.pixel = pixel = RegionAddress(configuration=self.configuration)
        inside = self.configuration.interlace
        # Those of a group lie in one element, too.
        shared = group_mask(inside) | -1 << inside.unit_bits
        m.d.comb += [
            *(getattr(pixel, name).eq(getattr(self, name))
              for name in ("x", "y", "element", "slot")),
            self.selected.eq(pixel.unit == self.id),
            self.address.eq(pixel.address),
            self.fetch.eq((self.x[:inside.group_bits] == 0)
                          & (((pixel.unit ^ self.id) & shared) == 0)),
        ]
        return m
