"""About how many clocks a machine takes to draw a frame, without simulating it.

A processing element walks each triangle row by row on the lattice of its own
pixels, and each fragment takes its unit's one port for a read and, where it is
visible, a write; or of two ports one clock.  A triangle takes it the longer of

    walk     its load, the lattice stride's bits, a clock a row
    ports    the accesses of its fragments, slowed down by the scan's slots

The frame takes what the busiest processing element takes.
Where it errs: how often a fragment is visible is the average for a random order of
drawing; one triangle's walk overlaps with the ports' work for the one before by a
few rows only, and broadcasts wait for a full FIFO.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .cards import domains
from .configuration import MachineConfiguration
from .coverage import Spans, Triangles, spans
from .display_list import DisplayList
from .errors import InputError
from .exact import depth_complexity
from .grid import Grid
from .interlace import Interlace

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: The span walker takes one to load a triangle, before the stride's bits and the rows.
LOAD_CLOCKS = 1
#: From the frame's start to the first triangle, from the last fragment to done.
LATENCY_CLOCKS = 16

#: What is tried for a number of cycles: up to so many processing elements, each with so many units.
MOST_ELEMENTS = 256
UNITS_EACH = (1, 2, 4)


@dataclass(frozen=True, eq=False)
class CycleEstimate:
    """Clocks to draw one frame.

    ``draw``       float64, per processing element
    ``fragments``  int64, per processing element; exact
    """

    draw: Float64
    fragments: Int64

    @property
    def total(self) -> int:
        return round(float(self.draw.max(initial=0)) + LATENCY_CLOCKS)


@dataclass(frozen=True)
class _Block:
    """An aligned power of two of units: a lattice of pixels, 2**bits apart, from an offset."""

    element: int
    x_offset: int
    y_offset: int
    x_bits: int
    y_bits: int


def estimate_cycles(configuration: MachineConfiguration,
                    display_list: DisplayList) -> CycleEstimate:
    """How long ``configuration`` takes for ``display_list``; whole arrays, no loop over pixels."""
    interlace = configuration.interlace
    shifts = {"x_shift": interlace.x_shift, "y_shift": interlace.y_shift}
    triangles = Triangles.of(display_list, Grid.of(display_list, **shifts))
    shares = domains(configuration.cards)
    blocks = [block for element, (first, count) in enumerate(shares)
              for block in _blocks(element, first, first + count, interlace)]
    accesses, slots = 1.0, 0.0
    if configuration.memory_ports == 1:
        accesses += visible_share(depth_complexity(display_list, **shifts))
        slots = _scan_share(configuration)
    draw, fragments = np.zeros(len(shares)), np.zeros(len(shares), np.int64)
    runs = list(spans(triangles))
    for x_bits, y_bits in sorted({(block.x_bits, block.y_bits) for block in blocks}):
        # Units in turn along a row share its accesses; one fragment a clock at best.
        in_turn = 1 << (interlace.x_unit_bits - x_bits)
        clocks = max(1.0, accesses / in_turn) / (1 - slots)
        walk = _walk(triangles, y_bits)
        for x_offset in range(1 << x_bits):
            covered = _covered(runs, len(triangles), x_offset, x_bits, y_bits)
            work = np.maximum(walk, covered * clocks).sum(axis=0)
            for block in blocks:
                if (block.x_bits, block.y_bits, block.x_offset) == (x_bits, y_bits, x_offset):
                    draw[block.element] += work[block.y_offset]
                    fragments[block.element] += covered[:, block.y_offset].sum()
    return CycleEstimate(draw, fragments)


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


def _blocks(element: int, first: int, end: int, interlace: Interlace) -> Iterator[_Block]:
    while first < end:
        largest = (end - first).bit_length() - 1
        aligned = (first & -first).bit_length() - 1 if first else largest
        bits = min(largest, aligned)
        x_bits, y_bits = interlace.stride_bits(bits)
        x, y = interlace.pixel(first, 0)
        yield _Block(element, x & ((1 << x_bits) - 1), y & ((1 << y_bits) - 1), x_bits, y_bits)
        first += 1 << bits


def _scan_share(configuration: MachineConfiguration) -> float:
    """Of a unit's clocks, those in which the scan reads it."""
    interlace, timing = configuration.interlace, configuration.timing
    active = timing.horizontal_active * timing.vertical_active / timing.pixels
    groups = configuration.clocks_per_pixel << (interlace.x_unit_bits + interlace.x_shift)
    return active / (groups << interlace.y_unit_bits)


def _walk(triangles: Triangles, y_bits: int) -> Int64:
    """(triangles, offsets in y): clocks to load a triangle and walk its rows; one at least."""
    offset = np.arange(1 << y_bits)
    top, bottom = triangles.top[:, np.newaxis], triangles.bottom[:, np.newaxis]
    # Rows r of top … bottom-1 with r = offset modulo the stride.
    rows = ((bottom - 1 - offset) >> y_bits) - ((top - 1 - offset) >> y_bits)
    return np.asarray(LOAD_CLOCKS + y_bits + np.maximum(rows, 1))


def _covered(runs: list[Spans], triangles: int, x_offset: int, x_bits: int,
             y_bits: int) -> Int64:
    """(triangles, offsets in y): pixels of each triangle on the lattices with this x offset."""
    offsets = 1 << y_bits
    covered = np.zeros(triangles * offsets, np.int64)
    for part in runs:
        last = part.first + part.length - 1
        columns = ((last - x_offset) >> x_bits) - ((part.first - 1 - x_offset) >> x_bits)
        place = part.triangle * offsets + (part.row & (offsets - 1))
        begin = int(place.min(initial=0))
        counts = np.bincount(place - begin, columns)
        covered[begin:begin + len(counts)] += counts.astype(np.int64)
    return covered.reshape(triangles, offsets)


def cards_for_cycles(display_list: DisplayList, cycles: int, **fields: Any) -> str:
    """The cards, with the fewest processing elements and then the fewest memory units, that are
    estimated to draw ``display_list`` in at most ``cycles``.

    ``fields`` of ``MachineConfiguration`` besides the cards and what the list itself gives.
    Raises ``InputError`` where more processing elements no longer help.
    """
    best: tuple[int, str] | None = None
    elements, refused = 1, InputError("")
    while elements <= MOST_ELEMENTS:
        before = best
        for units in UNITS_EACH:
            cards = f"{elements}x(P{'M' * units})" if elements > 1 else "P" + "M" * units
            try:
                machine = MachineConfiguration(
                    cards=cards, width=display_list.width, height=display_list.height,
                    sub_bits=display_list.sub_bits, depth_bits=display_list.depth_bits, **fields)
            except InputError as error:  # so few units do not hold the picture
                refused = error
                continue
            total = estimate_cycles(machine, display_list).total
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
