"""The paper's table, and what of it does not multiply out."""

import pytest

from cardcage.testbenches.figures.paper_table import PaperRow, contradictions, paper_rows


def row(**changes):
    return PaperRow(**{"name": "Any", "given": 200, "triangles": 100, "mean_size": 2.49,
                       "fragments": 249, "area": 1000, "depth": 0.25, "reduction": None} | changes)


def test_the_table_as_it_is_printed():
    rows = {row.name: row for row in paper_rows()}
    assert list(rows) == ["Bike", "Cube", "Zinnia", "Roses", "Wash.ht", "Brooks", "Capitol", "Rad"]
    assert rows["Wash.ht"] == PaperRow("Wash.ht", 441800, 49999, 56.45, 2822472, 894916, 3.15, 2.0)
    assert {name: row.reduction for name, row in rows.items() if row.reduction} == {
        "Brooks": 3.3, "Cube": 4.0, "Roses": 2.3, "Wash.ht": 2.0}
    # Those of which the paper says that they have a depth greater than three, and no others.
    assert {name for name, row in rows.items() if row.depth > 3} == {
        "Brooks", "Cube", "Roses", "Wash.ht"}


def test_three_rows_do_not_multiply_out():
    cube, brooks, rad = contradictions()
    assert cube.startswith("Cube: 47,459 primitives of 13.61 pixels are 645,917, not 6,459,105")
    assert cube.endswith("10.0 times more than printed")
    assert brooks.startswith("Brooks: ") and brooks.endswith("2.2 times less than printed")
    assert rad == "Rad: 1,615,499 pixels on a screen of 1,449,616 are a depth of 1.11, not 1.14"


@pytest.mark.parametrize(("changes", "lines"), [
    ({}, 0), ({"depth": 0.24}, 0), ({"depth": 0.23}, 1), ({"depth": 0.26}, 1),
    ({"mean_size": 2.495}, 0), ({"mean_size": 2.51}, 1), ({"fragments": 500}, 2)])
def test_the_last_digit_may_be_rounded_or_cut_off(changes, lines):
    assert len(row(**changes).contradictions) == lines
