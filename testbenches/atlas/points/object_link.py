"""What a host says of objects, and what processing elements that pass them on say to each other."""

from __future__ import annotations

from dataclasses import dataclass

from ....golden.objects.forwarding import forwarded_objects
from ....golden.objects.making import link_words
from ....golden.specification.commands import command_words, layout_bits, object_layout
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.display_list import DisplayList


@dataclass(frozen=True)
class ObjectLink:
    """Of one picture.

    ``once``           commands that load the meshes, before the first picture
    ``frame``          commands of a picture besides its start and its end: objects, and triangles
                       of those that are clipped
    ``passed``         how often an object goes from a processing element to its neighbour
    ``busiest_piece``  how often between the two neighbours that most pass, both ways
    ``passed_bits``    of an object, as it is passed on
    """

    once: int
    frame: int
    passed: int = 0
    busiest_piece: int = 0
    passed_bits: int = 0


def object_link(configuration: MachineConfiguration, display_list: DisplayList
                ) -> ObjectLink | None:
    """By the golden model, to whose counts those of simulated machines are equal; None where the
    host sends triangles."""
    if configuration.objects is None:
        return None
    words, each = link_words(configuration, display_list), command_words(configuration)
    once, frame = words.meshes // each, words.frame // each - 2
    if not configuration.forwards_objects:
        return ObjectLink(once, frame)
    passed = forwarded_objects(configuration, display_list)
    # Between an element and the next one: its own to the right, and that one's to the left.
    pieces = passed.right[:-1] + passed.left[1:]
    return ObjectLink(once, frame, int(pieces.sum()), int(pieces.max(initial=0)),
                      passed_object_bits(configuration))


def passed_object_bits(configuration: MachineConfiguration) -> int:
    """All but the element that the host gives it to; and the first and the last column and row of
    regions that it can meet."""
    regions = configuration.dealt_regions
    return (layout_bits(object_layout(configuration)) - configuration.element_bits
            + 2 * (regions.column_bits + regions.row_bits))
