"""What runs between neighbouring nodes that merge in a tree, and who says what they do."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ..rasteriser.interpolator import fragment_layout

__all__ = ["TreeLines", "tree_word_layout"]


def tree_word_layout(*, id_bits: int, address_bits: int, depth_bits: int) -> data.StructLayout:
    """A pixel on its way to the left, or the end of what a node sends.

    ``pixel``  as it would meet the receiver's memory
    ``last``   there is no pixel, and nothing follows
    """
    pixel = fragment_layout(id_bits=id_bits, address_bits=address_bits, depth_bits=depth_bits)
    return data.StructLayout({"pixel": pixel, "last": 1})


class TreeLines(wiring.Signature):
    """The controller's lines to every tree merge card, and their wired answer.

    Members
    -------
    start: Out(1)
        A step begins.
    step: Out(range(node_bits))
        Which one, counted from 0; it stays until the next ``start``.
    busy: In(1)
        From the clock after ``start`` on: the card has not received all of the step (wired or).

    Raises ``ValueError`` when ``node_bits`` is not positive.
    """

    def __init__(self, *, node_bits: int):
        if node_bits < 1:
            raise ValueError(f"node_bits must be positive, not {node_bits!r}")
        super().__init__({
            "start": Out(1),
            "step": Out(range(node_bits)),
            "busy": In(1),
        })
