"""How many clocks a tree of nodes takes to merge its pictures.

Step by step, all pairs at the same time: a step takes as long as its longest send, as the way from
the sender to the receiver, and as what goes before the first pixel and after the last one::

    step = STEP_CLOCKS + pixels of the longest send · clocks of a pixel + nodes passed · HOP_CLOCKS

A chain merges while it is scanned, which takes no clock of a frame.
"""

from __future__ import annotations

from ..merging.traffic import Traffic
from ..specification.configuration import MachineConfiguration

#: From the start of a step to that of the next one, if its senders are neighbours of the receivers
#: and have drawn nothing: to find the first word that was drawn, to read it, and to see that all
#: is written.
STEP_CLOCKS = 24

#: From a node to the next one on the way to the receiver.
HOP_CLOCKS = 1

#: A pixel that is received, by the ports of a memory unit: one port has a read and most often a
#: write, since pixels come unit by unit.
PIXEL_CLOCKS = {1: 2, 2: 1}


def merge_clocks(configuration: MachineConfiguration, traffic: Traffic) -> list[int]:
    """The clocks of each step of a tree's ``traffic``, from the end of drawing on."""
    pixel_clocks = PIXEL_CLOCKS[configuration.memory_ports]
    return [STEP_CLOCKS + pixels * pixel_clocks + (HOP_CLOCKS << step)
            for step, pixels in enumerate(traffic.steps)]
