"""What the controller does besides, where merge cards end nodes."""

from typing import ClassVar

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import Operation, response_fields
from ..merging.tree_words import TreeLines
from .tree_steps import TreeSteps

__all__ = ["NodeControl", "OneNode", "node_control"]


class OneNode:
    """What takes the place of a ``NodeControl`` where there are no merge cards: it adds nothing."""

    members: ClassVar[dict[str, wiring.Member]] = {}
    #: Commands that are not the controller's own.
    opcodes = ()
    #: The states after the report of the units, and after a swap.
    after_units = "CHECK_UNITS"
    after_swap = "REPORT_SHOWN"

    def add_to(self, m, controller):
        """What goes on beside the commands."""

    def all_units(self, controller):
        """Memory units in the cage."""
        return controller.total

    def refused(self, controller):
        """The cage draws nothing."""
        return controller.unsupported_units

    def fault(self, controller):
        """Why; only where it does not."""
        return Fault.UNITS_UNSUPPORTED

    def commands(self, m, controller):
        """Inside the switch over opcodes."""

    def states(self, m, controller):
        """Further states."""

    def drawn(self, m):
        """Inside the clock in which all is drawn; returns the state after its report."""
        return "SWAP"

    def report_merged(self, m, controller, drawn):
        """The states from there to the swap; ``drawn``: the clocks until all was."""


class NodeControl(OneNode):
    """Adds up the nodes at boot, has lists loaded and drawn, and reads merged depths.

    This is no component: it adds members, signals and states to the controller that has it, so
    that a controller without nodes stays as it is.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        #: Memory units of all nodes, and what is wrong with them.
        self.units = Signal(commands.RESPONSE_VALUE_BITS, name="node_units")
        self.unsupported = Signal(name="node_unsupported")
        self.differ = Signal(name="nodes_differ")
        #: The steps of a tree merge, and the clocks until they were done.
        self.steps = (TreeSteps(node_bits=configuration.node_bits) if configuration.sends_drawn
                      else None)
        self.merged = Signal(commands.RESPONSE_VALUE_BITS, name="merged")

    @property
    def members(self):
        configuration, members = self.configuration, {}
        members["nodes"] = In(configuration.node_bits)
        if configuration.list_words:
            members["lists_full"] = In(1)
        if configuration.sends_drawn:
            members["tree"] = Out(TreeLines(node_bits=configuration.node_bits))
        if configuration.scans_rank:
            members |= {"shown": In(1), "read_scan": Out(1), "scan_read": In(1),
                        "depths": In(stream.Signature(configuration.depth_bits))}
        return members

    after_units = "REPORT_NODES"

    def add_to(self, m, controller):
        self._count(m, controller)
        if self.steps is not None:
            self._add_steps(m, controller)

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

    def all_units(self, controller):
        return self.units

    def refused(self, controller):
        return controller.unsupported_units | self.unsupported | self.differ

    def fault(self, controller):
        units = controller.unsupported_units | self.unsupported
        return Mux(units, Fault.UNITS_UNSUPPORTED, Fault.NODES_DIFFER)

    def _add_steps(self, m, controller):
        """Where nodes merge in a tree."""
        m.submodules.steps = steps = self.steps
        wiring.connect(m, steps.lines, wiring.flipped(controller.tree))
        m.d.comb += [steps.nodes.eq(controller.nodes), steps.quiet.eq(controller.quiet)]
        with m.If(steps.done):
            m.d.sync += self.merged.eq(controller.frame_cycles)

    def drawn(self, m):
        if self.steps is None:
            return "REPORT_MERGED"
        m.d.comb += self.steps.start.eq(1)
        return "MERGING"

    def report_merged(self, m, controller, drawn):
        """Where the scan merges, nothing is left to be done."""
        if self.steps is not None:
            with m.State("MERGING"), m.If(self.steps.idle):
                m.next = "REPORT_MERGED"
        with m.State("REPORT_MERGED"):
            controller.respond(m, ResponseKind.MERGED,
                               drawn if self.steps is None else self.merged, "SWAP")

    @property
    def after_swap(self):
        return "SWAPPED" if self.configuration.scans_rank else "REPORT_SHOWN"

    @property
    def opcodes(self):
        return (Opcode.READ_DEPTH,) if self.configuration.scans_rank else ()

    def commands(self, m, controller):
        if self.configuration.list_words:
            self._draw_lists(m, controller)
        if self.configuration.scans_rank:
            with m.Case(Opcode.READ_DEPTH):
                m.d.comb += [controller.read_scan.eq(controller.quiet),
                             controller.commands.ready.eq(controller.quiet)]
                with m.If(controller.quiet):
                    m.next = "READ_SCAN"

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
            controller.respond(m, ResponseKind.NODES, controller.nodes, "CHECK_UNITS")
        if self.configuration.list_words:
            with m.State("LIST_FULL"):
                controller.respond(m, ResponseKind.ERROR, Fault.LIST_FULL, "COMMAND")
        if self.configuration.scans_rank:
            # Every node shows the new picture before one draws into what was shown.
            with m.State("SWAPPED"), m.If(controller.shown == controller.pictures.front):
                m.next = "REPORT_SHOWN"
            with m.State("READ_SCAN"):
                self._pass_depths(m, controller)

    def _pass_depths(self, m, controller):
        """The words of the scan go to the host."""
        responses, depths = controller.responses, controller.depths
        m.d.comb += [
            responses.valid.eq(depths.valid),
            responses.payload.kind.eq(ResponseKind.DEPTH),
            responses.payload.value.eq(depths.payload),
            depths.ready.eq(responses.ready),
        ]
        with m.If(controller.scan_read):
            m.next = "COMMAND"


class DirectNodeControl(NodeControl):
    """Nodes that share all memory units: these are counted on the ID lines, as where there is one
    node, and every fragment is merged when all are drawn."""

    def _count(self, m, controller):
        """Nodes cannot differ."""

    def all_units(self, controller):
        return controller.total

    def refused(self, controller):
        return controller.unsupported_units

    def fault(self, controller):
        return Fault.UNITS_UNSUPPORTED


def node_control(configuration: MachineConfiguration) -> OneNode:
    """What a machine's controller has."""
    if configuration.merges_directly:
        return DirectNodeControl(configuration=configuration)
    return NodeControl(configuration=configuration) if configuration.node_bits else OneNode()
