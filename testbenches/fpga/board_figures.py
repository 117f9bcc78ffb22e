"""Area and clock rate of boards, measured and put into a table or a file.

Each is synthesised, placed and routed for an ECP5 with yosys and nextpnr (extra ``fpga``), some
minutes a board.  The machine is exact for any triangle on its screen; each board has its queue
of triangles in it, the RAM of its pictures outside, behind registers (``outside_ram``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

from ..support.text_table import TextTable
from .boards import BOARDS
from .place_and_route import DEVICE, TARGET_MHZ, TOOLS, Part, Placement, place_and_route


def measure(parts: Mapping[str, Part], seeds: Sequence[int],
            step: Callable[[str], None] = lambda doing: None) -> dict[str, Placement]:
    """Place each of ``parts``, by names of ``BOARDS``.

    ``step`` is called before each synthesis and each seed.  Raises ``InputError`` where the tools
    are missing or fail.
    """
    placements = {}
    for name, part in parts.items():
        step(f"{name}: synthesising")

        def board_step(doing: str, name: str = name) -> None:
            step(f"{name}: {doing}")

        placements[name] = place_and_route(part, seeds, board_step)
    return placements



def board_table(placements: Mapping[str, Placement], title: str) -> TextTable:
    """A row for each board."""
    seeds = len(next(iter(placements.values())).mhz)
    columns = ("board", "LUT4", "CCU2C", "LUT4 + 2*CCU2C", "FF", "MULT18", "LUT RAM",
               *(f"seed {seed}" for seed in range(1, seeds + 1)), "median MHz")
    return TextTable(title, columns, tuple(
        (BOARDS[name].title, *(f"{count:,}" for count in (
            placed.lut4s, placed.carry_cells, placed.luts, placed.flip_flops, placed.multipliers,
            placed.lut_rams)), *(f"{mhz:.1f}" for mhz in (*placed.mhz, placed.median_mhz)))
        for name, placed in placements.items()))



def board_facts(parts: Mapping[str, Part], placements: Mapping[str, Placement]) -> dict[str, Any]:
    """The same for programs, and everything that it depends on."""
    return {
        "device": " ".join(DEVICE),
        "target_mhz": TARGET_MHZ,
        "tools": {tool: version(tool.replace("_", "-")) for tool in TOOLS},
        "boards": [{"name": name, "title": BOARDS[name].title, **placed.facts(),
                    "configuration": asdict(parts[name].configuration)}
                   for name, placed in placements.items()],
    }

