"""How much waits where in a machine, and how many wait side by side."""

from __future__ import annotations

from .card_order import domains
from .configuration import MachineConfiguration

#: Spans that are found ahead, so that rows of few pixels hide behind longer ones.
SPANS_WAITING = 16

#: Fragments that can wait before each lane, so that short runs in one unit even out, and rows
#: without fragments.
FRAGMENTS_WAITING = 16

#: Fragments of a processing element that can wait in the one queue it has before all units, where
#: it has not one for each (``MachineConfiguration.queue``).  The first holds up the others, so more
#: would not help.
FRAGMENTS_OF_ELEMENT = 4

#: Outlines of triangles that can wait for set-up in hardware: more than the pipeline that finds
#: them is long, so that it can be full.
OUTLINES_WAITING = 16

#: Objects of the host that can wait in a processing element that passes objects on, so that the
#: host goes on to other elements meanwhile; and objects that can wait there from each neighbour, so
#: that channels go on while an object is drawn.
OBJECTS_WAITING = 8
OBJECTS_PASSING = 8


def depth_lanes(configuration: MachineConfiguration) -> int:
    """Lanes of a one-port depth test: 1 where no processing element has more than one memory
    unit, else 2."""
    return 1 + any(units > 1 for cards in configuration.node_cards for _, units in domains(cards))

