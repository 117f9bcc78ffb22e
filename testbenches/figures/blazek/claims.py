"""What Blazek says of his results (1991, chapters V and VI), held against his machine and ours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

from ..verdict import Summary, Verdict, together
from .scenes.speed_ups import SpeedUps
from .scenes.spheres import NODES, SPHERES

MOST = NODES[-1]

#: "Very poor": a quarter of all nodes' work at most.  "Well below optimal": half of it.
VERY_POOR, BELOW = 0.25, 0.5

#: "Minimal change", and "relatively small": a tenth.
SMALL = 0.1

#: "Very good, though not quite as good": an efficiency above that half, and four fifths at least.
NEARLY = 0.8

#: What counts as level, where a curve rises or falls.
LEVEL = 0.005

POOR = "Host initiated yields very poor results."
FALLS = "As the number of nodes increases its efficiency and speed-up decrease."
PACKET = "The variation in packet size yields minimal change."
POORER = "Scenes of more polygons show even poorer performance of it."
BEST = "Node initiated yields the best results of all methods."
MAINTAINED = "More polygons maintain its high results."
MERGED = "The time to merge is small compared to all, above all with many polygons."
NARROW = "With object forwarding more and narrower strips are used less and less well."
WELL_BELOW = "Averaged over many runs it is well below optimal."
GOOD = "Broadcast is very good, though not quite as good as node initiated."
LINES = "Interlaced lines balance better than strips and yield a better performance."


class Methods:
    """One machine's methods, by name.

    ``hosts``    host initiated, by packet, the usual one being ``host``
    ``strips`` ``grid``   node initiated with object forwarding
    ``lines`` ``broadcast_strips``   host broadcast
    """

    def __init__(self, all_of_them: Mapping[str, SpeedUps]) -> None:
        self.by_name = all_of_them
        self.hosts = [method for name, method in all_of_them.items()
                      if name.startswith("host initiated")]
        self.host = all_of_them["host initiated, 100"]
        self.node = all_of_them["node initiated"]
        self.strips = all_of_them["forwarding, strips"]
        self.lines = all_of_them["broadcast, lines"]
        self.broadcast_strips = all_of_them["broadcast, strips"]


def claims_of(methods: Methods, spheres: int) -> list[Verdict]:
    """Those about scenes of so many spheres."""
    return [Verdict(claim, f"{spheres:,}", came_out, numbers)
            for claim, came_out, numbers in _claims(methods, spheres)]


def _claims(methods: Methods, spheres: int) -> Iterator[tuple[str, bool, str]]:
    host, node = methods.host, methods.node
    best = max(host.curve(spheres))
    yield POOR, host.efficiency(spheres, MOST) <= VERY_POOR, (
        f"a speed-up of {host.speed_up(spheres, MOST):.2f} on {MOST} nodes, of {best:.2f} at best, "
        f"an efficiency of {host.efficiency(spheres, MOST):.3f}")
    yield FALLS, _falls(host.efficiencies(spheres)) and _falls(host.curve(spheres)[1:]), (
        f"its speed-up is {_along(host.curve(spheres))}")
    times = [each.time(spheres, MOST) for each in methods.hosts]
    yield PACKET, max(times) <= (1 + SMALL) * min(times), (
        f"on {MOST} nodes the worst packet takes {_more(max(times), min(times))} longer than the "
        "best")
    others = {name: method.speed_up(spheres, MOST) for name, method in methods.by_name.items()
              if method is not node}
    name = max(others, key=lambda each: others[each])
    yield BEST, node.speed_up(spheres, MOST) >= others[name], (
        f"a speed-up of {node.speed_up(spheres, MOST):.1f} on {MOST} nodes; the best of the others "
        f"is {name}, {others[name]:.1f}")
    merging = node.merging(spheres, MOST) / node.time(spheres, MOST)
    yield MERGED, merging <= SMALL, (
        f"node initiated on {MOST} nodes it is {100 * merging:.0f} % of the frame")
    yield NARROW, _falls(methods.strips.efficiencies(spheres)), (
        f"efficiency is {_along(methods.strips.efficiencies(spheres))}")
    yield WELL_BELOW, methods.strips.efficiency(spheres, MOST) <= BELOW, (
        f"on {MOST} nodes an efficiency of {methods.strips.efficiency(spheres, MOST):.2f}")
    part = methods.lines.speed_up(spheres, MOST) / node.speed_up(spheres, MOST)
    good = methods.lines.efficiency(spheres, MOST) > BELOW
    yield GOOD, good and NEARLY <= part <= 1, (
        f"on {MOST} nodes a speed-up of {methods.lines.speed_up(spheres, MOST):.1f}, "
        f"{part:.2f} of node initiated")
    lines, strips = (each.time(spheres, MOST) for each in (methods.lines, methods.broadcast_strips))
    yield LINES, lines <= strips, (
        f"on {MOST} nodes strips take {_more(strips, lines)} longer" if lines <= strips else
        f"on {MOST} nodes lines take {_more(lines, strips)} longer")


def claims_of_all(methods: Methods) -> list[Verdict]:
    """Those about how results change with the number of spheres, asked once."""
    some = SPHERES[len(SPHERES) // 2:]
    hosts = [methods.host.efficiency(spheres, MOST) for spheres in some]
    nodes = [methods.node.efficiency(spheres, MOST) for spheres in some]
    scene = f"{some[0]} to {some[-1]:,}"
    return [
        Verdict(POORER, scene, _falls(hosts) and hosts[-1] < hosts[0] - LEVEL,
                f"its efficiency on {MOST} nodes goes from {hosts[0]:.3f} to {hosts[-1]:.3f}"),
        Verdict(MAINTAINED, scene, _falls(nodes[::-1]),
                f"its efficiency on {MOST} nodes goes from {nodes[0]:.2f} to {nodes[-1]:.2f}"),
    ]


def summary(methods: Methods) -> list[Summary]:
    """Each claim once, of all scenes together."""
    return together([*(verdict for spheres in SPHERES for verdict in claims_of(methods, spheres)),
                     *claims_of_all(methods)])


def _falls(values: list[float]) -> bool:
    return all(after <= before + LEVEL for before, after in pairwise(values))


def _along(values: list[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in values) + f" on {NODES[0]} to {MOST} nodes"


def _more(time: float, least: float) -> str:
    return f"{100 * (time / least - 1):.0f} %"
