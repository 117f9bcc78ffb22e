"""About how many clocks a machine takes to draw a frame, without simulating it.

A processing element finds the rows of its pixels, one a clock, and each fragment
takes its unit's one port for a read and, where it is visible, a write; where units
have two ports it takes one clock.  Rows and ports go on side by side, the rows a few
triangles ahead, so each few triangles take the longer of

    walk     the rows of all triangles whose bounding boxes hold a pixel of its lattice
    ports    the accesses of its fragments, slowed down by the scan's slots

and the frame takes as long as its busiest processing element does for all of them, or
as the broadcast, a clock for each triangle.  Where nodes share the triangles each is a cage by
itself; the broadcast is for all of them, unless each has its share in a list.  Elements without
pixels of their own draw a fragment a clock, and the ports are those of the busiest unit.
Where it errs: how often a fragment is visible is the average for a random order of
drawing; and many processing elements wait for each other's full queues, so that a
fine mesh takes up to a fifth longer; where regions are dealt out and neighbours in the
list lie in the same ones, twice as long.  ``cycle_model`` follows all that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..merging.direct import direct_traffic
from ..organisations.dealt_regions import DealtRegions
from ..organisations.organisation_of import organisation_of
from ..reference.coverage import Triangles
from ..reference.exact import depth_complexity
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from ..specification.queues import FRAGMENTS_WAITING
from ..specification.sampling_grid import Grid
from .element_latencies import PIPELINE
from .element_spans import lattice_spans
from .node_work import share_of_node
from .one_port.scan_reads import scan_share
from .regions.region_spans import region_spans
from .row_clocks import walks

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: From the frame's start until the first fragment is taken, from the last one's read to done.
LATENCY_CLOCKS = PIPELINE.queue + PIPELINE.latency + PIPELINE.finish

#: About so many triangles have rows that were found ahead.
TRIANGLES_AHEAD = 4

#: About so many times longer takes an element whose fragments all wait in one queue.
WAIT_IN_ONE_QUEUE = 1.2

#: ``cards_for_cycles`` tries up to so many processing elements, each with so many units.
MOST_ELEMENTS = 256
UNITS_EACH = (1, 2, 4)


@dataclass(frozen=True, eq=False)
class CycleEstimate:
    """Clocks to draw one frame.

    ``draw``       float64, per processing element
    ``broadcast``  for all triangles
    ``fragments``  int64, per processing element; exact
    ``units``      for the busiest memory unit, where processing elements share it
    """

    draw: Float64
    broadcast: int
    fragments: Int64
    units: float = 0.0

    @property
    def total(self) -> int:
        return round(max(float(self.draw.max(initial=0)), self.broadcast, self.units)
                     + LATENCY_CLOCKS)


def estimate_cycles(configuration: MachineConfiguration, display_list: DisplayList,
                    retained: bool = False, table: Int64 | None = None) -> CycleEstimate:
    """How long ``configuration`` takes for ``display_list``; whole arrays, no loop over pixels.

    ``retained``: the nodes draw it from their lists, all at the same time.  ``table``: what regions
    are dealt out by, int64 (regions,), or None for what a machine begins with.
    """
    organisation = organisation_of(configuration).dealt(table)
    nodes = ([_of_regions(organisation, display_list)] if isinstance(organisation, DealtRegions)
             else [_of_node(configuration, display_list, node)
                   for node in range(configuration.nodes)])
    broadcast = [node.broadcast for node in nodes]
    return CycleEstimate(np.concatenate([node.draw for node in nodes]),
                         max(broadcast) if retained else sum(broadcast),
                         np.concatenate([node.fragments for node in nodes]),
                         _of_shared_units(configuration, display_list))


def _of_shared_units(configuration: MachineConfiguration, display_list: DisplayList) -> float:
    """Clocks of the busiest unit that takes fragments of all elements."""
    if not configuration.merges_directly:
        return 0.0
    organisation = organisation_of(configuration)
    clocks = float(direct_traffic(organisation, display_list).taken.sum(axis=0).max())
    if configuration.memory_ports == 1:
        complexity = depth_complexity(display_list, **organisation.resolution.shifts)
        clocks *= (1 + visible_share(complexity)) / (1 - scan_share(configuration))
    return clocks


def _of_node(configuration: MachineConfiguration, display_list: DisplayList,
             node: int) -> CycleEstimate:
    """A node for itself, with the triangles that it draws."""
    _, display_list = share_of_node(configuration, display_list, node)
    organisation = organisation_of(configuration).each[node]
    shifts = organisation.resolution.shifts
    triangles = Triangles.of(display_list, Grid.of(display_list, **shifts))
    blocks = organisation.blocks
    alone = np.array([block.units == 1 for block in blocks])
    alternating = np.array([block.alternating for block in blocks])
    elements = len(organisation.domains)
    written, slots = _of_ports(configuration, display_list, node)
    draw, fragments = np.zeros(elements), np.zeros(elements, np.int64)
    for spans in lattice_spans(triangles, blocks):
        count = spans.end - spans.begin
        places = spans.triangle * elements + spans.element
        # Writes wait for reads of the same unit: all where the block is one unit; where units take
        # turns from row to row, those of a row longer than the queue; none where they do along it.
        waits = np.where(alone[spans.block], spans.length,
                         np.maximum(spans.length - FRAGMENTS_WAITING, 0))
        waits[alternating[spans.block]] = 0
        clocks = (spans.length + written * waits) / (1 - slots)
        drawn = _wait(configuration) * np.bincount(places, clocks, count * elements)
        _, walked, _ = walks(blocks, elements, spans, PIPELINE)
        draw += np.maximum(_together(walked), _together(drawn.reshape(count, elements))).sum(axis=0)
        fragments += np.bincount(spans.element, spans.length, elements).astype(np.int64)
    return CycleEstimate(draw, len(triangles), fragments)


def _of_regions(organisation: DealtRegions, display_list: DisplayList) -> CycleEstimate:
    """Where regions are dealt out: the rows of all visits, and the fragments."""
    configuration, elements = organisation.configuration, organisation.elements
    triangles = Triangles.of(display_list, Grid.of(display_list))
    written, slots = _of_ports(configuration, display_list)
    alternating = organisation.inside.x_unit_bits > 0
    draw, fragments = np.zeros(elements), np.zeros(elements, np.int64)
    for spans in region_spans(triangles, organisation):
        shape = spans.end - spans.begin, elements
        waits = np.where(spans.units == 1, spans.length,
                         0 if alternating else np.maximum(spans.length - FRAGMENTS_WAITING, 0))
        clocks = (spans.length + written * waits) / (1 - slots)
        places = spans.visit_triangle * elements + spans.visit_element
        drawn = np.bincount(places[spans.visit], clocks, shape[0] * elements)
        walked = np.bincount(places, spans.visit_rows, shape[0] * elements)
        draw += np.maximum(_together(walked.reshape(shape)),
                           _together(drawn.reshape(shape))).sum(axis=0)
        fragments += np.bincount(spans.element, spans.length, elements).astype(np.int64)
    return CycleEstimate(draw, len(triangles), fragments)


def _of_ports(configuration: MachineConfiguration, display_list: DisplayList,
              node: int = 0) -> tuple[float, float]:
    """Of units with one port: writes per fragment, and the share of the scan; of others none."""
    if configuration.memory_ports > 1 or configuration.merges_directly:
        return 0.0, 0.0
    shifts = organisation_of(configuration).resolution.shifts
    return (visible_share(depth_complexity(display_list, **shifts)),
            scan_share(configuration, node))


def _wait(configuration: MachineConfiguration) -> float:
    """How many times longer an element draws because fragments wait for others."""
    one_queue = configuration.merges_directly and configuration.queue == "element"
    meet = min(configuration.nodes, configuration.units) > 1
    return WAIT_IN_ONE_QUEUE if one_queue and meet else 1.0


def _together(clocks: NDArray[Any]) -> NDArray[Any]:
    """(triangles, elements) → (runs of a few triangles, elements): sums."""
    padded = np.pad(clocks, ((0, -len(clocks) % TRIANGLES_AHEAD), (0, 0)))
    return np.asarray(padded.reshape(-1, TRIANGLES_AHEAD, clocks.shape[1]).sum(axis=1))


def visible_share(complexity: NDArray[np.int32]) -> float:
    """Writes per fragment where those of a pixel come in random order of depth.

    Of d fragments the k-th is the nearest so far with probability 1/k, so
    1 + 1/2 + … + 1/d of them are written.
    """
    counts = np.bincount(complexity.ravel())
    drawn = np.arange(len(counts))
    written = np.cumsum(np.concatenate([[0.0], 1 / np.maximum(drawn[1:], 1)]))
    total = int((counts * drawn).sum())
    return float((counts * written).sum()) / total if total else 0.0


def cards_for_cycles(display_list: DisplayList | Sequence[DisplayList], cycles: int,
                     **fields: Any) -> str:
    """The cards, with the fewest processing elements and then the fewest memory units, that are
    estimated to draw ``display_list``, or each of several of one size, in at most ``cycles``.

    ``fields`` of ``MachineConfiguration`` besides the cards and what the list itself gives.
    Raises ``InputError`` where more processing elements no longer help.
    """
    lists = [display_list] if isinstance(display_list, DisplayList) else display_list
    first = lists[0]
    best: tuple[int, str] | None = None
    elements, refused = 1, InputError("")
    while elements <= MOST_ELEMENTS:
        before = best
        for units in UNITS_EACH:
            cards = f"{elements}x(P{'M' * units})" if elements > 1 else "P" + "M" * units
            try:
                machine = MachineConfiguration(
                    cards=cards, width=first.width, height=first.height,
                    sub_bits=first.sub_bits, depth_bits=first.depth_bits, **fields)
            except InputError as error:  # so few units do not hold the picture
                refused = error
                continue
            total = max(estimate_cycles(machine, each).total for each in lists)
            if total <= cycles:
                return cards
            best = min(best or (total, cards), (total, cards))
        if before is not None and best == before:
            break
        elements *= 2
    if best is None:
        raise refused
    raise InputError(f"cycles: {cycles:,} are too few: the fastest cage, {best[1]}, takes about "
                     f"{best[0]:,}; allow more, or make the picture smaller")
