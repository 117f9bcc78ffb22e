"""``cardcage boards``."""

from __future__ import annotations

import json
import sys
from contextlib import ExitStack
from pathlib import Path

import click

from ..fpga.place_and_route import TARGET_MHZ
from ..speed.cases import SIZE
from ..support.atomic_output import atomic_file, output_errors
from ..support.progress import step_bar
from .command_options import Several, Size

#: What can be measured (``fpga.boards``, which loads Amaranth and so is not asked here).
BOARD_NAMES = ("element", "domain", "domain-gouraud", "unit-1-port", "unit-2-ports",
               "unit-of-chain", "unit-of-tree", "unit-of-snoop", "chain-merge", "tree-merge",
               "snoop-merge", "frame-unit", "element-of-direct", "unit-of-direct", "direct-merge",
               "direct-merge-2", "direct-merge-element", "setup-fast", "setup-small",
               "element-of-regions", "balancer")


@click.command(name="boards")
@click.option("--boards", "names", type=Several(click.Choice(BOARD_NAMES), "NAME,…"),
              default=",".join(BOARD_NAMES), show_default=True, help="What to measure.")
@click.option("--cards", metavar="CARDS", default="PMM", show_default=True,
              help="The cage that the boards are for; the first P is measured, with its Ms.")
@click.option("--size", type=Size(), metavar="WxH", default=f"{SIZE}x{SIZE}", show_default=True,
              help="Of the screen.")
@click.option("--seeds", type=click.IntRange(1, 99), default=3, show_default=True,
              help="Of place and route, for a median.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), metavar="FILE",
              help="Also write the figures, for programs.")
def boards_command(names: tuple[str, ...], cards: str, size: tuple[int, int], seeds: int,
         json_file: Path | None) -> None:
    """Print area and clock rate of boards on an ECP5, speed grade 6.

    What was measured is kept, seed by seed: an interrupted run goes on where it was, and a board
    that has not changed is not placed again.

    \b
    Examples:
      cardcage boards
      cardcage boards --boards domain,setup-fast --seeds 1
      cardcage boards --boards domain --cards '16x(PMM)'
      cardcage boards --json boards.json
    """
    from ..fpga.board_figures import board_facts, board_table, measure
    from ..fpga.boards import BOARDS

    width, height = size
    parts = {name: BOARDS[name].part(cards, width, height) for name in names}
    with ExitStack() as outputs:
        file = json_file and outputs.enter_context(atomic_file(json_file, "--json"))
        with step_bar(len(parts) * (1 + seeds)) as step:
            placements = measure(parts, range(1, seeds + 1), step)
        if file and json_file:
            facts = board_facts(parts, placements)
            with output_errors(json_file, "--json"):
                file.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    table = board_table(placements, f"{cards} at {width}x{height}, ECP5-85k, speed grade 6; "
                        f"LUT RAM: of 16 words of 4 bits; clock asked for {TARGET_MHZ} MHz")
    if sys.stdout.isatty():
        click.echo(table.title)
        table.print()
    else:
        click.echo(table.text())
