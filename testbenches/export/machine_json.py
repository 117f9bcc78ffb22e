"""What a user of the exported Verilog has to know, as plain data: the contents of machine.json."""

import re
from collections import Counter
from collections.abc import Callable, Iterator
from importlib.metadata import version
from typing import Any

from amaranth.hdl import Fragment
from amaranth.lib import wiring

from ...golden.merging.cage import sent_pixel_bits
from ...golden.organisations.machine_facts import machine_facts
from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS
from ...hdl.components import COMPONENTS
from ...hdl.machine import Machine
from .port_meanings import described_ports, stated_timing

__all__ = ["component_for", "describe", "memories"]

#: The four boards and those of their parts that state a latency or a throughput.
_TIMED = ("central_broadcast_controller", "processing_element", "memory_unit",
          "video_scan_generator", "fragment_stepper", "interpolator",
          "depth_read_back", "response_link", "survey", "frame_tags", "tag_sweep")
_TIMED_BY_PORTS = {1: ("one_port_depth_test", "one_port_lane", "one_port_memory"),
                   2: ("two_port_depth_test", "two_port_memory")}


_COUNTERS_OF_NODES = ("READ_COUNTERS: after FRAGMENTS and BUSY of a node's processing elements "
                      "SENT, the pixels that its merge card sent for the picture")
_COUNTERS_OF_UNITS = ("READ_COUNTERS: after FRAGMENTS and BUSY of all processing elements TAKEN "
                      "and FOLLOWED of each memory unit: fragments that it took, and how often a "
                      "depth on its way to the memory took the place of what was read for one")


def _inspected(component: wiring.Component, facts: Callable[[wiring.Component], Any]) -> Any:
    """``facts`` of a component that is only looked at; Amaranth wants each elaborated once."""
    found = facts(component)
    Fragment.get(component, None)
    return found


def component_for(configuration: MachineConfiguration, name: str | None) -> wiring.Component:
    """The component of that name as a machine of this configuration has it; None: the machine."""
    return Machine(configuration=configuration) if name is None else COMPONENTS[name](configuration)


def describe(configuration: MachineConfiguration, verilog: str,
             name: str | None = None) -> dict[str, Any]:
    """All about ``verilog``, the text of the component ``name`` (None: of the whole machine).

    Keys: ``version``, ``top``, ``configuration`` (every field, and the picture that results),
    ``ports``, ``number_formats``, ``timing``, ``merging``, ``regions``, ``objects``, ``commands``,
    ``memories``.
    """
    top = name or "machine"
    modules = _modules(verilog)
    walker = "triangle_spans" if configuration.regions is None else "region_spans"
    timed = (name,) if name else (*_TIMED[:4], walker, *_TIMED[4:],
                                  *_TIMED_BY_PORTS[configuration.memory_ports])
    if name is None and configuration.setup == "hardware":
        timed += ("triangle_setup",)
    if name is None and configuration.objects is not None:
        timed += ("mesh_memory", "object_reader", "object_setup")
    if name is None and configuration.forwards_objects:
        timed += ("element_gate", "object_forwarder", "object_reach")
    return {
        "version": version("cardcage"),
        "top": top,
        "configuration": machine_facts(configuration),
        "ports": [*_clock_ports(modules[top]),
                  *_inspected(component_for(configuration, name), described_ports)],
        "number_formats": _number_formats(configuration),
        "timing": {part: _inspected(COMPONENTS[part](configuration), stated_timing)
                   for part in timed},
        "merging": _merging(configuration),
        "regions": _regions(configuration),
        "objects": _objects(configuration),
        "commands": _command_words(configuration),
        "memories": memories(verilog, top),
    }


def _clock_ports(module: str) -> list[dict[str, Any]]:
    """A combinational component has neither."""
    meanings = {"clk": "the one clock; everything happens at its rising edge",
                "rst": "synchronous reset, high for at least one clock; boots the machine"}
    return [{"name": name, "direction": "input", "width": 1, "meaning": meaning}
            for name, meaning in meanings.items() if f"\n  input {name};" in module]


