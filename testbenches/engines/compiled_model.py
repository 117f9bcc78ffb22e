"""From Verilog to a program: Verilator translates, the compiler compiles, nothing twice.

What a machine costs grows with its kinds of boards, less with their number.  Boards are modules
that are not inlined, and their functions are cut into pieces, so that Verilator finds the pieces
that 16 processing elements have in common and writes each once.  Its own runtime is compiled once
on a computer.  Measured with 16x(PMM): Verilator's hierarchical blocks compile each board by
itself, and simulate seven times slower; pieces without its data-flow optimisation are fewer still,
and simulate 1.4 times slower.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from ...hdl.machine import BOARDS
from ..support.cache import cached, content_hash
from .verilator_tool import ToolMissingError, VerilatorTool

#: Statements at which a function is cut; fewer cost speed for the calls, more leave fewer pieces
#: that are the same.
_PIECE = "200"

TRANSLATE = ["--cc", "--top-module", "machine", "-O3", "--x-assign", "fast",
             "--x-initial", "unique", "--no-timing", "-Wno-fatal", "-Wno-lint",
             "--output-split", "8000", "--output-split-cfuncs", _PIECE]

#: As fast as -O2 after what Verilator has done, in half the time.
_OFTEN = ["-O1", "-std=c++17"]

#: What runs once: reset values, the first evaluation.
_ONCE = ["-O0", "-std=c++17"]

#: Verilator's runtime runs in every clock and is compiled once.
_RUNTIME = ["-O2", "-std=c++17"]
_RUNTIME_PARTS = ["verilated", "verilated_threads"]

#: Bytes of source text that are worth a compiler of their own: it begins by reading Verilator's
#: headers, which takes as long as this.
_UNIT_BYTES = 1 << 20

NOT_INLINED = "`verilator_config\n" + "".join(
    f'no_inline -module "{name}"\n' for name in BOARDS)

#: All that a program depends on besides its texts and the tool.
RECIPE = [*TRANSLATE, *_OFTEN, *_ONCE, *_RUNTIME, str(_UNIT_BYTES), NOT_INLINED]


def compile_model(tool: VerilatorTool, texts: Mapping[str, str], folder: Path) -> None:
    """Build the program ``machine`` in ``folder``.

    ``texts``  ``machine.v``, ``main.cpp`` and what that includes, by name

    Raises ``ToolMissingError`` where a tool fails, ``OSError`` where the system has no room.
    """
    work = folder / "work"
    work.mkdir()
    for name, text in (*texts.items(), ("not_inlined.vlt", NOT_INLINED)):
        (work / name).write_text(text, encoding="utf-8")
    tool.translate([*TRANSLATE, "--Mdir", ".", "not_inlined.vlt", "machine.v"], work)
    include = ["-I.", *_include(tool)]
    sources = sorted(work.glob("*.cpp"), key=lambda path: -path.stat().st_size)
    slow = [path for path in sources if path.stem.endswith("Slow")]
    units = {"once": slow} | {f"often_{number}": unit for number, unit in enumerate(
        _shared_out([path for path in sources if path not in slow]))}
    for name, parts in units.items():
        (work / f"{name}.cc").write_text("".join(f'#include "{part.name}"\n' for part in parts))
    runtime = _runtime(tool)
    tool.compile([[*(_ONCE if name == "once" else _OFTEN), *include, "-c", f"{name}.cc"]
                  for name in units], work)
    _check_made(tool, work, _objects(units))
    tool.compile([["-o", "../machine", *_objects(units), *runtime, "-lpthread"]], work)
    _check_made(tool, folder, ["machine"])
    shutil.rmtree(work)


def _shared_out(sources: Iterable[Path]) -> list[list[Path]]:
    """Source files, the largest first, in units of about the same size, a core for each."""
    sources = list(sources)
    size = sum(path.stat().st_size for path in sources)
    units: list[list[Path]] = [[] for _ in range(
        max(1, min(os.cpu_count() or 1, size // _UNIT_BYTES)))]
    for path in sources:
        min(units, key=lambda unit: sum(part.stat().st_size for part in unit)).append(path)
    return units


def _include(tool: VerilatorTool) -> list[str]:
    return [f"-I{tool.root / 'include'}", f"-I{tool.root / 'include' / 'vltstd'}"]


def _runtime(tool: VerilatorTool) -> list[str]:
    """The objects of Verilator's runtime, compiled where they are not kept."""

    def build(folder: Path) -> None:
        tool.compile([[*_RUNTIME, *_include(tool), "-c",
                       str(tool.root / "include" / f"{part}.cpp"), "-o", f"{part}.o"]
                      for part in _RUNTIME_PARTS], folder)
        _check_made(tool, folder, _objects(_RUNTIME_PARTS))

    folder, _ = cached(content_hash(["runtime", *tool.versions(), *_RUNTIME]), build)
    return [str(folder / name) for name in _objects(_RUNTIME_PARTS)]


def _objects(names: Iterable[str]) -> list[str]:
    return [f"{name}.o" for name in names]


def _check_made(tool: VerilatorTool, folder: Path, names: Iterable[str]) -> None:
    """What is not there must not be kept as if it were."""
    for name in names:
        if not (folder / name).exists():
            raise ToolMissingError(f"{' '.join(tool.compiler)} made no {name}: is it a C++ "
                                   "compiler?")
