"""Boards of a cage in groups: a processing element and the memory units that it owns are a domain;
the controller and the scan generator, which have no slots, are a group, too, and any other board is
one by itself.

What a domain's neighbours give it for ever, as a processing element has no units to its left, is
in it a constant; what nobody reads is left out.  Groups of the same boards are then the same.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ....hdl.machine import BOARDS
from .netlist_text import (
    Cell,
    NetlistModule,
    Port,
    is_constant,
    modules_of,
    names_in,
    renumbered,
)

_MACHINE = r"\machine"
_ELEMENT, _UNIT = r"\processing_element", r"\memory_unit"
_SLOT = re.compile(r"\\slot_(\d+)_")


@dataclass(frozen=True)
class Group:
    """Equal groups.

    ``module``  RTLIL of one of them, a module ``name`` with an instance of each board
    ``count``   how many there are, ``at(0)`` and so on in the machine
    """

    name: str
    module: str
    count: int

    def at(self, place: int) -> str:
        return f"{self.name}_at_{place}"


@dataclass(frozen=True)
class GroupedMachine:
    """``netlist``: RTLIL of the machine, with groups in the place of boards."""

    netlist: str
    groups: tuple[Group, ...]


def group_boards(netlist: str) -> GroupedMachine | None:
    """The machine of RTLIL ``netlist``; None where groups of the same boards are not the same."""
    modules = modules_of(netlist)
    machine = modules[_MACHINE]
    boards = [cell for cell in machine.cells if cell.kind.removeprefix("\\") in BOARDS]
    used = _Used(machine, boards, modules)
    members: dict[tuple[str, ...], list[list[Cell]]] = {}
    in_order = _groups(boards)
    for cells in in_order:
        members.setdefault(tuple(cell.kind for cell in cells), []).append(cells)
    places = _Places(in_order, used)
    groups, instances = [], []
    for number, equal in enumerate(members.values()):
        made = [_group(rf"\group_{number}", cells, used, places) for cells in equal]
        if len({module for module, _ in made}) > 1:
            return None
        group = Group(f"group_{number}", made[0][0], len(equal))
        groups.append(group)
        instances += [Cell(rf"\{group.name}", rf"\{group.at(place)}", connections)
                      for place, (_, connections) in enumerate(made)]
    text = machine.without(cell.name for cell in boards).removesuffix("end\n")
    others = [renumbered(module.text) for name, module in modules.items() if name != _MACHINE]
    return GroupedMachine("".join([
        text, *(cell.text() for cell in instances),
        *(f"  connect {signal} {value}\n" for signal, value in used.fixed.items()), "end\n",
        *(group.module for group in groups), *others]), tuple(groups))


def _groups(boards: Iterable[Cell]) -> list[list[Cell]]:
    """Slots from left to right, then the boards that have none, of which there is one each."""
    slots = {int(found[1]): cell for cell in boards if (found := _SLOT.match(cell.name))}
    groups: list[list[Cell]] = []
    for _, cell in sorted(slots.items()):
        if cell.kind == _UNIT and groups and groups[-1][0].kind == _ELEMENT:
            groups[-1].append(cell)
        else:
            groups.append([cell])
    return [*groups, [cell for cell in boards if not _SLOT.match(cell.name)]]


class _Places:
    """What is connected to each port of the boards that begin, end or are inside a group."""

    def __init__(self, groups: Iterable[Sequence[Cell]], used: _Used) -> None:
        self._signals: dict[tuple[str, bool, bool, str], set[str]] = {}
        self._read: set[tuple[str, bool, bool, str]] = set()
        for group in groups:
            for place, cell in enumerate(group):
                for port, signal in cell.connections.items():
                    key = self._key(group, place, port)
                    self._signals.setdefault(key, set()).add(signal)
                    if used.is_read(cell, port):
                        self._read.add(key)

    def fixed(self, group: Sequence[Cell], place: int, port: str) -> str | None:
        """The constant that is there wherever the group stands, if it is one."""
        [signal, *others] = self._signals[self._key(group, place, port)]
        return signal if not others and is_constant(signal) else None

    def is_read(self, group: Sequence[Cell], place: int, port: str) -> bool:
        """An input is, where there is one; an output where anybody reads that of any group."""
        return self._key(group, place, port) in self._read

    def _key(self, group: Sequence[Cell], place: int, port: str) -> tuple[str, bool, bool, str]:
        return group[place].kind, place == 0, place == len(group) - 1, port


class _Used:
    """What of the boards' ports is of use, and how often each wire of the machine is used.

    Takes from ``boards`` the connections that are of none, and gives them the constants of others.
    """

    def __init__(self, machine: NetlistModule, boards: Sequence[Cell],
                 modules: Mapping[str, NetlistModule]) -> None:
        self._modules = modules
        #: What a board always puts out, by the wire: it is driven by that, and not by the board.
        self.fixed = {cell.connections[port]: value for cell in boards
                      for port, value in modules[cell.kind].constants.items()
                      if port in cell.connections}
        for cell in boards:
            cell.connections = {
                port: self.fixed.get(signal, signal) for port, signal in cell.connections.items()
                if port not in modules[cell.kind].unread | modules[cell.kind].constants.keys()}
        elsewhere = machine.without(cell.name for cell in boards)
        elsewhere = re.sub(r"^  wire (?!.*(?:input|output)).*\n", "", elsewhere, flags=re.MULTILINE)
        self._elsewhere = Counter(elsewhere.split())
        self.count = self._elsewhere + self.of(boards)
        self._read = set(self._elsewhere) | {
            name for cell in boards for port, signal in cell.connections.items()
            if self.port(cell, port).direction == "input" for name in names_in(signal)}

    def of(self, cells: Iterable[Cell]) -> Counter[str]:
        return Counter(name for cell in cells for signal in cell.connections.values()
                       for name in names_in(signal))

    def port(self, cell: Cell, name: str) -> Port:
        return self._modules[cell.kind].ports[name]

    def is_read(self, cell: Cell, port: str) -> bool:
        """It is an input, or an output that somebody reads."""
        return self.port(cell, port).direction == "input" or any(
            name in self._read for name in names_in(cell.connections[port]))


def _group(name: str, group: Sequence[Cell], used: _Used,
           places: _Places) -> tuple[str, dict[str, str]]:
    """The module of a group, and what its ports are connected to."""
    own = used.of(group)
    names: dict[tuple[str, str], str] = {}
    ports: list[Port] = []
    wires, cells, buffers, connections = [], [], [], {}
    for place, cell in enumerate(group):
        inner = Cell(cell.kind, rf"\board_{place}")
        for port, signal in sorted(cell.connections.items()):
            if (value := places.fixed(group, place, port)) is not None:
                inner.connections[port] = value
                continue
            if not places.is_read(group, place, port):
                continue
            of = used.port(cell, port)
            stays = own[signal] == used.count[signal] > 1
            # Who drives a wire has a port of its own: the unit that ends the chain reads its total.
            key = (signal, "" if stays else of.direction) if not is_constant(signal) else (
                f"{place} {port}", of.direction)
            if key not in names:
                names[key] = signal if signal == r"\clk" else rf"\at_{place}__{port[1:]}"
                if stays:
                    wires.append(f"  wire width {of.width} {names[key]}\n")
                else:
                    ports.append(Port(names[key], of.direction, of.width))
                    connections[names[key]] = signal
            inner.connections[port] = names[key]
            if not stays and of.direction == "output":
                inner.connections[port] = f"{names[key]}__driven"
                wires.append(f"  wire width {of.width} {names[key]}__driven\n")
                buffers.append(_buffer(names[key], of.width))
        cells.append(inner.text())
    declared = [f"  wire width {port.width} {port.direction} {number} {port.name}\n"
                for number, port in enumerate(ports, 1)]
    return "".join([f"module {name}\n", *declared, *wires, *cells, *buffers, "end\n"]), connections


def _buffer(name: str, width: int) -> str:
    """What drives an output, whole: bits of the wire behind it can come from here and there."""
    return (f"  attribute \\keep 1\n  cell $pos {name}__buffer\n    parameter \\A_SIGNED 0\n"
            f"    parameter \\A_WIDTH {width}\n    parameter \\Y_WIDTH {width}\n"
            f"    connect \\A {name}__driven\n    connect \\Y {name}\n  end\n")
