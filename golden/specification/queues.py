"""How much waits where in a machine, and how many wait side by side."""

from __future__ import annotations

from .card_order import domains
from .configuration import MachineConfiguration

#: Fragments that can wait before each lane, so that short runs in one unit even out, and rows
#: without fragments.
FRAGMENTS_WAITING = 16



def depth_lanes(configuration: MachineConfiguration) -> int:
    """1 where no processing element has more than one memory unit, or 2."""
    return 1 + any(units > 1 for _, units in domains(configuration.cards))

