"""The C++ between cores, which are compiled by themselves, and the shell between them."""

from __future__ import annotations

from collections.abc import Mapping

from .core_module import Core


def step_text(core: str, generated: str) -> str:
    """The function that gives a core a clock, for the end of its own source.

    ``core``  the class that Verilator made, in ``generated``.

    Verilator's ``eval`` looks for what has changed; here that is known: the inputs, then the clock.
    Where its two functions for that, or what they look at, have other names, ``eval`` has to do.
    """
    root, step = f"{core}___024root", f"\nvoid step_core({core}& core)"
    needed = (f"{root}___eval_ico(", f"{root}___eval_nba(",
              "__VicoTriggered[0", "__VnbaTriggered[0")
    if not all(name in generated for name in needed):
        return f"""{step} {{
    core.clk = 0;
    core.eval();
    core.clk = 1;
    core.eval();
}}
"""
    return f"""{step} {{
    {root}* const root = core.rootp;
    root->__VicoTriggered[0] = 1;
    {root}___eval_ico(root);
    root->__VnbaTriggered[0] = 1;
    {root}___eval_nba(root);
}}
"""


def cores_text(cores: Mapping[str, Core]) -> str:
    """The header ``cores.h``: each kind of core, by its class, as ``split_clock.h`` wants it."""
    lines = [f'#include "{name}.h"' for name in cores]
    for number, (name, core) in enumerate(cores.items()):
        lines += [
            f"void step_core({name}& core);",
            f"struct Core{number} {{",
            f"    using Core = {name};",
            f"    static constexpr unsigned COUNT = {core.count};",
            f'    inline static const std::string NAME = "core{number}_";',
            "    static void take(Core& core, const Vmodel& shell, unsigned n) {",
            *(f"        core.i{place} = shell.{port.name}[n];"
              for place, port in enumerate(core.taken)),
            "    }",
            "    static void show(const Core& core, Vmodel& shell, unsigned n) {",
            *(f"        shell.{port.name}[n] = core.o{place};"
              for place, port in enumerate(core.shown)),
            "    }",
            "};"]
    kinds = ", ".join(f"Core{number}" for number in range(len(cores)))
    return "\n".join([*lines, f"using Kinds = std::tuple<{kinds}>;"]) + "\n"
