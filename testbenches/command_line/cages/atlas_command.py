"""``cardcage atlas``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import click

from ....golden.specification.card_order import MAXIMUM_NODES
from ....golden.specification.configuration import RANGES
from ...atlas.atlas import (
    DEFAULT_CAGES,
    DEFAULT_FRACTION_BITS,
    DEFAULT_NODES,
    DEFAULT_PORTS,
    DEFAULT_SCENES,
    DEFAULT_SIZES,
    AtlasOptions,
    make_atlas,
)
from ...atlas.atlas_facts import atlas_facts
from ...atlas.atlas_table import headline, tables
from ...engines.choose_engine import AUTO, ENGINE_NAMES
from ...machine_options import MachineOptions
from ...support.progress import points_bar
from ...support.text_table import print_tables, tables_text
from ..command_group import EXIT_DIFFERENT, warn
from ..command_options import FRACTION_BITS, PACKET, Several, Size, view_options

_OF_MACHINE = ("memory_ports", "clocks_per_pixel", "packet", "view", "zoom", "background", "cull",
               "light")


@click.command(name="atlas")
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@click.option("--cages", multiple=True, metavar="CARDS", help="A cage, as --cards of compare has "
              "them: 4x(PMMT), with regions 4x(PMM)/8x8, or with the place where it makes the "
              "triangles of a scene file's objects, 4x(PMMT)@nodes, 4x(PMM)/4x4@elements, "
              "4x(PMM)@controller; give it once for each cage.  [default: "
              f"{', '.join(DEFAULT_CAGES)}]")
@click.option("--nodes", type=Several(click.IntRange(1, MAXIMUM_NODES), "N,…"),
              help="Each cage with so many nodes, or elements where all is one node.  [default: "
              f"{','.join(map(str, DEFAULT_NODES))} of the default cages, else as they are]")
@click.option("--size", "sizes", type=Several(Size(), "WxH,…"), help="Of the pictures.  [default: "
              f"{','.join('{}x{}'.format(*size) for size in DEFAULT_SIZES)}]")
@click.option("--fraction-bits", type=Several(FRACTION_BITS, "N|exact,…"),
              help="Of depth and colour.  [default: "
              f"{','.join(map(str, DEFAULT_FRACTION_BITS))}]")
@click.option("--retain/--immediate", default=None, help="Cages of nodes only with list memories, "
              "or only without.  [default: both]")
@click.option("--memory-ports", type=click.IntRange(*RANGES["memory_ports"]),
              default=DEFAULT_PORTS, show_default=True, metavar="1|2",
              help="Ports of each memory unit's RAM.")
@click.option("--clocks-per-pixel", type=click.IntRange(*RANGES["clocks_per_pixel"]), metavar="N",
              help="Clocks a pixel lasts on the video output.  [default: 2]")
@click.option("--packet", type=PACKET, metavar=PACKET.name, help="Which triangles of the list go "
              "to one node.  [default: work]")
@click.option("--simulate", is_flag=True, help="Simulate every point in RTL as well, and compare "
              "each picture and each count with golden: minutes for large cages.")
@click.option("--check-node", is_flag=True, help="Of each chain and tree with lists, however "
              "large, simulate one node in RTL, with the pixels that the model says come in.")
@click.option("--engine", type=click.Choice([AUTO, *ENGINE_NAMES]), default=AUTO, show_default=True,
              help="The simulator.")
@click.option("--processes", type=click.IntRange(1), metavar="N",
              help="On this machine, at the same time.  [default: as many as there are cores]")
@click.option("--cluster", metavar="ADDRESS", help="Of a Dask scheduler whose workers measure, "
              "such as tcp://host:8786, or local.  Needs pip install '.[cluster]'.")
@click.option("--json", "as_json", is_flag=True, help="For programs: print one object.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("cardcage-out"),
              show_default=True, metavar="DIR", help="Folder of the report.")
@view_options
@click.pass_obj
def atlas_command(command_line: str, /, scenes: tuple[str, ...], cages: tuple[str, ...],
                  as_json: bool, out: Path, **options: Any) -> None:
    """Map which organisation is best at what, for which scene and size.

    Each SCENE on each cage, at each size and precision: a point, by the cycle model, or with
    --simulate in RTL.  Which cage is fastest, has least memory and least traffic, or is smallest;
    what limits each; and its speed against its error.  A point that fails is reported and stops no
    other one.  Whatever was found is kept: an interrupted run goes on where it was, and a second
    one takes a second.

    Cages are sent triangles; one with a place behind its name loads the scene's meshes once, is
    sent objects, and makes their triangles there, with a set-up of its own: so one command sets
    decompositions side by side.

    Writes atlas.html, one page complete in itself, atlas.json, atlas.csv, and atlas.png, the map,
    to DIR.

    \b
    Examples:
      cardcage atlas
      cardcage atlas teapot terrain --size 64x64,128x128 --nodes 2,4,8
      cardcage atlas mesh.obj --cages '4x(PMM)' --cages '4x(PMM)/8x8' --cages '4x(PMMT)'
      cardcage atlas three_cubes --cages '4x(PMMT)' --cages '4x(PMMT)@nodes'
      cardcage atlas crystals --cages '4x(PMM)/4x4@elements' --cages '4x(PMM)@controller'
      cardcage atlas teapot --size 64x64 --nodes 4 --fraction-bits exact --simulate
      cardcage atlas sphereflake --size 256x256 --cages '64x(16x(PM)C)' --retain --check-node
      cardcage atlas --cluster tcp://host:8786

    Exit status: 0 every simulated picture and count as golden, 1 otherwise, or a point's machine
    or process failed, 2 the input or the system is at fault, or no machine can be built.
    """
    machine = MachineOptions(**{name: options.pop(name) for name in _OF_MACHINE})
    asked = AtlasOptions(
        scenes=scenes or DEFAULT_SCENES, cages=cages, nodes=options.pop("nodes") or (),
        sizes=options.pop("sizes") or DEFAULT_SIZES,
        fraction_bits=options.pop("fraction_bits") or DEFAULT_FRACTION_BITS, machine=machine,
        **options)
    atlas = make_atlas(asked, out=out, command_line=command_line, bar=points_bar)
    for warning in atlas.warnings:
        warn(warning)
    if as_json:
        click.echo(json.dumps(atlas_facts(atlas), indent=1))
    else:
        show = print_tables if sys.stdout.isatty() else _print
        show(headline(atlas), tables(atlas))
        click.echo(f"report: {atlas.report}")
    if atlas.differences:
        click.get_current_context().exit(EXIT_DIFFERENT)


def _print(*text: Any) -> None:
    click.echo(tables_text(*text))
