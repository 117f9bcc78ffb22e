"""How many clocks a tree of nodes takes to merge its pictures.

Step by step, all pairs at the same time: a step takes as long as its longest send, as the way from
the sender to the receiver, and as what goes before the first pixel and after the last one::

    step = STEP_CLOCKS + clocks of the longest send + nodes on the way · HOP_CLOCKS

With two ports a pixel takes a clock.  Where units have one port it is read and, if what comes is
nearer, written, at ports that in node 0 the scan has now and then (``received_pixels``).

A chain merges while it is scanned, which takes no clock of a frame; nodes on a bus have clocks of
their own (``snoop_clocks``).
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

import numpy as np

from ..merging.cage import cage_pictures
from ..merging.snoop import merge_snoop
from ..merging.tree import TreeSend, tree_sends
from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .received_pixels import received_clocks
from .snoop_clocks import snoop_clocks

#: From the end of drawing to the first step.
MERGE_CLOCKS = 1

#: From the start of a step to the next one, were the receiver the sender's own: to find the first
#: word that was drawn, to read it, and to see that all is written.  A node that has drawn nothing
#: is some clocks quicker.
STEP_CLOCKS = 19

#: From a node to the next one on the way to the receiver.
HOP_CLOCKS = 1

#: Places of a scan, equally far apart, at which a merge is tried where nobody knows when it begins.
PHASES = 4


def predict_merge(configuration: MachineConfiguration, display_list: DisplayList,
                  begin: float | None = None) -> int:
    """Clocks that merging takes after drawing; 0 where none is left to be done.  ``begin`` as in
    ``merge_clocks``."""
    if not organisation_of(configuration).merges_after_drawing:
        return 0
    pictures = cage_pictures(configuration, display_list)
    if configuration.snoops:
        return sum(snoop_clocks(merge_snoop(pictures)[1]))
    return sum(merge_clocks(configuration, tree_sends(pictures), begin))


def merge_clocks(configuration: MachineConfiguration, sends: Iterable[TreeSend],
                 begin: float | None = None) -> list[int]:
    """The clocks of each step of a tree's ``sends``, which come step by step; the first one's from
    the end of drawing on.

    Drawing ended ``begin`` clocks after a scan began to show its first line; None where nobody
    knows: then the steps have the mean of ``PHASES``.  With two ports it does not matter.
    """
    steps: list[int] = []
    for step, together in groupby(sends, lambda send: send.step):
        overhead = STEP_CLOCKS + (HOP_CLOCKS << step) + (0 if step else MERGE_CLOCKS)
        # Nearly all of it is before the first pixel comes.
        comes = None if begin is None else begin + sum(steps) + overhead
        longest = max(_send_clocks(configuration, send, comes) for send in together)
        steps.append(overhead + round(longest))
    return steps


def _send_clocks(configuration: MachineConfiguration, send: TreeSend, begin: float | None) -> float:
    if configuration.memory_ports == 2 or not send.sent.any():
        return float(np.count_nonzero(send.sent))
    if begin is not None:
        return received_clocks(configuration, send, begin)
    scanned = organisation_of(configuration).is_scanned(send.receiver)
    begins = np.arange(PHASES if scanned else 1) * (configuration.cycles_per_scan / PHASES)
    return float(np.mean([received_clocks(configuration, send, place)
                          for place in begins.tolist()]))
