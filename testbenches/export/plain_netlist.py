"""Netlists in a form whose Verilog reads the same to every tool: every operand spelled as wide as
its result, no parallel case."""

import re
from collections.abc import Iterator

__all__ = ["plain_netlist"]

_COMPARISONS = {"$eq", "$ne", "$lt", "$le", "$gt", "$ge"}
_ARITHMETIC = {"$add", "$sub", "$mul", "$and", "$or", "$xor", "$xnor"}
_ONE_OPERAND = {"$not", "$neg", "$shl", "$sshl"}
_RIGHT_SHIFTS = {"$shr", "$sshr"}

_PART = re.compile(r"    (parameter|connect) (?:signed )?(\S+) (.*)")


def plain_netlist(rtlil: str) -> str:
    """The same netlist, after ``proc``, with cells that Verilog can say without implied widths.

    Operands are extended, or cut, to the width in which the cell computes; ``$logic_not`` of a
    word becomes a comparison with zero; ``$pmux``, for which Verilog would need overlapping cases,
    becomes a chain of ``$mux``.  Ports of no bits are ports no more.
    """
    return "\n".join(_Rewriter().lines(iter(rtlil.splitlines()))) + "\n"


class _Rewriter:
    def __init__(self) -> None:
        self._count = 0

    def lines(self, lines: Iterator[str]) -> Iterator[str]:
        for line in lines:
            if not line.startswith("  cell $"):
                # What has no bits is no port in Verilog.
                yield re.sub(r"^(  wire .*width 0) (?:input|output) \d+", r"\1", line)
                continue
            _, kind, name = line.split()
            parts: dict[str, dict[str, str]] = {"parameter": {}, "connect": {}}
            for inner in lines:
                if inner == "  end":
                    break
                found = _PART.fullmatch(inner)
                assert found, inner
                parts[found[1]][found[2].removeprefix("\\")] = found[3]
            yield from self._cell(kind, name, parts["parameter"], parts["connect"])

    def _cell(self, kind: str, name: str, parameters: dict[str, str],
              ports: dict[str, str]) -> Iterator[str]:
        widths = {key: int(parameters[f"{key}_WIDTH"]) for key in "ABY"
                  if f"{key}_WIDTH" in parameters}
        if kind == "$pmux":
            yield from self._chain(name, int(parameters["WIDTH"]), int(parameters["S_WIDTH"]),
                                   ports)
            return
        if kind == "$logic_not" and widths["A"] > 1:
            kind = "$eq"
            parameters |= {"B_SIGNED": "0", "B_WIDTH": str(widths["A"])}
            ports["B"] = f"{widths['A']}'" + "0" * widths["A"]
        elif kind in _COMPARISONS:
            assert widths["Y"] == 1
            yield from self._fit("AB", max(widths["A"], widths["B"]), parameters, ports)
        elif kind in _ARITHMETIC:
            yield from self._fit("AB", widths["Y"], parameters, ports)
        elif kind in _ONE_OPERAND or (kind in _RIGHT_SHIFTS and widths["A"] < widths["Y"]):
            yield from self._fit("A", widths["Y"], parameters, ports)
        elif kind in _RIGHT_SHIFTS and widths["A"] > widths["Y"]:
            whole, wire = self._wire(widths["A"])
            yield wire
            yield f"  connect {ports['Y']} {_slice(whole, widths['Y'] - 1, 0)}"
            ports["Y"] = whole
            parameters["Y_WIDTH"] = str(widths["A"])
        yield from _text(kind, name, parameters, ports)

    def _fit(self, keys: str, width: int, parameters: dict[str, str],
             ports: dict[str, str]) -> Iterator[str]:
        """Extend or cut operands to ``width``."""
        signed = all(parameters[f"{key}_SIGNED"] == "1" for key in keys)
        for key in keys:
            own = int(parameters[f"{key}_WIDTH"])
            if own == width:
                continue
            # A wire of its own can be sliced whatever the operand is; cleaning removes it again.
            operand, wire = self._wire(own)
            yield wire
            yield f"  connect {operand} {ports[key]}"
            if own > width:
                ports[key] = _slice(operand, width - 1, 0)
            else:
                top = _slice(operand, own - 1, own - 1) if signed else "1'0"
                ports[key] = f"{{ {' '.join([top] * (width - own))} {operand} }}"
            parameters[f"{key}_WIDTH"] = str(width)

    def _chain(self, name: str, width: int, count: int,
               ports: dict[str, str]) -> Iterator[str]:
        choices, choices_wire = self._wire(width * count)
        select, select_wire = self._wire(count)
        yield from (choices_wire, select_wire, f"  connect {choices} {ports['B']}",
                    f"  connect {select} {ports['S']}")
        below = ports["A"]
        for index in reversed(range(count)):
            result, wire = (ports["Y"], None) if index == 0 else self._wire(width)
            if wire:
                yield wire
            yield from _text("$mux", f"{name}${index}", {"WIDTH": str(width)}, {
                "A": below, "B": _slice(choices, width * (index + 1) - 1, width * index),
                "S": _slice(select, index, index), "Y": result})
            below = result

    def _wire(self, width: int) -> tuple[str, str]:
        self._count += 1
        name = f"$plain${self._count}"
        return name, f"  wire width {width} {name}"


def _slice(wire: str, high: int, low: int) -> str:
    return f"{wire} [{high}:{low}]"


def _text(kind: str, name: str, parameters: dict[str, str],
          ports: dict[str, str]) -> Iterator[str]:
    yield f"  cell {kind} {name}"
    yield from (f"    parameter \\{key} {value}" for key, value in parameters.items())
    yield from (f"    connect \\{key} {value}" for key, value in ports.items())
    yield "  end"
