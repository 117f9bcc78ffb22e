"""Counts the cells of every kind of board at several formats: what ``cardcage atlas`` fits its
sizes to (``testbenches/data/board_cells.json``).

    python -m testbenches.studies.sizes.board_cells > testbenches/data/board_cells.json

Three quarters of an hour; what was counted is kept.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from importlib.metadata import version
from typing import Any, NamedTuple

from cardcage.golden.planning.machine_plan import plan, triangle_bits
from cardcage.golden.specification.card_order import CARD_MODULES, DIRECT_MERGE
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.atlas.points.atlas_point import FractionBits
from cardcage.testbenches.atlas.points.board_sizes import kind_of_board
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.export.cell_count import count_cells
from cardcage.testbenches.export.machine_json import component_for
from cardcage.testbenches.machine_options import MachineOptions, load_scene
from cardcage.testbenches.support.cache import sources_hash
from cardcage.testbenches.support.measurement_cache import measured_once

#: Scene, size and fraction bits: from narrow words to wide ones.
FORMATS: tuple[tuple[str, int, FractionBits], ...] = (
    ("teapot:tessellation=3", 64, 0),
    ("teapot:tessellation=3", 64, "exact"),
    ("five_primitives", 128, "exact"),
    ("sphereflake:depth=1", 256, "exact"),
)

#: Of scenes with objects.
OBJECT_FORMATS: tuple[tuple[str, int, FractionBits], ...] = (
    ("five_primitives", 64, 0),
    ("five_primitives", 64, "exact"),
    ("three_cubes", 256, "exact"),
)

#: A cage of each kind, with lists and without; of a direct merge, which grows with elements times
#: units, three.
CAGES = (
    Cage("4x(PMM)"), Cage("4x(PMM)", regions=(8, 8)),
    Cage("4x(PMMC)"), Cage("4x(PMMC)", retained=True),
    Cage("4x(PMMT)"), Cage("4x(PMMT)", retained=True),
    Cage("4x(PMMS)FF"), Cage("4x(PMMS)FF", retained=True),
    Cage("4xPD8xM"), Cage("4xPD8xM", retained=True),
    Cage("8xPD16xM"), Cage("8xPD8xM"),
)

#: Cages that make the triangles of objects, with set-up for three clocks a triangle.
OBJECT_CAGES = (
    Cage("4x(PMM)", objects="controller"), Cage("4x(PMM)", regions=(8, 8), objects="controller"),
    Cage("4x(PMMC)", objects="nodes"), Cage("4x(PMMT)", objects="nodes"),
    Cage("4x(PMMS)FF", objects="nodes"), Cage("4x(PMM)", regions=(8, 8), objects="elements"),
)

_ONCE = ("central_broadcast_controller", "video_scan_generator")


class Counted(NamedTuple):
    """A board of a cage, of that format, whose units have so many ports; ``flat``: whatever the
    scene has, colours are not interpolated."""

    cage: Cage
    board: str
    ports: int
    format: tuple[str, int, FractionBits]
    flat: bool = False


def wanted() -> list[Counted]:
    """Ports matter to elements and memory units alone."""
    found = []
    for cage in CAGES:
        letters = dict.fromkeys(cage.spelled or "")
        boards, formats = [*(CARD_MODULES[letter] for letter in letters), *_ONCE], FORMATS
        if cage in CAGES[-2:]:  # a crossbar takes minutes, and sees no triangle
            boards, formats = [CARD_MODULES[DIRECT_MERGE]], FORMATS[:1]
        elif cage.retained:  # a list is in the card that ends a node, or before D in the element
            boards = [board for board in boards if board.endswith("_merge")
                      or (DIRECT_MERGE in letters and board == "processing_element")]
        for board in boards:
            for ports in _ports(board):
                found += [Counted(cage, board, ports, each) for each in formats]
    return found + _wanted_of_objects()


def _ports(board: str) -> tuple[int, ...]:
    return (1, 2) if board in ("processing_element", "memory_unit") else (1,)


def _wanted_of_objects() -> list[Counted]:
    """The boards that know of objects; of those that make their triangles flat ones, too."""
    found = []
    for cage in OBJECT_CAGES:
        boards = [*(CARD_MODULES[letter] for letter in dict.fromkeys(cage.spelled or "")), *_ONCE]
        for board in boards:
            for ports in _ports(board):
                of_kind = kind_of_board(machine(Counted(cage, board, ports, OBJECT_FORMATS[0],
                                                        flat=True)), board)
                if of_kind.objects is not None:
                    found += [Counted(cage, board, ports, each) for each in OBJECT_FORMATS]
                if of_kind.flat:
                    found += [Counted(cage, board, ports, each, flat=True)
                              for each in OBJECT_FORMATS[1:]]
    return found


def machine(counted: Counted) -> MachineConfiguration:
    scene, size, bits = counted.format
    options = counted.cage.options(MachineOptions(
        size=(size, size), fraction_bits=bits, memory_ports=counted.ports,
        shading="flat" if counted.flat else "auto"))
    listed = load_scene(scene, options).display_list
    return plan(listed, **options.for_plan()).configuration


def count(counted: Counted) -> dict[str, Any]:
    configuration = machine(counted)
    cells = measured_once(
        ("board cells", version("amaranth"), sources_hash("golden", "hdl", "testbenches/export"),
         counted.board, repr(configuration)),
        lambda: asdict(count_cells(component_for(configuration, counted.board))))
    return described(counted, configuration) | {
        "cells": cells["flip_flops"] + cells["gates"] + cells["multipliers"]}


def described(counted: Counted, configuration: MachineConfiguration) -> dict[str, Any]:
    """What a board is, by which its cells are looked up."""
    return {
        "cage": counted.cage.label, "board": counted.board, "memory_ports": counted.ports,
        "merge": configuration.merge, "regions": configuration.regions is not None,
        "retained": counted.cage.retained, "objects": configuration.objects,
        "flat": configuration.shading == "flat", "triangle_bits": triangle_bits(configuration),
        "coordinate_bits": configuration.coordinate_bits,
        "elements": configuration.processing_elements, "units": configuration.units,
    }


def main() -> None:
    boards = wanted()
    found = []
    for number, board in enumerate(boards, 1):
        found.append(count(board))
        print(f"{number} of {len(boards)} boards", file=sys.stderr)
    print("[\n" + ",\n".join(json.dumps(each) for each in found) + "\n]")


if __name__ == "__main__":
    main()
