"""Clocks that a machine takes for a list of triangles, by model instead of simulation.

A processing element is two servers in a row, with room for a few spans between
them: the walker, which takes clocks for each triangle and each row, and the memory
ports, which take clocks for each fragment.  Times of a span are sums and maxima of
earlier times::

    walked[i] = max(walked[i-1] + rows between, begun[i-ahead] - lead)
    begun[i]  = max(walked[i] + latency, begun[i-1] + clocks of span i-1)

so what a triangle does to a processing element is a matrix over (max, +), whatever
came before.  The matrices of all triangles and elements are made at once; then the
broadcast of each triangle, which waits for the fullest FIFO, is followed through
the list, all elements at once.  ``cycle_estimate`` is the rough and quick sum of
the same parts.

Where a unit has one port, the clocks of a span are a model too: what reads, writes
and the scan's slots come to on average.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .configuration import MachineConfiguration
from .coverage import Triangles
from .display_list import DisplayList
from .grid import Grid
from .lattice_spans import LatticeBlock, LatticeSpans, lattice_blocks, lattice_spans
from .port_clocks import PortClocks

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class Pipeline:
    """Facts of the processing element's pipeline, in clocks unless said otherwise.

    ``broadcast``    from one broadcast to the next, at least
    ``fifo``         from a broadcast to the walker's load, where that is idle
    ``fifo_room``    from when the walker can load the next triangle until a place is free again
    ``load``         the walker's, per block of units
    ``stride``       per bit of the lattice's stride in y
    ``row``          per lattice row
    ``least_rows``   rows that a block is charged for, even if it has fewer
    ``latency``      from a span's leaving the walker to its first fragment's read
    ``spans_ahead``  a span leaves the walker when the one so many before it begins, or
    ``lead``         so many clocks earlier
    ``finish``       from the read of the last fragment until the machine is seen to be done
    """

    broadcast: int = 1
    fifo: int = 2
    fifo_room: int = 0
    load: int = 1
    stride: int = 1
    row: int = 1
    least_rows: int = 1
    latency: int = 4
    spans_ahead: int = 2
    lead: int = 2
    finish: int = 5


PIPELINE = Pipeline()

#: Earlier than any time that counts, and exact as a double with all that is added to it.
_NEVER = -1e15


@dataclass(frozen=True, eq=False)
class CyclePrediction:
    """What the model says of a list on a machine that is idle before, its pictures clear.

    ``finished``          float64 (n,): clocks from the first triangle taken until the machine is
                          done, were this triangle the last; of those that may cover a pixel
    ``broadcast_bound``   clocks to set up and send all of them at best
    ``element_bound``     float64 (elements,): clocks in which each processing element alone, all
                          triangles at hand, must walk, and in which it must draw; the greater
    """

    finished: Float64
    broadcast_bound: float
    element_bound: Float64

    @property
    def cycles(self) -> float:
        """First triangle taken … last fragment written."""
        return float(self.finished[-1]) if len(self.finished) else 0.0

    @property
    def bound(self) -> float:
        """No machine of these parts is faster."""
        return max(self.broadcast_bound, float(self.element_bound.max(initial=0)))

    @property
    def binding(self) -> str:
        """What sets the bound: set-up and ``broadcast``, or the ``busiest element``."""
        element = float(self.element_bound.max(initial=0))
        return "broadcast" if self.broadcast_bound >= element else "busiest element"


def predict_cycles(configuration: MachineConfiguration, display_list: DisplayList,
                   pipeline: Pipeline = PIPELINE,
                   fifo_depths: Sequence[int] | None = None,
                   after: DisplayList | None = None,
                   setup_clocks: int = 1) -> list[CyclePrediction]:
    """The clocks for ``display_list``, for each depth of the FIFOs; by default the machine's own.

    ``after`` was drawn before on the same picture: it hides what lies behind.  ``setup_clocks``
    is what the machine's own set-up takes for a triangle, busy with others before and after.
    Precision does not matter to the clocks.
    """
    interval = max(pipeline.broadcast, setup_clocks)
    interlace = configuration.interlace
    triangles = Triangles.of(display_list,
                             Grid.of(display_list, interlace.x_shift, interlace.y_shift))
    blocks = lattice_blocks(configuration)
    elements = configuration.processing_elements
    depths = [configuration.fifo_depth] if fifo_depths is None else list(fifo_depths)
    ports = PortClocks(configuration, display_list, triangles, after)
    broadcast = _Broadcast(elements, depths, pipeline, interval, len(triangles))
    bound = np.zeros((2, elements))
    for spans in lattice_spans(triangles, blocks):
        offsets, walk = _walk(blocks, elements, spans, pipeline)
        clocks = ports.of(spans)
        bound += [walk.sum(axis=0), np.bincount(spans.element, clocks, elements)]
        broadcast.follow(spans.begin, _matrices(spans, offsets, walk, clocks, pipeline))
    return [CyclePrediction(finished, float(interval * len(triangles)), bound.max(axis=0))
            for finished in broadcast.finished]


def _walk(blocks: list[LatticeBlock], elements: int, spans: LatticeSpans,
          pipeline: Pipeline) -> tuple[Float64, Float64]:
    """Clocks from a triangle's load until each span may leave the walker, (spans,), and until
    the next triangle's load, (triangles, elements)."""
    walk = np.zeros((spans.end - spans.begin, elements))
    offsets = np.zeros(len(spans.triangle))
    for number, block in enumerate(blocks):
        load = pipeline.load + pipeline.stride * block.y_bits
        here = np.flatnonzero((spans.element == block.element) & (spans.place == block.place))
        offsets[here] = (walk[spans.triangle[here], block.element] + load
                         + pipeline.row * spans.step[here])
        walk[:, block.element] += load + pipeline.row * np.maximum(spans.rows[:, number],
                                                                   pipeline.least_rows)
    return offsets, walk


