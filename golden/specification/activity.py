"""Where the clocks of a processing element go: the words of a machine that is observed."""

from __future__ import annotations

from enum import IntEnum

ACTIVITY_BITS = 4


class Activity(IntEnum):
    """What a processing element does in a clock.

    Fragments that wait in the depth test, before one-port units, have been taken; so these
    may be at work in a clock without a fragment.
    """

    FRAGMENT = 0  # the depth test took a fragment
    PORT = 1  # a fragment waited: its unit's port had others before it
    SCAN = 2  # a fragment waited: its unit's port was the scan's
    EMPTY_ROW = 3  # no fragment: the walker met a row or a block without pixels of its own
    PREPARING = 4  # no fragment: the walker took up another block of its domain
    FILLING = 5  # no fragment: the first one of a span was still on its way
    BROADCAST = 6  # nothing to draw: the FIFO of another processing element was full
    SETUP = 7  # nothing to draw: the next triangle was not set up
    DRAIN = 8  # nothing to draw, and no more to come: others, or the last writes, took longer
    SERVICE = 9  # surveying, reporting
