"""Which regions an object can meet, and who must hear of it."""

from typing import NamedTuple

from amaranth.hdl import *
from amaranth.lib import data

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration

__all__ = ["Routes", "object_bits", "reach_layout", "reaching_object_layout", "routes",
           "run_layout"]


def object_bits(configuration: MachineConfiguration) -> int:
    """Bits of what of an object is passed on: all but the element that is given it, which comes
    last in its command."""
    return commands.layout_bits(commands.object_layout(configuration)) - configuration.element_bits


def reach_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A rectangle of regions: columns ``left`` to ``right``, rows ``top`` to ``bottom``, both ends
    included."""
    regions = configuration.dealt_regions
    return data.StructLayout({
        "left": regions.column_bits, "right": regions.column_bits,
        "top": regions.row_bits, "bottom": regions.row_bits,
    })


def reaching_object_layout(configuration: MachineConfiguration,
                           object_bits: int) -> data.StructLayout:
    """An object of so many bits, whatever they are, and the regions that it can meet."""
    return data.StructLayout({"object": object_bits, "reach": reach_layout(configuration)})


def run_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """The run of regions of a processing element.

    ``first``  row and column of the first region that is its own or a later element's
    ``last``   of the last one that is its own or an earlier element's
    ``none_from``, ``none_to``  there is no such region

    A place as a number is less, the sooner its region comes row by row.  An element without regions
    has its ``first`` after its ``last``.
    """
    regions = configuration.dealt_regions
    place = data.StructLayout({"column": regions.column_bits, "row": regions.row_bits})
    return data.StructLayout({"first": place, "last": place, "none_from": 1, "none_to": 1})


class Routes(NamedTuple):
    """Who draws something of an object: this element, some that come before it, some after it."""

    here: Value
    before: Value
    after: Value


def routes(run: data.View, reach: data.View) -> Routes:
    """By the regions of an object and the run of an element.

    The object meets a region of an earlier element if the first region that it meets comes before
    the run, of a later one if the last does after it.  It meets one of the run's own if the first
    one that it meets, from the beginning of the run on, is not past the run's end.
    """
    first = Cat(reach.left, reach.top)
    last = Cat(reach.right, reach.bottom)
    begin, end = Value.cast(run.first), Value.cast(run.last)
    column, row = run.first.column, run.first.row
    # From the run's beginning on, where that comes after the first region met: in its row from its
    # column or the rectangle's left side on, or else in the row below.
    inside_row = column <= reach.right
    along = Cat(Mux(column < reach.left, reach.left, column), row)
    below = Cat(reach.left, (row + 1)[:len(row)])
    sooner = first >= begin
    met = Mux(sooner, first, Mux(inside_row, along, below))
    some = sooner | Mux(inside_row, row <= reach.bottom, row < reach.bottom)
    return Routes(
        here=some & (met <= end) & ~run.none_from & ~run.none_to,
        before=run.none_from | (first < begin),
        after=run.none_to | (last > end),
    )
