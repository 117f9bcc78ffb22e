"""What goes to one memory unit, from all who have something for it."""

from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from .round_robin import RoundRobin

__all__ = ["UnitFeed"]


class UnitFeed(wiring.Component):
    """Takes a fragment a clock from one of several ``FragmentQueue``s, in turn (``RoundRobin``).

    In a clock it chooses one, in the next one it reads that, and in the one after that the unit has
    it.  All move together, when the unit takes a fragment or has none.

    Latency: two clocks from ``waiting`` to the fragment.  Throughput: a fragment a clock.

    Parameters
    ----------
    elements: int, positive
        Who may have something.
    shape: data.StructLayout
        Of a fragment.

    Members
    -------
    waiting: In(elements)
        Who has one for this unit.
    grant: Out(elements)
        The one of these that is chosen in this clock, if any.
    given: In(shape) [elements]
        What those have given who were chosen last; what the others say is not looked at.
    taken: Out(elements)
        Whose is taken.
    fragments: Out(stream of fragments)
    busy: Out(1)
        Something is chosen or offered.

    Raises ``ValueError`` when ``elements`` is not positive.
    """

    latency = 2

    def __init__(self, *, elements: int, shape: data.StructLayout):
        if elements < 1:
            raise ValueError(f"elements must be positive, not {elements!r}")
        self._arbiter = RoundRobin(requesters=elements)
        self.elements = elements
        super().__init__({
            "waiting": In(elements),
            "grant": Out(elements),
            "given": In(shape).array(elements),
            "taken": Out(elements),
            "fragments": Out(stream.Signature(shape)),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.arbiter = arbiter = self._arbiter
        fragments = self.fragments
        chosen = Signal(self.elements)
        move = Signal()
        m.d.comb += [
            move.eq(~fragments.valid | fragments.ready),
            arbiter.requests.eq(self.waiting),
            arbiter.take.eq(move),
            self.grant.eq(Mux(move, arbiter.grant, 0)),
            self.taken.eq(Mux(move, chosen, 0)),
            self.busy.eq(chosen.any() | fragments.valid),
        ]
        with m.If(move):
            m.d.sync += [
                chosen.eq(arbiter.grant),
                fragments.valid.eq(chosen.any()),
                Value.cast(fragments.payload).eq(reduce(or_, (
                    Mux(mine, Value.cast(given), 0)
                    for mine, given in zip(chosen, self.given, strict=True)))),
            ]
        return m
