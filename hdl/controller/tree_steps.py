"""The steps by which node 0 comes by the picture of all."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..merging.tree_words import TreeLines

__all__ = ["TreeSteps"]


class TreeSteps(wiring.Component):
    """Has the tree merge cards do one step after the other, each when the last one is done.

    A step is done when all that receive have received everything, and what they gave to their
    processing elements is written.  There are as many as make the distance of the nodes that meet
    as large as the number of nodes: ⌈log2(nodes)⌉.

    Latency: a clock from ``start``, or from the end of a step, to the next one, or to ``done``.

    Parameters
    ----------
    node_bits: int, positive
        Node lines on the backplane.

    Members
    -------
    nodes: In(node_bits)
        How many there are.
    start: In(1)
        Begin; all is drawn.  Ignored unless ``idle``.
    idle: Out(1)
        No steps are made.
    done: Out(1)
        High for one clock at the end.
    quiet: In(1)
        No processing element has anything to do.  Where one has received a pixel it is low when
        its node is no longer busy, until the pixel is written.
    lines: Out(TreeLines)

    Blazek 1991, chapter V, algorithm 4 and figure 10.  Raises ``ValueError`` when ``node_bits`` is
    not positive.
    """

    def __init__(self, *, node_bits: int):
        lines = TreeLines(node_bits=node_bits)
        self.node_bits = node_bits
        super().__init__({
            "nodes": In(node_bits),
            "start": In(1),
            "idle": Out(1),
            "done": Out(1),
            "quiet": In(1),
            "lines": Out(lines),
        })

    def elaborate(self, platform):
        m = Module()
        lines = self.lines
        distance = Signal(self.node_bits + 1)  # of the nodes that meet
        with m.FSM():
            with m.State("IDLE"):
                m.d.comb += self.idle.eq(1)
                m.d.sync += [lines.step.eq(0), distance.eq(1)]
                with m.If(self.start):
                    m.next = "STEP"
            with m.State("STEP"):
                with m.If(distance < self.nodes):
                    m.d.comb += lines.start.eq(1)
                    m.next = "WAIT"
                with m.Else():
                    m.d.comb += self.done.eq(1)
                    m.next = "IDLE"
            with m.State("WAIT"), m.If(~lines.busy & self.quiet):
                m.d.sync += [lines.step.eq(lines.step + 1), distance.eq(distance << 1)]
                m.next = "STEP"
        return m