def _number_formats(configuration: MachineConfiguration) -> list[dict[str, Any]]:
    c, fraction = configuration, configuration.fraction_bits
    signed = not c.stays_in_range

    def number(name: str, bits: int, meaning: str, *, signed: bool = False,
               fraction_bits: int = 0) -> dict[str, Any]:
        """``bits`` in all; the sign, if any, counts among the integer bits."""
        return {"name": name, "signed": signed, "bits": bits,
                "integer_bits": bits - fraction_bits, "fraction_bits": fraction_bits,
                "meaning": meaning}

    colors = [number("channel", CHANNEL_BITS, "one colour channel of a pixel")]
    if c.shading == "gouraud":
        colors.append(number("channel_plane", c.channel_plane_bits, signed=signed,
                             fraction_bits=fraction, meaning="a channel as it is interpolated; "
                             "sums wrap, the value at a pixel does not"))
    return [
        number("vertex_coordinate", c.coordinate_bits, "x or y of a vertex, in pixels", signed=True,
               fraction_bits=c.sub_bits),
        number("column", c.x_bits, "pixel column, and one past the last"),
        number("row", c.y_bits, "pixel row, and one past the last"),
        number("edge", c.edge_word_bits, signed=not c.edges_on_screen,
               fraction_bits=c.edge_fraction_bits, meaning="first pixel column not left of an "
               "edge, exact on each of its rows; sums wrap, the column on a row does not"),
        number("depth", c.depth_bits, "stored depth, 0 nearest; the background is all ones"),
        number("tag", c.tag_bits, "tag of a frame, beside each depth and colour; 0 is none's"),
        number("depth_plane", c.depth_plane_bits, signed=signed, fraction_bits=fraction,
               meaning="depth as it is interpolated; sums wrap, the value at a pixel does not"),
        *colors,
        number("unit", c.id_bits, "number of a memory unit, or how many there are"),
        number("address", c.address_bits, "word of a memory unit"),
        *([] if c.merge is None else
          [number("node", c.node_bits, "number of a node, or how many there are")]),
        *([] if not c.round_bits else
          [number("round", c.round_bits, "round in which a node drew a pixel, beside its depth")]),
        *([] if not (c.merges_directly and c.order_bits) else
          [number("drawn_by", c.node_order_bits, "node that drew a pixel, below its round")]),
        *([] if c.regions is None else
          [number("element", c.element_bits, "number of a processing element, or one more"),
           number("slot", c.table_bits, "place of a region in its processing element")]),
        *([] if c.objects is None else
          [number("mesh", c.mesh_bits, "number of a mesh, or of one more than there can be")]),
    ]


def _merging(configuration: MachineConfiguration) -> dict[str, Any] | None:
    """How one picture comes of those of the nodes; None where there is one node."""
    organisation = organisation_of(configuration)
    if not organisation.merges:
        return None
    return {
        "organisation": organisation.name,
        "nodes": organisation.nodes,
        "memory_units_of_each": list(organisation.node_units),
        **({"frame_units": configuration.frame_units} if configuration.snoops else {}),
        "nearer": "least depth, of equal depths the least round, of equal rounds the lowest node",
        "order_bits": configuration.order_bits,
        "packet": configuration.packet,
        "list_words": configuration.list_words,
        "pixel_bits": sent_pixel_bits(configuration),
        "steps": organisation.merge_steps,
        **({"queue": configuration.queue} if configuration.merges_directly else {}),
        "counters": _COUNTERS_OF_UNITS if configuration.merges_directly else _COUNTERS_OF_NODES,
    }


def _regions(configuration: MachineConfiguration) -> dict[str, Any] | None:
    """How regions of the screen are dealt out; None where pixels are interlaced."""
    if configuration.regions is None:
        return None
    regions = configuration.dealt_regions
    return {
        "columns": regions.columns,
        "rows": regions.rows,
        "region_width": 1 << regions.x_bits,
        "region_height": 1 << regions.y_bits,
        "slots": configuration.slots,
        "words_of_a_slot": 1 << configuration.slot_bits,
        "balance": configuration.balance,
        "balancer": configuration.balancer,
        "at_first": "the processing element of a region is its number, row by row, modulo theirs",
        "explained_in": "docs/regions.md",
    }


