"""A machine cut in two: what holds a state, group by group, and what lies between.

In each group the logic on a path from an input to an output is left in the *shell*, with the wires
of the machine; all else, registers, memories and the logic that only they see, is the group's
*core*.  What a core puts out changes with the clock alone.  So a clock is: all cores take their
inputs and step, then the shell is settled once; no order has to be found.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ....golden.specification.configuration import MachineConfiguration
from ...export.verilog import machine_netlist
from ...export.yosys import instantiated, run_yosys, verilog_modules
from .core_module import Core, take_core_out
from .machine_groups import Group, group_boards
from .single_drivers import with_single_drivers

_FLATTEN = """\
cd {group}
flatten
opt_clean -purge
cd ..
"""

#: ``{registers}`` are the kinds of cells that hold a state.
_SPLIT = """\
cd {group}
select -set between i:* %co*:-{registers} o:* %ci*:-{registers} %i c:* %i
select -set others c:* @between %d
submod -name {group}_core @others
submod -name {group}_between @between
cd ..
"""

_TO_VERILOG = """\
opt_clean -purge
write_verilog -noattr
"""


@dataclass(frozen=True)
class SplitMachine:
    """``shell``: Verilog of the machine without the cores; beside the machine's ports its module
    ``machine`` has what the cores take (outputs) and show (inputs)."""

    shell: str
    cores: tuple[Core, ...]


def split_machine(configuration: MachineConfiguration) -> SplitMachine | None:
    """The machine, cut; None where equal boards are not used alike, or anything but a core holds a
    state."""
    netlist, memories = machine_netlist(configuration)
    grouped = group_boards(netlist)
    if grouped is None:
        return None
    modules = _cut(grouped.netlist, grouped.groups, memories)
    cores = []
    for number, group in enumerate(grouped.groups):
        core = take_core_out(group.name, number, group.count, modules, memories)
        if core is None:
            return None
        cores.append(core)
    modules["machine"] = _with_ports(modules["machine"], grouped.groups, cores)
    shell = instantiated(modules | memories, "machine")
    if memories.keys() & shell or any("posedge" in modules[name] for name in shell):
        return None
    return SplitMachine("\n".join(modules[name] for name in shell), tuple(cores))


def array_ports(cores: Iterable[Core]) -> dict[str, str]:
    """Declarations of what cores take and show, by name."""
    return {port.name: f"{direction} wire [{port.width - 1}:0] {port.name} [0:{core.count - 1}]"
            for core in cores
            for direction, ports in (("output", core.taken), ("input", core.shown))
            for port in ports}


def _cut(netlist: str, groups: Sequence[Group], memories: Mapping[str, str]) -> dict[str, str]:
    """The machine's modules in Verilog, where each group has a module for its core, and one for
    what is between its inputs and outputs."""
    known = "".join(_black_box(name, text) for name, text in memories.items())
    flat = run_yosys([netlist + known], "".join(
        _FLATTEN.format(group=group.name) for group in groups) + "write_rtlil\n")
    names = {rf"\{group.name}" for group in groups}
    flat = re.sub(r"^module (\S+)\n.*?^end\n", lambda found: (
        with_single_drivers(found[0]) if found[1] in names else found[0]), flat,
        flags=re.MULTILINE | re.DOTALL)
    # Memories that are read in the clock after combine nothing; the others are as any logic.
    registers = ["$dff", *(rf"\{name}" for name in memories if "asynchronous" not in name)]
    return verilog_modules(flat, "".join(
        _SPLIT.format(group=group.name, registers=",".join(registers))
        for group in groups) + _TO_VERILOG)


def _black_box(name: str, text: str) -> str:
    """A memory's ports as RTLIL: what is written and what is read."""
    ports = re.findall(r"^  (input|output) (?:reg )?(?:\[(\d+):0\] )?(\w+),?$", text, re.MULTILINE)
    wires = [f"  wire width {int(top or 0) + 1} {direction} {number} \\{port}\n"
             for number, (direction, top, port) in enumerate(ports, 1)]
    return "".join(["attribute \\blackbox 1\n", f"module \\{name}\n", *wires, "end\n"])


def _with_ports(machine: str, groups: Sequence[Group], cores: Sequence[Core]) -> str:
    """What cores take and show as ports of the machine, an element for each group."""
    for group, core in zip(groups, cores, strict=True):
        for place in range(group.count):
            at = f"  {group.name} {group.at(place)} (\n"
            assert at in machine, at
            machine = machine.replace(at, at + "".join(
                f"    .{port.name.partition('_')[2]}({port.name}[{place}]),\n"
                for port in (*core.taken, *core.shown)))
    head, _, rest = machine.partition(");\n")
    arrays = array_ports(cores)
    declared = "".join(f"  {line};\n" for line in arrays.values())
    return f"{', '.join([head, *arrays])});\n{declared}{rest}"
