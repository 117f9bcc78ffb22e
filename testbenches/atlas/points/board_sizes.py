"""How large a machine's logic is, by a fit to boards that were counted.

yosys takes seconds for each board of each machine.  So ``testbenches.studies.sizes.board_cells``
has it count every kind of board once at several formats, from narrow words to wide ones, and here
a board is as large as the straight line says that lies nearest to these, along the bits of a
triangle as it is broadcast: its edges and interpolants are what registers, adders and multipliers
of an element are as wide as.  A direct merge, a crossbar, grows with elements times units instead;
a board that makes triangles of objects, whose set-up multiplies coordinates and divides by areas,
with these bits times those of a coordinate.
"""

from __future__ import annotations

import json
from collections import Counter
from functools import lru_cache
from importlib import resources
from typing import Any, NamedTuple

import numpy as np

from ....golden.planning.machine_plan import triangle_bits
from ....golden.specification.card_order import CARD_MODULES, DIRECT_MERGE
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.errors import InputError
from ....golden.specification.fields.making import Objects

#: What was counted, in ``testbenches/data``.
COUNTED = "board_cells.json"

#: Boards whose size depends on how many ports memory units have.
OF_PORTS = ("processing_element", "memory_unit")

_CONTROLLER = "central_broadcast_controller"
_CROSSBAR = CARD_MODULES[DIRECT_MERGE]

#: Of a machine's interval between two set-ups only this was counted: fast.
COUNTED_INTERVAL = 1


class Kind(NamedTuple):
    """Boards of a kind are as large but for the width of their words.

    ``objects``  where the machine makes triangles of objects, if the board is one that knows
    ``flat``     a board that makes them has a plane to set up for depth alone
    """

    board: str
    merge: str | None
    regions: bool
    retained: bool
    ports: int
    objects: Objects | None = None
    flat: bool = False

    @property
    def makes(self) -> bool:
        """It makes triangles of objects."""
        return self.objects is not None and self.board == _maker(self.objects, self.merge)


def _home(merge: str | None) -> str:
    """The board that a node's list is in."""
    return "processing_element" if merge == DIRECT_MERGE else CARD_MODULES.get(merge or "", "")


def _maker(objects: Objects, merge: str | None) -> str:
    """The board that has meshes and a set-up."""
    return {"controller": _CONTROLLER, "nodes": _home(merge), "elements": "processing_element"
            }[objects]


def board_kind(board: str, *, merge: str | None, regions: bool, retained: bool, ports: int,
               objects: Objects | None = None, flat: bool = False) -> Kind:
    """A list is in the merge card that ends a node, before a direct merge in the element.  Meshes
    and set-up are there where triangles of objects are made.  What makes no triangles does not know
    of objects, but for the controller, which hands them on, and for all of a machine whose elements
    pass them on: its pixels have an order, and its regions no tables."""
    makes = objects is not None and board == _maker(objects, merge)
    knows = makes or board == _CONTROLLER or objects == "elements"
    return Kind(board, merge, regions, retained and board == _home(merge),
                ports if board in OF_PORTS else 1, objects if knows else None, flat and makes)


def cells_of_cage(configuration: MachineConfiguration) -> int:
    """Flip-flops, gates of one bit and partial products of multipliers, of all boards; memory is
    ``memory_bits``'s.  ``InputError`` for boards of which none was counted."""
    letters = Counter(configuration.cards)
    boards = {_CONTROLLER: 1, "video_scan_generator": 1} | {
        CARD_MODULES[letter]: number for letter, number in letters.items()}
    return sum(number * _cells(configuration, board) for board, number in boards.items())


def kind_of_board(configuration: MachineConfiguration, board: str) -> Kind:
    """As ``configuration`` has it."""
    return board_kind(board, merge=configuration.merge, regions=configuration.regions is not None,
                      retained=configuration.list_words > 0, ports=configuration.memory_ports,
                      objects=configuration.objects, flat=configuration.shading == "flat")


def _cells(configuration: MachineConfiguration, board: str) -> int:
    kind = kind_of_board(configuration, board)
    if kind not in _lines() or (configuration.objects is not None
                                and configuration.setup_interval != COUNTED_INTERVAL):
        raise InputError(f"{configuration.cards}: a {board.replace('_', ' ')} of such a machine "
                         "was not counted, so that nobody knows how large it is; take another cage")
    return cells_of_board(kind, board_size(
        kind, triangle_bits(configuration), configuration.coordinate_bits,
        configuration.processing_elements * configuration.units))


def cells_of_board(kind: Kind, size: int) -> int:
    """On the line of its kind; ``size`` is that of ``board_size``."""
    base, slope = _lines()[kind]
    return max(1, round(base + slope * size))


def board_size(kind: Kind, bits: int, coordinate_bits: int, crossings: int) -> int:
    """What the size of a board is a line along; ``bits`` of a triangle."""
    if kind.makes:
        return bits * coordinate_bits
    return crossings if kind.board == _CROSSBAR else bits


@lru_cache(maxsize=1)
def counted() -> list[dict[str, Any]]:
    """The boards that were counted."""
    text = (resources.files(__package__) / ".." / ".." / "data" / COUNTED).read_text("utf-8")
    return list(json.loads(text))


def counted_as(each: dict[str, Any]) -> tuple[Kind, int]:
    """The kind of a board that was counted, and its ``board_size``."""
    kind = board_kind(each["board"], merge=each["merge"], regions=each["regions"],
                      retained=each["retained"], ports=each["memory_ports"],
                      objects=each["objects"], flat=each["flat"])
    return kind, board_size(kind, each["triangle_bits"], each["coordinate_bits"],
                            each["elements"] * each["units"])


@lru_cache(maxsize=1)
def _lines() -> dict[Kind, tuple[float, float]]:
    """Of each kind the line nearest to what was counted: cells of nothing, and for each more."""
    points: dict[Kind, list[tuple[float, float]]] = {}
    for each in counted():
        kind, size = counted_as(each)
        points.setdefault(kind, []).append((float(size), float(each["cells"])))
    lines = {}
    for kind, some in points.items():
        sizes, cells = np.array(some).T
        slope, base = np.polyfit(sizes, cells, 1) if len(set(sizes)) > 1 else (0.0, cells.mean())
        lines[kind] = float(base), float(slope)
    return lines
