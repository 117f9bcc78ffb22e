"""The command line."""

from __future__ import annotations

import click

from .command_group import CommandGroup

#: The module of each command.
COMMANDS = {
    "atlas": ".cages.atlas_command",
    "bench": ".speed_command",
    "boards": ".boards_command",
    "cache": ".cache_command",
    "check-verilog": ".check_verilog_command",
    "compare": ".cages.compare_command",
    "engines": ".engines_command",
    "export": ".export_command",
    "figures": ".figures_command",
    "plan": ".plan_command",
    "precision": ".precision_command",
    "render": ".render_command",
    "scenes": ".scenes_command",
}

HELP_SETTINGS = {"max_content_width": 100, "help_option_names": ["-h", "--help"]}


@click.group(cls=CommandGroup, modules=COMMANDS, invoke_without_command=True,
             context_settings=HELP_SETTINGS)
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


if __name__ == "__main__":
    main(prog_name="cardcage")
