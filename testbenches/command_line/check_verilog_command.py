"""``cardcage check-verilog``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from ...golden.planning.scene_needs import fitted
from ...golden.scene_argument import DESCRIPTION_EXTENSION
from ...golden.scene_display_list import make_display_list
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ..cocotb_bench.exchange import read_configuration
from ..cocotb_bench.simulators import SIMULATORS
from ..engines.verilator_tool import ToolMissingError
from ..frames.compare import Comparison, compare
from ..frames.object_figures import object_figures
from ..frames.region_figures import RegionTables
from ..frames.responses import Simulation
from ..frames.simulation import simulate
from ..frames.wrong_counts import wrong_counts
from ..support.machine_error import MachineError
from .command_group import EXIT_DIFFERENT


@click.command(name="check-verilog")
@click.argument("verilog", type=click.Path(path_type=Path), metavar="MACHINE.v")
@click.argument("list_file", type=click.Path(path_type=Path), metavar="DISPLAY_LIST.npz|SCENE")
@click.option("--simulator", type=click.Choice(list(SIMULATORS)), default="verilator",
              show_default=True, help="Who simulates the Verilog.")
@click.option("--configuration", type=click.Path(path_type=Path), metavar="MACHINE.json",
              help="What the Verilog was built for.  [default: beside MACHINE.v, same name]")
@click.option("--stall-seed", type=click.IntRange(min=0), default=1, show_default=True,
              metavar="SEED", help="Of the host's pauses on both streams.")
@click.option("--no-stalls", is_flag=True, help="The host never pauses.")
@click.option("--memory-seed", type=click.IntRange(min=0), default=1, show_default=True,
              metavar="SEED", help="Of the memories' contents at power-on in Verilator; Icarus "
              "has them unknown (X).")
@click.option("--waveform", type=click.Path(path_type=Path), metavar="FILE",
              help="Write every signal: .vcd from Verilator, .fst from Icarus.")
def check_verilog_command(
        verilog: Path, list_file: Path, simulator: str, configuration: Path | None,
        stall_seed: int, no_stalls: bool, memory_seed: int, waveform: Path | None) -> None:
    """Draw DISPLAY_LIST with MACHINE.v in a Verilog simulator and check all that leaves it.

    In place of a display list it may be a scene file (.scene) or a built-in scene: a machine that
    makes the triangles of objects itself is sent these.

    \b
    Examples:
      cardcage check-verilog machine.v display_list.npz
      cardcage check-verilog machine.v three_cubes --no-stalls
      cardcage check-verilog machine.v display_list.npz --simulator icarus

    \b
    Exit status: 0 done and equal, 1 the picture differs from the golden model or a rule of the
    documents is broken, 2 the input or the system is at fault or the simulator is missing.
    """
    machine = read_configuration(configuration or verilog.with_suffix(".json"))
    display_list = _display_list(machine, list_file)
    _check_match(machine, display_list)
    if waveform is not None and not waveform.parent.is_dir():
        raise InputError(f"--waveform: there is no folder {waveform.parent}; make it "
                         "first")
    text = _text(verilog)
    from ..cocotb_bench.engine import CocotbEngine  # loads Amaranth

    # Regions are drawn by a table that the host sends, if it may.
    tables = None if machine.regions is None else RegionTables(machine, [display_list] * 2)
    number = int(machine.balancer == "host")
    try:
        simulation = simulate(machine, display_list, CocotbEngine(simulator, verilog=text),
                              memory_seed=memory_seed, waveform=waveform,
                              stall_seed=None if no_stalls else stall_seed,
                              table=None if tables is None else tables.sent(number))
    except (AssertionError, TimeoutError, MachineError) as error:
        raise MachineError(f"{verilog}: {error}") from None
    except ToolMissingError as missing:
        raise InputError(str(missing)) from None
    comparison = compare(machine, display_list, simulation)
    wrong = wrong_counts(None if tables is None else tables.figures(number, simulation),
                         object_figures(machine, display_list, simulation))
    click.echo(_summary(simulation, comparison, wrong))
    if wrong or not comparison.equal:
        click.get_current_context().exit(EXIT_DIFFERENT)


def _display_list(machine: MachineConfiguration, path: Path) -> DisplayList:
    """Of a file; of a scene, as the machine can draw it."""
    if path.suffix.lower() == DESCRIPTION_EXTENSION or not (path.suffix or path.exists()):
        return make_display_list(path, width=machine.width, height=machine.height,
                                 depth_bits=machine.depth_bits,
                                 shading=machine.shading).display_list
    return DisplayList.load(path)


def _text(verilog: Path) -> str:
    try:
        return verilog.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{verilog}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{verilog}: not a text in UTF-8; is this Verilog?") from None


def _check_match(machine: MachineConfiguration, display_list: DisplayList) -> None:
    """``InputError`` where the machine is built for other display lists."""
    fitted(machine, display_list)
    if machine.shading == "flat" and not display_list.flat:
        raise InputError("display list: its triangles have more than one colour, the machine is "
                         "built for flat ones: export a machine for this list")


def _summary(simulation: Simulation, comparison: Comparison, wrong: Sequence[str]) -> str:
    """``wrong``: a line for each count that is not golden's."""
    lines = [
        f"equal: {comparison.pixels_compared:,} colours and {comparison.depths_compared:,} depths "
        "compared, 0 different" if comparison.equal else
        f"DIFFERENT: {comparison.pixels_different:,} of {comparison.pixels_compared:,} colours, "
        f"{comparison.depths_different:,} of {comparison.depths_compared:,} depths",
        f"  {simulation.engine}: {simulation.cycles:,} cycles, {len(simulation.scans)} whole scans "
        f"in {simulation.seconds:.1f} s, after {simulation.build_seconds:.1f} s of building",
        *(f"  DIFFERENT: {line}" for line in wrong),
    ]
    if (first := comparison.first_difference) is not None:
        lines.insert(1, f"  first wrong pixel {first.pixel}: expected colour "
                     f"{first.expected.color} depth {first.expected.depth}, got colour "
                     f"{first.got.color} depth {first.got.depth}")
    return "\n".join(lines)

