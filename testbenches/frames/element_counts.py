"""What processing elements count that pass objects on, beside what the golden model says."""

from __future__ import annotations

from dataclasses import dataclass

from ...golden.objects.forwarding import forwarded_objects, made_at_elements
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from .responses import Simulation


@dataclass(frozen=True)
class ElementFigures:
    """Of one processing element, for a picture.

    ``objects``  that it has drawn, by golden
    ``made``     triangles that it made of these
    ``dropped``  of these, and of those that came as vertices, what its set-up dropped
    ``left``     objects that it passed to its left neighbour
    ``right``    to its right one
    """

    objects: int
    made: int
    dropped: int
    left: int
    right: int


def golden_elements(configuration: MachineConfiguration,
                    display_list: DisplayList) -> list[ElementFigures]:
    """As golden has them; none where elements pass nothing on."""
    if not configuration.forwards_objects:
        return []
    passed = forwarded_objects(configuration, display_list)
    return [ElementFigures(each.objects, each.made, each.dropped, left, right)
            for each, left, right in zip(made_at_elements(configuration, display_list),
                                         passed.left.tolist(), passed.right.tolist(),
                                         strict=True)]


def element_differences(configuration: MachineConfiguration, display_list: DisplayList,
                        simulation: Simulation) -> list[str]:
    """A line for each count of the machine that is not golden's; none where it was not asked."""
    if not simulation.forwarded:
        return []
    counted = [{"made": made, "dropped": dropped, "left": left, "right": right}
               for made, dropped, (left, right) in zip(
                   simulation.made, simulation.dropped, simulation.forwarded, strict=True)]
    said = {"made": "made {:,} triangles", "dropped": "dropped {:,} triangles",
            "left": "passed {:,} objects left", "right": "passed {:,} objects right"}
    return [f"processing element {number} {said[name].format(got)}, golden "
            f"{getattr(golden, name):,}"
            for number, (golden, own) in enumerate(zip(
                golden_elements(configuration, display_list), counted, strict=True))
            for name, got in own.items() if got != getattr(golden, name)]
