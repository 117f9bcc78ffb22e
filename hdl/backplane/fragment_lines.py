"""Private lines between a direct merge and one memory unit."""

from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.ranges import COLOR_BITS

__all__ = ["FragmentLines", "unit_fragment_layout"]


def unit_fragment_layout(*, address_bits: int, depth_bits: int) -> data.StructLayout:
    """A fragment on its way to the one unit that has its pixel; widths as of the ``MemoryBus``."""
    return data.StructLayout({"address": address_bits, "depth": depth_bits, "color": COLOR_BITS})


class FragmentLines(wiring.Signature):
    """Fragments for a memory unit that tests their depths itself; ``Out`` is towards the unit.

    Members
    -------
    fragments: Out(stream of unit_fragment_layout)
    busy: In(1)
        The unit still works on some of them.
    followed: In(1)
        In this clock a depth that was on its way to the unit's memory took the place of what was
        read there: two fragments hit one pixel within a few clocks.
    """

    def __init__(self, *, address_bits: int, depth_bits: int):
        super().__init__({
            "fragments": Out(stream.Signature(
                unit_fragment_layout(address_bits=address_bits, depth_bits=depth_bits))),
            "busy": In(1),
            "followed": In(1),
        })
