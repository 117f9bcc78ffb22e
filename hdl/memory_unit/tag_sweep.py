"""Visits the words of a memory unit in idle clocks and takes old tags out."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.ranges import MAXIMUM_WORDS

__all__ = ["TagSweep"]


class TagSweep(wiring.Component):
    """A pass over every word, in clocks in which nobody else asks for the RAM.

    Each part of a word has a tag of its own (``PARTS``).  A pass reads each word and writes
    tag 0 to the parts that are stale.  Where the processing element may have written the
    word between the two, it is read again.  So, after a pass: no part of any word has a tag
    that was not the part's current one at any time since the pass began.

    Proof: take such a tag.  From the beginning of the pass nothing writes it,
    since only current tags are written.  Each part of each word is read, and if it
    has the tag then, it is stale and erased, or else the word was written and is
    read again.

    The pass that follows ``initialise`` erases every part without a look: what is
    there after power-on is not known.  Fuchs & Johnson have the processing
    elements do that (step (c) after figure 12); here units that have none are
    background as well, and no element carries the logic for it.

    Whether somebody else asked is looked at a clock later: these signals come from far
    away, and nothing waits for the answer.

    Latency: at most six clocks a word while only the scan asks, which takes every
    other clock at most: read and check 3, erase 3.  ``initialise``: one, and two.  While
    there are writes, as long as it takes to find idle clocks.

    Parameters
    ----------
    words: int, positive
        How many it visits.
    parts: int, positive
        Parts of a word.

    Members
    -------
    start, initialise: In(1)
        Begin a pass of either kind; only while ``idle``.  Nothing is written in the latter.
    idle: Out(1)
        No pass goes on.
    address: Out(range(words))
        The word visited.
    sweep: Out(1)
        Asks for a read of the word.
    erase: Out(parts)
        Asks for tag 0 in these parts.
    busy: In(1)
        What is asked for does not take place in this clock.
    scan: In(1)
        The scan asks in this clock: while initialising, the only one.
    stale: In(parts)
        In the clock after a read: parts of that word whose tag is neither current nor 0.
    overwritten: In(1)
        The processing element writes in this clock, and perhaps to the word visited.

    Raises ``ValueError`` for a number out of range.
    """

    def __init__(self, *, words: int, parts: int):
        if not 1 <= words <= MAXIMUM_WORDS:
            raise ValueError(f"words must be 1 to {MAXIMUM_WORDS}, not {words!r}")
        if parts < 1:
            raise ValueError(f"parts must be positive, not {parts!r}")
        self.words = words
        self.parts = parts
        super().__init__({
            "start": In(1),
            "initialise": In(1),
            "idle": Out(1),
            "address": Out(range(max(2, words))),
            "sweep": Out(1),
            "erase": Out(parts),
            "busy": In(1),
            "scan": In(1),
            "stale": In(parts),
            "overwritten": In(1),
        })

    def elaborate(self, platform):
        m = Module()
        words = self.words
        left = Signal(self.parts)  # parts to erase
        everything = Signal()
        # In the clock before: the RAM was free; it was written; tag 0 was asked for.
        served = Signal()
        overwritten = Signal()
        asked = Signal()
        m.d.sync += [served.eq(~self.busy), overwritten.eq(self.overwritten)]
        following = self.address + 1
        # Where the address wraps by itself, the carry tells the last word: less hardware than a
        # comparison, which would tell the same.
        wraps = words == 1 << len(self.address)
        last = following[-1] if wraps else self.address == words - 1

        with m.FSM():
            with m.State("IDLE"):
                m.d.comb += self.idle.eq(1)
                m.d.sync += [everything.eq(self.initialise), left.eq((1 << self.parts) - 1)]
                with m.If(self.initialise):
                    m.next = "ERASE"
                with m.Elif(self.start):
                    m.next = "READ"
            with m.State("READ"):
                m.d.comb += self.sweep.eq(1)
                m.next = "CHECK"
            with m.State("CHECK"):
                m.d.comb += self.sweep.eq(~served)
                m.d.sync += [left.eq(self.stale), asked.eq(0)]
                with m.If(served):
                    m.next = "ERASE"
            with m.State("ERASE"):
                m.d.comb += self.erase.eq(Mux(overwritten, 0, left))
                m.d.sync += asked.eq(1)
                with m.If(Mux(everything, ~self.scan, (left == 0) | (asked & served))):
                    m.d.sync += self.address.eq(following)
                    with m.If(last):
                        if not wraps:
                            m.d.sync += self.address.eq(0)
                        m.next = "IDLE"
                    with m.Elif(~everything):
                        m.next = "READ"
                with m.Elif(overwritten):
                    m.next = "READ"
        return m
