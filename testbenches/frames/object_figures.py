"""What a machine made of a picture's objects, beside what the golden model says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...golden.objects.making import LinkWords, Made, golden_made, link_words, triangle_link_words
from ...golden.objects.object_words import made_of_objects
from ...golden.specification.commands import Opcode, command_words, opcode_of
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from .frame_job import frame_commands
from .responses import Simulation


@dataclass(frozen=True, eq=False)
class ObjectFigures:
    """Of one picture.

    ``objects``          how many it is made of
    ``meshes``           that were loaded, with so many ``mesh_triangles``
    ``golden``           of each place that makes triangles, from left to right
    ``made``             triangles, in the machine's own count, of each place; None where the
                         counters were not read
    ``dropped``          likewise, of these and of those that came as vertices
    ``words``            that the host sent, of 32 bits
    ``golden_words``     likewise, by the golden model
    ``triangle_words``   had it sent every triangle as vertices
    """

    configuration: MachineConfiguration
    objects: int
    meshes: int
    mesh_triangles: int
    golden: Sequence[Made]
    made: Sequence[int] | None
    dropped: Sequence[int] | None
    words: LinkWords
    golden_words: LinkWords
    triangle_words: int

    @property
    def differences(self) -> list[str]:
        """A line for each count that is not golden's."""
        found = []
        for name, counted in (("made", self.made), ("dropped", self.dropped)):
            wanted = [getattr(each, name) for each in self.golden]
            if counted is None:
                continue
            if len(counted) != len(wanted):
                found.append(f"{len(counted)} places say what they {name}, golden {len(wanted)}")
            found += [f"place {place} {name} {got:,} triangles, golden {of_golden:,}"
                      for place, (got, of_golden) in enumerate(zip(counted, wanted, strict=False))
                      if got != of_golden]
        found += [f"{what} took {got:,} words on the host link, golden {wanted:,}"
                  for what, got, wanted in (
                      ("meshes", self.words.meshes, self.golden_words.meshes),
                      ("the frame", self.words.frame, self.golden_words.frame)) if got != wanted]
        return found

    @property
    def clipped(self) -> int:
        """Objects that were sent as triangles."""
        return self.objects - sum(each.objects for each in self.golden)


def object_figures(configuration: MachineConfiguration, display_list: DisplayList,
                   simulation: Simulation) -> ObjectFigures | None:
    """None where the machine takes no objects."""
    if configuration.objects is None:
        return None
    objects = made_of_objects(display_list).objects
    opcodes = [opcode_of(word) for word in frame_commands(configuration, display_list)]
    start, each = opcodes.index(Opcode.FRAME_START), command_words(configuration)
    return ObjectFigures(
        configuration, len(objects.mesh), len(objects.meshes),
        sum(mesh.triangles for mesh in objects.meshes),
        golden_made(configuration, display_list),
        simulation.made if simulation.work else None,
        simulation.dropped if simulation.work else None,
        LinkWords(each * start, each * (len(opcodes) - start)),
        link_words(configuration, display_list),
        triangle_link_words(configuration, display_list))
