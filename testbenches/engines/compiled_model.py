"""From Verilog to a program: Verilator translates, the compiler compiles, nothing twice.

What a machine costs grows with its kinds of boards, less with their number.  Boards are modules
that are not inlined, and their functions are cut into pieces, so that Verilator finds the pieces
that 16 processing elements have in common and writes each once.  What all models have in common,
the main program among it, is compiled once on a computer (``model_runtime``).  Measured with
16x(PMM): Verilator's hierarchical blocks compile each board by itself, and simulate seven times
slower; pieces without its data-flow optimisation are fewer still, and simulate 1.4 times slower.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from ...hdl.machine import BOARDS
from . import model_runtime
from .model_runtime import (
    OFTEN,
    ONCE,
    TRANSLATION,
    check_made,
    headers,
    main_program,
    objects,
    port_texts,
    runtime,
)
from .model_wrapper import TOP
from .verilator_tool import VerilatorTool

#: Statements at which a function is cut; fewer cost speed for the calls, more leave fewer pieces
#: that are the same.
_PIECE = "200"

TRANSLATE = [*TRANSLATION, "--top-module", TOP, "--output-split", "8000",
             "--output-split-cfuncs", _PIECE]

#: Bytes of source text that are worth a compiler of their own.
_UNIT_BYTES = 1 << 20

NOT_INLINED = "`verilator_config\n" + "".join(
    f'no_inline -module "{name}"\n' for name in BOARDS)

#: What a clock of the model is.
_CLOCK = "whole_clock.h"


def recipe() -> list[str]:
    """All that a program depends on besides its texts and the tool."""
    return [*TRANSLATE, *model_runtime.recipe(), str(_UNIT_BYTES), NOT_INLINED,
            *port_texts(_CLOCK).values()]


def compile_model(tool: VerilatorTool, texts: Mapping[str, str], folder: Path) -> None:
    """Build the program ``machine`` in ``folder``.

    ``texts``  ``machine.v``, ``model.v`` around it, and ``machine_numbers.h``, by name

    Raises ``ToolMissingError`` where a tool fails, ``OSError`` where the system has no room.
    """
    work = folder / "work"
    work.mkdir()
    for name, text in {**texts, **port_texts(_CLOCK), "not_inlined.vlt": NOT_INLINED}.items():
        (work / name).write_text(text, encoding="utf-8")
    tool.translate([*TRANSLATE, "--Mdir", ".", "not_inlined.vlt", "machine.v", "model.v"], work)
    sources = sorted(work.glob("*.cpp"), key=lambda path: -path.stat().st_size)
    slow = [path for path in sources if path.stem.endswith("Slow")]
    units = {"once": slow} | {f"often_{number}": unit for number, unit in enumerate(
        _shared_out([path for path in sources if path not in slow]))}
    for name, parts in units.items():
        (work / f"{name}.cc").write_text(ONCE * (name == "once") + "".join(
            f'#include "{part.name}"\n' for part in parts))
    common, kept = ["-I.", *headers(tool)], [main_program(tool), *runtime(tool)]
    tool.compile([[*OFTEN, *common, "-c", f"{name}.cc"] for name in units], work)
    check_made(tool, work, objects(units))
    tool.compile([["-o", "../machine", *objects(units), *kept, "-lpthread"]], work)
    check_made(tool, folder, ["machine"])
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
