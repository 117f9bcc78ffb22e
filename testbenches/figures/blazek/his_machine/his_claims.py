"""What he says of his own machine alone: of messages, of balance, of tessellating again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ...verdict import Summary, Verdict, together
from ..scenes.spheres import NODES, SPHERES, Size
from .costs import COSTS
from .methods import Scene
from .times import BROADCAST_STRIPS, GRID, LINEAR, LINES, NODE, STRIPS, USUAL_HOST, Times

MOST = NODES[-1]

#: "Very heavily": a tenth of what the nodes are at work.  "Wander": a tenth of the speed-up.
HEAVY, WANDERING = 0.1, 0.1

LINK = "The host cannot send as fast as the nodes are able to render: the link is the bottleneck."
BALANCED = "Node initiated has an absolutely equal load balance."
COMMUNICATION = "What weighs on object forwarding is the cost of communicating objects."
WANDERS = "The curves of object forwarding wander, as the spheres happen to lie."
GRID_FORWARDS = "A grid of the least perimeter forwards fewer objects than strips."
POLYGONS = "To forward polygons takes less than to forward the object and to tessellate it again."
CONSTANT = "By broadcast the time to tessellate remains constant, and that to render decreases."
HIERARCHICAL = "Sent hierarchically a broadcast costs less than sent node by node."
BALANCES = "Interlaced lines balance the load of a broadcast better than strips."


def his_claims_of(times: Mapping[str, Times], size: Size, spheres: int) -> list[Verdict]:
    """Those about scenes of so many spheres."""
    return [Verdict(claim, f"{spheres:,}", came_out, numbers)
            for claim, came_out, numbers in _claims(times, size, spheres)]


def _claims(times: Mapping[str, Times], size: Size, spheres: int
            ) -> Iterator[tuple[str, bool, str]]:
    host = times[USUAL_HOST]
    at_work = host.balance(spheres, MOST)
    sending = host.mean_of("host", spheres, MOST) / host.mean_of("drawn", spheres, MOST)
    yield LINK, at_work <= 0.5 and sending >= 1 - HEAVY, (
        f"until all is drawn the host is at work for {100 * sending:.0f} % of the time, a node for "
        f"{100 * at_work:.0f} %")
    most = -(-spheres // MOST)
    yield BALANCED, most * MOST == spheres, (
        f"of {MOST} nodes the busiest has {most} of {spheres} spheres; on average a node is at "
        f"work for {_part(times[NODE].balance(spheres, MOST))} of the time")
    yield COMMUNICATION, *_communication(times, size, spheres)
    ranges = times[STRIPS].range_of_seeds(spheres, MOST)
    yield WANDERS, ranges >= WANDERING, (
        f"on {MOST} nodes speed-up differs by {_part(ranges)} from one set of places to another, "
        f"on 4 by {_part(times[STRIPS].range_of_seeds(spheres, 4))}")
    strips, grid = (times[method].mean_of("passed", spheres, MOST) for method in (STRIPS, GRID))
    yield GRID_FORWARDS, grid < strips, (
        f"{grid / spheres:.2f} messages an object on {MOST} nodes, by strips "
        f"{strips / spheres:.2f}")
    scene = Scene.of(size, 0, spheres)
    yield CONSTANT, *_constant(scene)
    lines, one_by_one = (times[method].time(spheres, MOST) for method in (LINES, LINEAR))
    yield HIERARCHICAL, lines < one_by_one, (
        f"{lines:.1f} s against {one_by_one:.1f} s: tessellating takes {scene.tessellating:.2f} s "
        f"an object, a message {1000 * COSTS.object_message:.1f} ms")
    own, others = (times[method].balance(spheres, MOST) for method in (LINES, BROADCAST_STRIPS))
    yield BALANCES, own > others, f"a node is at work for {_part(own)}, by strips {_part(others)}"


def _communication(times: Mapping[str, Times], size: Size, spheres: int) -> tuple[bool, str]:
    passed = times[STRIPS].mean_of("passed", spheres, MOST)
    busy = times[STRIPS].mean_of("busy", spheres, MOST)
    sent = passed * COSTS.object_message / busy
    again = passed * Scene.of(size, 0, 1).tessellating / busy
    return sent >= HEAVY, (
        f"on {MOST} nodes messages are {100 * sent:.2f} % of what the nodes are at work, and to "
        f"tessellate again what was passed on {100 * again:.0f} %")


def _constant(scene: Scene) -> tuple[bool, str]:
    first, last = (scene.drawing(nodes, "lines").sum(axis=0).max() for nodes in (1, MOST))
    return bool(last < first), (
        f"{scene.tessellating * scene.spheres:.1f} s on each node to tessellate, whatever their "
        f"number; to draw {first:.1f} s on one, {last:.1f} s on {MOST}")


def polygons_claim(size: Size) -> Verdict:
    """Of one sphere, whatever the scene."""
    scene = Scene.of(size, 0, 1)
    polygons = float(COSTS.message_time(COSTS.polygon_bytes * scene.template.polygons))
    again = COSTS.object_message + scene.tessellating
    return Verdict(POLYGONS, "any", polygons < again,
                   f"{polygons:.2f} s for the polygons of a sphere, {again:.2f} s otherwise")


def his_summary(times: Mapping[str, Times], size: Size) -> list[Summary]:
    """Each claim once, of all scenes together."""
    return together([*(verdict for spheres in SPHERES
                       for verdict in his_claims_of(times, size, spheres)),
                     polygons_claim(size)])


def _part(part: float) -> str:
    return f"{100 * part:.1f} %"
