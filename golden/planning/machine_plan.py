"""The smallest machine for a display list, and the reason for each of its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..organisations.organisation_of import organisation_of
from ..specification.commands import layout_bits, prepared_triangle_layout
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from ..specification.fixed_point import (
    check_max_error,
    error_bound,
    error_fraction_bits,
    on_screen_fraction_bits,
)
from .node_plan import check_given, fields_of_nodes, lines_of_nodes, needs_of_nodes
from .object_needs import fields_of_objects, lines_of_objects, most_of, needs_of_objects
from .plan_line import PlanLine
from .scene_needs import SceneNeeds, combined, fewest_sub_bits, scene_needs, with_sub_bits

#: What a processing element holds in waiting where there is enough to hold.
FIFO_DEPTH = MachineConfiguration.fifo_depth


@dataclass(frozen=True)
class Plan:
    """``configuration`` is the machine, ``full`` the one for every triangle on the screen;
    ``lines`` explain the difference, ``needs`` has the numbers behind them."""

    configuration: MachineConfiguration
    full: MachineConfiguration
    needs: SceneNeeds
    lines: tuple[PlanLine, ...]


def plan(display_list: DisplayList | Sequence[DisplayList], *, cards: str, max_error: int = 0,
         fraction_bits: int | None = None, retain: bool = False, **rest: Any) -> Plan:
    """The machine that draws ``display_list`` with the least hardware, on these cards.

    ``display_list``   or several, of one format, that one machine draws one after another

    ``max_error``      LSB by which a depth may be off; 0 is exact
    ``fraction_bits``  None: the fewest for ``max_error``
    ``retain``         the nodes have list memories, which hold the whole list
    ``rest``           further fields of ``MachineConfiguration``, which are then not planned;
                       ``width``, ``height`` and ``depth_bits`` must be those of the list, and
                       ``sub_bits``, always the fewest, is none of them

    Coverage is exact in any case, and the exact picture is the same as on the machine
    for the whole screen.  The stored depth keeps the list's ``depth_bits``, since the
    background's depth is part of the picture.  The plan is for the resolution that the
    memory holds: with units pulled out, ``scene_needs.fitted`` decides whether the list
    still fits.  In a cage of nodes pixels carry an order only where nodes tie.  Raises
    ``InputError``.

    >>> import cardcage
    >>> scene = cardcage.make_display_list("tetra:depth=0", width=16, height=16)
    >>> planned = cardcage.plan(scene.display_list, cards="PM")
    >>> planned.configuration.shading, len(planned.lines)
    ('flat', 13)
    """
    check_max_error(max_error)
    if fraction_bits is not None and max_error:
        raise InputError("max error: the fraction bits are given as well; leave one of them out")
    lists = [display_list] if isinstance(display_list, DisplayList) else display_list
    if not lists:
        raise InputError("display list: none is given; a machine is planned for one at least")
    # Lists may be made anew each time they are asked for.
    makes = rest.get("objects") is not None
    formats = [({name: getattr(each, name) for name in ("width", "height", "depth_bits")},
                each.sub_bits, fewest_sub_bits(each), each.flat,
                needs_of_objects(each) if makes else None) for each in lists]
    pictures, own, fewest, flat, made = zip(*formats, strict=True)
    objects = most_of(made) if makes else None
    if objects is not None:
        rest |= fields_of_objects(objects, rest)
        fewest = (*fewest, objects.sub_bits)
    picture = pictures[0]
    for name, given in picture.items():
        if rest.pop(name, given) != given:
            raise InputError(f"{name}: the display list has {given}; a plan is for the list's own")
        if any(each[name] != given for each in pictures):
            raise InputError(f"{name}: the display lists differ; one machine has one, take lists "
                             "that are alike")
    own_sub_bits, sub_bits = max(own), max(fewest)
    fixed = {"cards": cards, **picture}
    rest = {"shading": "flat" if all(flat) else "gouraud"} | rest
    machine = MachineConfiguration(**fixed, sub_bits=sub_bits, fraction_bits=fraction_bits or 0,
                                   **rest)
    shifts = organisation_of(machine).resolution.shifts
    each_needs, shared = [], []
    for each in lists:
        finer = with_sub_bits(each, sub_bits)
        each_needs.append(scene_needs(finer, **shifts))
        if machine.merge is not None:
            shared.append(finer)
    needs = combined(each_needs)
    if fraction_bits is None:
        fraction_bits = needs.exact_fraction_bits
        if max_error:
            fraction_bits = min(fraction_bits, error_fraction_bits(needs.extent, max_error))
    machine = replace(machine, fraction_bits=fraction_bits)
    nodes = needs_of_nodes(machine, shared, needs.exact_fraction_bits, retain)
    asked = {name: value for name, value in rest.items() if name != "shading"}
    planned = replace(machine, **_fewest(needs, machine) | asked
                      | fields_of_nodes(nodes, retain, rest))
    full = MachineConfiguration(
        **fixed, sub_bits=own_sub_bits, words=planned.words,
        clocks_per_pixel=planned.clocks_per_pixel, timing=planned.timing,
        maximum_units=planned.maximum_units, allow_orphans=planned.allow_orphans,
        packet=planned.packet, maximum_nodes=planned.maximum_nodes, regions=planned.regions,
        slots=planned.slots if planned.regions else 0, balance=planned.balance,
        balancer=planned.balancer,
        fraction_bits=on_screen_fraction_bits(planned.width, planned.height, own_sub_bits,
                                              max_error))
    lines = _lines(planned, full, needs, max_error, len(lists) > 1)
    if objects is not None:
        lines += lines_of_objects(planned, objects)
    if nodes:
        check_given(planned, nodes)
        lines += lines_of_nodes(planned, full, nodes, rest.get("order_bits"))
    return Plan(planned, full, needs, tuple(lines))


def _fewest(needs: SceneNeeds, machine: MachineConfiguration) -> dict[str, int]:
    """The widths that hold every triangle of the list."""
    return {
        "coordinate_bits": needs.coordinate_bits,
        "edge_column_bits": needs.edge_column_bits,
        "edge_height_bits": needs.edge_height_bits,
        "edge_fraction_bits": needs.edge_fraction_bits,
        "depth_integer_bits": needs.depth_integer_bits(machine),
        "channel_integer_bits": needs.channel_integer_bits(machine),
        # One triangle is drawn, and all the others can wait behind it.
        "fifo_depth": min(FIFO_DEPTH, max(2, needs.drawn + 1)),
    }


def triangle_bits(configuration: MachineConfiguration) -> int:
    """Bits of a triangle as it is broadcast, waits in a FIFO and is held while it is drawn."""
    return layout_bits(prepared_triangle_layout(configuration))


def _lines(planned: MachineConfiguration, full: MachineConfiguration, needs: SceneNeeds,
           max_error: int, several: bool) -> list[PlanLine]:
    unit = 1 << planned.sub_bits

    def bits(item: str, name: str, reason: str, **also: Any) -> PlanLine:
        """A width of the configuration; ``also`` changes with it."""
        value, before = getattr(planned, name), getattr(full, name)
        changed = replace(full, **{name: value} | also)
        return PlanLine(item, str(value), str(before), reason,
                        triangle_bits(full) - triangle_bits(changed))

    low, high = (f"{coordinate / unit:g}" for coordinate in needs.coordinates)
    drops = full.sub_bits - planned.sub_bits
    width, height, *_ = organisation_of(planned).resolution
    return [
        bits("sub-pixel bits", "sub_bits",
             f"every coordinate is a multiple of {1 << drops}/{unit << drops} pixel" if drops else
             f"some coordinate is an odd multiple of 1/{unit} pixel" if planned.sub_bits > 1 else
             "pixel centres need one",
             coordinate_bits=0, edge_column_bits=0, edge_height_bits=0, edge_fraction_bits=0),
        bits("coordinate bits", "coordinate_bits", f"vertices lie from {low} to {high} pixels"),
        bits("edge column bits", "edge_column_bits",
             "edges cross columns {} to {}".format(*needs.columns)),
        bits("edge height bits", "edge_height_bits",
             f"the highest edge is {needs.edge_height:,}/{unit} pixel high", edge_fraction_bits=0),
        bits("edge fraction bits", "edge_fraction_bits",
             "an edge's height in sub-pixels, times the rows it is followed down, is at most "
             f"{needs.edge_rows_height:,}"),
        _stored_depth(planned, needs),
        bits("fraction bits", "fraction_bits", _precision(planned, needs, max_error)),
        _integer("depth", planned, full, needs.greatest_depth, needs),
        _integer("channel", planned, full, needs.greatest_channel, needs),
        _interpolants(planned, full, needs),
        PlanLine("lines", "none", "none", "the scene has triangles only: no line stepper"),
        *_regions(planned),
        PlanLine("words a memory unit", f"{planned.words:,}", f"{full.words:,}",
                 f"{width}x{height} pixels over {planned.units} units"
                 if planned.regions is None else
                 f"{planned.slots} slots, each of {1 << planned.slot_bits} words of a region"),
        PlanLine("FIFO depth", str(planned.fifo_depth), str(full.fifo_depth),
                 # The most of each, which need not be of the same list.
                 f"up to {needs.drawn:,} of a picture's up to {needs.triangles:,} triangles may "
                 "cover a pixel" if several else
                 f"{needs.drawn:,} of {needs.triangles:,} triangles may cover a pixel"),
    ]


def _regions(planned: MachineConfiguration) -> list[PlanLine]:
    """Where they are dealt out: what does not depend on the scene."""
    if planned.regions is None:
        return []
    regions = planned.dealt_regions
    size = f"{1 << regions.x_bits}x{1 << regions.y_bits}"
    slots, even = planned.slots, regions.even_share(planned.processing_elements)
    return [PlanLine(name, value, value, reason) for name, value, reason in (
        ("regions", f"{regions.columns}x{regions.rows}", f"asked for; {size} pixels each"),
        ("slots", str(slots), f"regions that each of {planned.processing_elements} processing "
         f"elements has room for; an even share is {even}"))]


def _stored_depth(planned: MachineConfiguration, needs: SceneNeeds) -> PlanLine:
    fits = needs.greatest_depth.bit_length()
    reason = f"the picture's format: its background lies at depth {planned.depth_background:,}"
    if fits < planned.depth_bits:
        reason += f"; {fits} would hold the vertices"
    return PlanLine("stored depth bits", str(planned.depth_bits), str(planned.depth_bits), reason)


def _precision(planned: MachineConfiguration, needs: SceneNeeds, max_error: int) -> str:
    bits = planned.fraction_bits
    if bits == needs.exact_fraction_bits:
        return (f"exact: a triangle of doubled area {needs.exact_double_area:,} sub-pixels reaches "
                f"{needs.exact_extent} pixels, right and down")
    error = float(error_bound(bits, needs.extent))
    source = f"at most {max_error:,} LSB asked for" if max_error else "asked for"
    return (f"{source}: a triangle reaches {needs.extent} pixels, right and down, and then errs by "
            f"up to {error:.3g}; exact from {needs.exact_fraction_bits}")


def _integer(name: str, planned: MachineConfiguration, full: MachineConfiguration,
             greatest: int, needs: SceneNeeds) -> PlanLine:
    """The bits of carried depth or of a carried channel above its binary point."""
    widths = [getattr(machine, f"{name}_plane_bits") - machine.fraction_bits
              for machine in (planned, full)]
    if name == "channel" and planned.shading == "flat":
        return PlanLine("channel integer bits", "-", str(widths[1]), "no channel is interpolated")
    error = 0 if planned.stays_in_range else needs.error(planned.fraction_bits)
    changed = replace(full, **{f"{name}_integer_bits": widths[0]})
    return PlanLine(
        f"{name} integer bits", str(widths[0]), str(widths[1]),
        f"a vertex has up to {greatest:,}" + (f", off by up to {error:,}" if error else "")
        + ("" if planned.stays_in_range else ", and a sign"),
        triangle_bits(full) - triangle_bits(changed))


def _interpolants(planned: MachineConfiguration, full: MachineConfiguration,
                  needs: SceneNeeds) -> PlanLine:
    named = {"flat": "depth", "gouraud": "depth, colour"}
    if planned.shading == "flat":
        reason = ("every triangle has one colour" if needs.flat else
                  "flat shading asked for") + ": no colour interpolator"
    else:
        reason = "some triangle has more than one colour" if not needs.flat else "asked for"
    saves = triangle_bits(full) - triangle_bits(replace(full, shading=planned.shading))
    return PlanLine("interpolants", named[planned.shading], named[full.shading], reason, saves)
