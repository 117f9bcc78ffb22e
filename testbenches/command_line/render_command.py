"""``cardcage render``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ...golden.scene_display_list import description_of
from ...golden.specification.errors import InputError
from ..engines.choose_engine import AUTO, ENGINE_NAMES
from ..render import DEFAULT_SCENE, prepare_render
from ..render_frames import FramesOptions, check_alone, prepare_frames
from ..support.progress import busy, progress_bar
from .command_group import EXIT_DIFFERENT, warn
from .command_options import machine_options, sequence_options
from .tables.render_summary import frames_summary, render_summary

#: Some minutes of simulation: say so before.
PATIENCE_CYCLES = {"pysim": 300_000, "verilator": 30_000_000}


@click.command(name="render")
@click.argument("scene", default=DEFAULT_SCENE, metavar="[SCENE]")
@machine_options
@click.option("--engine", type=click.Choice([AUTO, *ENGINE_NAMES]), default=AUTO, show_default=True,
              help="The simulator.")
@click.option("--random-memory", type=click.IntRange(0), metavar="SEED",
              help="Start with random words in every memory, as after power-on.")
@click.option("--waveform", type=click.Path(path_type=Path), metavar="FILE.vcd",
              help="Also record every signal.")
@sequence_options
@click.option("--depth", type=click.Choice(["last", "all"]), default="last", show_default=True,
              help="With --frames or --path: whose depths are read back as well.")
@click.option("--out", type=click.Path(path_type=Path), metavar="DIR",
              help="Folder of the report; where nothing is said cardcage-out, or what a scene file "
              "says.")
@click.pass_obj
def render_command(command_line: str, /, scene: str, waveform: Path | None,
                   out: Path | None, **options: Any) -> None:
    """Draw SCENE on a simulated machine and compare every pixel with the golden model.

    SCENE is a mesh (.obj .stl .ply .glb .gltf), a scene file (.scene), a saved display list
    (.npz), a hard case (hard:NAME) or a built-in scene, with arguments if need be.  The report
    goes to DIR: open report.html.

    \b
    Examples:
      cardcage render
      cardcage render mesh.stl --size 96x96 --out mesh-report
      cardcage render teapot --cards '4x(PMM)' --size 64x64
      cardcage render teapot --view 200,45 --zoom 1.5 --background navy
      cardcage render teapot --frames 8 --turn 45 --out turning
      cardcage render teapot --frames 8 --turn 45 --cards '3x(PMM)' --regions 8x8
      cardcage render sphereflake:depth=1 --fraction-bits 6
      cardcage render random:n=40,size=12,seed=7 --preset tiny --waveform tiny.vcd
      cardcage render cardcage-out/display_list.npz --cards 'PM PMMM'
    """
    asked = FramesOptions(**options)
    if out is None:
        out = _report_folder(scene)
    if asked.frames is not None or asked.path is not None:
        _render_frames(scene, asked, waveform, out, command_line)
        return
    check_alone(asked)
    job = prepare_render(scene, asked, command_line)
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
    if not rendering.equal:
        click.get_current_context().exit(EXIT_DIFFERENT)


def _report_folder(scene: str) -> Path:
    description = description_of(scene)
    return Path((description and description.outfile) or "cardcage-out")


def _render_frames(scene: str, options: FramesOptions, waveform: Path | None, out: Path,
                   command_line: str) -> None:
    if waveform is not None:
        raise InputError("--waveform: is of one picture; leave out --frames and --path")
    with busy("looking from every side"):
        job = prepare_frames(scene, options, command_line)
    for warning in job.warnings:
        warn(warning)
    with progress_bar(job.expected_cycles()) as progress:
        rendering = job.run(out, progress)
    for warning in rendering.shown.warnings[len(job.warnings):]:
        warn(warning)
    click.echo(frames_summary(rendering))
    if not rendering.equal:
        click.get_current_context().exit(EXIT_DIFFERENT)
