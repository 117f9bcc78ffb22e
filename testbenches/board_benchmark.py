"""Area and clock rate of boards: ``python -m cardcage.testbenches.board_benchmark``.

Synthesises, places and routes each for an ECP5 with yosys and nextpnr (extra ``fpga``), some
minutes a board.  The machine is exact for any triangle on its screen; each board has its queue
of triangles in it, the RAM of its pictures outside, behind registers (``outside_ram``).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import click

from .atomic_output import atomic_file, output_errors
from .bench_cases import SIZE
from .boards import BOARDS
from .command_group import OneLineErrors
from .command_options import Several, Size
from .place_and_route import DEVICE, TARGET_MHZ, TOOLS, Part, Placement, place_and_route
from .progress import step_bar
from .text_table import TextTable


def measure(parts: Mapping[str, Part], seeds: Sequence[int],
            step: Callable[[str], None] = lambda doing: None) -> dict[str, Placement]:
    """Place each of ``parts``, by names of ``BOARDS``.

    ``step`` is called before each synthesis and each seed.  Raises ``InputError`` where the tools
    are missing or fail.
    """
    placements = {}
    for name, part in parts.items():
        step(f"{name}: synthesising")
        placements[name] = place_and_route(
            part, seeds, lambda doing, name=name: step(f"{name}: {doing}"))
    return placements


def board_table(placements: Mapping[str, Placement], title: str) -> TextTable:
    """A row for each board."""
    seeds = len(next(iter(placements.values())).mhz)
    columns = ("board", "LUT4", "CCU2C", "LUT4 + 2*CCU2C", "FF", "MULT18", "LUT RAM",
               *(f"seed {seed}" for seed in range(1, seeds + 1)), "median MHz")
    return TextTable(title, columns, tuple(
        (BOARDS[name].title, *(f"{count:,}" for count in (
            placed.lut4s, placed.carry_cells, placed.luts, placed.flip_flops, placed.multipliers,
            placed.lut_rams)), *(f"{mhz:.1f}" for mhz in (*placed.mhz, placed.median_mhz)))
        for name, placed in placements.items()))


def board_facts(parts: Mapping[str, Part], placements: Mapping[str, Placement]) -> dict[str, Any]:
    """The same for programs, and everything that it depends on."""
    return {
        "device": " ".join(DEVICE),
        "target_mhz": TARGET_MHZ,
        "tools": {tool: version(tool.replace("_", "-")) for tool in TOOLS},
        "boards": [{"name": name, "title": BOARDS[name].title, **placed.facts(),
                    "configuration": asdict(parts[name].configuration)}
                   for name, placed in placements.items()],
    }


@click.command(cls=OneLineErrors)
@click.option("--boards", "names", type=Several(click.Choice(list(BOARDS)), "NAME,…"),
              default=",".join(BOARDS), show_default=True, help="What to measure.")
@click.option("--cards", metavar="CARDS", default="PMM", show_default=True,
              help="The cage that the boards are for; the first P is measured, with its Ms.")
@click.option("--size", type=Size(), metavar="WxH", default=f"{SIZE}x{SIZE}", show_default=True,
              help="Of the screen.")
@click.option("--seeds", type=click.IntRange(1, 99), default=3, show_default=True,
              help="Of place and route, for a median.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), metavar="FILE",
              help="Also write the figures, for programs.")
def main(names: tuple[str, ...], cards: str, size: tuple[int, int], seeds: int,
         json_file: Path | None) -> None:
    """Print area and clock rate of boards on an ECP5, speed grade 6.

    What was measured is kept, seed by seed: an interrupted run goes on where it was, and a board
    that has not changed is not placed again.

    \b
    Examples:
      python -m cardcage.testbenches.board_benchmark
      python -m cardcage.testbenches.board_benchmark --boards domain,setup-fast --seeds 1
      python -m cardcage.testbenches.board_benchmark --boards domain --cards '16x(PMM)'
      python -m cardcage.testbenches.board_benchmark --json boards.json
    """
    width, height = size
    parts = {name: BOARDS[name].part(cards, width, height) for name in names}
    with ExitStack() as outputs:
        file = json_file and outputs.enter_context(atomic_file(json_file, "--json"))
        with step_bar(len(parts) * (1 + seeds)) as step:
            placements = measure(parts, range(1, seeds + 1), step)
        if file:
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


if __name__ == "__main__":
    main()
