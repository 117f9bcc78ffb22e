"""The scan lines where pictures are merged as they are scanned: from merge card to merge card."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import COLOR_BITS
from .connectors import scan_address_layout

__all__ = ["ScanChain", "scanned_pixel_layout"]


def scanned_pixel_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A pixel on its way to the pins, with its sync.

    ``begin``   high in the first clock of every pixel time, blanking included
    ``active``  the pixel is in the picture; its colour is 0 outside
    ``horizontal_sync``, ``vertical_sync``  with the polarity of the timing
    ``rank``    depth and order of the nearest so far, all ones where none has been drawn
    ``color``   its colour, or the background: red in the low byte, then green, blue
    """
    return data.StructLayout({
        "begin": 1, "active": 1, "horizontal_sync": 1, "vertical_sync": 1,
        "rank": configuration.rank_bits, "color": COLOR_BITS,
    })


class ScanChain(wiring.Signature):
    """What passes from node to node, through a register in each merge card.

    So node k does everything k clocks later than node 0, and the pixels of a place on the screen
    meet.

    Members
    -------
    fetch, show: Out(scan_address_layout)
        As of ``ScanLines``, for the node's memory units.
    front: Out(1)
        As of ``PictureLines``.
    pixel: Out(scanned_pixel_layout)
        On the video bus of the next node in the same clock: what the nodes to the left show.

    PixelFlow, in Cox & Hanrahan 1993, section 5.
    """

    def __init__(self, configuration: MachineConfiguration):
        super().__init__({
            "fetch": Out(scan_address_layout(configuration)),
            "show": Out(scan_address_layout(configuration)),
            "front": Out(1),
            "pixel": Out(scanned_pixel_layout(configuration)),
        })
