"""From a machine that is cut into cores and a shell to a program: cores are kept, and compiled only
where no machine had them before.

Measured with 16x(PMM) at 128x128 (``python -m testbenches.studies.model_building``): a quarter of
the processor time that it takes in one piece, a tenth where the cores are there.  It is simulated
as fast, for the one text of all domains stays in the processor's caches; with other cards slower.
"""

from __future__ import annotations

import platform
import re
import shutil
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

from ....golden.specification.card_order import MEMORY_UNIT, PROCESSING_ELEMENT
from ....golden.specification.configuration import MachineConfiguration
from ...support.cache import cached, content_hash, lookup, sources_hash
from .. import model_runtime
from ..model_runtime import (
    OFTEN,
    ONCE,
    TRANSLATION,
    check_made,
    headers,
    main_program,
    port_texts,
    runtime,
)
from ..model_wrapper import TOP, machine_numbers, shell_wrapper
from ..verilator_tool import VerilatorTool
from . import core_module
from .core_module import Core
from .core_texts import cores_text, step_text
from .split_machine import SplitMachine, array_ports

#: Machines with fewer domains of one kind are compiled soon enough in one piece, which is simulated
#: up to a quarter faster while it fits into the processor's caches.
_LEAST_ALIKE = 12
#: Each kind takes a translation and a compiler, all at the same time.
_MOST_KINDS = 4

#: Ports that are arrays are copied in loops: with a line for each element the shell would cost more
#: than the cores.
_TRANSLATE_SHELL = [*TRANSLATION, "--expand-limit", "2"]

#: What a clock of the model is.
_CLOCK = "split_clock.h"


def recipe() -> list[str]:
    """All that a program depends on besides its machine and the tool."""
    return [*_TRANSLATE_SHELL, *model_runtime.recipe(), *port_texts(_CLOCK).values(),
            sources_hash("testbenches/engines/domains")]


def has_equal_domains(configuration: MachineConfiguration) -> bool:
    """Many alike and few others, and no cards but theirs.

    Not where the machine sets up triangles itself: its controller is then larger than all domains,
    and is cut in no less time than it is compiled in.
    """
    others = set(configuration.cards) - {PROCESSING_ELEMENT, MEMORY_UNIT}
    alike = Counter(re.findall(f"{PROCESSING_ELEMENT}{MEMORY_UNIT}*", configuration.cards))
    return (not others and configuration.setup == "host" and len(alike) <= _MOST_KINDS
            and max(alike.values(), default=0) >= _LEAST_ALIKE)


def compile_domains(tool: VerilatorTool, configuration: MachineConfiguration, split: SplitMachine,
                    folder: Path) -> None:
    """Build the program ``machine`` in ``folder``.

    Raises ``ToolMissingError`` where a tool fails, ``OSError`` where the system has no room.
    """
    work = folder / "work"
    work.mkdir()
    cores = {_core_name(tool, core): core for core in split.cores}
    assert len(cores) == len(split.cores), "groups of other boards are the same"
    found = {name: lookup(_key(name)) for name in cores}
    missing = [name for name in cores if found[name] is None]
    shell = work / "shell"
    shell.mkdir()
    _write_shell(configuration, split, cores, shell)
    for name in missing:
        (work / name).mkdir()
        (work / name / "core.v").write_text(cores[name].verilog, encoding="utf-8")
    tool.run([
        [str(tool.executable), *_TRANSLATE_SHELL, "--top-module", TOP, "--Mdir", "shell",
         "shell/machine.v", "shell/model.v"],
        *([str(tool.executable), *TRANSLATION, "--prefix", name, "--top-module", core_module.TOP,
           "--Mdir", name, f"{name}/core.v"] for name in missing)], work)
    for name in missing:
        _write_unit(work / name, step_text(name, _sources(work / name)))
    _write_unit(shell, "")
    folders = [str(found[name] or work / name) for name in cores]
    common = [*OFTEN, *headers(tool)]
    tool.run([
        [*tool.compiler, *common, "-Ishell", *(f"-I{path}" for path in folders), "-c",
         "shell/unit.cc", "-o", "shell/unit.o"],
        *([*tool.compiler, *common, f"-I{name}", "-c", f"{name}/unit.cc", "-o", f"{name}/core.o"]
          for name in missing)], work)
    check_made(tool, work, ["shell/unit.o", *(f"{name}/core.o" for name in missing)])
    for name in missing:
        def keep(kept_folder: Path, name: str = name) -> None:
            for part in ("core.o", f"{name}.h"):
                shutil.copyfile(work / name / part, kept_folder / part)

        cached(_key(name), keep)
    tool.compile([["-o", "../machine", "shell/unit.o",
                   *(f"{path}/core.o" for path in folders), main_program(tool), *runtime(tool),
                   "-lpthread"]], work)
    check_made(tool, folder, ["machine"])
    shutil.rmtree(work)


def _core_name(tool: VerilatorTool, core: Core) -> str:
    """Of its class: by all that its object depends on."""
    return "Vcore_" + content_hash([core.verilog, *TRANSLATION, *OFTEN, ONCE, *tool.versions(),
                                    sources_hash("testbenches/engines/domains"),
                                    platform.machine()])


def _key(name: str) -> str:
    """In the cache."""
    return name.removeprefix("Vcore_")


def _write_shell(configuration: MachineConfiguration, split: SplitMachine,
                 cores: Mapping[str, Core], folder: Path) -> None:
    texts = {"machine.v": split.shell,
             "model.v": shell_wrapper(configuration, array_ports(split.cores)),
             "machine_numbers.h": machine_numbers(configuration), "cores.h": cores_text(cores)}
    for name, text in (texts | port_texts(_CLOCK)).items():
        (folder / name).write_text(text, encoding="utf-8")


def _sources(folder: Path) -> str:
    """What Verilator wrote."""
    return "".join(path.read_text("utf-8") for path in sorted(folder.glob("*.cpp")))


def _write_unit(folder: Path, end: str) -> None:
    """All sources of a folder, and ``end``, as one: to start a compiler costs as much as a small
    one of them."""
    parts = sorted(folder.glob("*.cpp"))
    once = [path for path in parts if path.stem.endswith("Slow")]
    lines = [*(f'#include "{path.name}"\n' for path in parts if path not in once), end, ONCE,
             *(f'#include "{path.name}"\n' for path in once)]
    (folder / "unit.cc").write_text("".join(lines), encoding="utf-8")
