"""A board without its RAM, which is then no part of what is measured."""

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Cat, ClockSignal, Elaboratable, Fragment, Instance, Module, Value
from amaranth.lib import memory, wiring

from .register_wrapper import RAM_PORTS

__all__ = ["OutsideRam"]


class OutsideRam(wiring.Component):
    """A component as it is, but for some of its RAMs: an instance of ``RAM_PORTS`` for each.

    A picture of any size does not fit the RAM of an FPGA.  Board and RAM then meet in
    registers, and which words the RAM has behind them makes no difference to the board.

    ``storages`` are memories that elaborating the component brings up, each with one
    port to write and one to read.  Members: the component's own.
    """

    def __init__(self, *, component: wiring.Component, storages: Sequence[memory.Memory]):
        self._component = component
        self._storages = tuple(storages)
        super().__init__(component.signature)

    def elaborate(self, platform: Any) -> Module:
        m = Module()
        m.submodules.board = Fragment.get(self._component, _Outside(self._storages, platform))
        wiring.connect(m, wiring.flipped(self), self._component)
        return m


class _Outside:
    """A platform like another one, except that the memories ``storages`` become instances."""

    def __init__(self, storages: Sequence[memory.Memory], platform: Any) -> None:
        self._storages = storages
        self._platform = platform

    def get_memory(self, ram: memory.Memory) -> Elaboratable:
        if not any(ram is storage for storage in self._storages):
            return self._platform.get_memory(ram)
        [write], [read] = ram.write_ports, ram.read_ports
        # Enables differ between RAMs that share the rest, so they come where all is folded in.
        inputs = Cat(write.en, read.en, write.addr, Value.cast(write.data), read.addr)
        m = Module()
        m.submodules.ports = Instance(
            RAM_PORTS, p_INPUTS=len(inputs), p_DATA=len(Value.cast(read.data)),
            i_clk=ClockSignal(), i_inputs=inputs, o_data=Value.cast(read.data))
        return m
