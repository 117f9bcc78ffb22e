"""``cardcage bench``."""

from __future__ import annotations

import json
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Any, get_args

import click

from ...golden.specification.configuration import RANGES
from ...golden.specification.errors import InputError
from ...golden.specification.regions import Balance
from ..engines.choose_engine import ENGINE_NAMES, make_engine
from ..machine_options import SETUPS, MachineOptions
from ..speed.baseline import against, load_baseline
from ..speed.cases import DEFAULT_CASES, ORDERS, case_names, check_case
from ..speed.machines import (
    ALL_MACHINES,
    MachineAxes,
    bench_machines,
    beside_interlace,
    varied,
)
from ..speed.speed_rows import bench, steps
from ..speed.speed_table import bench_facts, bench_table, bench_text
from ..support.atomic_output import atomic_file, output_errors
from ..support.progress import step_bar
from .command_group import EXIT_DIFFERENT
from .command_options import RegionCounts, Several, view_options

#: The value of ``--engine`` that asks the cycle model only.
MODEL = "model"


def _numbers(least: int, most: int) -> Several:
    return Several(click.IntRange(least, most), "N,…")


@click.command(name="bench")
@click.argument("cases", nargs=-1, metavar="[CASE]...")
@click.option("--elements", type=_numbers(1, 4096), help="Processing elements.  [default: 1,16]")
@click.option("--units", type=_numbers(1, 64), help="Memory units of each.  [default: 2]")
@click.option("--ports", type=_numbers(*RANGES["memory_ports"]),
              help="Ports of a memory unit.  [default: 2]")
@click.option("--setup", "setups", type=Several(click.Choice(list(SETUPS)), "WHO,…"),
              help="Who prepares the triangles: host, small or fast hardware.  [default: host]")
@click.option("--block", "blocks", type=_numbers(*RANGES["block"]),
              help="Pixels a side that neighbour in one processing element; 1 interlaces pixel by "
              "pixel.  [default: 1]")
@click.option("--skew/--no-skew", default=None, help="Whether two units of a processing element "
              "alternate along its rows, not only from row to row; wants --block 1.  [default: "
              "where they have one port]")
@click.option("--lines", type=Several(click.BOOL, "yes|no,…"), help="Whether processing elements "
              "have whole lines in turn, in place of --block 1.  [default: no]")
@click.option("--fifo", "fifos", type=_numbers(*RANGES["fifo_depth"]),
              help="Triangles a processing element holds in waiting.  [default: 16]")
@click.option("--regions", type=Several(RegionCounts("none"), "COLUMNSxROWS,…"),
              help="Regions of the screen, dealt out by what the same picture costs them, as in "
              "8x16; none interlaces pixels.  [default: none]")
@click.option("--balance", "balances", type=Several(click.Choice(get_args(Balance)), "WHAT,…"),
              help="With regions: what is counted of each: static nothing, triangles, or clocks.  "
              "[default: clocks]")
@click.option("--order", "orders", type=Several(click.Choice(ORDERS), "HOW,…"),
              help="visible: each triangle lies before those drawn earlier; random: the list "
              "stays, and depths are shuffled.  Of mesh, which has depths of its own, visible "
              "draws the list in its order, and random shuffles the list.  [default: visible]")
@view_options
@click.option("--all", "everything", is_flag=True, help="Every case, order and machine that no "
              "option restricts: hours.")
@click.option("--engine", type=click.Choice([*ENGINE_NAMES, MODEL]), default="verilator",
              show_default=True, help="The simulator; model simulates nothing and asks the cycle "
              "model.")
@click.option("--json", "json_file", type=click.Path(path_type=Path), metavar="FILE",
              help="Also write the figures, for programs and as a baseline.")
@click.option("--against", "baseline", type=click.Path(path_type=Path), metavar="FILE",
              help="Compare with the figures that --json wrote earlier.")
