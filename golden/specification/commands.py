"""The words between the host and the central broadcast controller, version 4.

One place for the layout: the hardware builds its structures from these tables,
the host packs and reads its words with them, ``machine.json`` lists them, and
``docs/command-words.md`` describes them.
A command is one word on the command stream; in a file it is ``command_words``
32-bit words, least significant first.  The opcode is in the low ``OPCODE_BITS``
bits, the fields follow from ``BODY_OFFSET`` upwards without gaps.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, TypeAlias

from .configuration import MachineConfiguration
from .ranges import CHANNEL_BITS

VERSION = 4
OPCODE_BITS = 4
BODY_OFFSET = 8
WORD_BITS = 32
CHANNELS = ("red", "green", "blue")
EDGES = ("long", "upper", "lower")

#: Field name → bits, or a nested layout; in order, from the least significant bit.
Layout: TypeAlias = "dict[str, int | Layout]"


class Opcode(IntEnum):
    """What the host can ask for."""

    FRAME_START = 1  # the back picture is the background colour throughout
    TRIANGLE = 2  # vertices, for the machine with set-up in hardware
    PREPARED_TRIANGLE = 3  # increments computed by the host
    FRAME_END = 4  # finish the picture, show it from the next scan on
    READ_DEPTH = 5  # send every word of the depth buffer
    READ_COUNTERS = 6  # send the work of every processing element, and what each node sent
    # Only where nodes have list memories:
    LOAD = 7  # what TRIANGLE or PREPARED_TRIANGLE has, for the list of its node
    DRAW_LISTS = 8  # each node draws all that is in its list
    CLEAR_LISTS = 9  # all lists are empty
    # Only where regions of the screen are dealt out:
    REGION = 10  # give the next region, row by row, to a processing element; not inside a frame
    READ_REGIONS = 11  # send what was counted of each slot of every processing element
    READ_TABLE = 12  # send the table that the machine has made for the next picture
    # Only where the machine makes triangles of objects, of which CLEAR_LISTS clears the meshes:
    MESH = 13  # begin the next mesh, with its box
    MESH_TRIANGLE = 14  # vertices of the mesh begun last, about its own origin
    OBJECT = 15  # make and draw the triangles of a mesh, moved and coloured


class ResponseKind(IntEnum):
    """What the machine answers: ``RESPONSE_KIND_BITS`` of kind below ``RESPONSE_VALUE_BITS`` of
    value, whose fields are in ``RESPONSE_FIELDS``."""

    DOMAIN = 1  # at boot, per processing element: its memory units
    UNITS = 2  # at boot: units in some domain, units in the cage
    PICTURE = 3  # at boot: the machine's own resolution
    BOOTED = 4  # at boot: cycles from reset until both pictures were black
    FRAME_DRAWN = 5  # cycles from the frame start to the last processing element's done
    FRAME_SHOWN = 6  # scans that began with the old picture since the frame start
    DEPTH = 7  # one word of the depth buffer, units in order, addresses ascending
    FRAGMENTS = 8  # per processing element: fragments tested since the frame start
    BUSY = 9  # per processing element: cycles it drew since the frame start
    ERROR = 10  # one of Fault
    NODE = 11  # at boot, per node: its number, and the memory units it draws into
    NODES = 12  # at boot, where there are nodes: how many
    MERGED = 13  # where there are: cycles from the frame start to the merged picture
    SENT = 14  # per node: pixels its merge card has sent for the picture merged last
    FRAME_UNITS = 15  # at boot, where nodes send to frame units: how many there are
    TAKEN = 16  # per memory unit behind a direct merge: fragments it took since the frame start
    FOLLOWED = 17  # times that a depth on its way to the memory took the place of one read there
    REGION_COUNT = 18  # per processing element and slot: its count since the frame start
    TABLE_ENTRY = 19  # per region, row by row: its processing element in the next picture
    MADE = 20  # per place that makes triangles of objects: those made since the frame start
    DROPPED = 21  # likewise: triangles that set-up dropped there, which have no pixel
    FORWARDED = 22  # per processing element that passes objects on: those passed left, and right


class Fault(IntEnum):
    """The value of an ``ERROR`` response."""

    UNKNOWN_COMMAND = 1  # this opcode is not, or not yet, built in
    UNITS_UNSUPPORTED = 2  # the number of memory units, or of frame units, is no power of two, or
    # shares that must be equal are not, or frame units do not hold the picture: nothing is drawn
    NODES_DIFFER = 3  # nodes have different numbers of memory units: nothing is drawn
    LIST_FULL = 4  # a list memory has no room for what was loaded; nothing of the lists is drawn;
    # likewise of a mesh memory, and of objects
    REGION_TO_NOBODY = 5  # no such processing element, or a region was left out: the table that
    # was there before stays, as with the next three
    REGION_TWICE = 6  # a region that the table has already
    NO_SLOT = 7  # more regions than the processing element has room for
    TABLE_LATE = 8  # a region after the frame start
    NO_MESH = 9  # an object's mesh was not loaded: it is not drawn


def fault_text(value: int) -> str:
    """The value of an ``ERROR`` response as people read it: number and, where it has one, name."""
    return f"{value} ({Fault(value).name})" if value in list(Fault) else str(value)


RESPONSE_KIND_BITS = 8
RESPONSE_VALUE_BITS = 32

#: The word itself.
RESPONSE_LAYOUT: Layout = {"kind": RESPONSE_KIND_BITS, "value": RESPONSE_VALUE_BITS}

#: What the value of each kind is made of.  Numbers of units, and a picture's sides, fit in half.
_HALF = RESPONSE_VALUE_BITS // 2
RESPONSE_FIELDS: dict[ResponseKind, Layout] = {
    ResponseKind.DOMAIN: {"units": _HALF, "first": _HALF},
    ResponseKind.UNITS: {"total": _HALF, "owned": _HALF},
    ResponseKind.PICTURE: {"width": _HALF, "height": _HALF},
    ResponseKind.BOOTED: {"cycles": RESPONSE_VALUE_BITS},
    ResponseKind.FRAME_DRAWN: {"cycles": RESPONSE_VALUE_BITS},
    ResponseKind.FRAME_SHOWN: {"scans": RESPONSE_VALUE_BITS},
    ResponseKind.DEPTH: {"depth": RESPONSE_VALUE_BITS},
    ResponseKind.FRAGMENTS: {"fragments": RESPONSE_VALUE_BITS},
    ResponseKind.BUSY: {"cycles": RESPONSE_VALUE_BITS},
    ResponseKind.ERROR: {"fault": RESPONSE_VALUE_BITS},
    ResponseKind.NODE: {"units": _HALF, "node": _HALF},
    ResponseKind.NODES: {"nodes": RESPONSE_VALUE_BITS},
    ResponseKind.MERGED: {"cycles": RESPONSE_VALUE_BITS},
    ResponseKind.SENT: {"pixels": RESPONSE_VALUE_BITS},
    ResponseKind.FRAME_UNITS: {"units": RESPONSE_VALUE_BITS},
    ResponseKind.TAKEN: {"fragments": RESPONSE_VALUE_BITS},
    ResponseKind.FOLLOWED: {"fragments": RESPONSE_VALUE_BITS},
    ResponseKind.REGION_COUNT: {"count": RESPONSE_VALUE_BITS},
    ResponseKind.TABLE_ENTRY: {"element": RESPONSE_VALUE_BITS},
    ResponseKind.MADE: {"triangles": RESPONSE_VALUE_BITS},
    ResponseKind.DROPPED: {"triangles": RESPONSE_VALUE_BITS},
    ResponseKind.FORWARDED: {"left": _HALF, "right": _HALF},
}


def plane_layout(bits: int) -> Layout:
    """An interpolant: its value at the bounding box's corner, its steps per pixel."""
    return {"start": bits, "step_x": bits, "step_y": bits}


