"""Structures of the command and broadcast words, built from the shared tables."""

from amaranth.hdl import *
from amaranth.lib import data, enum

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration

__all__ = [
    "ObjectOperation",
    "Operation",
    "broadcast_layout",
    "object_word_layout",
    "outline_layout",
    "planes_layout",
    "prepared_triangle_layout",
    "response_fields",
    "response_layout",
    "response_value",
    "row_shape",
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
    # To merge cards alone, which keep lists for their nodes.
    LOAD = 6  # keep one prepared triangle
    DRAW_LISTS = 7  # have your processing elements draw all that you keep
    CLEAR_LISTS = 0  # keep nothing
    # In the place of one that only cages of nodes have, where regions are dealt out.
    READ_REGIONS = 6  # send your count of each slot since the last frame start
    # In the place of one that only cages with lists have, where triangles are made of objects.
    MAKE = 7  # one of ObjectOperation


class ObjectOperation(enum.Enum, shape=3):
    """What is said to those who make triangles of objects, beside an ``Operation``."""

    CLEAR = 0  # forget all meshes
    MESH = 1  # begin the next one
    MESH_TRIANGLE = 2  # it has this one
    OBJECT = 3  # make, set up and draw the triangles of one
    TRIANGLE = 4  # set up and draw this one, as it is in the display list


def struct_layout(layout: commands.Layout) -> data.StructLayout:
    """A layout table as an Amaranth structure, first field in the lowest bits."""
    return data.StructLayout({
        name: unsigned(entry) if isinstance(entry, int) else struct_layout(entry)
        for name, entry in layout.items()
    })


def prepared_triangle_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """All that a processing element is told of a triangle."""
    return struct_layout(commands.prepared_triangle_layout(configuration))


def outline_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A prepared triangle without its interpolants: rows, columns and edges."""
    layout = prepared_triangle_layout(configuration).members
    return data.StructLayout({name: shape for name, shape in layout.items()
                              if name not in ("planes", "node")})


def row_shape(configuration: MachineConfiguration) -> Shape:
    """A row, or one that a processing element would own next, past the picture's end."""
    beyond = (configuration.maximum_units + 1) << configuration.square_bits
    return Shape.cast(range(configuration.height + beyond))


def walked_outline_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """An outline, and above it what of the processing element's pixels is known early.

    ``first_row``   the first owned row, where the domain is one lattice
    ``second_row``  the one after it
    ``one_row``     that is past the triangle's end

    Where regions are dealt out, instead:

    ``own``         which of the box's at most 2 × 2 regions are its own, row by row
    ``large``       the box has more regions, of which nothing is known
    """
    if configuration.regions is not None:
        return data.StructLayout({**outline_layout(configuration).members, "own": 4, "large": 1})
    return data.StructLayout({**outline_layout(configuration).members,
                              "first_row": row_shape(configuration),
                              "second_row": row_shape(configuration),
                              "one_row": 1})


def planes_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """The interpolants of a prepared triangle."""
    return struct_layout(commands.planes_layout(configuration))


def broadcast_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One broadcast word: an operation and its body; ``make`` only where boards that hear it make
    triangles of objects."""
    made = configuration.objects in ("nodes", "elements")
    return data.StructLayout({
        "operation": Operation,
        "body": data.UnionLayout({
            "draw": prepared_triangle_layout(configuration),
            **({"make": object_word_layout(configuration)} if made else {}),
        }),
    })


def object_word_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """What is said to those who make triangles of objects: an operation, and its body as in the
    command of that name."""
    return data.StructLayout({
        "operation": ObjectOperation,
        "body": data.UnionLayout({
            "mesh": struct_layout(commands.mesh_layout(configuration)),
            "mesh_triangle": struct_layout(commands.mesh_triangle_layout(configuration)),
            "object": struct_layout(commands.object_layout(configuration)),
            "triangle": struct_layout(commands.triangle_layout(configuration)),
        }),
    })


def response_layout() -> data.StructLayout:
    """One response word: its kind, a ``ResponseKind``, and its value."""
    return struct_layout(commands.RESPONSE_LAYOUT)


def response_fields(kind: commands.ResponseKind, value: Value) -> data.View:
    """The value of a response, by field."""
    return data.View(struct_layout(commands.RESPONSE_FIELDS[kind]), value)


def response_value(kind: commands.ResponseKind, **fields: Value) -> Value:
    """The value of a response from all of its fields, each extended or cut to its width."""
    return Cat(fields[name][:bits] if len(fields[name]) > bits else fields[name] | C(0, bits)
               for name, bits in commands.RESPONSE_FIELDS[kind].items())


def span_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A run of pixels of one row of a triangle: where it starts and how many pixels it has.

    ``x``, ``y``        first pixel, at the machine's resolution
    ``end``             column that its last pixel lies before
    ``left``            the triangle's first column, from which interpolants count
    ``y_steps``         rows from the triangle's first one, likewise
    ``stride``          distance between neighbouring pixels of the run; where regions are dealt
                        out it is 1, and in its place is
    ``slot``            where their region lies
    ``none``            no pixel at all
    ``last``            nothing of the triangle follows
    """
    return data.StructLayout({
        "x": unsigned(configuration.x_bits),
        "y": unsigned(configuration.y_bits),
        "end": unsigned(configuration.x_bits),
        "left": unsigned(configuration.x_bits),
        "y_steps": unsigned(configuration.y_bits),
        **({"stride": range(configuration.maximum_units + 1)} if configuration.regions is None
           else {"slot": configuration.table_bits}),
        "none": 1,
        "last": 1,
    })
