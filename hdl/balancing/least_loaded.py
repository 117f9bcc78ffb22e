"""Each region to the processing element that bears least."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["LeastLoaded"]


class LeastLoaded(wiring.Component):
    """Gives regions, in the order in which they come, to processing elements: each to the one that
    bears least so far, of these to one with fewest regions, of these to the lowest; one that has
    ``slots`` regions gets no more.

    A region weighs its count and one more.  After each region all elements are looked at, one a
    clock; what they bear is in a memory.

    Latency: none from a region to its element, where it has been waited for.  Throughput: a region
    in ``elements`` + ``overhead`` clocks.  After ``start`` it takes a clock for each element until
    the first region is waited for.

    Parameters
    ----------
    elements: int, positive
        The most there are.
    slots: int, positive
    count_bits: int, positive
    label: shape
        The name of a region.

    Members
    -------
    start: In(1)
        All elements are empty; only before the first region, or after the last one.
    elements: In(range(elements + 1))
        How many there are, from 1; static from ``start`` to the last region.  They have room for
        all that come.
    regions: In(stream of (weight, label, last))
        Of each its count, its name, and whether no more come.
    given: Out(1)
        In this clock the region that is taken is given away.
    element: Out(range(elements + 1))
        To whom.

    Raises ``ValueError`` for a number that is not positive.

    Ellsworth 1994, the greedy multiple-bin packing before figure 3.
    """

    #: Clocks that a region takes besides one for each element.
    overhead = 2

    def __init__(self, *, elements: int, slots: int, count_bits: int, label: ShapeLike):
        for name, value in (("elements", elements), ("slots", slots), ("count_bits", count_bits)):
            if value < 1:
                raise ValueError(f"{name} must be positive, not {value!r}")
        self.slots = slots
        self._most = elements
        # Elements are compared by both at once, what they bear above how many regions they have.
        self._burden = data.StructLayout({
            "held": range(slots + 1), "load": range((slots << count_bits) + 1)})
        super().__init__({
            "start": In(1),
            "elements": In(range(elements + 1)),
            "regions": In(stream.Signature(data.StructLayout(
                {"weight": count_bits, "label": label, "last": 1}))),
            "given": Out(1),
            "element": Out(range(elements + 1)),
        })

    def elaborate(self, platform):
        m = Module()
        region = self.regions.payload
        m.submodules.burdens = burdens = memory.Memory(
            shape=self._burden, depth=self._most, init=[], attrs={"no_rw_check": 1})
        write, read = burdens.write_port(), burdens.read_port()

        asked = Signal.like(self.elements)
        answers, answered = Signal(), Signal.like(self.elements)
        least = Signal(self._burden)
        all_asked = asked + 1 == self.elements
        m.d.comb += [
            read.addr.eq(asked),
            self.regions.ready.eq(self.given),
            # One carry chain: a bit below both carries the one more.
            write.data.load.eq((Cat(1, least.load) + Cat(1, region.weight)) >> 1),
            write.data.held.eq(least.held + 1),
            write.addr.eq(self.element),
        ]
        m.d.sync += [answers.eq(0), answered.eq(asked)]
        with m.If(answers & (read.data.held != self.slots)
                  & (read.data.as_value() < least.as_value())):
            m.d.sync += [least.eq(read.data), self.element.eq(answered)]

        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += asked.eq(0)
                with m.If(self.start):
                    m.next = "EMPTY"
            with m.State("EMPTY"):
                m.d.comb += [write.en.eq(1), write.addr.eq(asked), write.data.eq(0)]
                m.d.sync += asked.eq(asked + 1)
                with m.If(all_asked):
                    # So the lowest bears least.
                    m.d.sync += [least.eq(0), self.element.eq(0)]
                    m.next = "GIVE"
            with m.State("GIVE"):
                # Above what any element bears.
                m.d.comb += [self.given.eq(self.regions.valid), write.en.eq(self.given)]
                m.d.sync += asked.eq(0)
                with m.If(self.given):
                    m.d.sync += least.eq(-1)
                    m.next = "IDLE"
                    with m.If(~region.last):
                        m.next = "ASK"
            with m.State("ASK"):
                m.d.sync += [answers.eq(1), asked.eq(asked + 1)]
                with m.If(all_asked):
                    m.next = "LAST ANSWER"
            with m.State("LAST ANSWER"):
                m.next = "GIVE"
        return m