def edge_layout(configuration: MachineConfiguration) -> Layout:
    """An edge's columns, row by row: in fixed point, exact on every row.  Its numbers are what
    ``golden.reference.triangle_setup.carry_edges`` gives."""
    return dict.fromkeys(("start", "step"), configuration.edge_word_bits)


def planes_layout(configuration: MachineConfiguration) -> Layout:
    """What is interpolated over a triangle, or constant on it."""
    layout: Layout = {"depth": plane_layout(configuration.depth_plane_bits)}
    for channel in CHANNELS:
        layout[channel] = (CHANNEL_BITS if configuration.shading == "flat"
                           else plane_layout(configuration.channel_plane_bits))
    return layout | _round(configuration)


def _round(configuration: MachineConfiguration) -> Layout:
    """The round in which a triangle's node draws it; only where pixels keep it."""
    return {"round": configuration.round_bits} if configuration.round_bits else {}


def _node(configuration: MachineConfiguration) -> Layout:
    """The node that draws a triangle; only where there are nodes."""
    return {"node": configuration.node_bits} if configuration.node_bits else {}


def prepared_triangle_layout(configuration: MachineConfiguration) -> Layout:
    """The body of ``PREPARED_TRIANGLE``; also what is broadcast to the processing elements, then
    with ``top`` and ``bottom`` held to the picture's height."""
    rows, columns = configuration.y_bits, configuration.x_bits
    return {
        "top": rows, "middle": rows, "bottom": rows, "left": columns, "right": columns,
        "long_edge_left": 1,
        **{edge: edge_layout(configuration) for edge in EDGES},
        "planes": planes_layout(configuration),
        **_node(configuration),
    }


def list_word_bits(configuration: MachineConfiguration) -> int:
    """Bits of a triangle in a list memory: all that is broadcast of it but its node."""
    return layout_bits(prepared_triangle_layout(configuration)) - configuration.node_bits