def _objects(configuration: MachineConfiguration) -> dict[str, Any] | None:
    """Where triangles are made of objects; None where the machine takes triangles only."""
    if configuration.objects is None:
        return None
    return {
        "place": configuration.objects,
        "mesh_triangles": configuration.mesh_triangles,
        "meshes": configuration.meshes,
        "packet_counts": "objects",
        "counters": "READ_COUNTERS: of each place that makes triangles MADE and DROPPED, those "
                    "made of objects and those that set-up dropped there since the frame's start"
                    + ("; then FORWARDED, objects passed left and right"
                       if configuration.forwards_objects else ""),
        "explained_in": "docs/decompositions.md",
    }


def _command_words(configuration: MachineConfiguration) -> dict[str, Any]:
    bodies = {
        commands.Opcode.FRAME_START: commands.frame_start_layout(),
        commands.Opcode.TRIANGLE: commands.triangle_layout(configuration),
        commands.Opcode.PREPARED_TRIANGLE: commands.prepared_triangle_layout(configuration),
        commands.Opcode.LOAD: (
            commands.triangle_layout(configuration) if configuration.setup == "hardware"
            else commands.prepared_triangle_layout(configuration)),
    }
    if configuration.objects is not None:
        bodies |= {
            commands.Opcode.MESH: commands.mesh_layout(configuration),
            commands.Opcode.MESH_TRIANGLE: commands.mesh_triangle_layout(configuration),
            commands.Opcode.OBJECT: commands.object_layout(configuration),
        }
    if configuration.regions is not None:
        bodies[commands.Opcode.REGION] = commands.region_layout(configuration)
    return {
        "version": commands.VERSION,
        "explained_in": "docs/command-words.md",
        "bits": commands.command_bits(configuration),
        "words_of_32_bits": commands.command_words(configuration),
        "opcode": {"offset": 0, "width": commands.OPCODE_BITS},
        "opcodes": [
            {"name": opcode.name, "opcode": int(opcode),
             "fields": list(_fields(bodies.get(opcode, {}), commands.BODY_OFFSET))}
            for opcode in commands.Opcode
        ],
        "responses": {
            "bits": commands.layout_bits(commands.RESPONSE_LAYOUT),
            "fields": list(_fields(commands.RESPONSE_LAYOUT, 0)),
            "kinds": [
                {"name": kind.name, "kind": int(kind),
                 "fields": list(_fields(commands.RESPONSE_FIELDS[kind],
                                        commands.RESPONSE_KIND_BITS))}
                for kind in commands.ResponseKind
            ],
            "faults": [{"name": fault.name, "value": int(fault)} for fault in commands.Fault],
        },
    }


def _fields(layout: commands.Layout, offset: int,
            prefix: str = "") -> Iterator[dict[str, str | int]]:
    """Every plain field with its place in the word."""
    for name, entry in layout.items():
        if isinstance(entry, int):
            yield {"name": prefix + name, "offset": offset, "width": entry}
            offset += entry
        else:
            yield from _fields(entry, offset, f"{prefix}{name}.")
            offset += commands.layout_bits(entry)


def _modules(verilog: str) -> dict[str, str]:
    return {found[1]: found[0] for found in
            re.finditer(r"^module (\S+?)\(.*?^endmodule", verilog, re.DOTALL | re.MULTILINE)}


def memories(verilog: str, top: str = "machine") -> list[dict[str, Any]]:
    """The memory modules of a Verilog text, and how often each is instantiated below ``top``."""
    modules = _modules(verilog)
    counts = Counter({top: 1})
    waiting = [top]
    while waiting:  # each level of the hierarchy adds to the one below
        for instance in re.findall(r"^  (\S+) \S+ \($", modules[waiting.pop()], re.MULTILINE):
            if instance in modules:
                counts[instance] += 1
                waiting.append(instance)
    return [
        {"module": name, "words": int(words), "bits": int(bits), "instances": counts[name],
         "contents_at_power_on": "unknown"}
        for words, bits, name in re.findall(
            r"^// (\d+) words of (\d+) bits.*\nmodule (\w+)", verilog, re.MULTILINE)
    ]
