"""The tag of each frame, and when a tag may be used again."""

from functools import reduce
from operator import and_

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import (
    MAXIMUM_TAG_BITS,
    MINIMUM_TAG_BITS,
    SNOOP_TAG_BITS,
)

__all__ = ["FrameTags"]


class FrameTags(wiring.Component):
    """Gives every frame a tag that no word in memory has: whatever was drawn before it reads as
    background, without a write.

    Each part of a memory word (depth, and either colour) has one current tag: what is
    written gets it, and what has another reads as background.  A frame start gives the
    depths and the back colours a new one; the front colours keep theirs, however long
    they are shown.  So no more than two are current: the depths' is that of the colours
    which were last given one.

    Where frame units show what nodes have drawn, these have two colours more.  A frame that is
    handed over to them gives its tag to their back colours too: they have no word with it, as it
    was free when the frame started.  Then three are current at most.

    A tag is *free* when no word has it.  Only free tags are given out, so a frame
    starts on background throughout.  After the boot all are free but the first,
    which is current; one that is given out is free no more.  What is neither free
    nor current is stale, and nothing can make it current.  A pass over the memory
    (``TagSweep``) leaves no word with a tag that has not been current since the
    pass began: those that were stale then are free when it ends.

    A pass begins when the lower half of the tags is used up, which leaves most of the upper half, a
    frame each, for the units to find idle clocks for it.  If they find too few a frame start waits:
    with no free tag, all but two of at least three are stale, or all but three of at least seven,
    so that a pass goes on or begins, and when it ends some are free.  A frame start waits for done
    besides, so the units are idle but for the scan, and for a merge, and the wait is no longer than
    a pass and that.

    Latency: none.  A new tag is current from the clock after ``start`` on.

    Members
    -------
    start: In(1)
        A frame starts in the colours ``back``; only while ``ready``.
    back: In(1)
    ready: Out(1)
        There is a free tag.
    depth: Out(tag_bits)
        Current tag of the depths.
    color: Out(tag_bits) [2]
        Current tag of each of the two colours.  Neither this nor ``depth`` is ever 0.
    sweep: Out(1)
        Begin a pass in every unit, in this clock.
    swept: In(1)
        No unit is in a pass; low from the clock after ``sweep`` until the last one ends.
    hand_over: In(1), frame_back: In(1)
        The frame drawn in the colours ``back`` is handed over to the frame units' colours
        ``frame_back``.
    frame_color: Out(tag_bits) [2]
        Current tag of each of their two colours.

    The last three only with ``frame_units``.  Raises ``ValueError`` where ``tag_bits`` is out of
    range.
    """

    latency = 0

    def __init__(self, *, tag_bits: int, frame_units: bool = False):
        least = SNOOP_TAG_BITS if frame_units else MINIMUM_TAG_BITS
        if not least <= tag_bits <= MAXIMUM_TAG_BITS:
            raise ValueError(f"tag_bits must be {least} to {MAXIMUM_TAG_BITS}, not "
                             f"{tag_bits!r}")
        self.tag_bits = tag_bits
        self.frame_units = frame_units
        super().__init__({
            "start": In(1),
            "back": In(1),
            "ready": Out(1),
            "depth": Out(tag_bits, init=1),
            "color": Out(tag_bits, init=1).array(2),
            "sweep": Out(1),
            "swept": In(1),
            **({"hand_over": In(1), "frame_back": In(1),
                "frame_color": Out(tag_bits, init=1).array(2)} if frame_units else {}),
        })

    def elaborate(self, platform):
        m = Module()
        tags = range(1, 1 << self.tag_bits)  # 0 is no frame's
        lower = 1 << self.tag_bits - 1
        free = Signal(len(tags) + 1, init=sum(1 << tag for tag in tags if tag != 1))
        stale = Signal.like(free, init=0)
        going = Signal.like(free, init=0)
        taken = Signal.like(free, init=0)
        swept = Signal.like(free, init=0)
        fresh = Signal.like(self.depth, init=0)
        for tag in reversed(tags):  # the lowest one is the last assignment
            with m.If(free[tag]):
                m.d.comb += fresh.eq(tag)
            m.d.comb += stale[tag].eq(reduce(
                and_, (color != tag for color in self._colors), ~free[tag]))
        m.d.comb += self.ready.eq(free.any())
        # No tag is taken and swept in one clock: one is free, the other was stale and still is.
        m.d.sync += free.eq((free & ~taken) | swept)

        with m.If(self.start):
            m.d.comb += taken.eq(1 << fresh)
            m.d.sync += self.depth.eq(fresh)
            for place, color in enumerate(self.color):
                with m.If(self.back == place):
                    m.d.sync += color.eq(fresh)

        if self.frame_units:
            drawn = Mux(self.back, self.color[1], self.color[0])
            for place, color in enumerate(self.frame_color):
                with m.If(self.hand_over & (self.frame_back == place)):
                    m.d.sync += color.eq(drawn)

        with m.FSM():
            with m.State("IDLE"), m.If(stale.any() & ~free[:lower].any()):
                m.d.comb += self.sweep.eq(1)
                m.d.sync += going.eq(stale)
                m.next = "SWEEPING"
            with m.State("SWEEPING"), m.If(self.swept):
                m.d.comb += swept.eq(going)
                m.next = "IDLE"
        return m

    @property
    def _colors(self):
        """All current tags, the depths' being one of them."""
        return [*self.color, *(self.frame_color if self.frame_units else [])]
