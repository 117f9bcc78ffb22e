"""Which of the broadcast triangles concern a processing element."""

from typing import NamedTuple

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import row_shape
from ..mapping.lattice import first_owned, lattice_layout, next_owned, rows_mask

__all__ = ["Share", "ShareFilter"]


class Share(NamedTuple):
    """What a ``ShareFilter`` finds of a triangle.

    ``first_row``  the first owned row that is not above it, in the clock in which it comes
    ``keep``       it is to be kept, ``ShareFilter.latency`` clocks later
    """

    first_row: Value
    keep: Value


class ShareFilter:
    """Keeps the triangles that may have pixels of this processing element, and drops the others.

    A triangle whose bounding box holds no pixel of the domain's lattice is dropped.
    Where the domain is no single lattice all are kept.  Where the rows of the lattice are
    shifted, a triangle is kept if some row owns a column of its box.

    This is no component, but adds its signals to the module of the ``BroadcastQueue`` that
    uses it: that costs no hierarchy and no cell, so a machine without further filters
    stays as it is.  What has to be known for the decision are ``members``, which become
    members of the queue and are connected by the processing element.  So another filter
    brings its inputs as ``members``, its registers in ``add_to``, and what it has found out as
    ``known``, as the ``RegionFilter`` does; the queue is not touched.

    Latency: ``latency`` clock, for which the queue holds the triangle in a register.
    Throughput: a triangle a clock.

    Members
    -------
    lattice: In(lattice_layout), whole: In(1)
        The pixels of the domain, where it is one block of units.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What it has to be told, besides the triangle."""
        return {"lattice": In(lattice_layout(self.configuration)), "whole": In(1)}

    def add_to(self, m: Module, triangle: data.View, inputs) -> Share:
        """Put the filter into ``m``.

        ``triangle`` is a prepared triangle that may be another one in every clock; ``inputs`` has
        the ``members`` as attributes.
        """
        lattice, square_bits = inputs.lattice, self.configuration.square_bits
        first_row = first_owned(triangle.top, lattice.y_offset, lattice.y_mask, square_bits)
        first_column = first_owned(triangle.left, lattice.x_offset,
                                   rows_mask(lattice, self.configuration), square_bits)
        in_rows = Signal()
        in_columns = Signal()
        m.d.sync += [
            in_rows.eq(first_row < triangle.bottom),
            in_columns.eq(first_column < triangle.right),
        ]
        return Share(first_row, ~inputs.whole | (in_rows & in_columns))

    def known(self, m: Module, share: Share, kept: data.View, inputs) -> Value:
        """What goes with the outline ``kept`` into the queue, as in ``walked_outline_layout``:
        ``latency`` clocks after the ``share`` was found of it."""
        kept_row = Signal(row_shape(self.configuration), name="kept_row", reset_less=True)
        second_row = Signal(row_shape(self.configuration), name="second_row", reset_less=True)
        m.d.sync += kept_row.eq(share.first_row)
        m.d.comb += second_row.eq(next_owned(kept_row, inputs.lattice.y_mask,
                                             self.configuration.square_bits))
        return Cat(kept_row, second_row, second_row >= kept.bottom)
