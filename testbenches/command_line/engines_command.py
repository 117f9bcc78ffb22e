"""``cardcage engines``."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import click

from ...golden.planning.machine_plan import plan
from ...golden.planning.presets import PRESETS
from ...golden.scene_display_list import make_display_list
from ...golden.specification.errors import InputError
from ..engines.verilator_tool import ToolMissingError
from ..support.counted import counted
from ..support.progress import busy
from .command_options import RegionCounts


@click.command(name="engines")
@click.option("--preset", "name", type=click.Choice(list(PRESETS)), default="paper",
              show_default=True, help="The machine, as wide as the scene needs.")
@click.option("--scene", default="teapot:tessellation=8", show_default=True, help="What it draws.")
@click.option("--cards", metavar="CARDS", help="Instead of the preset's.")
@click.option("--retain", is_flag=True, help="Nodes keep their triangles in list memories.")
@click.option("--regions", type=RegionCounts(), metavar="COLUMNSxROWS",
              help="Deal so many regions of the screen out, one after another.")
@click.option("--runs", type=click.IntRange(1), default=5, show_default=True,
              help="Of which the median counts.")
@click.option("--pysim-cycles", type=click.IntRange(1), default=2048, show_default=True,
              help="Cycles of the slow engine that are waited for.")
@click.option("--json", "as_json", is_flag=True, help="For programs: one object.")
def engines_command(name: str, scene: str, cards: str | None, retain: bool,
                    regions: tuple[int, int] | None, runs: int, pysim_cycles: int,
                    as_json: bool) -> None:
    """Measure how fast the simulators are on this computer.

    Simulated cycles a second of one frame: through the Verilator engine, in a bare loop that only
    toggles the clock of the same compiled model, and in Amaranth's own simulator.

    \b
    Examples:
      cardcage engines
      cardcage engines --preset small --scene teapot
      cardcage engines --cards '16x(PMMC)' --retain --scene teapot:tessellation=29
      cardcage engines --cards '16x(PMM)' --regions 16x8
    """
    from ..speed.engine_speed import measure_engines  # loads Amaranth

    size: dict[str, Any] = {axis: PRESETS[name][axis] for axis in ("width", "height")}
    display_list = make_display_list(scene, **size).display_list
    asked = PRESETS[name] | {"fraction_bits": None} | ({"cards": cards} if cards else {})
    machine = plan(display_list, retain=retain, regions=regions, **asked).configuration
    try:
        with busy("measuring engines"):
            speed = measure_engines(machine, display_list, runs=runs, pysim_cycles=pysim_cycles)
    except ToolMissingError as missing:
        raise InputError(f"verilator: {missing}; only pysim works here") from None
    if as_json:
        click.echo(json.dumps({"cards": machine.cards, "scene": scene, **asdict(speed)}, indent=1))
        return
    built = ("found" if speed.build_seconds is None
             else f"built in {speed.build_seconds:.0f} s")
    click.echo(f"machine   {machine.cards}, {machine.width}x{machine.height}, "
               f"{machine.fraction_bits} fraction bits; model {built}")
    click.echo(f"frame     {scene}: {counted(display_list.triangles, 'triangle')}, "
               f"{speed.cycles:,} cycles")
    click.echo(f"verilator {speed.verilator:12,.0f} cycles a second, whole frame, median of {runs}")
    click.echo(f"bare loop {speed.bare_loop:12,.0f} cycles a second; ratio "
               f"{speed.verilator / speed.bare_loop:.2f}")
    click.echo(f"pysim     {speed.pysim:12,.0f} cycles a second; verilator is "
               f"{speed.verilator / speed.pysim:,.0f} times as fast")
