"""The machine as files for other people's tools: Verilog, its description, lint waivers."""

from __future__ import annotations

import json
import textwrap
from contextlib import ExitStack
from dataclasses import dataclass, fields
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

from ...golden.specification.card_order import CARD_MODULES, MERGING_CARDS
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError
from ...golden.specification.fields.making import NO_OBJECTS
from ..machine_options import (
    MachineOptions,
    machine_for_scene,
    machine_without_scene,
    option_words,
    resolution_warnings,
)
from ..support.any_characters import readable
from ..support.atomic_output import atomic_file, output_errors
from ..support.counted import counted
from ..views.asked_views import AskedViews, machine_for_frames

#: Fields that the Verilog's header tells only of machines that have what they ask for.
_SAID_WHERE_ON = ("lines", *NO_OBJECTS)

#: What can be exported alone: the boards, then their parts (``hdl.components``, which loads
#: Amaranth and so is not asked here).
COMPONENT_NAMES = (
    "central_broadcast_controller", *(
        module for letter, module in CARD_MODULES.items() if letter not in MERGING_CARDS),
    "video_scan_generator", *(CARD_MODULES[letter] for letter in MERGING_CARDS),
    "balancer", "band_probes", "band_scan", "broadcast_queue", "crossbar", "depth_read_back",
    "direct_element", "direct_element_control", "divider", "drawn_map", "edge_columns",
    "edge_setup", "element_gate", "forwarding_element", "fragment_queue", "fragment_stepper",
    "frame_tags", "id_increment", "interpolator", "large_visits", "lattice_block", "least_loaded",
    "memory_bus_selector", "merge_sorter", "mesh_memory", "nearest_word", "object_forwarder",
    "object_reach", "object_reader", "object_setup", "one_port_depth_test", "one_port_lane",
    "one_port_memory", "own_columns", "own_regions", "picture_maps", "pipelined_multiplier",
    "pixel_address", "pixel_box", "plane_setup", "processing_element_control", "region_address",
    "region_clip", "region_counts", "region_order", "region_places", "region_rows",
    "region_scan_address",
    "region_spans", "region_table", "region_visits",
    "response_link", "result_queue", "round_robin", "sampling_grid", "scan_address", "span_clip",
    "survey", "tag_sweep", "triangle_outline", "triangle_rows", "triangle_setup", "triangle_spans",
    "two_port_depth_test", "two_port_memory", "unit_counters", "unit_feed", "unit_pixel",
    "vertex_sort",
)


#: Verilator's lint rules that do not apply, with reasons; copied beside every export.
WAIVERS = files(__package__) / "machine.vlt"


@dataclass(frozen=True)
class Export:
    """What was written.

    ``verilog``, ``description``, ``waivers``  the files
    ``top``        the top module
    ``lines``      of Verilog
    ``precision``  why the interpolants have their fraction bits
    ``warnings``   one line each
    """

    configuration: MachineConfiguration
    verilog: Path
    description: Path
    waivers: Path
    top: str
    lines: int
    precision: str
    warnings: tuple[str, ...]


def export(output: str | Path, scene: str | Path | None = None, *, component: str | None = None,
           frames: int | None = None, turn: float | None = None, path: str | Path | None = None,
           **options: Any) -> Export:
    """Write a machine as Verilog, its description as JSON and Verilator's lint waivers.

    ``output``     the Verilog, a ``.v`` file; the others lie beside it: ``.json`` and ``.vlt``
    ``scene``      its numbers are as wide as this scene needs; None: every triangle on the screen
                   is drawn exactly
    ``component``  one of ``COMPONENT_NAMES`` alone; None: the whole machine
    ``frames``, ``turn``, ``path``  several pictures of the scene, as of ``render_frames``: its
                   numbers are as wide as all of them need
    ``options``    the fields of ``MachineOptions``: ``cards``, ``size`` and the others that the
                   command line has

    The same arguments write the same bytes.  Raises ``InputError`` for whatever cannot be used or
    written; then nothing has changed.

    >>> import cardcage
    >>> exported = cardcage.export("machine.v", "tetra:depth=0", cards="PM", size=(16, 16))
    >>> exported.top, exported.verilog.name, exported.description.name
    ('machine', 'machine.v', 'machine.json')
    """
    asked = AskedViews(frames, turn, None if path is None else Path(path))
    return _export(Path(output), scene, MachineOptions(**options), asked, component)


