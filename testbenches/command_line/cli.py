"""The command line."""

from __future__ import annotations

import click

from .boards_command import boards_command
from .cache_command import cache_command
from .cages.atlas_command import atlas_command
from .cages.compare_command import compare_command
from .check_verilog_command import check_verilog_command
from .command_group import CommandGroup
from .engines_command import engines_command
from .export_command import export_command
from .figures_command import figures_command
from .plan_command import plan_command
from .precision_command import precision_command
from .render_command import render_command
from .scenes_command import scenes_command
from .speed_command import bench_command

HELP_SETTINGS = {"max_content_width": 100, "help_option_names": ["-h", "--help"]}


@click.group(cls=CommandGroup, invoke_without_command=True, context_settings=HELP_SETTINGS)
@click.version_option(package_name="cardcage", prog_name="cardcage")
@click.pass_context
def main(context: click.Context) -> None:
    """Parallel Z-buffer graphics machines as RTL, every pixel checked against a golden model.

    \b
    Examples:
      cardcage render                    the teapot, simulated and checked in some 20 seconds
      cardcage render mesh.obj           a mesh of yours
      cardcage scenes                    what else there is to draw

    \b
    Exit status: 0 done and equal, 1 the picture differs from the golden model or the machine
    delivers none, 2 the input or the system is at fault, 130 interrupted.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


for command in (atlas_command, bench_command, boards_command, cache_command, check_verilog_command,
                compare_command, engines_command, export_command, figures_command, plan_command,
                precision_command, render_command, scenes_command):
    main.add_command(command)


if __name__ == "__main__":
    main(prog_name="cardcage")
