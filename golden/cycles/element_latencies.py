"""The facts of a processing element's pipeline that the cycle model goes by.

The golden models do not import the hardware, so the clocks are said here once more;
``tests/hdl/test_cycle_constants.py`` holds them to what its components state.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ..specification.queues import SPANS_WAITING

#: Clocks: long before all that counts.
NEVER = -1e15


@dataclass(frozen=True)
class Pipeline:
    """Facts of the processing element's pipeline, in clocks unless said otherwise.

    ``queue``        from a broadcast to the walker's load, where that is idle
    ``latency``      from the load until the depth test takes the first row's first fragment
    ``spans_ahead``  spans that fit between the walker and the fragments
    ``lead``         by how much the walk runs ahead of the fragments, where they are full
    ``valued``       from the pixel's valuing until its fragment has been taken
    ``first_row``    to find a triangle's first row, in a domain of several blocks of units
    ``block``        from the last row of a block to the first one of the next
    ``again``        from such a domain's last row to the next load
    ``finish``       from the last fragment's read until the machine is seen to be done
    """

    queue: int = 3
    latency: int = 15
    spans_ahead: int = SPANS_WAITING
    lead: int = 5
    valued: int = 6
    first_row: int = 2
    block: int = 3
    again: int = 2
    finish: int = 4


#: The machine's own.
PIPELINE = Pipeline()


class Drawn(NamedTuple):
    """When an element has drawn a triangle, and all before it.

    ``drawn``   the last fragment has been taken by the depth test
    ``walker``  the last span leaves the walker, at the soonest
    ``done``    the last accesses are done
    """

    drawn: float
    walker: float
    done: float
