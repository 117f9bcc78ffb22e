"""What a cage is made of: bits of memory, and cells on request."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict, dataclass
from typing import Any

from ...golden.specification.card_order import CARD_MODULES
from ...golden.specification.configuration import MachineConfiguration
from ..support.measurement_cache import measured_once, package_hash


@dataclass(frozen=True)
class Memory:
    """``instances`` memories of ``words`` words of ``bits`` bits."""

    words: int
    bits: int
    instances: int

    @property
    def all_bits(self) -> int:
        return self.words * self.bits * self.instances


def memories_of(configuration: MachineConfiguration) -> list[Memory]:
    """Every memory of the machine's Verilog: of memory units, lists, what was drawn, queues."""

    def measure() -> dict[str, Any]:
        # They load Amaranth: only those whose machine was not looked at before wait for it.
        from ..export.machine_json import memories
        from ..export.verilog import machine_verilog

        return {"memories": memories(machine_verilog(configuration))}

    found = measured_once([package_hash(), "memories", repr(configuration)], measure)
    return [Memory(each["words"], each["bits"], each["instances"]) for each in found["memories"]]


def cells_of(configuration: MachineConfiguration) -> dict[str, int]:
    """Cells of all boards, memory left out: each kind is counted once, times its boards.

    Keys: ``flip_flops``, ``gates``, ``multipliers`` (``export.cell_count.Cells``).
    """
    letters = Counter(configuration.cards)
    boards = {"central_broadcast_controller": 1, "video_scan_generator": 1} | {
        module: letters[letter] for letter, module in CARD_MODULES.items() if letters[letter]}
    total: Counter[str] = Counter()
    for board, number in boards.items():
        for kind, cells in _cells(configuration, board).items():
            total[kind] += number * cells
    return {kind: total[kind] for kind in ("flip_flops", "gates", "multipliers")}


def _cells(configuration: MachineConfiguration, board: str) -> dict[str, int]:
    def measure() -> dict[str, Any]:
        from ..export.cell_count import count_cells
        from ..export.machine_json import component_for

        return asdict(count_cells(component_for(configuration, board)))

    return measured_once([package_hash(), "cells", board, repr(configuration)], measure)
