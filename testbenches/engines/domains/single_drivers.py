"""Wires cut into pieces, so that each has one driver.

``submod`` moves wires whole; a wire whose bits come from several cells could be driven from both
sides of the cut.
"""

from __future__ import annotations

import re
from itertools import pairwise

_TOKEN = re.compile(r"\{|\}|\[\d+(?::\d+)?\]|\S+")
#: A port of a cell, and the signal that it is at.
_CONNECTION = re.compile(r"^    connect (\S+) (.*)$", re.MULTILINE)
_ATTRIBUTE = re.compile(r"^  attribute ")

#: Ports of cells that drive what they are connected to.
_DRIVING = {r"\Y", r"\Q", r"\read_data"}


def with_single_drivers(text: str) -> str:
    """A flat module of cells, the outputs of which are named in ``_DRIVING``, after ``opt_clean``:
    no cell uses a second name of a net, so those are left out.  Each port is driven whole."""
    text = re.sub(r"^  connect .*\n", "", text, flags=re.MULTILINE)
    widths = _wires(text)
    borders = {name: {0, width} for name, width in widths.items()}
    for port, signal in _CONNECTION.findall(text):
        if port in _DRIVING:
            for name, high, low in _chunks(signal, widths):
                if name in borders:
                    borders[name] |= {low, high + 1}
    cut = {name: sorted(ends) for name, ends in borders.items() if len(ends) > 2}

    def pieces(found: re.Match[str]) -> str:
        said = [part for chunk in _chunks(found[2], widths)
                for part in _pieces(chunk, cut, widths)]
        signal = said[0] if len(said) == 1 else f"{{ {' '.join(said)} }}"
        return f"    connect {found[1]} {signal}"

    return _declared(_CONNECTION.sub(pieces, text), cut)


def _wires(text: str) -> dict[str, int]:
    found = re.findall(r"^  wire (.*)$", text, re.MULTILINE)
    return {line.split()[-1]: int(width[1]) if (width := re.search(r"\bwidth (\d+)", line)) else 1
            for line in found}


def _chunks(signal: str, widths: dict[str, int]) -> list[tuple[str, int, int]]:
    """From the highest bits to the lowest; a constant is its text, with no bits."""
    chunks: list[tuple[str, int, int]] = []
    for token in _TOKEN.findall(signal):
        if token[0] == "[":
            name, _, low = chunks[-1]
            ends = [int(end) for end in token[1:-1].split(":")]
            chunks[-1] = (name, low + ends[0], low + ends[-1])
        elif token not in "{}":
            chunks.append((token, widths[token] - 1, 0) if token in widths else (token, -1, 0))
    return chunks


def _pieces(chunk: tuple[str, int, int], cut: dict[str, list[int]],
            widths: dict[str, int]) -> list[str]:
    name, high, low = chunk
    if name not in widths:
        return [name]
    if name not in cut:
        return [_slice(name, widths[name], high, low)]
    return [_slice(_piece(name, begin), end - begin, min(high + 1, end) - 1 - begin,
                   max(low, begin) - begin)
            for begin, end in reversed([*pairwise(cut[name])]) if begin <= high and end > low]


def _slice(name: str, width: int, high: int, low: int) -> str:
    if (high, low) == (width - 1, 0):
        return name
    return f"{name} [{high}]" if high == low else f"{name} [{high}:{low}]"


def _piece(name: str, begin: int) -> str:
    return "\\" + re.sub(r"[^\w.$]", "", name).lstrip("$") + f"_from_{begin}"


def _declared(text: str, cut: dict[str, list[int]]) -> str:
    """The pieces' wires in the place of those that are cut."""
    lines, attributes = [], []
    for line in text.splitlines(keepends=True):
        if _ATTRIBUTE.match(line):
            attributes.append(line)
            continue
        name = line.split()[-1] if line.startswith("  wire ") else ""
        if name not in cut:
            lines += [*attributes, line]
        else:
            init = _initial("".join(attributes), cut[name][-1])
            for begin, end in pairwise(cut[name]):
                if init:
                    said = init[len(init) - end:len(init) - begin]
                    lines.append(f"  attribute \\init {end - begin}'{said}\n")
                lines.append(f"  wire width {end - begin} {_piece(name, begin)}\n")
        attributes = []
    return "".join(lines)


def _initial(attributes: str, width: int) -> str:
    """The bits of an ``init``, the highest first; what it does not say is not known."""
    found = re.search(r"^  attribute \\init (?:\d+'([01x]+)|(\d+))$", attributes, re.MULTILINE)
    if found is None:
        return ""
    return (found[1] or f"{int(found[2]):032b}").rjust(width, "x")
