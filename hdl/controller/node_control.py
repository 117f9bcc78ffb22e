"""What the controller does besides, where merge cards end nodes."""

from amaranth.hdl import *
from amaranth.lib import stream
from amaranth.lib.wiring import In

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import Operation, response_fields, response_layout
from .object_commands import ObjectCommands
from .one_node import OneNode
from .presenter import Presenter

__all__ = ["NodeControl"]

#: Of the faults for which a cage of nodes draws nothing; a machine may have greater ones.
FAULT_BITS = 3


class NodeControl(OneNode):
    """Adds up the nodes at boot, has lists loaded and drawn, and what is drawn merged and shown.

    Where commands can be taken meanwhile, such as those that change lists, a ``Presenter`` does the
    latter; elsewhere it is what comes next, as where the cage is all one node.

    A subclass says how its cards merge; this is for those that have nothing left to merge when all
    is drawn.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        ahead = configuration.list_words or configuration.snoops
        self.presenter = Presenter() if ahead else None
        self._objects = (ObjectCommands(configuration=configuration)
                         if configuration.objects is not None else None)
        #: Memory units of all nodes, and what is wrong with them.
        self.units = Signal(commands.RESPONSE_VALUE_BITS, name="node_units")
        self.unsupported = Signal(name="node_unsupported")
        self.differ = Signal(name="nodes_differ")
        self._answers = stream.Signature(response_layout()).create(path=("answers",))

    @property
    def members(self):
        configuration = self.configuration
        return {"nodes": In(configuration.node_bits),
                **({"lists_full": In(1)} if configuration.reports_full else {})}

    after_units = "REPORT_NODES"
    #: The state after the report of the nodes.
    after_nodes = "CHECK_UNITS"

    # What of the merging differs from one kind of cards to the next.

    #: ``merged``, and ``shown``, are always high.
    merges_at_once = True
    shows_at_once = True

    def merged(self, controller):
        """The picture that was drawn last can be scanned."""
        return C(1)

    def shown(self, controller):
        """No scan reads the picture any more that was shown before the last swap."""
        return C(1)

    def merge_cycles(self, controller):
        """Clocks from the frame's start until the picture could be scanned."""
        return controller.drawn_cycles

    def scans(self, controller):
        """Those that began since the start of the frame that is presented."""
        return controller.scans

    # All that is common.

    def add_to(self, m, controller):
        self._count(m, controller)
        if self.presenter is not None:
            self._present(m, controller)
            self._take_turns(m, controller)

    def _count(self, m, controller):
        """Nodes' reports as they pass: each must be like the first one."""
        response = controller.right.response
        report = response_fields(ResponseKind.NODE, response.payload.value)
        first = Signal.like(report.units, name="first_units")
        known, supported = Signal(name="first_known"), Signal(name="node_supported")
        numbers = [interlace.units for interlace in self.configuration.interlaces()]
        with m.Switch(report.units), m.Case(*numbers):
            m.d.comb += supported.eq(1)
        with m.If(response.valid & response.ready
                  & (response.payload.kind == ResponseKind.NODE)):
            m.d.sync += [
                self.units.eq(self.units + report.units),
                self.unsupported.eq(self.unsupported | ~supported),
                self.differ.eq(self.differ | (known & (report.units != first))),
                known.eq(1),
                first.eq(report.units),
            ]

    def _present(self, m, controller):
        m.submodules.presenter = presenter = self.presenter
        m.d.comb += [
            presenter.merged.eq(self.merged(controller)),
            presenter.cycles.eq(self.merge_cycles(controller)),
            presenter.scan_start.eq(controller.scan_start),
            presenter.scans.eq(self.scans(controller)),
            presenter.shown.eq(self.shown(controller)),
        ]
        with m.If(presenter.swap):
            m.d.sync += self.front(controller).eq(~self.front(controller))

    def _take_turns(self, m, controller):
        """Two give responses."""
        own, presented, responses = self._answers, self.presenter.responses, controller.responses
        turn = self._presenter_turn(m)
        m.d.comb += [
            responses.valid.eq(own.valid | presented.valid),
            own.ready.eq(responses.ready & ~turn),
            presented.ready.eq(responses.ready & turn),
        ]
        if self.answers_meet:
            m.d.comb += responses.payload.eq(Mux(turn, presented.payload, own.payload))
        else:  # whoever has nothing to say says 0
            m.d.comb += Value.cast(responses.payload).eq(
                Value.cast(own.payload) | Value.cast(presented.payload))

    @property
    def answers_meet(self):
        """Something else than what the presenter says may be answered while a picture is on its
        way to the screen."""
        return self.configuration.snoops

    def _presenter_turn(self, m):
        """What one has begun to offer it offers until that is taken."""
        if not self.answers_meet:
            return self.presenter.responses.valid
        own = self._answers
        begun = Signal(name="answer_begun")  # by what takes commands, and not by the presenter
        turn = Signal(name="presenter_turn")
        m.d.comb += turn.eq(self.presenter.responses.valid & ~begun)
        m.d.sync += begun.eq(own.valid & ~own.ready & ~turn)
        return turn

    def answers(self, controller):
        return controller.responses if self.presenter is None else self._answers

    def in_turn(self, controller, ready):
        """Lists are not what is presented; for all else there is no memory sooner."""
        if self.presenter is None:
            return ready
        return ready & (self.is_for_lists(controller) | self.presenter.idle)

    def is_for_lists(self, controller):
        """The offered command changes lists, and nothing else."""
        if not self.configuration.list_words:
            return C(0)
        return (controller.opcode == Opcode.LOAD) | (controller.opcode == Opcode.CLEAR_LISTS)

    def all_units(self, controller):
        return self.units

    def refused(self, controller):
        return controller.unsupported_units | self.unsupported | self.differ

    def fault(self, controller):
        units = controller.unsupported_units | self.unsupported
        return Mux(units, C(Fault.UNITS_UNSUPPORTED, FAULT_BITS), C(Fault.NODES_DIFFER, FAULT_BITS))

    def after_drawn(self, m, controller):
        if self.presenter is None:
            return "REPORT_MERGED" if self.merges_at_once else "MERGING"
        m.d.comb += self.presenter.start.eq(self._answers.ready)
        return "COMMAND"

    @property
    def after_swap(self):
        return "REPORT_SHOWN" if self.shows_at_once else "SWAPPED"

    def show(self, m, controller):
        """As a presenter does it, where there is none."""
        if self.presenter is not None:
            return
        if not self.merges_at_once:
            with m.State("MERGING"), m.If(self.merged(controller)):
                m.next = "REPORT_MERGED"
        with m.State("REPORT_MERGED"):
            controller.respond(m, ResponseKind.MERGED, self.merge_cycles(controller), "SWAP")
        super().show(m, controller)
        if not self.shows_at_once:
            with m.State("SWAPPED"), m.If(self.shown(controller)):
                m.next = "REPORT_SHOWN"

    def commands(self, m, controller):
        if self.configuration.list_words:
            self._draw_lists(m, controller)
        if self._objects is not None:
            self._objects.commands(m, controller)

    def _draw_lists(self, m, controller):
        for opcode, full in ((Opcode.CLEAR_LISTS, C(0)),
                             (Opcode.DRAW_LISTS, controller.lists_full)):
            with m.Case(opcode):
                controller.announce(m, Operation[opcode.name], when=~full)
                m.d.comb += controller.commands.ready.eq(controller.broadcast.strobe | full)
                with m.If(full):
                    m.next = "LIST_FULL"

    def states(self, m, controller):
        with m.State("REPORT_NODES"):
            controller.respond(m, ResponseKind.NODES, controller.nodes, self.after_nodes)
        if self.configuration.list_words:
            with m.State("LIST_FULL"):
                controller.respond(m, ResponseKind.ERROR, Fault.LIST_FULL, "COMMAND")
        if self._objects is not None:
            self._objects.states(m, controller)