@click.option("--plot", type=click.Path(path_type=Path), metavar="FILE.png",
              help="Also draw the speed along --fifo, --block or --elements; with --regions none "
              "and others, that of regions beside that of interlaced pixels.")
@click.pass_obj
def bench_command(command_line: str, /, cases: tuple[str, ...], orders: tuple[Any, ...] | None,
                  everything: bool, engine: str, json_file: Path | None, baseline: Path | None,
                  plot: Path | None, view: Any, zoom: float | None, background: Any,
                  cull: bool | None, light: Any, **axes: Any) -> None:
    """Measure clocks per triangle and fragment on chosen machines, beside the peers' figures.

    Every machine is exact for any triangle on its 512x512 screen, and scans its picture out
    meanwhile, at four clocks a pixel.  Options with commas multiply.  A CASE is a list of
    triangles that open rasterisers were measured on, or mesh, a teapot of 53,592 triangles; a
    wrong name lists close ones.  Without options a few cases run on 1 and 16 processing elements.

    \b
    Examples:
      cardcage bench
      cardcage bench one_pixel random_bbox16 --elements 1,4,16 --units 1,2
      cardcage bench mesh --view 90,10 --cull --elements 16
      cardcage bench mesh --elements 16 --fifo 2,4,8,16,32,64 --plot fifo.png
      cardcage bench random_bbox16 mesh --elements 16 --block 1,2,4,8,16,32 --engine model
      cardcage bench random_bbox16 sliver_vert_2x480 --ports 1 --no-skew
      cardcage bench random_bbox16 sliver_diag_480 --elements 16 --regions none,8x16
      cardcage bench random_bbox16 --elements 256,1024 --engine model
      cardcage bench --json now.json --against before.json
      cardcage bench --all --json everything.json

    Exit status: 0 every picture equal and nothing slower, 1 a picture differs or a figure of
    --against is better, 2 the input or the system is at fault.
    """
    chosen = {name: values for name, values in axes.items() if values is not None}
    standard = vars(ALL_MACHINES) if everything else {}
    if axes["balances"] and not any(axes["regions"] or ()):
        raise InputError("--balance: is for regions that are dealt out; give --regions as well")
    machines = bench_machines(MachineAxes(**standard | chosen))
    if plot is not None and not (varied(machines) or beside_interlace(machines)):
        raise InputError("--plot: nothing to draw along; give --fifo, --block or --elements "
                         "several numbers, or --regions none and others")
    names = [check_case(case) for case in cases] or list(
        case_names() if everything else DEFAULT_CASES)
    orders = orders or (ORDERS if everything else ORDERS[:1])
    looking = MachineOptions(view=view, zoom=zoom, background=background, cull=cull, light=light)
    if baseline is not None and engine == MODEL:
        raise InputError("--against: only what is simulated is compared; leave out --engine model")
    before = None if baseline is None else load_baseline(baseline)
    with ExitStack() as outputs:
        files = {path: outputs.enter_context(atomic_file(path, option))
                 for path, option in ((json_file, "--json"), (plot, "--plot")) if path is not None}
        with step_bar(steps(machines, names, orders)) as step:
            rows = list(bench(machines, names, orders,
                              None if engine == MODEL else make_engine(engine), step, looking))
        if json_file is not None:
            facts = {"command_line": command_line, "rows": bench_facts(rows)}
            with output_errors(json_file, "--json"):
                files[json_file].write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
        if plot is not None:
            # They take a second to load.
            from ..speed.region_chart import region_chart
            from ..speed.speed_chart import bench_chart

            with output_errors(plot, "--plot"):
                draw = region_chart if beside_interlace(machines) else bench_chart
                draw(rows, files[plot])
    if sys.stdout.isatty():
        bench_table(rows)
    else:
        click.echo(bench_text(rows))
    if before is not None:
        comparison = against(rows, before)
        click.echo(comparison.text())
        if comparison.slower:
            click.get_current_context().exit(EXIT_DIFFERENT)