def _matrices(spans: LatticeSpans, offsets: Float64, walk: Float64, clocks: Float64,
              pipeline: Pipeline) -> Float64:
    """(triangles, state, state, elements): a triangle's effect, over (max, +), from state to state.

    The state is when the walker can load, when the ports are free, and when each of the last
    ``spans_ahead`` spans began, the newest first.
    """
    triangles, elements = walk.shape
    size = 2 + pipeline.spans_ahead
    group = spans.triangle * elements + spans.element
    counts = np.bincount(group, minlength=triangles * elements)
    starts = np.cumsum(counts) - counts
    state = np.full((triangles * elements, size, size), _NEVER)
    state[:, np.arange(size), np.arange(size)] = 0
    at = np.zeros(triangles * elements)  # where the walker is, after the load
    most_first = np.argsort(-counts, kind="stable")
    remaining = np.searchsorted(-counts[most_first], -np.arange(counts.max(initial=0)), "left")
    for turn, groups in enumerate(remaining.tolist()):
        chosen = most_first[:groups]
        span = starts[chosen] + turn
        before = state[chosen]
        walker, ports, begun = before[:, 0], before[:, 1], before[:, 2:]
        walker = np.maximum(walker + (offsets[span] - at[chosen])[:, np.newaxis],
                            begun[:, -1] - pipeline.lead)
        begins = np.maximum(walker + pipeline.latency, ports)
        state[chosen] = np.concatenate([
            walker[:, np.newaxis], (begins + clocks[span][:, np.newaxis])[:, np.newaxis],
            begins[:, np.newaxis], begun[:, :-1]], axis=1)
        at[chosen] = offsets[span]
    state[:, 0] += (walk.reshape(-1) - at)[:, np.newaxis]
    # Elements last: what is done for all of them at once lies together.
    return np.ascontiguousarray(state.reshape(triangles, elements, size, size)
                                .transpose(0, 3, 2, 1))


class _Broadcast:
    """Follows a list through the FIFOs, for several depths at once."""

    def __init__(self, elements: int, depths: list[int], pipeline: Pipeline,
                 interval: int, triangles: int) -> None:
        self._pipeline = pipeline
        self._interval = interval
        self._depths = np.array(depths)
        # Every processing element idle for long.
        self._state = np.full((len(depths), 2 + pipeline.spans_ahead, elements), _NEVER)
        self._sent = np.full(len(depths), -float(interval))
        #: When the last processing element was through with the walk of a triangle.
        self._walked = np.full((len(depths), triangles), _NEVER)
        self.finished = np.zeros((len(depths), triangles))

    def follow(self, begin: int, matrices: Float64) -> None:
        """Triangles from ``begin`` on; see ``_matrices``."""
        pipeline, state, sent = self._pipeline, self._state, self._sent
        lines = np.arange(len(self._depths))
        for number, matrix in enumerate(matrices, begin):
            place = number - self._depths
            room = np.where(place >= 0, self._walked[lines, np.maximum(place, 0)]
                            + pipeline.fifo_room, 0)
            sent = np.maximum(sent + self._interval, room)
            np.maximum(state[:, 0], (sent + pipeline.fifo)[:, np.newaxis], out=state[:, 0])
            state = (matrix + state[:, :, np.newaxis]).max(axis=1)
            last = state[:, :2].max(axis=2)
            self._walked[:, number] = last[:, 0]
            self.finished[:, number] = last[:, 1] + pipeline.finish
        self._state, self._sent = state, sent
