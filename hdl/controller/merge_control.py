"""What the controller does for each kind of merge card."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..merging.tree_words import TreeLines
from .balanced_regions import BalancedRegions
from .making_objects import making
from .node_control import NodeControl
from .one_node import OneNode
from .region_node import RegionNode
from .snoop_control import SnoopControl
from .tree_steps import TreeSteps

__all__ = ["ChainControl", "DirectControl", "TreeControl", "merge_control"]


class ChainControl(NodeControl):
    """Where nodes are merged as they are scanned, nothing is left to be merged; a picture is shown
    when the last node shows it, and depths are read as they are scanned."""

    opcodes = (Opcode.READ_DEPTH,)
    shows_at_once = False

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        #: Every node showed the new picture a clock ago; so the last one knows what it has sent of
        #: the one before.  Without a presenter a clock passes anyway.
        self._all_show = Signal(name="all_show")

    @property
    def members(self):
        return {**super().members, "shown": In(1), "read_scan": Out(1), "scan_read": In(1),
                "depths": In(stream.Signature(self.configuration.depth_bits))}

    def add_to(self, m, controller):
        super().add_to(m, controller)
        if self.presenter is not None:
            m.d.sync += self._all_show.eq(controller.shown == controller.pictures.front)

    def shown(self, controller):
        # Every node shows the new picture before one draws into what was shown.
        shown = controller.shown == controller.pictures.front
        return shown if self.presenter is None else self._all_show & shown

    def commands(self, m, controller):
        super().commands(m, controller)
        with m.Case(Opcode.READ_DEPTH):
            m.d.comb += [controller.read_scan.eq(controller.quiet),
                         controller.commands.ready.eq(controller.quiet)]
            with m.If(controller.quiet):
                m.next = "READ_SCAN"

    def states(self, m, controller):
        super().states(m, controller)
        with m.State("READ_SCAN"):
            self._pass_depths(m, controller)

    def _pass_depths(self, m, controller):
        """The words of the scan go to the host."""
        answers, depths = controller.answers, controller.depths
        m.d.comb += [
            answers.valid.eq(depths.valid),
            answers.payload.kind.eq(ResponseKind.DEPTH),
            answers.payload.value.eq(depths.payload),
            depths.ready.eq(answers.ready),
        ]
        with m.If(controller.scan_read):
            m.next = "COMMAND"


class TreeControl(NodeControl):
    """Has a tree merge its steps from the clock on in which all is drawn."""

    merges_at_once = False

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        self.steps = TreeSteps(node_bits=configuration.node_bits)
        self._cycles = Signal(commands.RESPONSE_VALUE_BITS, name="merged")

    @property
    def members(self):
        return {**super().members, "tree": Out(TreeLines(node_bits=self.configuration.node_bits))}

    def merged(self, controller):
        return self.steps.idle

    def merge_cycles(self, controller):
        return self._cycles

    def add_to(self, m, controller):
        super().add_to(m, controller)
        m.submodules.steps = steps = self.steps
        wiring.connect(m, steps.lines, wiring.flipped(controller.tree))
        m.d.comb += [
            steps.nodes.eq(controller.nodes),
            # What is announced meanwhile is for lists, and no processing element hears of it.
            steps.quiet.eq(controller.broadcast.done),
        ]
        with m.If(steps.done):
            m.d.sync += self._cycles.eq(controller.frame_cycles)

    def drawn(self, m):
        m.d.comb += self.steps.start.eq(1)


class DirectControl(NodeControl):
    """Nodes share all memory units: these are counted on the ID lines, as where all is one node,
    and no two nodes can differ.  When all is drawn it is merged."""

    def _count(self, m, controller):
        """What nodes report is known."""

    def all_units(self, controller):
        return controller.total

    def refused(self, controller):
        return controller.unsupported_units

    def fault(self, controller):
        return Fault.UNITS_UNSUPPORTED


def merge_control(configuration: MachineConfiguration) -> OneNode:
    """What a machine's controller has."""
    if configuration.scans_rank:
        return ChainControl(configuration=configuration)
    if configuration.sends_drawn:
        return TreeControl(configuration=configuration)
    if configuration.merges_directly:
        return DirectControl(configuration=configuration)
    if configuration.snoops:
        return SnoopControl(configuration=configuration)
    kind: type[OneNode] = OneNode
    if configuration.regions is not None:
        kind = RegionNode if configuration.balancer == "host" else BalancedRegions
    if configuration.objects == "controller":
        kind = making(kind)
    return kind(configuration=configuration)
