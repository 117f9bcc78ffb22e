"""What a display list asks of a machine: the fewest bits of every word, and why.

Every width is one at which the picture is the same as on a machine for all the
guard band: words that are summed modulo a power of two need only hold the values
that count, which are those on an edge's own rows and at covered pixels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation_of import organisation_of
from ..reference.triangle_setup import Edges, Outlines, outline
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from ..specification.fixed_point import error_bound, exact_fraction_bits
from ..specification.sampling_grid import Grid
from ..specification.widths import fewest_edge_fraction_bits
from .node_needs import NodeNeeds

Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class SceneNeeds:
    """The numbers of a display list that decide how wide a machine must be.

    ``triangles``            in the list
    ``drawn``                those that may cover a pixel centre; all that follows is about them,
                             but for ``coordinates``
    ``flat``                 each triangle has one colour
    ``sub_bits``             the list's own
    ``width``                of the picture, at the machine's resolution
    ``x_bits``               of a column at the highest resolution
    ``coordinates``          least and greatest vertex coordinate, in sub-pixel units
    ``columns``              least and greatest column on a row of an edge
    ``edge_height``          of the highest edge, in sub-pixel units
    ``edge_rows_height``     the greatest product of an edge's height and the rows it has
    ``greatest_depth``       of a vertex
    ``greatest_channel``     of a vertex's colour
    ``extent``               the largest triangle's, right and down together, in pixels
    ``widest``, ``tallest``  columns and rows of the widest and of the tallest box
    ``exact_fraction_bits``  at which every triangle is exact, because of the one with
    ``exact_double_area``    this doubled area in square sub-pixel units, and
    ``exact_extent``         this extent
    """

    triangles: int
    drawn: int
    flat: bool
    sub_bits: int
    width: int
    x_bits: int
    coordinates: tuple[int, int]
    columns: tuple[int, int]
    edge_height: int
    edge_rows_height: int
    greatest_depth: int
    greatest_channel: int
    extent: int
    widest: int
    tallest: int
    exact_fraction_bits: int
    exact_double_area: int
    exact_extent: int

    @property
    def coordinate_bits(self) -> int:
        return _signed_bits(*self.coordinates)

    @property
    def edge_column_bits(self) -> int:
        """Bits of a column on an edge: an unsigned one where none is off the screen, else a signed
        one, which has more."""
        low, high = self.columns
        if low >= 0 and high <= self.width:
            return max(1, high.bit_length())
        return max(_signed_bits(low, high), self.x_bits + 1)

    @property
    def edge_height_bits(self) -> int:
        return max(1, self.edge_height.bit_length())

    @property
    def edge_fraction_bits(self) -> int:
        return fewest_edge_fraction_bits(self.edge_height, self.edge_rows_height)

    def error(self, fraction_bits: int) -> int:
        """The most by which a stored depth or channel is off."""
        if fraction_bits >= self.exact_fraction_bits:
            return 0
        return ceil(error_bound(fraction_bits, self.extent))

    def depth_integer_bits(self, machine: MachineConfiguration) -> int:
        """Integer bits of carried depth.

        At a covered pixel it lies between the depths of the vertices, but for its error; whatever
        the sums come to on the way, modulo a power of two they end there.  Only the size and the
        fraction bits of ``machine`` matter.
        """
        return self._integer_bits(machine, self.greatest_depth)

    def channel_integer_bits(self, machine: MachineConfiguration) -> int:
        """Integer bits of a carried colour channel, likewise."""
        return self._integer_bits(machine, self.greatest_channel)

    def _integer_bits(self, machine: MachineConfiguration, greatest: int) -> int:
        if machine.stays_in_range:
            return max(1, greatest.bit_length())
        error = self.error(machine.fraction_bits)
        return _signed_bits(-error, greatest + error)


def combined(each: Sequence[SceneNeeds]) -> SceneNeeds:
    """The needs of a machine that draws several lists, of one size and with as many sub-pixel bits,
    one after another."""
    decisive = max(each, key=lambda needs: needs.exact_fraction_bits)

    def ends(name: str) -> tuple[int, int]:
        lows, highs = zip(*(getattr(needs, name) for needs in each), strict=True)
        return min(lows), max(highs)

    greatest = {name: max(getattr(needs, name) for needs in each) for name in (
        "triangles", "drawn", "edge_height", "edge_rows_height", "greatest_depth",
        "greatest_channel", "extent", "widest", "tallest")}
    return replace(decisive, flat=all(needs.flat for needs in each),
                   coordinates=ends("coordinates"), columns=ends("columns"), **greatest)


def scene_needs(display_list: DisplayList, *, x_shift: int = 0, y_shift: int = 0) -> SceneNeeds:
    """The needs of ``display_list`` at the resolution ``Grid.of`` gives."""
    grid = Grid.of(display_list, x_shift, y_shift)
    outlines = outline(display_list, grid)
    boxes, edges = outlines.boxes, _used_edges(outlines)
    extent = boxes.extent
    # Below 2**44 * 2**13.
    product = boxes.double_area * (1 + extent)
    decisive = int(product.argmax()) if len(product) else None
    area, reach = ((0, 0) if decisive is None else
                   (int(boxes.double_area[decisive]), int(extent[decisive])))
    position = display_list.position
    return SceneNeeds(
        triangles=display_list.triangles,
        drawn=len(product),
        flat=display_list.flat,
        sub_bits=display_list.sub_bits,
        width=grid.width,
        x_bits=display_list.width.bit_length(),
        coordinates=_ends(position),
        columns=_ends(np.concatenate([columns for edge in edges for columns in edge.ends()])),
        edge_height=max(int(edge.height.max(initial=1)) for edge in edges),
        edge_rows_height=max(int((edge.height * edge.rows).max(initial=1)) for edge in edges),
        greatest_depth=int(display_list.depth[boxes.primitive].max(initial=0)),
        greatest_channel=int(display_list.color[boxes.primitive].max(initial=0)),
        extent=int(extent.max(initial=0)),
        widest=int((boxes.right - boxes.left).max(initial=0)),
        tallest=int((boxes.bottom - boxes.top).max(initial=0)),
        exact_fraction_bits=0 if decisive is None else exact_fraction_bits(area, reach),
        exact_double_area=area,
        exact_extent=reach,
    )


@dataclass(frozen=True, eq=False)
class _UsedEdges:
    """The long, upper or lower edges that have rows; int64 (n,) each."""

    edges: Edges
    used: Int64
    rows: Int64

    @property
    def height(self) -> Int64:
        return self.edges.denominator[self.used]

    def ends(self) -> tuple[Int64, Int64]:
        """Columns on the first and on the last row: no other row's are smaller or greater."""
        column, step, remainder, remainder_step = (
            part[self.used] for part in (self.edges.column, self.edges.column_step,
                                         self.edges.remainder, self.edges.remainder_step))
        more = self.rows - 1
        # Both products below 2**37: a step is at most the guard band, the rows the screen.
        carried = (remainder + remainder_step * more) // self.height
        return column, np.asarray(column + step * more + carried)