def _export(output: Path, scene: str | Path | None, options: MachineOptions, asked: AskedViews,
            component: str | None) -> Export:
    if output.suffix != ".v":
        raise InputError(f"-o: {output} does not end in .v, as a Verilog file should")
    if component is not None and component not in COMPONENT_NAMES:
        raise InputError(f"component: {component!r} is none of {', '.join(COMPONENT_NAMES)}")
    description, waivers = output.with_suffix(".json"), output.with_suffix(".vlt")
    with ExitStack() as written:
        places = [written.enter_context(atomic_file(target, "-o"))
                  for target in (output, description, waivers)]
        configuration, notes, subject = _machine(scene, options, asked)
        precision = _precision(configuration, options, subject)
        text, facts = _translated(configuration, component)
        words = ["cardcage export", *([] if scene is None else [_name_alone(scene)]),
                 *option_words(options), *asked.words(_name_alone),
                 *(["--component", component] if component else [])]
        text = _header(configuration, words, component, precision) + text
        contents = (text, json.dumps(facts | {"precision": precision}, indent=1) + "\n",
                    WAIVERS.read_text("utf-8"))
        with output_errors(output, "-o"):
            for place, content in zip(places, contents, strict=True):
                place.write_text(readable(content), encoding="utf-8", newline="\n")
    return Export(configuration, output, description, waivers, facts["top"], text.count("\n"),
                  precision, (*notes, *resolution_warnings(configuration)))


def _machine(scene: str | Path | None, options: MachineOptions, asked: AskedViews
             ) -> tuple[MachineConfiguration, tuple[str, ...], str]:
    """With the scene's notes, and what it draws."""
    if scene is None:
        asked.check_no_scene()
        return machine_without_scene(options), (), "every triangle whose vertices are on the screen"
    lists = asked.lists(scene, options)
    if lists is None:
        loaded, configuration = machine_for_scene(scene, options)
        return configuration, loaded.notes, _name_alone(scene)
    return (machine_for_frames(lists, options), lists.first.notes,
            f"each of {counted(len(lists), 'picture')} of {_name_alone(scene)}")


def export_summary(exported: Export) -> str:
    """What the command line says of it."""
    c = exported.configuration
    return "\n".join((
        f"{exported.verilog}: module {exported.top}, {exported.lines:,} lines of Verilog",
        f"{exported.description}: ports, number formats, timing, command words",
        f"{exported.waivers}: lint waivers for Verilator",
        f"machine: {c.cards}, {c.width}x{c.height}, {c.words} words a memory unit, {c.shading}",
        f"fraction bits: {exported.precision}",
    ))


def _translated(configuration: MachineConfiguration, component: str | None
                ) -> tuple[str, dict[str, Any]]:
    # They load Amaranth: only those who export wait for it.
    from .machine_json import component_for, describe
    from .verilog import component_verilog, machine_verilog

    if component is None:
        text = machine_verilog(configuration)
    else:
        text = component_verilog(component_for(configuration, component), component)
    return text, describe(configuration, text, component)


def _precision(configuration: MachineConfiguration, options: MachineOptions, subject: str) -> str:
    bits = configuration.fraction_bits
    if options.max_error:
        return f"{bits}, at most {options.max_error} LSB of depth off for {subject}"
    if options.machine().get("fraction_bits") is not None:
        source = "asked for" if options.fraction_bits is not None else "the preset's"
        return f"{bits}, {source}"
    return f"{bits}, exact for {subject}"


def _name_alone(file: str | Path) -> str:
    """A file without its folder: the same file gives the same text wherever it lies."""
    return str(file).replace("\\", "/").rpartition("/")[2]


def _header(configuration: MachineConfiguration, words: list[str], component: str | None,
            precision: str) -> str:
    built = ", ".join(f"{field.name} {getattr(configuration, field.name)}"
                      for field in fields(configuration) if field.name != "timing"
                      and (field.name not in _SAID_WHERE_ON or getattr(configuration, field.name)))
    paragraphs = [
        f"Cardcage {version('cardcage')}: {component or 'machine'}, made by",
        "  " + " ".join(" ".join(words).split()),
        f"Configuration: {built}.",
        f"Fraction bits: {precision}.",
        "One clock, clk; rst is synchronous. Streams pass a word in a clock in which valid and "
        "ready are high. No memory has initial contents. The .json beside this file explains every "
        "port.",
    ]
    return "".join(f"// {line}\n" for paragraph in paragraphs
                   for line in textwrap.wrap(paragraph, 96, subsequent_indent="    ",
                                             drop_whitespace=True, break_long_words=False)) + "\n"
