"""What the controller does besides, where merge cards end nodes."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import Operation, response_fields
from ..merging.tree_words import TreeLines
from .tree_steps import TreeSteps

__all__ = ["NodeControl"]


class NodeControl:
    """Adds up the nodes at boot, has lists loaded and drawn, and reads merged depths.

    This is no component: it adds members, signals and states to the controller that has it, so
    that a controller without nodes stays as it is.

    Members, of the controller
    --------------------------
    nodes: In(node_bits)
        How many there are, from the right end of the node lines.
    lists_full: In(1)
        A triangle found no room in its node's list (wired or); only with list memories.
    shown: In(1)
        ``front`` at the right end of the scan chain.
    read_scan: Out(1), scan_read: In(1), depths: In(stream of depth_bits)
        ``ScanReadBack``: to start it, that it is done, and what it reads.
        These and ``shown`` only where pictures are merged as they are scanned.
    tree: Out(TreeLines)
        Only where nodes merge in a tree.
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

    def count(self, m, controller):
        """Nodes' reports as they pass: each must be like the first one."""
        response = controller.right.response
        report = response_fields(ResponseKind.NODE, response.payload.value)
        resolution = Signal(commands.RESPONSE_VALUE_BITS, name="node_resolution")
        first = Signal(commands.RESPONSE_VALUE_BITS, name="first_resolution")
        known = Signal(name="first_known")
        with m.Switch(report.units):
            for interlace in self.configuration.interlaces():
                with m.Case(interlace.units):
                    m.d.comb += resolution.eq(commands.response_value(
                        ResponseKind.PICTURE, width=interlace.width, height=interlace.height))
        with m.If(response.valid & response.ready
                  & (response.payload.kind == ResponseKind.NODE)):
            m.d.sync += [self.units.eq(self.units + report.units), known.eq(1)]
            with m.If(resolution == 0):
                m.d.sync += self.unsupported.eq(1)
            with m.If(~known):
                m.d.sync += first.eq(resolution)
            with m.Elif(resolution != first):
                m.d.sync += self.differ.eq(1)

    @property
    def refused(self):
        return self.unsupported | self.differ

    def fault(self, controller):
        """Why the cage is refused; only where it is."""
        units = controller.unsupported_units | self.unsupported
        return Mux(units, Fault.UNITS_UNSUPPORTED, Fault.NODES_DIFFER)

    def report_nodes(self, m, controller, then):
        """The state after the report of the units."""
        with m.State("REPORT_NODES"):
            controller.respond(m, ResponseKind.NODES, controller.nodes, then)

    def add_steps(self, m, controller):
        """Where nodes merge in a tree: what goes on beside the commands."""
        if self.steps is None:
            return
        m.submodules.steps = steps = self.steps
        wiring.connect(m, steps.lines, wiring.flipped(controller.tree))
        m.d.comb += [steps.nodes.eq(controller.nodes), steps.quiet.eq(controller.quiet)]
        with m.If(steps.done):
            m.d.sync += self.merged.eq(controller.frame_cycles)

    def drawn(self, m):
        """Inside the clock in which all is drawn; returns the state after its report."""
        if self.steps is None:
            return "REPORT_MERGED"
        m.d.comb += self.steps.start.eq(1)
        return "MERGING"

    def report_merged(self, m, controller, drawn):
        """The states after the report of the clocks until all was ``drawn``: where the scan merges,
        nothing is left to be done."""
        if self.steps is not None:
            with m.State("MERGING"), m.If(self.steps.idle):
                m.next = "REPORT_MERGED"
        with m.State("REPORT_MERGED"):
            controller.respond(m, ResponseKind.MERGED,
                               drawn if self.steps is None else self.merged, "SWAP")

    def await_shown(self, m, controller):
        """The state after a swap: until every node shows the new picture, so that none is drawn
        into the one that another still shows."""
        if self.configuration.scans_rank:
            with m.State("SWAPPED"), m.If(controller.shown == controller.pictures.front):
                m.next = "REPORT_SHOWN"

    @property
    def after_swap(self):
        return "SWAPPED" if self.configuration.scans_rank else "REPORT_SHOWN"

    # Commands.

    def list_commands(self, m, controller):
        """Inside the switch over opcodes."""
        if not self.configuration.list_words:
            return
        for opcode in (Opcode.CLEAR_LISTS, Opcode.DRAW_LISTS):
            with m.Case(opcode):
                full = (controller.lists_full if opcode == Opcode.DRAW_LISTS else C(0))
                controller.announce(m, Operation[opcode.name], when=~full)
                m.d.comb += controller.commands.ready.eq(controller.broadcast.strobe | full)
                with m.If(full):
                    m.next = "LIST_FULL"

    def list_states(self, m, controller):
        if self.configuration.list_words:
            with m.State("LIST_FULL"):
                controller.respond(m, ResponseKind.ERROR, Fault.LIST_FULL, "COMMAND")

    def read_depth(self, m, controller):
        """READ_DEPTH, taken when all that was announced is done; returns whether it is here."""
        with m.Case(Opcode.READ_DEPTH):
            m.d.comb += [controller.read_scan.eq(controller.quiet),
                         controller.commands.ready.eq(controller.quiet)]
            with m.If(controller.quiet):
                m.next = "READ_SCAN"

    def read_states(self, m, controller):
        """The words of the scan go to the host."""
        if not self.configuration.scans_rank:
            return
        responses, depths = controller.responses, controller.depths
        with m.State("READ_SCAN"):
            m.d.comb += [
                responses.valid.eq(depths.valid),
                responses.payload.kind.eq(ResponseKind.DEPTH),
                responses.payload.value.eq(depths.payload),
                depths.ready.eq(responses.ready),
            ]
            with m.If(controller.scan_read):
                m.next = "COMMAND"
