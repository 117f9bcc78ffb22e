"""What the controller does besides, where it deals regions of the screen out."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..backplane.words import Operation
from .object_commands import ObjectCommands
from .one_node import OneNode
from .region_table import RegionTable, region_layout

__all__ = ["RegionNode"]


class RegionNode(OneNode):
    """A frame is drawn by the table that came whole before it, or else by that of the frame before.

    Before the boot is over the controller itself deals the regions out in turn, or, where
    processing elements pass objects on, in runs, and then no other table comes.  Later tables come
    from the host; ``REGION`` is taken in one clock, inside a frame too, where it is refused.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.table = RegionTable(configuration=configuration)
        self._forwarded = (ObjectCommands(configuration=configuration)
                           if configuration.forwards_objects else None)
        #: Processing elements in the cage.
        self._elements = Signal(configuration.element_bits, name="elements")
        #: The first table is being dealt.
        self._dealing = Signal(name="dealing")
        #: Some frame has started, and its commands have not ended.
        self._in_frame = Signal(name="in_frame")
        #: What was wrong with a region last.
        self._fault = Signal.like(self.table.fault, name="region_fault")

    @property
    def members(self) -> dict[str, wiring.Member]:
        return {"regions": Out(RegionLines(self.configuration)), "shown_table": Out(1),
                **({} if self._forwarded is None else {"lists_full": In(1)})}

    def add_to(self, m, controller):
        m.submodules.region_table = table = self.table
        wiring.connect(m, table.lines, wiring.flipped(controller.regions))
        m.d.comb += [
            controller.shown_table.eq(table.shown),
            table.elements.eq(self._elements),
            table.region.eq(controller.body[:region_layout(self.configuration).size]),
            table.late.eq(self._in_frame),
            # Nothing is drawn any more by the table in use.
            table.take.eq(controller.tags.start),
        ]
        with m.If(table.fault != 0):
            m.d.sync += self._fault.eq(table.fault)
        self._count(m, controller)
        self._deal_in_turn(m, controller)

    def _count(self, m, controller):
        """Processing elements, as their reports pass."""
        response = controller.right.response
        with m.If(response.valid & response.ready
                  & (response.payload.kind == ResponseKind.DOMAIN)):
            m.d.sync += self._elements.eq(self._elements + 1)

    def _deal_in_turn(self, m, controller):
        """The table of the first frame: region modulo processing elements.  It is in use from the
        boot on, so that there is one whatever the host says of others."""
        element = Signal.like(self._elements, name="dealt_to")
        with m.If(controller.pictures.initialise):
            m.d.sync += self._dealing.eq(1)
        with m.If(self._dealing):
            if self.configuration.forwards_objects:
                self._deal_runs(m, element)
            else:
                self.deal(m, element)
                m.d.sync += element.eq(Mux(element == self._elements - 1, 0, element + 1))
            with m.If(self.table.whole):
                m.d.comb += [self.table.offer.eq(0), self.table.take.eq(1)]
                m.d.sync += self._dealing.eq(0)

    def _deal_runs(self, m, element):
        """In place of that, where processing elements pass objects on: a run for each.

        Region r of R is of the first element i of n for which (r + 1) · n is not more than
        (i + 1) · R.  ``over`` is how much more it is for the next region; while it is, the next
        element is looked at.
        """
        regions = self.configuration.dealt_regions.count
        over = Signal(range(-regions, (1 << len(self._elements)) + 1), name="over")
        begun = Signal(name="begun_dealing")
        next_is_later = over > 0
        m.d.sync += begun.eq(1)
        with m.If(~begun):
            m.d.sync += over.eq(self._elements - regions)
        with m.Elif(next_is_later):
            m.d.sync += [element.eq(element + 1), over.eq(over - regions)]
        with m.Else():
            self.deal(m, element)
            m.d.sync += over.eq(over + self._elements)

    def deal(self, m, element):
        """Inside a clock in which the controller itself gives the next region to ``element``."""
        table = self.table
        m.d.comb += [
            table.offer.eq(1),
            table.region.column.eq(table.next_column),
            table.region.row.eq(table.next_row),
            table.region.element.eq(element),
        ]

    def swept(self, controller):
        return controller.pictures.swept & ~self._dealing

    def refused(self, controller):
        """Units left of all processing elements would be the first one's region memory."""
        owned = Cat(C(0, self.configuration.share_bits), self._elements)
        return controller.unsupported_units | (owned != controller.total)

    def start(self, m, controller):
        super().start(m, controller)
        m.d.comb += self.table.start.eq(1)
        m.d.sync += self._in_frame.eq(1)
        with m.If(self.table.unfinished):
            m.next = "REFUSE_TABLE"

    def drawn(self, m):
        # No command has been taken since the end of the frame.
        m.d.sync += self._in_frame.eq(0)

    def swapped(self, m):
        m.d.comb += self.table.swap.eq(1)

    def commands(self, m, controller):
        if self.configuration.takes_tables:
            with m.Case(Opcode.REGION):
                m.d.comb += [self.table.offer.eq(1), controller.commands.ready.eq(1)]
                with m.If(self.table.fault != 0):
                    m.next = "REFUSE_REGION"
        if self.configuration.balance != "static":
            with m.Case(Opcode.READ_REGIONS):
                controller.announce(m, Operation.READ_REGIONS, "ANSWERING", when=controller.quiet)
                m.d.comb += controller.commands.ready.eq(controller.broadcast.strobe)
        if self._forwarded is not None:
            self._forwarded.commands(m, controller)

    def states(self, m, controller):
        with m.State("REFUSE_REGION"):
            controller.respond(m, ResponseKind.ERROR, self._fault, "COMMAND")
        with m.State("REFUSE_TABLE"):
            controller.respond(m, ResponseKind.ERROR, Fault.REGION_TO_NOBODY, "START_FRAME")
        if self._forwarded is not None:
            self._forwarded.states(m, controller)
