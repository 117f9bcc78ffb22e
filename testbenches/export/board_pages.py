"""The reference pages of the boards.

Made by ``python -m cardcage.testbenches.export.board_pages docs/boards``.  Each page says what the
docstrings of its board and of the board's interfaces say, and nothing else: what it does, its
latency and throughput, every port.  A test compares the pages with these.
"""

from __future__ import annotations

import inspect
import re
import sys
import textwrap
from itertools import groupby
from pathlib import Path

from amaranth.hdl import Fragment
from amaranth.lib import wiring

from ...golden.planning.presets import PRESETS
from ...golden.specification.configuration import MachineConfiguration
from ...hdl.components import COMPONENTS
from ...hdl.machine import BOARDS
from ..support.atomic_output import atomic_file
from .port_meanings import ports_in_parts, stated_timing

#: Boards, and the processing element that takes the other one's place before a direct merge.
PAGES = (*BOARDS, "direct_element")

#: The pages show this machine's numbers of bits.
PRESET = "small"


def board_page(name: str) -> str:
    """The page of one board, in Markdown."""
    configuration = MachineConfiguration(**PRESETS[PRESET])
    component = COMPONENTS[name](configuration)
    source = inspect.getsourcefile(type(component))
    assert source is not None
    folder, file = Path(source).parts[-2:]
    timing = stated_timing(component)
    lines = [
        f"# {name.replace('_', ' ').capitalize()}",
        "",
        f"Made from the docstrings of `hdl/{folder}/{file}` and of its interfaces "
        "(`CONTRIBUTING.md` says how); `cardcage export --component "
        f"{name}` writes it alone.",
        "",
        *_prose(type(component)),
        "## Ports",
        "",
        f"Bits are those of the preset `{PRESET}` ({configuration.cards}, {configuration.width}×"
        f"{configuration.height}); `machine.json` has those of an exported machine. All ports but "
        "`clk` and `rst`:",
        "",
        "| port | direction | bits | meaning |",
        "|---|---|---|---|",
        *_port_rows(component),
        "",
    ]
    Fragment.get(component, None)  # it is only looked at; Amaranth wants each elaborated once
    if timing["latency_clocks"] is not None:
        lines += [f"Latency in this preset: {timing['latency_clocks']} clocks.", ""]
    return "\n".join(lines)


def _prose(board: type[wiring.Component]) -> list[str]:
    """The docstring up to its list of members: paragraphs, and drawings as they are."""
    text = (inspect.getdoc(board) or "").partition("Members\n-------\n")[0]
    lines: list[str] = []
    for paragraph in re.split(r"\n\n(?=\S)", text.strip()):
        if paragraph.startswith("::"):
            drawing = textwrap.dedent(paragraph.removeprefix("::").strip("\n"))
            lines += ["```", *drawing.splitlines(), "```", ""]
        else:
            lines += [_markdown(" ".join(paragraph.split())), ""]
    return lines


def _port_rows(component: wiring.Component) -> list[str]:
    """A row for each port, and above the ports of one member what they have in common."""
    rows = []
    for member, ports in groupby(ports_in_parts(component),
                                 key=lambda port: port["name"].partition("__")[0]):
        first, *others = ports
        if "__" in first["name"]:
            rows.append(f"| **{member}** | | | {_markdown(first['meaning'][0])} |")
        for port in (first, *others):
            own = port["meaning"][1:] if "__" in port["name"] else port["meaning"]
            rows.append(f"| `{port['name']}` | {port['direction']} | {port['width']} | "
                        f"{_markdown(': '.join(own))} |")
            for field in port.get("fields", ()):
                low, high = field["offset"], field["offset"] + field["width"] - 1
                rows.append(f"| └ `{field['name']}` | | {field['width']} | "
                            + (f"bits {high} to {low} |" if high > low else f"bit {low} |"))
    return rows


def _markdown(text: str) -> str:
    return text.replace("``", "`").replace("|", "\\|")


def main(folder: Path) -> None:
    """Write all pages into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in PAGES:
        with atomic_file(folder / f"{name}.md", "docs") as file:
            file.write_text(board_page(name), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
