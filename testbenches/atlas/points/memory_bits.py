"""The bits of a machine's memories, by its configuration alone.

``comparison.cage_memory`` counts them in the Verilog, which takes seconds for each machine.  Here
pictures, lists, maps and frame units are exact; queues, a few per cent of the rest, are counted by
what is in them, some bits off.  A test holds the sum to the Verilog of every kind of cage.
"""

from __future__ import annotations

from ....golden.cycles.objects.object_setup import OBJECTS_WAITING as OBJECTS_BEFORE_READER
from ....golden.planning.machine_plan import triangle_bits
from ....golden.specification.card_order import MEMORY_UNIT, TREE_MERGE
from ....golden.specification.commands import (
    layout_bits,
    mesh_layout,
    mesh_triangle_layout,
    object_layout,
    triangle_layout,
)
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.queues import OBJECTS_PASSING, OBJECTS_WAITING, OUTLINES_WAITING
from ....golden.specification.ranges import COLOR_BITS
from ...frames.setup_timing import setup_timing
from .object_link import passed_object_bits

#: Bits of a word of a map of what was drawn, and of its summary.
MAP_WORD = 64

#: An element knows that much more of a waiting triangle: where it begins in its lattice.
KNOWN_BITS = 15

#: Spans that wait between walker and fragments, and their bits beside the ends.
SPANS, SPAN_BITS = 16, 28

#: Accesses that wait before a memory of one port, and their bits beside a pixel.
ACCESSES, ACCESS_BITS = 15, 13

#: Places of a queue of a crossbar.
CROSSBAR_PLACES = 2

#: Bits of an outline beside its vertices, its box and its area.
OUTLINE_BITS = 14


def memory_bits(configuration: MachineConfiguration) -> dict[str, int]:
    """What for → bits, of all boards: ``pictures``, ``lists``, ``meshes``, ``maps``,
    ``frame_units``, ``queues``, ``tables``."""
    units = configuration.cards.count(MEMORY_UNIT)
    return {
        "pictures": units * configuration.words * word_bits(configuration),
        "lists": configuration.nodes * configuration.list_words * _kept_bits(configuration),
        "meshes": makers(configuration) * _mesh_bits(configuration),
        "maps": units * _map_bits(configuration),
        "frame_units": _frame_bits(configuration),
        "queues": _queue_bits(configuration, units) + _making_bits(configuration),
        "tables": _table_bits(configuration),
    }


def word_bits(configuration: MachineConfiguration) -> int:
    """Of a word of a memory unit: depth and two colours, or two pictures of depth and colour, each
    part with its tag.  Of one port all parts have the width of the widest."""
    tag, rank = configuration.tag_bits, configuration.rank_bits
    parts = ([rank + COLOR_BITS + tag] * 2 if configuration.keeps_two_depths
             else [rank + tag, COLOR_BITS + tag, COLOR_BITS + tag])
    return sum(parts) if configuration.memory_ports == 2 else len(parts) * max(parts)


def _kept_bits(configuration: MachineConfiguration) -> int:
    """Of a triangle in its node, which needs no number of it any more."""
    return triangle_bits(configuration) - configuration.node_bits


def makers(configuration: MachineConfiguration) -> int:
    """How many places make triangles of objects."""
    return {None: 0, "controller": 1, "nodes": configuration.nodes,
            "elements": configuration.processing_elements}[configuration.objects]


def _mesh_bits(configuration: MachineConfiguration) -> int:
    """Of all meshes, where one place keeps them: triangles, a flat machine's with one colour;
    where each mesh begins and how many it has; and, where objects are passed on, its box."""
    triangle = layout_bits(mesh_triangle_layout(configuration)) - _unused(configuration)
    last = configuration.mesh_triangles - 1
    entry = last.bit_length() + (last + 1).bit_length()
    if configuration.forwards_objects:
        entry += layout_bits(mesh_layout(configuration))
    return configuration.mesh_triangles * triangle + configuration.meshes * entry


def _unused(configuration: MachineConfiguration) -> int:
    """Of three vertices the colours that a flat machine does not look at."""
    return 2 * COLOR_BITS if configuration.shading == "flat" else 0


def _making_bits(configuration: MachineConfiguration) -> int:
    """Of the queues where triangles of objects are made: objects, outlines, triangles whose parts
    are on their way, and objects that come from the host and from both neighbours."""
    timing = setup_timing(configuration) if configuration.objects is not None else None
    if timing is None:
        return 0
    vertices = layout_bits(triangle_layout(configuration))
    box = 3 * configuration.y_bits + 2 * configuration.x_bits
    outline = (vertices - _unused(configuration) + box + 2 * configuration.coordinate_bits
               + OUTLINE_BITS)
    entry = 1 + max(vertices, layout_bits(object_layout(configuration)))
    # The last one of each queue is in a register.
    found = ((OBJECTS_BEFORE_READER - 1) * entry + (OUTLINES_WAITING - 1) * outline
             + (timing.inside - 1) * triangle_bits(configuration))
    if configuration.forwards_objects:
        found += (OBJECTS_WAITING + 2 * OBJECTS_PASSING) * passed_object_bits(configuration)
    return makers(configuration) * found


def _map_bits(configuration: MachineConfiguration) -> int:
    """Of a unit's maps of what was drawn; two where one picture merges while another is drawn."""
    if not (configuration.sends_drawn or configuration.snoops):
        return 0
    words = -(-configuration.words // MAP_WORD)
    one = (words + -(-words // MAP_WORD)) * MAP_WORD
    return one * (2 if configuration.snoops else 1)


def _frame_bits(configuration: MachineConfiguration) -> int:
    """Two colours, and no depth."""
    if not configuration.snoops:
        return 0
    one = configuration.frame.words * (COLOR_BITS + configuration.tag_bits)
    return 2 * one * configuration.frame_units


def _queue_bits(configuration: MachineConfiguration, units: int) -> int:
    elements = configuration.processing_elements
    waiting = max(configuration.fifo_depth, 3) - 1
    spans = SPANS * (configuration.x_bits + configuration.y_bits + SPAN_BITS)
    found = elements * (waiting * (_kept_bits(configuration) + KNOWN_BITS) + spans)
    pixel = configuration.rank_bits + COLOR_BITS
    if configuration.memory_ports == 1:
        found += units * ACCESSES * (pixel + ACCESS_BITS)
    if configuration.merges_directly:
        queues = 1 if configuration.queue == "element" else units
        found += elements * queues * CROSSBAR_PLACES * 4 * (pixel + configuration.address_bits)
    if configuration.sends_drawn or configuration.snoops:
        sent = pixel + configuration.address_bits
        found += units * (2 * configuration.address_bits + 3 * sent)
        if configuration.merge == TREE_MERGE:
            found += configuration.nodes * 2 * (sent + configuration.id_bits)
    return found


def _table_bits(configuration: MachineConfiguration) -> int:
    """Where regions are dealt out: who draws each, for two pictures, in every element and in the
    scan generator; and the counts."""
    if configuration.regions is None:
        return 0
    regions = configuration.dealt_regions.count
    elements = configuration.processing_elements
    slot = configuration.table_bits + 1
    shown = 2 * regions * (configuration.element_bits + slot)
    counts = configuration.slots * 32 * 2 if configuration.balance != "static" else 0
    return shown + elements * (2 * regions * (slot + 2) + counts)
