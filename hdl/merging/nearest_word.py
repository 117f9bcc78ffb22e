"""The minimum that makes one picture of two nodes' pictures, a word at a time."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["NearestWord", "rank_layout"]


def rank_layout(*, depth_bits: int, order_bits: int) -> data.StructLayout:
    """What a word is compared by; as a number it is less the nearer the word is.

    depth: depth_bits
    order: order_bits
        The round in which the word was drawn; no bits where no two nodes tie.
    """
    return data.StructLayout({"order": order_bits, "depth": depth_bits})


class NearestWord(wiring.Component):
    """Says which of two nodes' words of a pixel stays.  Combinational.

    It is the one of the less depth, of equal depths the one of the less order, and where these are
    equal as well that of the node with the lower number.  The minimum is associative: any order
    of merging neighbours gives the same words.

    A word that is not drawn, or stale, has the greatest depth and the greatest order.  No word
    that is drawn has that depth, so it is the identity.

    Members
    -------
    lower: In(rank_layout)
        The word of the node with the lower number, or of those merged into it.
    higher: In(rank_layout)
        The word of the node with the higher number.
    higher_stays: Out(1)
        The word that stays is ``higher``, colour and all.

    Raises ``ValueError`` when ``depth_bits`` is not positive, or ``order_bits`` is negative.
    """

    def __init__(self, *, depth_bits: int, order_bits: int):
        for name, value, least in (("depth_bits", depth_bits, 1), ("order_bits", order_bits, 0)):
            if value < least:
                raise ValueError(f"{name} must be at least {least}, not {value!r}")
        self.depth_bits = depth_bits
        self.order_bits = order_bits
        rank = rank_layout(depth_bits=depth_bits, order_bits=order_bits)
        super().__init__({"lower": In(rank), "higher": In(rank), "higher_stays": Out(1)})

    def elaborate(self, platform):
        m = Module()
        m.d.comb += self.higher_stays.eq(Value.cast(self.higher) < Value.cast(self.lower))
        return m
