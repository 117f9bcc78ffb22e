"""One link of the chain that carries responses leftwards to the controller."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from .words import response_layout

__all__ = ["ResponseLink"]


class ResponseLink(wiring.Component):
    """This card's own responses first, then those of the cards to its right.

    While ``own_turn`` is high nothing from the right passes, so that responses
    reach the controller in the order of the cards.

    Latency: one clock.  Throughput: a word a clock.

    Members
    -------
    own: In(stream of response_layout)
        0 while not valid; valid only in its own turn.
    right: In(stream of response_layout)
    left: Out(stream of response_layout)
    own_turn: In(1)
        This card still has, or may have, something to say.

    The paper only has the processing elements signal that they are done; the chain runs from
    slot to slot like the ID lines of figure 10.
    """

    latency = 1

    def __init__(self):
        super().__init__({
            "own": In(stream.Signature(response_layout())),
            "right": In(stream.Signature(response_layout())),
            "left": Out(stream.Signature(response_layout())),
            "own_turn": In(1),
        })

    def elaborate(self, platform):
        m = Module()
        free = ~self.left.valid | self.left.ready
        m.d.comb += [
            self.own.ready.eq(free),
            self.right.ready.eq(free & ~self.own_turn),
        ]
        with m.If(free):
            m.d.sync += [
                self.left.valid.eq(self.own.valid | (self.right.valid & ~self.own_turn)),
                Value.cast(self.left.payload).eq(
                    Value.cast(self.own.payload)
                    | Mux(self.own_turn, 0, Value.cast(self.right.payload))),
            ]
        return m
