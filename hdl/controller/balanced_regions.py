"""What the controller does where it makes the tables of regions itself."""

from amaranth.hdl import *
from amaranth.lib import stream

from ...golden.specification.commands import RESPONSE_VALUE_BITS, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import Operation, response_layout
from ..balancing.balancer import Balancer
from .region_node import RegionNode
from .region_table import after

__all__ = ["BalancedRegions"]


class BalancedRegions(RegionNode):
    """Has what was counted in a frame sent when that is drawn, and packs the next frame's table
    while the picture waits for a scan, which does not wait for it.

    When the picture is shown one of the two tables is free again, and the packed one is dealt, a
    region a clock; then commands are taken again.  A frame that was never begun has no counts, and
    leaves the table that waits for the next one as it is.

    Ellsworth 1994, figure 3.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        regions = configuration.dealt_regions
        self._balancer = Balancer(
            columns=regions.columns, rows=regions.rows, slots=configuration.slots,
            elements=configuration.maximum_units >> configuration.share_bits,
            count_bits=RESPONSE_VALUE_BITS)
        #: The controller's answers and the chain's, the counts among them.
        self._answers = stream.Signature(response_layout()).create(path=("answers",))
        #: All of a frame is drawn.
        self._frame_drawn = Signal(name="frame_drawn")
        #: Nothing is counted, packed or dealt.
        self._balanced = Signal(name="balanced")
        #: Counts are the balancer's.
        self._packing = Signal(name="packing")
        #: Go on to the next region of the table that is read.
        self._advance = Signal(name="advance")
        self._column = Signal.like(self.table.next_column, name="read_column")
        self._row = Signal.like(self.table.next_row, name="read_row")
        self._last = Signal(name="last_read")

    def add_to(self, m, controller):
        super().add_to(m, controller)
        m.submodules.balancer = balancer = self._balancer
        m.d.comb += balancer.elements.eq(self._elements)
        m.d.comb += [getattr(balancer.dealt, name).eq(getattr(controller.regions, name))
                     for name in balancer.dealt.signature.members]
        self._read(m, balancer)
        self._take_counts(m, controller, balancer)
        self._balance(m, controller, balancer)

    def _read(self, m, balancer):
        """The balancer's table, row by row."""
        column, row, last = after(self.configuration.dealt_regions, self._column, self._row)
        m.d.comb += [balancer.column.eq(self._column), balancer.row.eq(self._row),
                     self._last.eq(last)]
        with m.If(self._advance):
            m.d.sync += [self._column.eq(column), self._row.eq(row)]

    def _take_counts(self, m, controller, balancer):
        """Counts that nobody but the controller asked for do not reach the host."""
        answers, responses, taken = self._answers, controller.responses, Signal(name="count_taken")
        m.d.comb += [
            taken.eq(self._packing & (answers.payload.kind == ResponseKind.REGION_COUNT)),
            responses.valid.eq(answers.valid & ~taken),
            responses.payload.eq(answers.payload),
            balancer.counts.valid.eq(answers.valid & taken),
            balancer.counts.payload.eq(answers.payload.value),
            answers.ready.eq(Mux(taken, balancer.counts.ready, responses.ready)),
        ]

    def _balance(self, m, controller, balancer):
        """From a frame that is drawn to the table for the next one, beside what becomes of its
        picture."""
        comes = Signal(name="read_comes")
        m.d.sync += comes.eq(0)
        with m.If(comes):
            self.deal(m, balancer.element)
        with m.FSM(name="balance"):
            with m.State("BALANCED"):
                m.d.comb += self._balanced.eq(1)
                with m.If(self._frame_drawn):
                    m.next = "ASK"
            with m.State("ASK"):
                controller.announce(m, Operation.READ_REGIONS, "PACK")
                m.d.comb += balancer.start.eq(controller.broadcast.strobe)
            with m.State("PACK"):
                m.d.comb += self._packing.eq(1)
                with m.If(balancer.done):
                    m.next = "PACKED"
            with m.State("PACKED"), m.If(self.table.shown == self.table.lines.table):
                m.next = "DEAL"
            with m.State("DEAL"):
                m.d.comb += self._advance.eq(1)
                m.d.sync += comes.eq(1)
                with m.If(self._last):
                    m.next = "DEALT"
            with m.State("DEALT"):
                m.next = "BALANCED"

    def answers(self, controller):
        return self._answers

    def in_turn(self, controller, ready):
        return ready & self._balanced

    def drawn(self, m):
        super().drawn(m)
        m.d.comb += self._frame_drawn.eq(self._in_frame)

    def commands(self, m, controller):
        super().commands(m, controller)
        with m.Case(Opcode.READ_TABLE):
            m.d.comb += controller.commands.ready.eq(1)
            m.next = "READ_ENTRY"

    def states(self, m, controller):
        super().states(m, controller)
        with m.State("READ_ENTRY"):
            m.next = "REPORT_ENTRY"
        with m.State("REPORT_ENTRY"):
            controller.respond(m, ResponseKind.TABLE_ENTRY, self._balancer.element, "READ_ENTRY")
            m.d.comb += self._advance.eq(self._answers.ready)
            with m.If(self._answers.ready & self._last):
                m.next = "COMMAND"
