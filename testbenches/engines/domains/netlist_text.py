"""Modules of an RTLIL netlist, as far as their cells and ports go."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

_CELL = re.compile(r"^  cell (\S+) (\S+)\n(.*?)^  end\n", re.MULTILINE | re.DOTALL)
_CONNECTION = re.compile(r"^    connect (\S+) (.*)\n", re.MULTILINE)
_CONSTANT = re.compile(r"\d+'[01]+")


@dataclass(frozen=True)
class Port:
    """``direction``: "input" or "output"."""

    name: str
    direction: str
    width: int


@dataclass
class Cell:
    """``connections``: by port, what it is connected to."""

    kind: str
    name: str
    connections: dict[str, str] = field(default_factory=dict)

    def text(self) -> str:
        return "".join([f"  cell {self.kind} {self.name}\n",
                        *(f"    connect {port} {signal}\n"
                          for port, signal in self.connections.items()), "  end\n"])


@dataclass
class NetlistModule:
    """``text``: whole, from ``module`` to ``end``; names are as in RTLIL, ``\\`` included."""

    name: str
    text: str

    @cached_property
    def ports(self) -> dict[str, Port]:
        found = {}
        for line in self.text.splitlines():
            _, *said, name = line.split() if line.startswith("  wire ") else [""] * 2
            for direction in {"input", "output"} & set(said):
                width = int(said[said.index("width") + 1]) if "width" in said else 1
                found[name] = Port(name, direction, width)
        return found

    @cached_property
    def constants(self) -> dict[str, str]:
        """The outputs that are always the same, and what they are."""
        said = re.findall(r"^  connect (\S+) (\d+'[01]+)$", self.text, re.MULTILINE)
        return {name: value for name, value in said
                if name in self.ports and self.ports[name].direction == "output"}

    @cached_property
    def unread(self) -> set[str]:
        """The inputs that nothing reads."""
        counts = Counter(self.text.split())
        return {name for name, port in self.ports.items()
                if port.direction == "input" and counts[name] == 1}

    @cached_property
    def cells(self) -> list[Cell]:
        """In the order of the text."""
        return [Cell(kind, name, dict(_CONNECTION.findall(body)))
                for kind, name, body in _CELL.findall(self.text)]

    def without(self, names: Iterable[str]) -> str:
        """Its text without the cells of these names."""
        gone = set(names)
        return _CELL.sub(lambda cell: "" if cell[2] in gone else cell[0], self.text)


def modules_of(netlist: str) -> dict[str, NetlistModule]:
    """All modules, by name."""
    found = re.findall(r"^(module (\S+)\n.*?^end\n)", netlist, re.MULTILINE | re.DOTALL)
    return {name: NetlistModule(name, text) for text, name in found}


def is_constant(signal: str) -> bool:
    return _CONSTANT.fullmatch(signal) is not None


def names_in(signal: str) -> Iterator[str]:
    """The wires that a signal is made of."""
    return (word for word in signal.split() if word[0] in "\\$")


def renumbered(text: str) -> str:
    """A module in which what has only a number is numbered from 1, whatever else is in the
    netlist."""
    numbers: dict[str, str] = {}
    return re.sub(r"(?<= )\$(?:plain\$)?\d+(?=[ \n])",
                  lambda found: numbers.setdefault(found[0], f"${len(numbers) + 1}"), text)
