"""bench where regions are dealt out: the rows, what binds them, and the chart."""

from __future__ import annotations

import json

import numpy as np
from click.testing import CliRunner
from PIL import Image

from cardcage.golden.balancing.region_counts import region_counts, utilisation
from cardcage.golden.balancing.region_grid import RegionGrid
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.organisations.region_table import packed_table
from cardcage.golden.reference.exact import draw
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.speed.cases import case_lists
from cardcage.testbenches.speed.machines import MachineAxes, bench_machines

SIXTEEN = ["random_bbox16", "random_bbox64", "--elements", "16", "--regions", "none,8x16",
           "--engine", "model"]


def rows_of(tmp_path, *options):
    path = tmp_path / "rows.json"
    result = CliRunner().invoke(main, ["bench", *SIXTEEN, *options, "--json", str(path)])
    assert result.exit_code == 0, result.output
    rows = json.loads(path.read_text())["rows"]
    return {(row["case"], row["machine"]["regions"] is not None, row["machine"]["fifo_depth"]): row
            for row in rows}, result.output


def test_rows_of_regions_and_a_chart(tmp_path):
    chart = tmp_path / "regions.png"
    rows, text = rows_of(tmp_path, "--fifo", "16,64", "--plot", str(chart))
    short, long = rows["random_bbox64", True, 16], rows["random_bbox64", True, 64]
    assert (short["bound"]["binding"], long["bound"]["binding"]) == ("queue", "busiest element")
    assert short["predicted_cycles"] > 1.1 * long["predicted_cycles"]
    assert "Bound by the queue" in text and "Regions: how evenly" in text
    # Of triangles of 16 pixels anywhere, each element walks fewer rows than of interlaced pixels.
    faster, interlaced = rows["random_bbox16", True, 16], rows["random_bbox16", False, 16]
    assert faster["predicted_cycles"] < 1.7 * 200 < interlaced["predicted_cycles"]
    assert interlaced["region_utilisation"] is None
    assert 0.9 < faster["region_utilisation"] <= 1
    with Image.open(chart) as picture:
        assert len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0)) > 20


def test_a_case_is_drawn_by_the_table_of_its_own_frame(tmp_path):
    rows, _ = rows_of(tmp_path)
    case = case_lists("random_bbox16")
    [machine] = bench_machines(MachineAxes(elements=(16,), regions=((8, 16),)))
    configuration = machine.configuration
    counts = region_counts(case.frame, RegionGrid.of(configuration.dealt_regions)).clocks
    table = packed_table(counts, 16, configuration.slots)
    clocks = [predict_cycles(configuration, listed, table=table).cycles
              for listed in (case.once, case.twice)]
    row = rows["random_bbox16", True, 16]
    assert row["predicted_cycles"] == clocks[1] - clocks[0]
    assert row["region_utilisation"] == utilisation(counts, table, 16)


def test_diagonal_slivers_want_low_regions():
    """A visit walks all rows that the box has in a region, so that regions twice as high gain
    nothing."""
    case = case_lists("sliver_diag_480")
    axes = MachineAxes(elements=(16,), regions=(None, (8, 16), (16, 8)))
    interlaced, low, high = (
        clocks_a_triangle(machine.configuration, case) for machine in bench_machines(axes))
    assert low <= 90 < 0.8 * interlaced
    assert high > 1.5 * low


def clocks_a_triangle(configuration, case):
    """Clocks a triangle, by the cycle model alone."""
    table = None
    if configuration.regions is not None:
        counts = region_counts(case.frame, RegionGrid.of(configuration.dealt_regions)).clocks
        table = packed_table(counts, 16, configuration.slots)
    once, twice = (predict_cycles(configuration, listed, table=table).cycles
                   for listed in (case.once, case.twice))
    return (twice - once) / case.once.triangles


def test_a_shuffled_mesh_is_the_same_picture():
    """Its triangles have other numbers, which decide between equal depths; the mesh has none that
    would be seen."""
    in_order, shuffled = (case_lists("mesh", order) for order in ("visible", "random"))
    assert (in_order.once.position != shuffled.once.position).any(axis=(1, 2)).mean() > 0.99
    for one, other in ((in_order.once, shuffled.once), (in_order.frame, shuffled.frame)):
        expected, picture = draw(one), draw(other)
        assert len(np.unique(expected.depth)) > 1000
        np.testing.assert_array_equal(picture.color, expected.color)
        np.testing.assert_array_equal(picture.depth, expected.depth)


def test_nothing_to_draw_along():
    options = ["bench", "random_bbox16", "--elements", "16", "--regions", "8x16", "--engine",
               "model", "--plot", "no.png"]
    result = CliRunner().invoke(main, options)
    assert result.exit_code == 2 and "--regions none and others" in result.output
