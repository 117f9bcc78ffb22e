"""The straight lines that say how large a board is, against boards that yosys counts."""

from dataclasses import replace

import pytest

from cardcage.golden.planning.machine_plan import plan, triangle_bits
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.atlas.points.board_sizes import (
    board_kind,
    board_size,
    cells_of_board,
    cells_of_cage,
    counted,
    counted_as,
)
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.export.cell_count import count_cells
from cardcage.testbenches.export.machine_json import component_for
from cardcage.testbenches.machine_options import MachineOptions, load_scene

#: Of the counted boards, and of one that was not.
ALIKE = 0.12


def test_every_counted_board_is_near_its_line(record_property):
    assert len(counted()) > 100
    errors = {}
    for each in counted():
        kind, size = counted_as(each)
        errors[kind, size] = cells_of_board(kind, size) / each["cells"] - 1
    worst = max(errors, key=lambda place: abs(errors[place]))
    record_property("measured", f"cells of boards: {worst[0].board} is {errors[worst]:+.1%} off, "
                    "the farthest")
    assert abs(errors[worst]) < ALIKE


def configuration(cage, size=64, scene="tetra:depth=2", **asked):
    options = cage.options(MachineOptions(size=(size, size), memory_ports=2, fraction_bits=6,
                                          **asked))
    listed = load_scene(scene, options).display_list
    return plan(listed, **options.for_plan()).configuration


@pytest.mark.parametrize("board", ["memory_unit", "processing_element"])
def test_a_board_that_was_not_among_them(board):
    machine = configuration(Cage("2x(PMMT)"))
    cells = count_cells(component_for(machine, board))
    kind = board_kind(board, merge="T", regions=False, retained=False, ports=2)
    found = cells_of_board(kind, board_size(kind, triangle_bits(machine), 0, 0))
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


@pytest.mark.parametrize("name", ["4x(PMM)@controller", "4x(PMM)/4x4@controller", "4x(PMMC)@nodes",
                                  "4x(PMMT)@nodes", "4x(PMMS)FF@nodes", "4x(PMM)/4x4@elements"])
def test_set_ups_are_counted_where_triangles_are_made(name):
    """One at the controller, or four; a flat one is smaller, and a small one nobody has counted."""
    cage = Cage.named(name)
    sent = cells_of_cage(configuration(replace(cage, objects=None), scene="crystals"))
    more = cells_of_cage(configuration(cage, scene="crystals")) - sent
    places = 1 if cage.objects == "controller" else 4
    assert places * 30_000 < more < places * 80_000
    flat = configuration(cage, scene="crystals", shading="flat")
    assert cells_of_cage(flat) < sent + 0.7 * more
    with pytest.raises(InputError, match="was not counted, so that nobody knows how large"):
        cells_of_cage(configuration(cage, scene="crystals", setup="small"))