def _used_edges(outlines: Outlines) -> list[_UsedEdges]:
    boxes, middle = outlines.boxes, outlines.middle
    found = []
    for edges, rows in ((outlines.long, boxes.bottom - boxes.top),
                        (outlines.upper, middle - boxes.top),
                        (outlines.lower, boxes.bottom - middle)):  # fmt: skip
        used = np.flatnonzero(rows > 0)
        found.append(_UsedEdges(edges, used, rows[used]))
    return found


def _ends(values: NDArray[Any]) -> tuple[int, int]:
    return (int(values.min()), int(values.max())) if values.size else (0, 0)


def _signed_bits(low: int, high: int) -> int:
    """The width of a two's complement number that holds ``low`` … ``high``."""
    return 1 + max((-1 - low).bit_length() if low < 0 else 0, high.bit_length())


def fewest_sub_bits(display_list: DisplayList) -> int:
    """Sub-pixel bits that are left, at least one, when all coordinates are halved while even."""
    together = int(np.bitwise_or.reduce(display_list.position, axis=None, initial=0))
    zeros = (together & -together).bit_length() - 1 if together else display_list.sub_bits
    return display_list.sub_bits - min(zeros, display_list.sub_bits - 1)


def with_sub_bits(display_list: DisplayList, sub_bits: int) -> DisplayList:
    """The same triangles in units of ``2**-sub_bits`` pixel.

    Its exact picture is the same.  ``InputError`` where a vertex would move.
    """
    more = sub_bits - display_list.sub_bits
    if more == 0:
        return display_list
    if sub_bits < (needed := fewest_sub_bits(display_list)):
        raise InputError(f"display list: sub_bits {needed}, the machine is built for {sub_bits}: "
                         "export a machine for this list")
    position = display_list.position << more if more > 0 else display_list.position >> -more
    return replace(display_list, position=position, sub_bits=sub_bits)


def fitted(configuration: MachineConfiguration, display_list: DisplayList) -> DisplayList:
    """``display_list`` in the formats of a machine, for ``triangle_setup.prepare`` and
    ``bit_true.draw``.

    Raises ``InputError``, naming the field and both numbers, for a list whose picture that
    machine could not draw: other sizes or depths, words too narrow for a triangle, or, in a cage
    of nodes, too few to keep ties in order or to hold the largest share.  Fewer fraction bits
    than the list needs are no error: they are what makes a picture approximate.
    """
    def refuse(field: str, needed: int, built: int) -> InputError:
        return InputError(f"display list: {field} {needed}, the machine is built for {built}: "
                          "export a machine for this list")

    for field in ("width", "height", "depth_bits"):
        needed, built = getattr(display_list, field), getattr(configuration, field)
        if needed != built:
            raise refuse(field, needed, built)
    display_list = with_sub_bits(display_list, configuration.sub_bits)
    needs = scene_needs(display_list, **organisation_of(configuration).resolution.shifts)
    bits = configuration.fraction_bits
    for field, needed in (
        ("coordinate_bits", needs.coordinate_bits),
        ("edge_column_bits", needs.edge_column_bits),
        ("edge_height_bits", needs.edge_height_bits),
        ("edge_fraction_bits", needs.edge_fraction_bits),
        ("depth_plane_bits", needs.depth_integer_bits(configuration) + bits),
        ("channel_plane_bits", needs.channel_integer_bits(configuration) + bits),
    ):
        if field == "channel_plane_bits" and configuration.shading == "flat":
            continue
        if needed > (built := getattr(configuration, field)):
            raise refuse(field, needed, built)
    if configuration.merge is not None:
        nodes = NodeNeeds(configuration, display_list, needs.exact_fraction_bits)
        for field, needed, reason, remedy in nodes.lacks(configuration):
            raise InputError(f"display list: {field} {needed} {reason}, the machine is built for "
                             f"{getattr(configuration, field)}: {remedy}")
    return display_list
