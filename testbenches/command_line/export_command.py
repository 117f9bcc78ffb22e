"""``cardcage export``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..export.export_files import COMPONENT_NAMES, export, export_summary
from .command_group import warn
from .command_options import machine_options, sequence_options


@click.command(name="export")
@click.argument("scene", required=False, metavar="[SCENE]")
@machine_options
@sequence_options
@click.option("--component", type=click.Choice(COMPONENT_NAMES), metavar="NAME",
              help="One board or part alone, such as memory_unit; a wrong name lists them all.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=Path("machine.v"),
              show_default=True, metavar="FILE.v", help="The Verilog; its description (.json) and "
              "Verilator's waivers (.vlt) go beside it.")
def export_command(scene: str | None, component: str | None, output: Path,
                   **options: Any) -> None:
    """Write the machine as Verilog, its ports and number formats as JSON.

    With a SCENE the number formats are what it needs, with --frames or --path what all its pictures
    need; without one they draw every triangle on the screen exactly.

    \b
    Examples:
      cardcage export
      cardcage export mesh.obj --cards '4x(PMM)' --size 640x480 -o machine.v
      cardcage export teapot --frames 8 --turn 45 -o turning.v
      cardcage export --preset paper --shading flat -o paper.v
      cardcage export --component memory_unit -o memory_unit.v
    """
    exported = export(output, scene, component=component, **options)
    for warning in exported.warnings:
        warn(warning)
    click.echo(export_summary(exported))

