"""What the controller does with meshes and objects, and with triangles that are not set up here."""

from amaranth.hdl import *
from amaranth.lib import data

from ...golden.specification.commands import Fault, Opcode, ResponseKind, object_layout
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import ObjectOperation, Operation, struct_layout

__all__ = ["ObjectCommands"]

#: Commands that go on as they are.
PASSED = {Opcode.TRIANGLE: ObjectOperation.TRIANGLE, Opcode.MESH: ObjectOperation.MESH,
          Opcode.MESH_TRIANGLE: ObjectOperation.MESH_TRIANGLE,
          Opcode.CLEAR_LISTS: ObjectOperation.CLEAR, Opcode.OBJECT: ObjectOperation.OBJECT}


class ObjectCommands:
    """Broadcasts them to those who make triangles of objects, as soon as all of these take them.
    An object of a mesh that was not loaded, or after one that found no room, is refused.

    This is no component: it adds signals and states to the controller that has it.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._loaded = Signal(range(configuration.meshes + 1), name="loaded_meshes")

    def full(self, controller):
        """Some mesh found no room."""
        return controller.lists_full

    def say(self, m, controller, operation, when):
        """The offered command goes on; returns that it does so in this clock."""
        make = controller.packet.body.make
        m.d.comb += [make.operation.eq(operation),
                     make.body.as_value().eq(controller.body[:make.body.as_value().shape().width])]
        controller.announce(m, Operation.MAKE, when=when)
        return controller.broadcast.strobe

    def commands(self, m, controller):
        """Inside the switch over opcodes."""
        for opcode, operation in PASSED.items():
            with m.Case(opcode):
                if opcode == Opcode.OBJECT:
                    self._object(m, controller)
                    continue
                said = self.say(m, controller, operation, 1)
                m.d.comb += controller.commands.ready.eq(said)
                if opcode == Opcode.CLEAR_LISTS:
                    with m.If(said):
                        m.d.sync += self._loaded.eq(0)
                if opcode == Opcode.MESH:
                    with m.If(said & (self._loaded != self.configuration.meshes)):
                        m.d.sync += self._loaded.eq(self._loaded + 1)

    def _object(self, m, controller):
        full, unknown = self.full(controller), Signal(name="unknown_mesh")
        layout = struct_layout(object_layout(self.configuration))
        offered = data.View(layout, controller.body[:layout.size])
        m.d.comb += unknown.eq(offered.mesh >= self._loaded)
        said = self.say(m, controller, ObjectOperation.OBJECT, ~full & ~unknown)
        m.d.comb += controller.commands.ready.eq(said | full | unknown)
        with m.If(full):
            m.next = "LIST_FULL"
        with m.Elif(unknown):
            m.next = "NO_MESH"

    def states(self, m, controller):
        """Further states."""
        for fault in (Fault.LIST_FULL, Fault.NO_MESH):
            with m.State(fault.name):
                controller.respond(m, ResponseKind.ERROR, fault, "COMMAND")
