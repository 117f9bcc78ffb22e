"""The machine as Verilog: one module per component, each card written once."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from amaranth.back import rtlil
from amaranth.hdl import (
    C,
    Cat,
    ClockSignal,
    Elaboratable,
    Instance,
    Module,
    ResetSignal,
    Shape,
    Value,
)
from amaranth.lib import memory, wiring

from ...golden.specification.configuration import MachineConfiguration
from ...hdl.machine import Machine, boards_of
from ..support.garbage_collector import collector_paused
from .plain_netlist import plain_netlist
from .yosys import instantiated, run_yosys, verilog_modules

__all__ = [
    "Port",
    "component_ports",
    "component_verilog",
    "machine_netlist",
    "machine_verilog",
]

#: Processes become registers and multiplexers; what nothing reads is left out.
_TO_NETLIST = """
proc
opt_expr -mux_undef
opt_merge
wreduce t:$add t:$sub t:$mul
opt_clean -purge
clean_zerowidth
write_rtlil
"""

_TO_VERILOG = """
opt_clean -purge
write_verilog -noattr
"""

_MEMORY = """\
// {depth} words of {width} bits, one write and one read a clock; contents unknown at power-on.
module {name}(
  input clk,
  input [{address_top}:0] write_address,
  input [{lane_top}:0] write_enable,
  input [{data_top}:0] write_data,
  input [{address_top}:0] read_address,
{read_ports}
);
  {attribute}reg [{data_top}:0] words [0:{last}];
  always @(posedge clk) begin
{writes}
{read}
endmodule
"""

#: The end of a module's name, its ports and its read: for block RAM, whose read is clocked, and for
#: the small RAM of look-up tables, whose read is not.
_READS = {
    "sync": ("", "  input read_enable,\n  output reg [{data_top}:0] read_data",
             "    if (read_enable) read_data <= words[read_address];\n  end"),
    "comb": ("_asynchronous_read", "  output [{data_top}:0] read_data",
             "  end\n  assign read_data = words[read_address];"),
}


class _VerilogPlatform:
    """Makes each memory an instance of a module of our own, written once per shape.

    Amaranth would write a line for every word, initialised or not.
    """

    def __init__(self) -> None:
        self.modules: dict[str, str] = {}

    def modules_in_order(self) -> dict[str, str]:
        return dict(sorted(self.modules.items()))

    def get_memory(self, ram: memory.Memory) -> Elaboratable:
        [write], [read] = ram.write_ports, ram.read_ports
        assert write.domain == "sync" and not read.transparent_for
        ending, read_ports, read_text = _READS[read.domain]
        width, lanes = Shape.cast(ram.shape).width, len(write.en)
        name = f"memory_{ram.depth}x{width}" + (f"_lanes_{lanes}" if lanes > 1 else "") + ending
        unchecked = "no_rw_check" in ram.attrs
        name += "_no_rw_check" * unchecked
        address_width = max(1, len(write.addr))
        lane = width // lanes
        self.modules[name] = _MEMORY.format(
            name=name, depth=ram.depth, width=width, last=ram.depth - 1,
            attribute="(* no_rw_check *) " * unchecked,
            address_top=address_width - 1, lane_top=lanes - 1, data_top=width - 1,
            read_ports=read_ports.format(data_top=width - 1), read=read_text,
            writes="\n".join(
                f"    if (write_enable[{index}]) words[write_address]"
                f"[{index * lane + lane - 1}:{index * lane}] <= "
                f"write_data[{index * lane + lane - 1}:{index * lane}];"
                for index in range(lanes)))
        enable = {"i_read_enable": read.en} if read.domain == "sync" else {}
        m = Module()
        m.submodules.ram = Instance(
            name, i_clk=ClockSignal(),
            i_write_address=_padded(write.addr, address_width), i_write_enable=write.en,
            i_write_data=Value.cast(write.data),
            i_read_address=_padded(read.addr, address_width), **enable,
            o_read_data=Value.cast(read.data))
        return m


def _padded(address: Value, width: int) -> Value:
    """A memory of one word has no address bits, a Verilog port has at least one."""
    return address if len(address) == width else Cat(address, C(0, width - len(address)))


class _Instantiated(wiring.Component):
    """Stands in a machine for a board whose module is written once, elsewhere."""

    def __init__(self, module: str, signature: wiring.Signature) -> None:
        self._module = module
        super().__init__(signature)

    def elaborate(self, platform: Any) -> Elaboratable:
        return Instance(self._module, i_clk=ClockSignal(), i_rst=ResetSignal(), **{
            f"{'i' if flow == wiring.In else 'o'}_{name}": value
            for name, flow, value in _flat_ports(self)})


class _MachineOfInstances(Machine):
    """The machine with an instance in the place of every board."""

    def __init__(self, configuration: MachineConfiguration,
                 boards: dict[str, wiring.Component]) -> None:
        self._signatures = {name: board.signature for name, board in boards.items()}
        super().__init__(configuration=configuration)

    def make_board(self, name: str) -> wiring.Component:
        return _Instantiated(name, self._signatures[name])


@dataclass(frozen=True)
class Port:
    """A port of a Verilog module: its name, ``"input"`` or ``"output"``, and its width."""

    name: str
    direction: str
    width: int


def _flat_ports(component: wiring.Component) -> Iterator[tuple[str, wiring.Flow, Value]]:
    for path, member, value in component.signature.flatten(component):
        yield "__".join(map(str, path)), member.flow, Value.cast(value)


def component_ports(component: wiring.Component) -> list[Port]:
    """The ports of a component's module, besides ``clk`` and ``rst``; none are of no bits."""
    return [Port(name, "input" if flow == wiring.In else "output", len(value))
            for name, flow, value in _flat_ports(component) if len(value)]


