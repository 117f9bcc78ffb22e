"""``cardcage precision``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from ..engines.choose_engine import AUTO, ENGINE_NAMES
from ..precision.precision_table import precision_table, precision_text
from ..precision.scene_precision import (
    NO_ENGINE,
    PrecisionOptions,
    expected_steps,
    measure_precision,
)
from ..render import DEFAULT_SCENE
from ..support.atomic_output import atomic_folder, output_errors
from ..support.progress import step_bar
from .command_group import EXIT_DIFFERENT, warn
from .command_options import machine_options_of_any_precision


@click.command(name="precision")
@click.argument("scene", default=DEFAULT_SCENE, metavar="[SCENE]")
@machine_options_of_any_precision
@click.option("--engine", type=click.Choice([AUTO, *ENGINE_NAMES, NO_ENGINE]), default=AUTO,
              show_default=True, help="The simulator that counts cycles; none counts none.")
@click.option("--simulate", type=click.Choice(["few", "all"]), help="Fraction bits to simulate; "
              "few: 0, those that hold depth to 1 LSB, exact.  [default: all, few with pysim]")
@click.option("--place-and-route", is_flag=True, help="Measure area and clock rate with yosys and "
              "nextpnr, of the few, or of all with --simulate all: minutes for each.  Without it "
              "earlier results are shown.")
@click.option("--seeds", type=click.IntRange(1, 99), default=3, show_default=True,
              help="Of place and route, for a median and a range.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("cardcage-out"),
              show_default=True, metavar="DIR", help="Folder of the report.")
@click.pass_obj
def precision_command(command_line: str, /, scene: str, out: Path, **options: Any) -> None:
    """Show what SCENE's machine costs and gains as its numbers get coarser.

    For each number of fraction bits: errors of depth and colour against the exact picture and
    against the scene before it was quantised, the bound that holds, cycles, and, after
    --place-and-route, area and clock rate.  An ordinary float32 Z-buffer stands beside it.
    Open precision.html in DIR.  An interrupted run goes on where it was.

    \b
    Examples:
      cardcage precision
      cardcage precision mesh.obj --size 256x256 --cards '4x(PMM)' --out mesh-precision
      cardcage precision hard:crossing-3-lsb --engine none
      cardcage precision teapot --place-and-route --seeds 5

    Exit status: 0 no bound exceeded and exact without an error, 1 otherwise.
    """
    from ..precision.precision_report import (  # charts take a second
        PRECISION_FILES,
        write_precision_report,
    )

    asked = PrecisionOptions(**options)
    with atomic_folder(out, PRECISION_FILES) as folder:
        with step_bar(expected_steps(asked)) as step:
            precision = measure_precision(scene, asked, command_line, step)
        with output_errors(out, "--out"):
            write_precision_report(precision, folder)
    for warning in precision.warnings:
        warn(warning)
    if sys.stdout.isatty():
        precision_table(precision)
    else:
        click.echo(precision_text(precision))
    click.echo(f"report: {out / 'precision.html'}")
    if precision.problems():
        click.get_current_context().exit(EXIT_DIFFERENT)
