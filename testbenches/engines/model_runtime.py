"""What models have in common, compiled once on a computer: the main program, Verilator's runtime
and its headers."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import resources
from pathlib import Path

from ..support.cache import cached, content_hash
from .model_constants import model_constants
from .verilator_tool import ToolMissingError, VerilatorTool

#: For Verilator, besides what it is to translate.
TRANSLATION = ["--cc", "-O3", "--x-assign", "fast", "--x-initial", "unique", "--no-timing",
             "-Wno-fatal", "-Wno-lint"]

#: As fast as -O2 after what Verilator has done, in half the time.
OFTEN = ["-O1", "-std=c++17"]

#: Begins a source file that runs once: reset values, the first evaluation.
ONCE = """\
#ifdef __clang__
#pragma clang optimize off
#else
#pragma GCC optimize ("O0")
#endif
"""

#: The runtime runs in every clock.
_RUNTIME = ["-O2", "-std=c++17"]
_PARTS = ["verilated", "verilated_threads"]
_HEADER = "verilated_before.h"

_MAIN = "verilator_main.cpp"


def engine_text(name: str) -> str:
    """A source file of this folder."""
    return (resources.files(__package__) / name).read_text("utf-8")


def port_texts(clock: str) -> dict[str, str]:
    """The sources between the main program and what Verilator writes, by name; ``clock`` is the
    file that says what a clock is."""
    sources = {"verilator_model.h": "verilator_model.h",
               "verilator_model.cpp": "verilator_model.cpp", "clock.h": clock}
    return {name: engine_text(source) for name, source in sources.items()}


def recipe() -> list[str]:
    """All that a model depends on besides its texts and the tool."""
    return [*TRANSLATION, *OFTEN, ONCE, *_RUNTIME, *_main_texts().values()]


def include(tool: VerilatorTool) -> list[str]:
    """Where the compiler finds Verilator's headers."""
    return [f"-I{tool.root / 'include'}", f"-I{tool.root / 'include' / 'vltstd'}"]


def runtime(tool: VerilatorTool) -> list[str]:
    """The objects of Verilator's runtime, compiled where they are not kept."""

    def build(folder: Path) -> None:
        tool.compile([[*_RUNTIME, *include(tool), "-c",
                       str(tool.root / "include" / f"{part}.cpp"), "-o", f"{part}.o"]
                      for part in _PARTS], folder)
        check_made(tool, folder, objects(_PARTS))

    folder, _ = cached(content_hash(["runtime", *tool.versions(), *_RUNTIME]), build)
    return [str(folder / name) for name in objects(_PARTS)]


def main_program(tool: VerilatorTool) -> str:
    """The object of the main program, which drives whatever model it is linked with; compiled where
    it is not kept."""
    texts = _main_texts()

    def build(folder: Path) -> None:
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        tool.compile([[*_RUNTIME, "-c", _MAIN, "-o", "main.o"]], folder)
        check_made(tool, folder, ["main.o"])

    folder, _ = cached(content_hash(["main program", *tool.versions(), *_RUNTIME, *texts.values()]),
                       build)
    return str(folder / "main.o")


def _main_texts() -> dict[str, str]:
    """The main program and what it includes, by name."""
    return {_MAIN: engine_text(_MAIN), "verilator_model.h": engine_text("verilator_model.h"),
            "model_constants.h": model_constants()}


def headers(tool: VerilatorTool) -> list[str]:
    """Arguments to compile what Verilator wrote, beside ``OFTEN``.

    To read its headers takes as long as to compile a board; the GNU compiler keeps them compiled,
    and reads them itself where it finds that those are not for it.
    """
    if not any("Free Software Foundation" in said for said in tool.versions()):
        return include(tool)

    def build(folder: Path) -> None:
        (folder / _HEADER).write_text('#include "verilated.h"\n', encoding="ascii")
        tool.compile([[*OFTEN, *include(tool), "-x", "c++-header",
                       str(tool.root / "include" / "verilated.h"), "-o", f"{_HEADER}.gch"]], folder)
        check_made(tool, folder, [f"{_HEADER}.gch"])

    folder, _ = cached(content_hash(["headers", *tool.versions(), *OFTEN, *include(tool)]), build)
    return ["-include", str(folder / _HEADER), *include(tool)]


def objects(names: Iterable[str]) -> list[str]:
    return [f"{name}.o" for name in names]


def check_made(tool: VerilatorTool, folder: Path, names: Iterable[str]) -> None:
    """What is not there must not be kept as if it were."""
    for name in names:
        if not (folder / name).exists():
            raise ToolMissingError(f"{' '.join(tool.compiler)} made no {name}: is it a C++ "
                                   "compiler?")
