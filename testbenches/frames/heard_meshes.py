"""What becomes of the meshes that a host loads, and of objects of these."""

from __future__ import annotations

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, opcode_of
from ...golden.specification.configuration import MachineConfiguration


class HeardMeshes:
    """Takes command after command, and says what is answered to those that are about objects, as
    ``docs/command-words.md`` has it.

    ``meshes``     that were begun since all were forgotten, and found room
    ``triangles``  of these
    ``full``       some mesh or triangle found none
    """

    def __init__(self, configuration: MachineConfiguration) -> None:
        self.configuration = configuration
        self.meshes = self.triangles = 0
        self.full = False

    def take(self, word: int) -> Fault | None:
        """The fault that is answered, if any."""
        opcode = opcode_of(word)
        if opcode == Opcode.CLEAR_LISTS:
            self.meshes = self.triangles = 0
            self.full = False
        elif opcode == Opcode.MESH:
            self._begin()
        elif opcode == Opcode.MESH_TRIANGLE and self.meshes:
            self._store()
        elif opcode == Opcode.OBJECT:
            return self._fault(word)
        return None

    def _begin(self) -> None:
        if self.meshes == self.configuration.meshes:
            self.full = True
        else:
            self.meshes += 1

    def _store(self) -> None:
        if self.full or self.triangles == self.configuration.mesh_triangles:
            self.full = True
        else:
            self.triangles += 1

    def _fault(self, word: int) -> Fault | None:
        layout = commands.object_layout(self.configuration)
        mesh = commands.unpack(layout, word >> commands.BODY_OFFSET)["mesh"]
        if self.full:
            return Fault.LIST_FULL
        return Fault.NO_MESH if mesh >= self.meshes else None
