"""What each processing element does in each clock: only in machines that are to be observed."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ..golden.specification.activity import ACTIVITY_BITS, Activity

__all__ = ["ElementActivity", "MachineActivity", "activity_layout"]


def activity_layout(elements: int) -> data.ArrayLayout:
    """One ``golden.specification.activity.Activity`` for each processing element, left to right."""
    return data.ArrayLayout(unsigned(ACTIVITY_BITS), elements)


class ElementActivity(wiring.Component):
    """Says what one processing element does.  It only listens.

    The reason for a clock without a fragment is what the rasteriser (``TriangleSpans``) did
    ``delay`` clocks ago, when the fragment that is missing should have set out.  Stalls
    on the way shift it by a few clocks.

    Latency: none.  An element without anything to draw is said to be in ``SETUP``;
    ``MachineActivity`` tells why it has nothing.

    Members
    -------
    offered, taken: In(1)
        A fragment is at the depth test; the depth test takes it.
    scanned: In(1)
        The scan has the port that the fragment waits for.
    preparing, empty_row: In(1)
        The rasteriser takes up a block of its domain; it passes a row without pixels.
    walking: In(1)
        The rasteriser has a triangle.
    service: In(1)
        Something else than drawing goes on.
    activity: Out(4)

    Raises ``ValueError`` for a negative ``delay``.
    """

    def __init__(self, *, delay: int):
        if delay < 0:
            raise ValueError(f"delay must not be negative, not {delay!r}")
        self._delay = delay
        super().__init__({
            **{name: In(1) for name in ("offered", "taken", "scanned", "preparing", "empty_row",
                                        "walking", "service")},
            "activity": Out(ACTIVITY_BITS),
        })

    @property
    def delay(self) -> int:
        """Clocks from the rasteriser to the depth test."""
        return self._delay

    def elaborate(self, platform):
        m = Module()
        reason = Signal(ACTIVITY_BITS)
        with m.If(self.preparing):
            m.d.comb += reason.eq(Activity.PREPARING)
        with m.Elif(self.empty_row):
            m.d.comb += reason.eq(Activity.EMPTY_ROW)
        with m.Elif(self.walking):
            m.d.comb += reason.eq(Activity.FILLING)
        with m.Else():
            m.d.comb += reason.eq(Activity.SETUP)
        for stage in range(self._delay):
            later = Signal(ACTIVITY_BITS, name=f"reason_{stage + 1}", init=Activity.SETUP)
            m.d.sync += later.eq(reason)
            reason = later
        with m.If(self.taken):
            m.d.comb += self.activity.eq(Activity.FRAGMENT)
        with m.Elif(self.offered):
            m.d.comb += self.activity.eq(Mux(self.scanned, Activity.SCAN, Activity.PORT))
        with m.Elif(self.service):
            m.d.comb += self.activity.eq(Activity.SERVICE)
        with m.Else():
            m.d.comb += self.activity.eq(reason)
        return m


class MachineActivity(wiring.Component):
    """Tells apart why processing elements have nothing to draw.  Combinational.

    Members
    -------
    elements: In(activity_layout)
        What each says of itself.
    blocked: In(1)
        The controller cannot broadcast: some FIFO is full.
    more: In(1)
        Triangles are still to come.
    activity: Out(activity_layout)
    """

    def __init__(self, *, elements: int):
        layout = activity_layout(elements)
        super().__init__({
            "elements": In(layout),
            "blocked": In(1),
            "more": In(1),
            "activity": Out(layout),
        })

    def elaborate(self, platform):
        m = Module()
        idle = Signal(ACTIVITY_BITS)
        m.d.comb += idle.eq(Mux(self.blocked, Activity.BROADCAST,
                                Mux(self.more, Activity.SETUP, Activity.DRAIN)))
        for said, activity in zip(self.elements, self.activity, strict=True):
            m.d.comb += activity.eq(Mux(said == Activity.SETUP, idle, said))
        return m
