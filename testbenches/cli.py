"""The command line."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from .bench_command import bench_command
from .command_group import EXIT_DIFFERENT, CommandGroup, warn
from .command_options import machine_options
from .engines import AUTO, ENGINES
from .export.export_files import COMPONENT_NAMES, export, export_summary
from .hard_cases_table import hard_cases_json, hard_cases_table, hard_cases_text
from .machine_options import MachineOptions
from .model_cache import cache_folder, cache_size, clear_cache
from .plan_command import plan_command
from .precision_command import precision_command
from .progress import progress_bar
from .render import DEFAULT_SCENE, RenderOptions, prepare_render
from .render_summary import render_summary
from .scenes_table import scenes_json, scenes_table, scenes_text

#: Some minutes of simulation: say so before.
PATIENCE_CYCLES = {"pysim": 300_000, "verilator": 30_000_000}

HELP_SETTINGS = {"max_content_width": 100, "help_option_names": ["-h", "--help"]}


@click.group(cls=CommandGroup, invoke_without_command=True, context_settings=HELP_SETTINGS)
@click.version_option(package_name="cardcage", prog_name="cardcage")
@click.pass_context
def main(context: click.Context) -> None:
    """Parallel Z-buffer graphics machines as RTL, every pixel proved against a golden model.

    \b
    Examples:
      cardcage render                    the teapot, simulated and checked in some 20 seconds
      cardcage render mesh.obj           a mesh of yours
      cardcage scenes                    what else there is to draw

    \b
    Exit status: 0 done and equal, 1 the picture differs from the golden model,
    2 the input is wrong, 130 interrupted.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


@main.command()
@click.argument("scene", default=DEFAULT_SCENE, metavar="[SCENE]")
@machine_options
@click.option("--engine", type=click.Choice([AUTO, *ENGINES]), default=AUTO, show_default=True,
              help="The simulator.")
@click.option("--random-memory", type=click.IntRange(0), metavar="SEED",
              help="Start with random words in every memory, as after power-on.")
@click.option("--waveform", type=click.Path(path_type=Path), metavar="FILE.vcd",
              help="Also record every signal.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("cardcage-out"),
              show_default=True, metavar="DIR", help="Folder of the report.")
@click.pass_obj
def render(command_line: str, scene: str, waveform: Path | None, out: Path,
           **options: Any) -> None:
    """Draw SCENE on a simulated machine and compare every pixel with the golden model.

    SCENE is a mesh (.obj .stl .ply .glb .gltf), a saved display list (.npz), a hard case
    (hard:NAME) or a built-in scene, with arguments if need be.  The report goes to DIR: open
    report.html.

    \b
    Examples:
      cardcage render
      cardcage render mesh.stl --size 96x96 --out mesh-report
      cardcage render teapot --cards '4x(PMM)' --size 64x64
      cardcage render sphereflake:depth=1 --fraction-bits 6
      cardcage render random:n=40,size=12,seed=7 --preset tiny --waveform tiny.vcd
      cardcage render cardcage-out/display_list.npz --cards 'PM PMMM'
    """
    job = prepare_render(scene, RenderOptions(**options), command_line)
    for warning in job.warnings:
        warn(warning)
    expected = job.expected_cycles()
    if expected > PATIENCE_CYCLES.get(job.options.engine, PATIENCE_CYCLES["verilator"]):
        warn(f"about {expected:,} cycles to simulate: this takes long; a smaller --size is quicker")
    with progress_bar(expected) as progress:
        rendering = job.run(out, waveform, progress)
    for warning in rendering.warnings[len(job.warnings):]:
        warn(warning)
    click.echo(render_summary(rendering))
    if not rendering.comparison.equal:
        click.get_current_context().exit(EXIT_DIFFERENT)


@main.command()
@click.option("--clear", is_flag=True, help="Remove all of it.")
def cache(clear: bool) -> None:
    """Show where compiled models and long measurements are kept, or remove them.

    A model is compiled once for each machine, a machine placed and routed once; CARDCAGE_CACHE
    names another folder.

    \b
    Examples:
      cardcage cache
      cardcage cache --clear
    """
    if clear:
        click.echo(f"{clear_cache() / 1e6:,.1f} MB removed from {cache_folder()}")
    else:
        click.echo(f"{cache_size() / 1e6:,.1f} MB in {cache_folder()}")


@main.command(name="export")
@click.argument("scene", required=False, metavar="[SCENE]")
@machine_options
@click.option("--component", type=click.Choice(COMPONENT_NAMES), metavar="NAME",
              help="One board or part alone, such as memory_unit; a wrong name lists them all.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=Path("machine.v"),
              show_default=True, metavar="FILE.v", help="The Verilog; its description (.json) and "
              "Verilator's waivers (.vlt) go beside it.")
def export_command(scene: str | None, component: str | None, output: Path,
                   **options: Any) -> None:
    """Write the machine as Verilog, its ports and number formats as JSON.

    With a SCENE the number formats are what it needs; without one they draw every triangle on the
    screen exactly.

    \b
    Examples:
      cardcage export
      cardcage export mesh.obj --cards '4x(PMM)' --size 640x480 -o machine.v
      cardcage export --preset paper --shading flat -o paper.v
      cardcage export --component memory_unit -o memory_unit.v
    """
    exported = export(output, scene, MachineOptions(**options), component)
    for warning in exported.warnings:
        warn(warning)
    click.echo(export_summary(exported))


@main.command()
@click.option("--hard", is_flag=True,
              help="The hard cases, and what a naive implementation does wrong on each.")
@click.option("--json", "as_json", is_flag=True, help="For programs: a list of objects.")
def scenes(hard: bool, as_json: bool) -> None:
    """List the built-in scenes, their parameters and their triangles, or the hard cases.

    \b
    Examples:
      cardcage scenes
      cardcage scenes --json
      cardcage render sphereflake:depth=1,tessellation=2
      cardcage scenes --hard
      cardcage render hard:sliver-fan
    """
    to_json, to_table, to_text = (
        (hard_cases_json, hard_cases_table, hard_cases_text) if hard
        else (scenes_json, scenes_table, scenes_text))
    if as_json:
        click.echo(to_json())
    elif sys.stdout.isatty():
        to_table()
    else:
        click.echo(to_text())


main.add_command(bench_command)
main.add_command(plan_command)
main.add_command(precision_command)
