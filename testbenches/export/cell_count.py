"""How much logic a component is, counted in its netlist by yosys, before any technology."""

import json
from dataclasses import dataclass

from amaranth.back import rtlil
from amaranth.lib import wiring

from .yosys import run_yosys

__all__ = ["Cells", "count_cells"]

#: Everything in one module, processes as registers and multiplexers, single bits where yosys'
#: own simple mapping knows how.
_COUNT = """
hierarchy -top {name}
proc
flatten
opt
memory_collect
wreduce
opt -full
simplemap
opt
opt_clean -purge
write_json
"""

_ADDERS = {"$add", "$sub", "$neg"}
_COMPARISONS = {"$lt", "$le", "$gt", "$ge", "$eq", "$ne"}
_SHIFTS = {"$shl", "$shr", "$sshl", "$sshr", "$shift", "$shiftx"}


@dataclass(frozen=True)
class Cells:
    """What a netlist consists of, in bits.

    ``flip_flops``  registers
    ``gates``       gates and multiplexers of one bit; an adder or a comparison counts as its width
    ``multipliers`` partial products: the widths of both operands, multiplied
    ``memory``      bits of memory words
    """

    flip_flops: int
    gates: int
    multipliers: int
    memory: int

    @property
    def total(self) -> int:
        return self.flip_flops + self.gates + self.multipliers + self.memory


def count_cells(component: wiring.Component, name: str = "component") -> Cells:
    """Count the cells of ``component`` with all its parts.

    Raises ``RuntimeError`` with what yosys said where it could not translate.
    """
    text = rtlil.convert(component, name=name, emit_src=False)
    netlist = json.loads(run_yosys([text], _COUNT.format(name=name)))
    cells = netlist["modules"][name]["cells"].values()
    totals = dict.fromkeys(Cells.__dataclass_fields__, 0)
    for cell in cells:
        kind, amount = _weight(cell["type"], cell["parameters"])
        totals[kind] += amount
    return Cells(**totals)


def _weight(cell: str, parameters: dict[str, str]) -> tuple[str, int]:
    def number(name: str) -> int:
        return int(parameters[name], 2)

    if cell.startswith("$_"):
        return ("flip_flops" if "DFF" in cell else "gates"), 1
    if cell in _ADDERS:
        return "gates", number("Y_WIDTH")
    if cell in _COMPARISONS:
        return "gates", max(number("A_WIDTH"), number("B_WIDTH"))
    if cell in _SHIFTS:  # a multiplexer a bit for each bit of the distance
        return "gates", number("Y_WIDTH") * number("B_WIDTH")
    if cell == "$pmux":
        return "gates", number("WIDTH") * number("S_WIDTH")
    if cell == "$mul":
        return "multipliers", number("A_WIDTH") * number("B_WIDTH")
    if cell == "$mem_v2":
        return "memory", number("WIDTH") * number("SIZE")
    raise AssertionError(f"no weight for a cell {cell}")
