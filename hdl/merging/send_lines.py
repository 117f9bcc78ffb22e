"""What runs between a merge card that sends and the memory units of its node."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.ranges import COLOR_BITS

__all__ = ["SendLines", "sent_pixel_layout"]


def sent_pixel_layout(*, address_bits: int, depth_bits: int) -> data.StructLayout:
    """A pixel as one memory unit sends it: where it lies there, and what was drawn."""
    return data.StructLayout({"address": address_bits, "depth": depth_bits, "color": COLOR_BITS})


class SendLines(wiring.Signature):
    """The lines of a merge card to the memory units of its node, and their wired answers.

    All units begin to list what was drawn into them at once, and are taken one after the other:
    only the ``unit`` that is named answers, others drive 0.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    settled: In(1)
        The unit knows of all that was written into it (wired and over all).
    start: Out(1)
        All list; only while ``settled``.
    unit: Out(id_bits)
        Whose turn it is.
    valid: In(1), pixel: In(sent_pixel_layout), ready: Out(1)
        Its pixels, as a stream (wired or); 0 while not valid.
    more: In(1)
        Pixels may follow the one that is offered; from the clock after ``start`` on (wired or).
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        super().__init__({
            "settled": In(1),
            "start": Out(1),
            "unit": Out(id_bits),
            "valid": In(1),
            "pixel": In(sent_pixel_layout(address_bits=address_bits, depth_bits=depth_bits)),
            "ready": Out(1),
            "more": In(1),
        })
