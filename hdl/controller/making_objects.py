"""What the controller does besides, where it makes the triangles of objects."""

from amaranth.hdl import *

from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import ObjectOperation, Operation
from ..objects.object_setup import ObjectSetup
from .balanced_regions import BalancedRegions
from .one_node import OneNode
from .region_node import RegionNode

__all__ = ["MakingBalancedRegions", "MakingObjects", "MakingRegionNode", "making"]


class MakingObjects(OneNode):
    """Every processing element gets every object and would make the same triangles of it in the
    same clocks; so they are made once, in front of the controller's set-up, and broadcast.

    It knows how many meshes are loaded, and refuses objects of others.

    Blazek 1991, host broadcast; that the triangles are made once is ours.
    """

    opcodes = (Opcode.READ_COUNTERS,)

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        self.setup = ObjectSetup(configuration=configuration)
        #: How many are loaded.
        self._meshes = Signal(configuration.mesh_bits, name="meshes")
        #: What was wrong with an object last.
        self._refused = Signal(range(max(Fault) + 1), name="object_fault")

    @property
    def storages(self):
        return self.setup.storages

    def add_to(self, m, controller):
        super().add_to(m, controller)
        m.submodules.object_setup = setup = self.setup
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
        words = self.setup.words
        with m.Case(Opcode.CLEAR_LISTS):
            self._tell(m, controller, ObjectOperation.CLEAR)
            with m.If(words.ready):
                m.d.sync += self._meshes.eq(0)
        with m.Case(Opcode.MESH):
            self._tell(m, controller, ObjectOperation.MESH)
            with m.If(words.ready):  # more than there is room for make the memory full
                m.d.sync += self._meshes.eq(self._meshes + 1)
        for opcode in (Opcode.MESH_TRIANGLE, Opcode.TRIANGLE):
            with m.Case(opcode):
                self._tell(m, controller, ObjectOperation[opcode.name])
        with m.Case(Opcode.OBJECT):
            with m.If(self._wrong != 0):
                m.d.comb += controller.commands.ready.eq(1)
                m.d.sync += self._refused.eq(self._wrong)
                m.next = "REFUSE_OBJECT"
            with m.Else():
                self._tell(m, controller, ObjectOperation.OBJECT)
        with m.Case(Opcode.READ_COUNTERS):
            controller.announce(m, Operation.READ_COUNTERS, "COUNTING", when=controller.quiet)
            m.d.comb += controller.commands.ready.eq(controller.broadcast.strobe)

    def _tell(self, m, controller, operation):
        """The offered command goes to set-up."""
        words = self.setup.words
        m.d.comb += [words.payload.operation.eq(operation), words.valid.eq(1),
                     controller.commands.ready.eq(words.ready)]

    @property
    def _wrong(self):
        """What is wrong with the offered object, or 0."""
        unknown = self.setup.words.payload.body.object.mesh >= self._meshes
        return Mux(self.setup.full, int(Fault.LIST_FULL), Mux(unknown, int(Fault.NO_MESH), 0))

    def states(self, m, controller):
        super().states(m, controller)
        with m.State("REFUSE_OBJECT"):
            controller.respond(m, ResponseKind.ERROR, self._refused, "COMMAND")
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
