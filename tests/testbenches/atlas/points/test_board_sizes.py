"""The straight lines that say how large a board is, against boards that yosys counts."""

import pytest

from cardcage.golden.planning.machine_plan import plan, triangle_bits
from cardcage.testbenches.atlas.points.board_sizes import (
    board_kind,
    board_size,
    cells_of_board,
    cells_of_cage,
    counted,
)
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.export.cell_count import count_cells
from cardcage.testbenches.export.machine_json import component_for
from cardcage.testbenches.machine_options import MachineOptions, load_scene

#: Of the counted boards, and of one that was not.
ALIKE = 0.12


def kind_of(each):
    return board_kind(each["board"], merge=each["merge"], regions=each["regions"],
                      retained=each["retained"], ports=each["memory_ports"])


def test_every_counted_board_is_near_its_line(record_property):
    assert len(counted()) > 100
    errors = {}
    for each in counted():
        size = board_size(each["board"], each["triangle_bits"], each["elements"] * each["units"])
        errors[kind_of(each), size] = cells_of_board(kind_of(each), size) / each["cells"] - 1
    worst = max(errors, key=lambda place: abs(errors[place]))
    record_property("measured", f"cells of boards: {worst[0].board} is {errors[worst]:+.1%} off, "
                    "the farthest")
    assert abs(errors[worst]) < ALIKE


def configuration(cage, size=64):
    options = cage.options(MachineOptions(size=(size, size), memory_ports=2, fraction_bits=6))
    listed = load_scene("tetra:depth=2", options).display_list
    return plan(listed, **options.for_plan()).configuration


@pytest.mark.parametrize("board", ["memory_unit", "processing_element"])
def test_a_board_that_was_not_among_them(board):
    machine = configuration(Cage("2x(PMMT)"))
    cells = count_cells(component_for(machine, board))
    found = cells_of_board(board_kind(board, merge="T", regions=False, retained=False, ports=2),
                           board_size(board, triangle_bits(machine), 0))
    assert abs(found - (cells.total - cells.memory)) < 2 * ALIKE * found


def test_every_cage_has_a_size_and_a_larger_one_more():
    sizes = {}
    for name in ("2x(PMM)", "4x(PMM)", "4x(PMMC)", "4x(PMMT)", "4x(PMMS)FF", "4xPD8xM"):
        for retained in (False, True):
            if retained and name.endswith("(PMM)"):
                continue
            sizes[name, retained] = cells_of_cage(configuration(Cage(name, retained)))
    assert sizes["4x(PMM)", False] > 1.5 * sizes["2x(PMM)", False]
    for (name, retained), cells in sizes.items():
        if retained:
            assert cells > sizes[name, False]