def triangle_layout(configuration: MachineConfiguration) -> Layout:
    """The body of ``TRIANGLE``: three vertices as in the display list."""
    return {**mesh_triangle_layout(configuration), **_round(configuration), **_node(configuration)}


def mesh_triangle_layout(configuration: MachineConfiguration) -> Layout:
    """The body of ``MESH_TRIANGLE``: three vertices about the mesh's own origin, in the fields of
    ``TRIANGLE``; in place of colours they have shades."""
    vertex = _place(configuration) | dict.fromkeys(CHANNELS, CHANNEL_BITS)
    return {f"vertex_{corner}": vertex for corner in range(3)}


def _place(configuration: MachineConfiguration) -> Layout:
    return {"x": configuration.coordinate_bits, "y": configuration.coordinate_bits,
            "depth": configuration.depth_bits}


def mesh_layout(configuration: MachineConfiguration) -> Layout:
    """The body of ``MESH``: its box about its own origin, in sub-pixel units."""
    return dict.fromkeys(("left", "top", "right", "bottom"), configuration.coordinate_bits)


def object_layout(configuration: MachineConfiguration) -> Layout:
    """The body of ``OBJECT``: which mesh, what is added to each of its vertices modulo their
    fields, and the colour that its shades modulate; where processing elements pass objects on, the
    one that is given it."""
    return {"mesh": configuration.mesh_bits, **_place(configuration),
            **dict.fromkeys(CHANNELS, CHANNEL_BITS),
            **_round(configuration), **_node(configuration),
            **({"element": configuration.element_bits} if configuration.forwards_objects else {})}


def frame_start_layout() -> Layout:
    """The body of ``FRAME_START``: the background colour."""
    return dict.fromkeys(CHANNELS, CHANNEL_BITS)


def region_layout(configuration: MachineConfiguration) -> Layout:
    """The body of ``REGION``: which region, and the number of its processing element, for which
    there are bits enough to name one that is not there."""
    regions = configuration.dealt_regions
    return {"column": regions.columns.bit_length(), "row": regions.rows.bit_length(),
            "element": configuration.element_bits}


def layout_bits(layout: Layout) -> int:
    return sum(entry if isinstance(entry, int) else layout_bits(entry)
               for entry in layout.values())


def command_words(configuration: MachineConfiguration) -> int:
    """32-bit words that one command takes in a file."""
    objects = [] if configuration.objects is None else [object_layout(configuration)]
    bits = BODY_OFFSET + max(layout_bits(layout) for layout in (
        prepared_triangle_layout(configuration), triangle_layout(configuration),
        frame_start_layout(), *objects))
    return -(-bits // WORD_BITS)


def command_bits(configuration: MachineConfiguration) -> int:
    return command_words(configuration) * WORD_BITS


def pack(layout: Layout, values: Any) -> Any:
    """Lay ``values`` (a nested dict of integers, or of object arrays of them) out as ``layout``
    says, each taken modulo its field."""
    word: Any = 0
    offset = 0
    for name, entry in layout.items():
        if isinstance(entry, int):
            word = word + ((values[name] & ((1 << entry) - 1)) << offset)
            offset += entry
        else:
            word = word + (pack(entry, values[name]) << offset)
            offset += layout_bits(entry)
    return word


def unpack(layout: Layout, word: Any) -> dict[str, Any]:
    """The inverse of ``pack``: ``word``, an integer or an array of them, taken apart."""
    values: dict[str, Any] = {}
    for name, entry in layout.items():
        bits = entry if isinstance(entry, int) else layout_bits(entry)
        part = word & ((1 << bits) - 1)
        values[name] = part if isinstance(entry, int) else unpack(entry, part)
        word = word >> bits
    return values


def command(opcode: Opcode, body: int = 0) -> int:
    return int(opcode) | body << BODY_OFFSET


def frame_start(background: tuple[int, int, int]) -> int:
    return command(Opcode.FRAME_START,
                   pack(frame_start_layout(), dict(zip(CHANNELS, background, strict=True))))


def with_opcode(word: int, opcode: Opcode) -> int:
    """A command with the same body."""
    return word - opcode_of(word) + int(opcode)


def opcode_of(word: int) -> int:
    """The opcode of a command, which need not be one of ``Opcode``."""
    return word & ((1 << OPCODE_BITS) - 1)


def unpack_response(word: int) -> tuple[int, int]:
    """The kind, which need not be one of ``ResponseKind``, and the value."""
    return word & ((1 << RESPONSE_KIND_BITS) - 1), word >> RESPONSE_KIND_BITS


def response_value(kind: ResponseKind, **fields: int) -> int:
    """The value of a response, from all of its fields."""
    return int(pack(RESPONSE_FIELDS[kind], fields))


def response_fields(kind: ResponseKind, value: Any) -> dict[str, Any]:
    """The fields of a response's value, or arrays of them of an array of values."""
    return unpack(RESPONSE_FIELDS[kind], value)