def component_verilog(component: wiring.Component, name: str) -> str:
    """One component and all its parts as Verilog text, modules ``name`` and ``name__part``.

    Deterministic: the same component gives the same text.  Raises ``RuntimeError`` with what
    yosys said where it could not translate.
    """
    return _translated({name: component})


def machine_verilog(configuration: MachineConfiguration) -> str:
    """A whole machine as Verilog text; the top module is ``machine``.

    Each kind of board is one module, in the order of ``hdl.machine.BOARDS``, however many slots
    hold one, and so is each memory.
    """
    return _translated(_components(configuration))


def machine_netlist(configuration: MachineConfiguration) -> tuple[str, dict[str, str]]:
    """The same machine as RTLIL, and the Verilog of its memories, by name."""
    return _netlist(_components(configuration))


def _components(configuration: MachineConfiguration) -> dict[str, wiring.Component]:
    boards = {name: board(configuration=configuration)
              for name, board in boards_of(configuration).items()}
    return {"machine": _MachineOfInstances(configuration, boards), **boards}


def _translated(components: dict[str, wiring.Component]) -> str:
    """Modules in the order of ``components``, the top first, each followed by its parts; memories
    last.  What nothing instantiates is left out."""
    netlist, memories = _netlist(components)
    modules = verilog_modules(netlist, _TO_VERILOG)
    order = list(components)
    ranked = sorted(modules, key=lambda name: (order.index(name.partition("__")[0]), name))
    written = {name: modules[name] for name in ranked} | memories
    return "\n".join(written[name] for name in instantiated(written, order[0]))


def _netlist(components: dict[str, wiring.Component]) -> tuple[str, dict[str, str]]:
    """The components as RTLIL, and the Verilog of the memories in them, by name."""
    platform = _VerilogPlatform()
    with collector_paused():
        texts = [rtlil.convert(component, name=name, platform=platform, emit_src=False)
                 for name, component in components.items()]
    return plain_netlist(run_yosys(texts, _TO_NETLIST)), platform.modules_in_order()
