"""What processing elements that pass objects on make, draw and forward of a scene."""

from __future__ import annotations

import numpy as np

from ..organisations.dealt_regions import DealtRegions
from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .forwarded_objects import ForwardedObjects
from .made import Made, dropped_of_objects
from .object_boxes import ObjectBoxes
from .object_words import made_of_objects, source_shares


def forwarded_objects(configuration: MachineConfiguration,
                      display_list: DisplayList) -> ForwardedObjects:
    """Of the objects of a list; those that are clipped come to all elements as triangles, and are
    nobody's here."""
    listed = made_of_objects(display_list)
    organisation = organisation_of(configuration)
    assert isinstance(organisation, DealtRegions)
    met = ObjectBoxes.of(listed.objects).met(configuration.dealt_regions)
    return ForwardedObjects(
        configuration.processing_elements, source_shares(configuration, listed).node,
        met & ~listed.objects.clipped[:, np.newaxis], organisation.table)


def made_at_elements(configuration: MachineConfiguration,
                     display_list: DisplayList) -> list[Made]:
    """Of each processing element; ``objects`` are those that it draws, from the host or from a
    neighbour, and ``sent`` are the same triangles for all."""
    listed = made_of_objects(display_list)
    drawn = forwarded_objects(configuration, listed).drawn
    counts, clipped = listed.counts, listed.objects.clipped
    dropped = dropped_of_objects(configuration, listed)
    return [Made(objects=int(own.sum()), made=int(counts[own].sum()),
                 sent=int(counts[clipped].sum()), dropped=int(dropped[own | clipped].sum()))
            for own in drawn.T]
