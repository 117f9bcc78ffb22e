"""What a memory unit keeps of a pixel, and how it asks its RAM for it."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MAXIMUM_TAG_BITS, MAXIMUM_WORDS, MINIMUM_TAG_BITS
from ...golden.specification.ranges import CHANNEL_BITS

__all__ = ["MemoryAccess", "lane_layout"]


def lane_layout(bits: int, tag_bits: int) -> data.StructLayout:
    """One lane of a word: a depth or a colour, and the tag of the frame that wrote it."""
    return data.StructLayout({"tag": tag_bits, "value": bits})


class MemoryAccess(wiring.Signature):
    """Four users of one RAM, in order of precedence; ``Out`` is towards the RAM.

    A word has three lanes (figure 6): depth, and two colours.  Each access takes
    place in the clock in which it is asked for and its busy line is low; what it
    reads is there in the next clock, and in that one only.  What a read sees of a
    write of the same word in the same clock is unknown, and so is what a scan reads
    of the very colour that is written.  So are all contents after power-on.

    Members
    -------
    scan: Out(1)
        Read the colours for the screen.
    scan_address: Out(address_bits)
        Word whose colours are read.
    write: Out(1)
        Write the depth and the colour ``back``.
    back: Out(1)
        The colour that is drawn into.
    write_address: Out(address_bits)
        Word that is written.
    depth_in: Out(lane_layout), color_in: Out(lane_layout)
        What is written.
    write_busy: In(1)
        The port is the scan's.
    read: Out(1)
        Read the depth.
    read_address: Out(address_bits)
        Word whose depth is read.
    read_busy: In(1)
        The port is the scan's, or taken by a write.
    sweep: Out(1)
        Read all three lanes, for their tags.
    erase: Out(3)
        Write tag 0 to these lanes: depth, colour 0, colour 1.  Not together with ``sweep``.
    sweep_address: Out(address_bits)
        Word that is swept.
    sweep_busy: In(1)
        Somebody else asks.
    depth: In(lane_layout)
        Of the word last read.
    color: In(lane_layout) [2]
        Both colours of the word last read.

    Raises ``ValueError`` for a number out of range.
    """

    def __init__(self, *, words: int, depth_bits: int, tag_bits: int):
        for name, value, low, high in (("words", words, 1, MAXIMUM_WORDS),
                                       ("depth_bits", depth_bits, 1, 32),
                                       ("tag_bits", tag_bits, MINIMUM_TAG_BITS, MAXIMUM_TAG_BITS)):
            if not low <= value <= high:
                raise ValueError(f"{name} must be {low} to {high}, not {value!r}")
        address = range(max(2, words))
        depth = lane_layout(depth_bits, tag_bits)
        color = lane_layout(3 * CHANNEL_BITS, tag_bits)
        super().__init__({
            "scan": Out(1),
            "scan_address": Out(address),
            "write": Out(1),
            "back": Out(1),
            "write_address": Out(address),
            "depth_in": Out(depth),
            "color_in": Out(color),
            "write_busy": In(1),
            "read": Out(1),
            "read_address": Out(address),
            "read_busy": In(1),
            "sweep": Out(1),
            "erase": Out(3),
            "sweep_address": Out(address),
            "sweep_busy": In(1),
            "depth": In(depth),
            "color": In(color).array(2),
        })
