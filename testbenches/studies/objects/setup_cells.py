"""What set-up for a triangle a clock costs: one in each node against some at the controller.

Sixteen nodes that each set up a triangle every sixteen clocks do one a clock together; so do some
of the fastest in turn, as many as one of these takes clocks for a triangle.  Cells are counted by
yosys before any technology: flip-flops, gates and multiplexers of one bit, partial products of
multipliers.
"""

from __future__ import annotations

import click
from amaranth.hdl import Fragment

from cardcage.golden.planning.on_screen_widths import on_screen_widths
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.objects.object_reader import ObjectReader
from cardcage.hdl.triangle_setup.triangle_setup import TriangleSetup
from cardcage.testbenches.export.cell_count import Cells, count_cells
from cardcage.testbenches.support.text_table import TextTable


def machine(size: int, interval: int, nodes: int) -> MachineConfiguration:
    """Exact for every triangle on the screen."""
    return MachineConfiguration(
        f"{nodes}x(PMMT)", size, size, setup="hardware", setup_interval=interval, shading="flat",
        packet="contiguous", objects="nodes", mesh_triangles=512, meshes=8,
        **on_screen_widths(size, size, 8))


def interval_of(size: int, interval: int, nodes: int) -> int:
    unit = TriangleSetup(configuration=machine(size, interval, nodes))
    Fragment.get(unit, None)  # Amaranth warns of components that are never elaborated
    return unit.interval


def slowest(size: int, nodes: int) -> int:
    """The greatest ``setup_interval`` at which so many set up a triangle a clock together."""
    return max(each for each in range(1, nodes + 1) if interval_of(size, each, nodes) <= nodes)


def row(name: str, count: int, interval: int, cells: Cells) -> tuple[str, ...]:
    return (name, str(count), str(interval), f"{count / interval:.2f}",
            *(f"{count * number:,}" for number in (
                cells.total - cells.memory, cells.flip_flops, cells.gates, cells.multipliers)))


@click.command()
@click.option("--size", type=click.IntRange(16, 1024), default=512, show_default=True)
@click.option("--nodes", type=click.IntRange(2, 64), default=16, show_default=True)
def main(size: int, nodes: int) -> None:
    """One set-up in each node against some fast ones at the controller."""
    slow, fast = slowest(size, nodes), interval_of(size, 1, nodes)
    rows = []
    for name, count, interval in (("in each node", nodes, slow), ("in each node, fast", nodes, 1),
                                  ("at the controller, in turn", fast, 1)):
        unit = TriangleSetup(configuration=machine(size, interval, nodes))
        rows.append(row(name, count, unit.interval, count_cells(unit)))
    reader = count_cells(ObjectReader(configuration=machine(size, 1, nodes)))
    rows.append(row("readers of objects, in each node", nodes, 1, reader))
    click.echo(TextTable(
        f"set-up for {nodes} nodes, flat, {size}x{size}, exact; cells of all together, without "
        "memory",
        ("where", "how many", "clocks each", "triangles a clock", "cells", "flip-flops", "gates",
         "multipliers"), tuple(rows)).text())


if __name__ == "__main__":
    main()
