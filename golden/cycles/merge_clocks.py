"""How many clocks a tree of nodes takes to merge its pictures.

Step by step, all pairs at the same time: a step takes as long as its longest send, as the way from
the sender to the receiver, and as what goes before the first pixel and after the last one::

    step = STEP_CLOCKS + clocks of the longest send + nodes on the way · HOP_CLOCKS

A pixel takes a clock.  Where units have one port it is read and, if what comes is nearer, written,
at a port that the scan has now and then; pixels come from two units in turn, so that two ports
share them.  How many each of the two units sends is not looked at, which makes this up to a tenth
wrong.

A chain merges while it is scanned, which takes no clock of a frame; nodes on a bus have clocks of
their own (``snoop_clocks``).
"""

from __future__ import annotations

from ..merging.cage import merge_cage
from ..merging.traffic import Send, Traffic
from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .one_port_lanes import scan_share
from .snoop_clocks import snoop_clocks

#: From the end of drawing to the first step.
MERGE_CLOCKS = 1

#: From the start of a step to the next one, were the receiver the sender's own: to find the first
#: word that was drawn, to read it, and to see that all is written.  A node that has drawn nothing
#: is some clocks quicker.
STEP_CLOCKS = 19

#: From a node to the next one on the way to the receiver.
HOP_CLOCKS = 1


def predict_merge(configuration: MachineConfiguration, display_list: DisplayList) -> int:
    """Clocks that merging takes after drawing; 0 where none is left to be done."""
    if not organisation_of(configuration).merges_after_drawing:
        return 0
    _, traffic = merge_cage(configuration, display_list)
    return sum(snoop_clocks(traffic) if configuration.snoops else
               merge_clocks(configuration, traffic))


def merge_clocks(configuration: MachineConfiguration, traffic: Traffic) -> list[int]:
    """The clocks of each step of a tree's ``traffic``, the first one's from the end of drawing
    on."""
    longest = [0.0] * (traffic.nodes - 1).bit_length()
    for send in traffic.sends:
        longest[send.step] = max(longest[send.step], _send_clocks(configuration, send))
    return [STEP_CLOCKS + round(clocks) + (HOP_CLOCKS << step) + (0 if step else MERGE_CLOCKS)
            for step, clocks in enumerate(longest)]


def _send_clocks(configuration: MachineConfiguration, send: Send) -> float:
    if configuration.memory_ports == 2:
        return send.pixels
    assert send.receiver is not None, "only of a tree"
    # Pixels come from two units in turn, and are written to two while those of both have any.
    ports = min(2, configuration.units)
    clocks = max(send.pixels, (send.pixels + send.kept) / ports)
    return clocks / (1 - scan_share(configuration, send.receiver))
