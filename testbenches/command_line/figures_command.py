"""``cardcage figures``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import click

from ..engines.choose_engine import AUTO, ENGINES
from ..support.atomic_output import atomic_folder, output_errors
from ..support.progress import step_bar
from ..support.text_table import print_tables, tables_text
from .command_group import EXIT_DIFFERENT
from .command_options import Size

#: The papers that can be redrawn.
PAPERS = ("cox-hanrahan",)


@click.command(name="figures")
@click.argument("paper", type=click.Choice(PAPERS), metavar="PAPER")
@click.option("--size", type=Size(), metavar="WxH", default="512x512", show_default=True,
              help="Of the screen.")
@click.option("--rtl/--no-rtl", "simulate", default=True, show_default=True,
              help="Simulate the cages of the last table, and the points measured in RTL: minutes "
              "the first time.  The rest are golden and cycle models, a minute.")
@click.option("--cells", is_flag=True, help="Also place and route the boards of the last table, "
              "some minutes each, the direct merge more than a quarter of an hour; without it "
              "earlier results are shown.")
@click.option("--engine", type=click.Choice([AUTO, *ENGINES]), default=AUTO, show_default=True,
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

    Writes PAPER.html, one page complete in itself, PAPER.json and PAPER.png, some of the figures,
    to DIR.  What was measured is kept: an interrupted run goes on where it was.

    \b
    Examples:
      cardcage figures cox-hanrahan --no-rtl
      cardcage figures cox-hanrahan --no-rtl --size 128x128 --out small
      cardcage figures cox-hanrahan
      cardcage figures cox-hanrahan --cells
      cardcage figures cox-hanrahan --no-rtl --json

    Exit status: 0 every simulated picture and count as golden, 1 otherwise, 2 the input or the
    system is at fault.
    """
    from ..figures.cox_hanrahan import (  # charts take a second
        FiguresOptions,
        expected_steps,
        redraw_cox_hanrahan,
    )
    from ..figures.cox_hanrahan_facts import cox_hanrahan_facts
    from ..figures.cox_hanrahan_page import FIGURE_FILES, write_cox_hanrahan
    from ..figures.figure_tables import headline, tables

    asked = FiguresOptions(**options)
    with atomic_folder(out, FIGURE_FILES) as folder:
        with step_bar(expected_steps(asked)) as step:
            found = redraw_cox_hanrahan(asked, command_line, step)
        with output_errors(out, "--out"):
            write_cox_hanrahan(found, folder)
    if as_json:
        click.echo(json.dumps(cox_hanrahan_facts(found), indent=2))
    else:
        if sys.stdout.isatty():
            print_tables(headline(found), tables(found))
        else:
            click.echo(tables_text(headline(found), tables(found)))
        click.echo(f"page: {out / FIGURE_FILES[0]}")
    if found.differences:
        click.get_current_context().exit(EXIT_DIFFERENT)
