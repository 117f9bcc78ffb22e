"""What the controller does besides, where it makes the triangles of objects."""

from amaranth.hdl import *

from ...golden.specification.commands import Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import Operation
from ..objects.object_setup import ObjectSetup
from .balanced_regions import BalancedRegions
from .object_commands import ObjectCommands
from .one_node import OneNode
from .region_node import RegionNode

__all__ = ["MakingBalancedRegions", "MakingObjects", "MakingRegionNode", "making"]


class OwnObjectCommands(ObjectCommands):
    """They go no further than to the controller's own set-up."""

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        self.setup = ObjectSetup(configuration=configuration)

    def full(self, controller):
        return self.setup.full

    def say(self, m, controller, operation, when):
        words = self.setup.words
        m.d.comb += [words.payload.operation.eq(operation), words.valid.eq(when)]
        return words.valid & words.ready


class MakingObjects(OneNode):
    """Every processing element gets every object and would make the same triangles of it in the
    same clocks; so they are made once, in front of the controller's set-up, and broadcast.

    Blazek 1991, host broadcast; that the triangles are made once is ours.
    """

    opcodes = (Opcode.READ_COUNTERS,)

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        self._own_objects = OwnObjectCommands(configuration=configuration)

    @property
    def setup(self):
        return self._own_objects.setup

    @property
    def storages(self):
        return self.setup.storages

    def add_to(self, m, controller):
        super().add_to(m, controller)
        m.submodules.setup = setup = self.setup
        m.d.comb += [setup.total.eq(controller.total),
                     Value.cast(setup.words.payload.body).eq(controller.body)]
        with m.If(setup.triangles.valid):
            m.d.comb += [controller.packet.body.draw.eq(setup.triangles.payload),
                         setup.triangles.ready.eq(controller.broadcast.ready)]
            controller.announce(m, Operation.DRAW)

    def setting_up(self, controller, setup):
        return ((controller.commands.valid & (controller.opcode == Opcode.OBJECT))
                | self.setup.busy)

    def in_turn(self, controller, ready):
        """Objects and vertices follow one another; all else waits until they are set up."""
        draws = (controller.opcode == Opcode.OBJECT) | (controller.opcode == Opcode.TRIANGLE)
        return super().in_turn(controller, ready & (draws | ~self.setup.busy))

    def start(self, m, controller):
        super().start(m, controller)
        m.d.comb += self.setup.start.eq(1)

    def commands(self, m, controller):
        super().commands(m, controller)
        self._own_objects.commands(m, controller)
        with m.Case(Opcode.READ_COUNTERS):
            controller.announce(m, Operation.READ_COUNTERS, "COUNTING", when=controller.quiet)
            m.d.comb += controller.commands.ready.eq(controller.broadcast.strobe)

    def states(self, m, controller):
        super().states(m, controller)
        self._own_objects.states(m, controller)
        with m.State("COUNTING"), m.If(controller.quiet):
            m.next = "REPORT_MADE"
        with m.State("REPORT_MADE"):
            controller.respond(m, ResponseKind.MADE, self.setup.made, "REPORT_DROPPED")
        with m.State("REPORT_DROPPED"):
            controller.respond(m, ResponseKind.DROPPED, self.setup.dropped, "COMMAND")


class MakingRegionNode(MakingObjects, RegionNode):
    """The same, where the host deals regions out."""


class MakingBalancedRegions(MakingObjects, BalancedRegions):
    """The same, where the machine deals regions out."""


def making(kind: type[OneNode]) -> type[OneNode]:
    """What takes the place of that kind of cage where the controller makes the triangles."""
    return {OneNode: MakingObjects, RegionNode: MakingRegionNode,
            BalancedRegions: MakingBalancedRegions}[kind]
