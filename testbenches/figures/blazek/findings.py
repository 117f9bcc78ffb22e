"""What the figures say beyond his claims: sentences, made of the numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .claims import MOST, NEARLY
from .his_machine.costs import COSTS, MICROSECOND
from .his_machine.methods import Scene
from .his_machine.sensitivity import (
    BYTE,
    SCREEN,
    SPHERES,
    TESSELLATING,
    Sensitivity,
    axis_of,
)
from .his_machine.times import BROADCAST_STRIPS, LINES, NODE, STRIPS, USUAL_HOST
from .our_machine.clocks import Clocks
from .our_machine.in_rtl import Point
from .scenes.spheres import SPHERES as ALL_SPHERES
from .scenes.spheres import Size


def findings(sensitivity: Sequence[Sensitivity], clocks: Mapping[str, Clocks],
             points: Sequence[Point], size: Size) -> list[str]:
    """Of both machines."""
    return [*_of_his(sensitivity, size), *_of_ours(clocks), *_of_points(points)]


def _of_his(sensitivity: Sequence[Sensitivity], size: Size) -> list[str]:
    by_axis = {each.axis: each.speed_up for each in sensitivity}
    speed, method, axis, place = max(
        (speed, method, axis, place) for axis, found in by_axis.items()
        for method in (LINES, BROADCAST_STRIPS) for place, speed in enumerate(found[method]))
    free = by_axis[TESSELLATING]
    scene = Scene.of(size, 0, 1)
    drawn, sending = float(scene.polygon_drawing.mean()), COSTS.byte * COSTS.polygon_bytes
    pixels = scene.template.whole.pixels.sum() / scene.template.polygons
    meetings = scene.work(MOST, "lines").polygons.sum() / scene.template.polygons
    share = (1 / NEARLY - 1) / (MOST - 1 / NEARLY)
    lines = [
        f"Whatever cost is changed while the others stay, broadcast comes to a speed-up of "
        f"{speed:.1f} on {MOST} nodes at best: {method}, {axis} {axis_of(axis).values[place]:g} "
        f"{axis_of(axis).unit}, where node initiated has {by_axis[axis][NODE][place]:.1f} "
        f"({SPHERES} spheres).",
        f"Were drawing shared out evenly and nothing else to cost anything, a broadcast on {MOST} "
        f"nodes that is {NEARLY:g} of perfect needs tessellating to take {100 * share:.1f} % of "
        f"drawing: {share * drawn / MICROSECOND:.1f} µs a polygon.  By chapter V it takes longer "
        f"than to send one, {sending / MICROSECOND:.0f} µs.  Both hold only where drawing a "
        f"polygon takes {1000 * sending / share:.0f} ms or more: of "
        f"{float(f'{pixels:.2g}'):g} pixels here.",
        f"Even where tessellating is all but free ({axis_of(TESSELLATING).values[0]:g} µs) "
        f"interlaced lines come to a speed-up of {free[LINES][0]:.1f} on {MOST} nodes: a polygon "
        f"is set up by each node that has a line of it, {meetings:.1f} on average.  Strips come to "
        f"{free[BROADCAST_STRIPS][0]:.1f}.",
    ]
    byte = axis_of(BYTE)
    usual, tenth = (by_axis[BYTE][NODE][byte.values.index(each)]
                    for each in (byte.usual, byte.usual / 10))
    host = by_axis[BYTE][USUAL_HOST]
    lines.append(
        f"Merging whole frame buffers at {byte.usual:g} µs a byte is what holds node initiated "
        f"back: {usual:.1f} on {MOST} nodes, {tenth:.1f} at a tenth of that, nearer to the "
        "2.8 megabytes a second of an iPSC/2's links.  Host initiated would gain little: "
        f"{host[byte.values.index(byte.usual / 10)]:.1f}.")
    screen = axis_of(SCREEN).values.index(128)
    strips = by_axis[SCREEN][STRIPS][screen]
    lines.append(
        "He does not print how large his pictures were, and that matters as much: on a screen of "
        f"128 × 128 node initiated comes to {by_axis[SCREEN][NODE][screen]:.1f}, and his order "
        f"comes out but for broadcast: forwarding {strips:.1f} by strips, broadcast "
        f"{by_axis[SCREEN][LINES][screen]:.1f}, host initiated "
        f"{by_axis[SCREEN][USUAL_HOST][screen]:.1f}.")
    return lines


def _of_ours(clocks: Mapping[str, Clocks]) -> list[str]:
    spheres = ALL_SPHERES[-1]
    node, host = clocks["node initiated"], clocks["host initiated, 100"]
    lines = clocks["broadcast, lines"]
    order = sorted(clocks, key=lambda name: clocks[name].time(spheres, MOST))
    fastest, merging = clocks[order[0]], node.merging(spheres, MOST)
    return [
        f"Of ours {order[0]} draws {spheres:,} spheres on {MOST} nodes in the fewest clocks: "
        f"{fastest.time(spheres, MOST):,.0f}, a speed-up of {fastest.speed_up(spheres, MOST):.1f}; "
        f"then come {order[1]} ({clocks[order[1]].time(spheres, MOST):,.0f}) and {order[2]} "
        f"({clocks[order[2]].time(spheres, MOST):,.0f}).",
        f"Node initiated draws {host.drawing(spheres, MOST) / node.drawing(spheres, MOST):.1f} "
        f"times as fast as host initiated there, in {node.drawing(spheres, MOST):,.0f} clocks, a "
        f"speed-up of {node.drawing(spheres, 1) / node.drawing(spheres, MOST):.1f}; then its tree "
        f"merges for {merging:,.0f}, {100 * merging / node.time(spheres, MOST):.0f} % of the "
        "frame.",
        "Made in one place, triangles come one in three clocks, however many elements there are, "
        "as by his host, or as all his nodes tessellate all objects: broadcast by lines and host "
        f"initiated draw in {lines.drawing(spheres, MOST):,.0f} and "
        f"{host.drawing(spheres, MOST):,.0f} clocks.",
        "A list of objects keeps those elements waiting in whose parts of the screen none of the "
        f"objects lies that come just then: broadcast to strips draws in "
        f"{clocks['broadcast, strips'].drawing(spheres, MOST):,.0f} clocks, to a grid in "
        f"{clocks['broadcast, grid'].drawing(spheres, MOST):,.0f}.  Forwarded, objects wait in "
        f"each element's own queue: {clocks['forwarding, strips'].drawing(spheres, MOST):,.0f} and "
        f"{clocks['forwarding, grid'].drawing(spheres, MOST):,.0f}.",
        f"The host sends {node.words(spheres, MOST):,} words for the objects, meshes loaded anew, "
        f"and {host.words(spheres, MOST):,} for their triangles: "
        f"{host.words(spheres, MOST) / node.words(spheres, MOST):.0f} times as many.",
    ]


def _of_points(points: Sequence[Point]) -> list[str]:
    if not points:
        return []
    worst = max(points, key=lambda point: abs(point.off))
    return [f"The model is within {100 * abs(worst.off):.2f} % of the {len(points)} frames that "
            f"were simulated (worst: {worst.decomposition}, {worst.spheres} spheres)."]
