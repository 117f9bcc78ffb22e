"""What runs between nodes that merge on a bus, their frame units, and the controller."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from .tree_words import tree_word_layout

__all__ = ["SnoopLines", "bus_word_layout", "heard_pixel_layout"]


def bus_word_layout(*, id_bits: int, address_bits: int, depth_bits: int) -> data.StructLayout:
    """What is on the bus in a clock: a pixel, in its unit and at its address of every node, or the
    end of what a node sends.  Cards that send nothing drive 0 (wired or)."""
    return data.StructLayout({"valid": 1, "word": tree_word_layout(
        id_bits=id_bits, address_bits=address_bits, depth_bits=depth_bits)})


def heard_pixel_layout(*, id_bits: int, address_bits: int, depth_bits: int) -> data.StructLayout:
    """A pixel that a node hears: where it would lie, and how near it is."""
    return data.StructLayout({"valid": 1, "unit": id_bits, "address": address_bits,
                              "depth": depth_bits})


class SnoopLines(wiring.Signature):
    """The controller's lines to every snoop merge card and frame unit, and their wired answer.

    Members
    -------
    start: Out(1)
        The front pictures of all nodes are to be merged.
    ended: In(1)
        High for one clock as the frame units have written all of a node's pixels (wired or); the
        last node's are those that end a merge.
    """

    def __init__(self):
        super().__init__({"start": Out(1), "ended": In(1)})
