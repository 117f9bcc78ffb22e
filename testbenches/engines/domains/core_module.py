"""A group's core as a module of its own, and ports in its place in the shell."""

from __future__ import annotations

import re
from collections.abc import Mapping, MutableMapping, Sequence
from dataclasses import dataclass

from ...export.yosys import instantiated

#: The top module of a core.
TOP = "core"

_PORT = re.compile(r"^  (input|output|inout) (?:reg )?(?:\[(\d+):0\] )?(\\\S+|[\w$]+) ?;",
                   re.MULTILINE)
_CONNECTION = re.compile(r"^    \.(\\\S+ |[\w$]+)\((.*?)\),?$", re.MULTILINE)

#: What a register is called.
_REGISTER = re.compile(r"^  always @\(posedge clk\)\n    (\\\S+|[\w$]+)", re.MULTILINE)
_BEGUN = re.compile(r"^  initial (\\\S+|[\w$]+)", re.MULTILINE)


@dataclass(frozen=True)
class CorePort:
    """``name``: in the shell, where it is an array, an element for each core."""

    name: str
    width: int


@dataclass(frozen=True)
class Core:
    """``verilog``: its module ``core`` has ``clk``, and the inputs ``i0``, ``i1`` and so on and the
    outputs ``o0``, ``o1`` and so on, as the ``taken`` and ``shown`` of the shell."""

    verilog: str
    count: int
    taken: tuple[CorePort, ...]
    shown: tuple[CorePort, ...]


def take_core_out(group: str, number: int, count: int, modules: MutableMapping[str, str],
                  memories: Mapping[str, str]) -> Core | None:
    """The core of a group's module, in which it leaves ports ``i0``, ``o0`` and so on; None where
    there is none, or a register in it does not say what it begins with.

    ``number``    of the group, ``count`` how many there are
    ``modules``   Verilog as yosys writes it, by name; the core's is ``group``, then ``_core``
    ``memories``  the Verilog of memories that may be in it, by name
    """
    name = f"{group}_core"
    if name not in modules:
        return None
    text, outer = _with_numbered_nets(name, modules[name], modules[group])
    if set(_REGISTER.findall(text)) - set(_BEGUN.findall(text)):
        return None
    ports = _ports(text)
    taken = [(width, net) for direction, width, net in ports if direction == "input"]
    shown = [(width, net) for direction, width, net in ports if direction == "output"]
    assert len(taken) + len(shown) == len(ports), "a net is driven from inside and from outside"
    modules[group] = _with_ports(name, outer, taken, shown)
    numbered = [("input", "i", taken), ("output", "o", shown)]
    top = "\n".join([
        f"module {TOP}(", ",\n".join(["  input clk", *(
            f"  {direction} [{width - 1}:0] {letter}{place}" for direction, letter, some in numbered
            for place, (width, _) in enumerate(some))]), ");",
        "  registers registers(", ",\n".join(["    .clk(clk)", *(
            f"    .{_escaped(net)}({letter}{place})" for _, letter, some in numbered
            for place, (_, net) in enumerate(some))]), "  );", "endmodule\n"])
    inner = {name: _in_order(text, ports), **memories}
    return Core("\n".join([top, *(inner[module] for module in instantiated(inner, name))]), count,
                tuple(CorePort(f"core{number}_i{place}", width)
                      for place, (width, _) in enumerate(taken)),
                tuple(CorePort(f"core{number}_o{place}", width)
                      for place, (width, _) in enumerate(shown)))


def _with_numbered_nets(name: str, text: str, outer: str) -> tuple[str, str]:
    """The core and what is around it: ports of the core for nets that had no name are numbered as
    its text uses them, and not by the rest of the netlist."""
    body = re.sub(r"^(module|  (input|output|wire|reg) ).*\n|^, .*\n", "", text, flags=re.MULTILINE)
    numbers: dict[str, str] = {}
    for net in re.findall(r"\bn\d+\b", body):
        numbers.setdefault(net, f"net_{len(numbers)}")

    def renamed(net: re.Match[str]) -> str:
        return numbers.get(net[0], net[0])

    return re.sub(r"\bn\d+\b", renamed, text), _instance(name).sub(lambda found: re.sub(
        r"(?<=^    \.)n\d+(?=\()", renamed, found[0], flags=re.MULTILINE), outer)


def _with_ports(name: str, outer: str, taken: Sequence[tuple[int, str]],
                shown: Sequence[tuple[int, str]]) -> str:
    """What is around a core, without it."""
    [body] = _instance(name).findall(outer)
    nets = {port.strip(): net for port, net in _CONNECTION.findall(body)}
    ports, declared, assigned = [], [], []
    for letter, direction, some in (("i", "output", taken), ("o", "input", shown)):
        for place, (width, inner) in enumerate(some):
            port, net = f"{letter}{place}", nets[inner]
            ports.append(f", {port}")
            declared.append(f"  {direction} [{width - 1}:0] {port};\n")
            assigned.append("  assign " + (f"{port} = {net}" if direction == "output" else
                                           f"{net} = {port}") + ";\n")
    head, _, rest = _instance(name).sub("", outer).partition(");\n")
    return "".join([head, *ports, ");\n", *declared, rest.removesuffix("endmodule\n"), *assigned,
                    "endmodule\n"])


def _in_order(text: str, ports: Sequence[tuple[str, int, str]]) -> str:
    """A core as the module ``registers`` with these ports in this order: yosys has an order of its
    own, which depends on the rest of the netlist."""
    body = re.sub(r"^  (input|output) .*\n|^  wire (\[\d+:0\] )?clk;\n", "",
                  text.partition(");\n")[2], flags=re.MULTILINE)
    declared = ["  input clk"]
    for direction, width, name in ports:
        line = re.compile(rf"^  (wire|reg) (\[\d+:0\] )?{re.escape(name)} ?;\n", re.MULTILINE)
        [(kind, _)] = line.findall(body)
        body = line.sub("", body)
        declared.append(f"  {direction} {kind} [{width - 1}:0] {_escaped(name)}")
    return "module registers(\n" + ",\n".join(declared) + f"\n);\n{body}"


def _ports(text: str) -> list[tuple[str, int, str]]:
    """Direction, width and name of those of a core, besides the clock's."""
    return sorted(((direction, int(top or 0) + 1, name)
                   for direction, top, name in _PORT.findall(text) if name != "clk"),
                  key=lambda port: port[2])


def _instance(name: str) -> re.Pattern[str]:
    """Where a module has the one of this name; its connections are the first group."""
    return re.compile(rf"^  {name} {name} ?\(\n(.*?)^  \);\n", re.MULTILINE | re.DOTALL)


def _escaped(name: str) -> str:
    """Verilog's own words end with a blank where they are names."""
    return f"{name} " if name.startswith("\\") else name
