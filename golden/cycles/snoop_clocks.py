"""How many clocks nodes take to send their pictures over a bus, one after the other.

A node's turn begins when all before it have said that they are done and what it deletes for them
has been deleted; then a pixel takes a clock, whatever ports units have::

    turn = TURN_CLOCKS + its pixels

A node in whose first units nothing is left is some clocks slower.  Where bits of its map are few
and far between, a clock is added for every 4096 words of a unit in which there are none.
"""

from __future__ import annotations

from ..merging.traffic import Traffic

#: From the end of drawing to the first node's turn, and from the last one's until its last pixel
#: has been written into a frame unit.
BUS_CLOCKS = 7

#: Of a node that sends nothing: to see that all is deleted, to find the first word that is left and
#: to read it, and to say that it was the last.
TURN_CLOCKS = 16


def snoop_clocks(traffic: Traffic) -> list[int]:
    """The clocks of each node's turn, the first one's from the end of drawing on, until the merged
    picture is complete."""
    turns = [TURN_CLOCKS + send.pixels for send in traffic.sends]
    turns[0] += BUS_CLOCKS
    return turns
