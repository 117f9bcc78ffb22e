"""Structures of the command and broadcast words, built from the shared tables."""

from amaranth.hdl import *
from amaranth.lib import data, enum

from ..golden import commands
from ..golden.configuration import MachineConfiguration

__all__ = [
    "Operation",
    "broadcast_layout",
    "operation_layout",
    "outline_layout",
    "planes_layout",
    "prepared_triangle_layout",
    "response_layout",
    "span_layout",
    "struct_layout",
    "walked_outline_layout",
]


class Operation(enum.Enum, shape=3):
    """What the central broadcast controller can tell every processing element at once."""

    SURVEY = 1  # find the memory units of your domain and report them
    FRAME_START = 2  # count from here on
    DRAW = 3  # rasterise one prepared triangle
    READ_DEPTH = 4  # send every depth word of your domain
    READ_COUNTERS = 5  # send your counts since the last frame start


def struct_layout(layout: commands.Layout) -> data.StructLayout:
    """A layout table as an Amaranth structure, first field in the lowest bits."""
    return data.StructLayout({
        name: unsigned(entry) if isinstance(entry, int) else struct_layout(entry)
        for name, entry in layout.items()
    })


def prepared_triangle_layout(configuration: MachineConfiguration) -> data.StructLayout:
    return struct_layout(commands.prepared_triangle_layout(configuration))


def outline_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A prepared triangle without its interpolants: rows, columns and edges."""
    layout = prepared_triangle_layout(configuration).members
    return data.StructLayout({name: shape for name, shape in layout.items() if name != "planes"})


def walked_outline_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """An outline, and above it the first row of a processing element's lattice."""
    return data.StructLayout({**outline_layout(configuration).members,
                              "first_row": unsigned(configuration.y_bits)})


def planes_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """The interpolants of a prepared triangle."""
    return struct_layout(commands.planes_layout(configuration))


def operation_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A broadcast word as it waits in a processing element, interpolants elsewhere."""
    return data.StructLayout({
        "operation": Operation,
        "triangle": walked_outline_layout(configuration),
    })


def broadcast_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One broadcast word: an operation and its body."""
    return data.StructLayout({
        "operation": Operation,
        "body": data.UnionLayout({"draw": prepared_triangle_layout(configuration)}),
    })


def response_layout() -> data.StructLayout:
    return data.StructLayout({
        "kind": unsigned(commands.RESPONSE_KIND_BITS),
        "value": unsigned(commands.RESPONSE_VALUE_BITS),
    })


def span_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A run of pixels of one row of a triangle: where it starts and how many pixels it has.

    ``x``, ``y``        first pixel, at the machine's resolution
    ``x_steps``         pixel columns from the triangle's origin to it
    ``y_steps``         pixel rows from the triangle's origin to it
    ``more``            pixels after the first
    ``x_stride_bits``   log2 of the distance between neighbouring pixels of the run
    ``none``            no pixel at all
    ``last``            nothing of the triangle follows
    """
    return data.StructLayout({
        "x": unsigned(configuration.x_bits),
        "y": unsigned(configuration.y_bits),
        "x_steps": unsigned(configuration.x_bits),
        "y_steps": unsigned(configuration.y_bits),
        "more": unsigned(configuration.x_bits),
        "x_stride_bits": range(configuration.maximum_units.bit_length()),
        "none": 1,
        "last": 1,
    })
