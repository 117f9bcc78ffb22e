"""What a machine made of a picture's objects, beside what the golden model says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...golden.objects.forwarding import forwarded_objects
from ...golden.objects.made import Made
from ...golden.objects.making import LinkWords, golden_made, link_words, triangle_link_words
from ...golden.objects.object_words import made_of_objects
from ...golden.specification.commands import Opcode, command_words, opcode_of
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ..support.counted import counted
from .frame_job import frame_commands
from .responses import Simulation


@dataclass(frozen=True, eq=False)
class ObjectFigures:
    """Of one picture.

    ``objects``          how many it is made of
    ``clipped``          of these, how many were sent as triangles
    ``meshes``           that were loaded, with so many ``mesh_triangles``
    ``golden``           of each place that makes triangles, from left to right
    ``made``             triangles, in the machine's own count, of each place; None where the
                         counters were not read
    ``dropped``          likewise, of these and of those that came as vertices
    ``forwarded``        objects that each processing element passed left and right, likewise;
                         golden's are ``golden_forwarded``; empty where none does
    ``words``            that the host sent, of 32 bits
    ``golden_words``     likewise, by the golden model
    ``triangle_words``   had it sent every triangle as vertices
    """

    configuration: MachineConfiguration
    objects: int
    clipped: int
    meshes: int
    mesh_triangles: int
    golden: Sequence[Made]
    made: Sequence[int] | None
    dropped: Sequence[int] | None
    forwarded: Sequence[tuple[int, int]] | None
    golden_forwarded: Sequence[tuple[int, int]]
    words: LinkWords
    golden_words: LinkWords
    triangle_words: int

    @property
    def differences(self) -> list[str]:
        """A line for each count that is not golden's."""
        found = []
        for name, told in (("made", self.made), ("dropped", self.dropped)):
            wanted = [getattr(each, name) for each in self.golden]
            if told is None:
                continue
            if len(told) != len(wanted):
                found.append(f"places that say what they {name}: {len(told)}, golden "
                             f"{len(wanted)}")
            found += [f"place {place} {name} {counted(got, 'triangle')}, golden {of_golden:,}"
                      for place, (got, of_golden) in enumerate(zip(told, wanted, strict=False))
                      if got != of_golden]
        if self.forwarded is not None:
            found += [f"processing element {place} passed {counted(got[0], 'object')} left and "
                      f"{got[1]:,} right, golden {wanted[0]:,} and {wanted[1]:,}"
                      for place, (got, wanted) in enumerate(zip(
                          self.forwarded, self.golden_forwarded, strict=True)) if got != wanted]
        found += [f"{what} took {counted(got, 'word')} on the host link, golden {wanted:,}"
                  for what, got, wanted in (
                      ("meshes", self.words.meshes, self.golden_words.meshes),
                      ("the frame", self.words.frame, self.golden_words.frame)) if got != wanted]
        return found


def object_figures(configuration: MachineConfiguration, display_list: DisplayList,
                   simulation: Simulation) -> ObjectFigures | None:
    """None where the machine takes no objects."""
    if configuration.objects is None:
        return None
    objects = made_of_objects(display_list).objects
    opcodes = [opcode_of(word) for word in frame_commands(configuration, display_list)]
    start, each = opcodes.index(Opcode.FRAME_START), command_words(configuration)
    return ObjectFigures(
        configuration, len(objects.mesh), int(objects.clipped.sum()), len(objects.meshes),
        sum(mesh.triangles for mesh in objects.meshes),
        golden_made(configuration, display_list),
        simulation.made if simulation.work else None,
        simulation.dropped if simulation.work else None,
        simulation.forwarded if simulation.work else None,
        _golden_forwarded(configuration, display_list),
        LinkWords(each * start, each * (len(opcodes) - start)),
        link_words(configuration, display_list),
        triangle_link_words(configuration, display_list))


def _golden_forwarded(configuration: MachineConfiguration,
                      display_list: DisplayList) -> list[tuple[int, int]]:
    if not configuration.forwards_objects:
        return []
    passed = forwarded_objects(configuration, display_list)
    return list(zip(passed.left.tolist(), passed.right.tolist(), strict=True))
