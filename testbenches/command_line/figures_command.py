"""``cardcage figures``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import click

from ..engines.choose_engine import AUTO, ENGINE_NAMES
from ..support.atomic_output import atomic_folder, output_errors
from ..support.progress import step_bar
from ..support.text_table import print_tables, tables_text
from .command_group import EXIT_DIFFERENT
from .command_options import Size

#: The papers that can be redrawn.
PAPERS = ("cox-hanrahan", "ellsworth", "blazek")


@click.command(name="figures")
@click.argument("paper", type=click.Choice(PAPERS), metavar="PAPER")
@click.option("--size", type=Size(), metavar="WxH",
              help="Of the screen; by default 512x512, for ellsworth 640x512.")
@click.option("--frames", type=int, metavar="N",
              help="ellsworth: of each model; by default as many as a few minutes allow.")
@click.option("--model", "models", multiple=True, metavar="SCENE",
              help="ellsworth: a mesh or scene file to turn in place of the two models; may be "
              "given again.")
@click.option("--rtl/--no-rtl", "simulate", default=True, show_default=True,
              help="Simulate the machines whose points are marked, and the cages of a table: "
              "minutes the first time.  The rest are golden and cycle models.")
@click.option("--cells", is_flag=True, help="cox-hanrahan: also place and route the boards of the "
              "last table, some minutes each, the direct merge more than a quarter of an hour; "
              "without it earlier results are shown.")
@click.option("--engine", type=click.Choice([AUTO, *ENGINE_NAMES]), default=AUTO, show_default=True,
              help="The simulator.")
@click.option("--json", "as_json", is_flag=True, help="For programs: print one object.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("cardcage-out"),
              show_default=True, metavar="DIR", help="Folder of the page.")
@click.pass_obj
def figures_command(command_line: str, /, paper: str, as_json: bool, out: Path,
                    **options: Any) -> None:
    """Redraw the figures and tables of PAPER for our scenes and machines.

    cox-hanrahan: M. Cox and P. Hanrahan, Pixel Merging for Object-Parallel Rendering: a Distributed
    Snooping Algorithm, 1993.  Table 1 and figures 5 and 6, the traffic that nodes have on a snooped
    bus, expected and observed, on 1 to 64 nodes; under each figure which of the paper's claims came
    out.  Then which assignment of the triangles to the nodes makes a frame shortest, and what each
    kind of merge costs on sixteen nodes.

    ellsworth: D. A. Ellsworth, A New Algorithm for Interactive Graphics on Multicomputers, 1994.
    Figures 4 and 5 and the overlap factor: how evenly regions of the screen that are dealt out anew
    for each frame share the work of 2 to 512 processors, by triangles, as the paper counts, and by
    clocks; and what cures the loss where the last frame's counts have to do.

    blazek: E. M. Blazek, Parallel Image Generation Using the Z-Buffering Algorithm on a Medium
    Grained Distributed Memory Model Computer, 1991.  Figures 12 to 19: speed-up and efficiency of
    his four methods, for 1 to 2,048 spheres on 1 to 32 nodes, on his hypercube, by a model of its
    messages, and on our machines, in clocks; and how far that depends on what things cost.

    Writes PAPER.html, one page complete in itself, PAPER.json and PAPER.png, some of the figures,
    to DIR.  What was measured is kept: an interrupted run goes on where it was.

    \b
    Examples:
      cardcage figures cox-hanrahan --no-rtl
      cardcage figures cox-hanrahan --no-rtl --size 128x128 --out small
      cardcage figures cox-hanrahan
      cardcage figures cox-hanrahan --cells
      cardcage figures cox-hanrahan --no-rtl --json
      cardcage figures ellsworth --no-rtl
      cardcage figures ellsworth --no-rtl --frames 4 --size 128x96 --model teapot
      cardcage figures ellsworth
      cardcage figures blazek --no-rtl
      cardcage figures blazek

    Exit status: 0 every simulated picture and count as golden, 1 otherwise, 2 the input or the
    system is at fault.
    """
    from ..figures.papers import PAPERS as KNOWN  # charts take a second

    known = KNOWN[paper]
    # What was not asked for is the paper's own default.
    asked = known.chosen(paper, {
        name: value for name, value in options.items()
        if not (value is None or value == () or (name == "cells" and not value))})
    with atomic_folder(out, known.files) as folder:
        with step_bar(len(asked.jobs()) + 1) as step:
            found = known.redraw(asked, command_line, step)
        with output_errors(out, "--out"):
            known.write(found, folder)
    if as_json:
        click.echo(json.dumps(known.facts(found), indent=2))
    else:
        if sys.stdout.isatty():
            print_tables(known.headline(found), known.tables(found))
        else:
            click.echo(tables_text(known.headline(found), known.tables(found)))
        click.echo(f"page: {out / known.files[0]}")
    if found.differences:
        click.get_current_context().exit(EXIT_DIFFERENT)
