"""Host broadcast, Blazek's fourth decomposition: what it takes to draw spheres on 1, 2, 4 …
elements of one cage, however these interlace, where the controller makes the triangles of all
objects.

Clocks are those of the cycle model, and ``speed-up`` is over one element.  Words on the host link,
of 32 bits, are the same for any number of elements; beside them are those of the same list sent
triangle by triangle.
"""

from __future__ import annotations

from typing import Any

import click

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.objects.making import link_words, triangle_link_words
from cardcage.golden.planning.machine_plan import plan
from cardcage.testbenches.frames.setup_timing import setup_timing
from cardcage.testbenches.machine_options import SETUPS, SetupChoice
from cardcage.testbenches.support.text_table import TextTable

from .object_rates import spheres


def ways(elements: int, height: int) -> dict[str, dict[str, Any]]:
    """How so many elements can share a picture of that height: each has a strip or a rectangle of
    its own, or some a second one, where their number is no power of two."""
    bits = (elements - 1).bit_length()
    dealt = {"strips": (1, 1 << bits), "grid": (1 << (bits + 1) // 2, 1 << bits // 2)}
    found: dict[str, dict[str, Any]] = {"pixel by pixel": {}, "lines in turn": {"lines": True}}
    if elements != 1 << bits:
        found, dealt = {}, {"lines in turn": (1, height), **dealt}
    return found | {way: {"regions": regions, "balance": "static"}
                    for way, regions in dealt.items()}


@click.command()
@click.option("--count", type=click.IntRange(1, 4000), default=200, show_default=True)
@click.option("--recursion", type=click.IntRange(0, 5), default=2, show_default=True,
              help="Subdivisions of an octahedron.")
@click.option("--radius", type=float, default=16.0, show_default=True, help="In pixels.")
@click.option("--size", type=click.IntRange(16, 1024), default=256, show_default=True)
@click.option("--elements", type=int, multiple=True, default=(1, 2, 4, 8, 16), show_default=True)
@click.option("--fifo", type=click.IntRange(2, 4096), default=16, show_default=True,
              help="Triangles that an element can hold in waiting.")
@click.option("--setup", type=click.Choice(["fast", "small"]), default="fast", show_default=True,
              help="Of the controller.")
def main(count: int, recursion: int, radius: float, size: int, elements: tuple[int, ...],
         fifo: int, setup: SetupChoice) -> None:
    """Host broadcast of objects to 1, 2, 4 … processing elements."""
    listed = spheres(count, recursion, radius, size)
    rows: list[tuple[str, ...]] = []
    alone: dict[str, float] = {}
    for number in elements:
        for way, fields in ways(number, size).items():
            machine = plan(listed, cards=f"{number}x(PMM)", memory_ports=2, clocks_per_pixel=2,
                           objects="controller", fifo_depth=fifo, **SETUPS[setup],
                           **fields).configuration
            found = predict_cycles(machine, listed, setup=setup_timing(machine))
            first = alone.setdefault(way, found.cycles)
            rows.append((f"{number}", way, f"{found.cycles:,.0f}", f"{first / found.cycles:.2f}",
                         f"{found.bound / found.cycles:.0%}", found.binding))
    words, triangles = link_words(machine, listed), triangle_link_words(machine, listed)
    click.echo(TextTable(
        f"{count:,} spheres of {listed.triangles // count} triangles, radius {radius:g} pixels, "
        f"{size}x{size}, set-up {setup} at the controller, FIFO of {fifo}: {words.total:,} words "
        f"on the host link, {words.meshes:,} of them once; {triangles:,} as triangles",
        ("elements", "share the picture", "clocks to draw", "speed-up", "of bound", "bound by"),
        tuple(rows)).text())


if __name__ == "__main__":
    main()
