"""Who draws what by each assignment."""

import numpy as np
import pytest

from cardcage.golden.organisations.shares import Shares
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.sampling_grid import Grid
from cardcage.testbenches.figures.assignments.assignment import (
    ASSIGNMENTS,
    boxes,
    nearest_first,
    runs,
    work,
)

LIST = make_display_list("random:n=300,size=11,seed=6", width=64, height=48,
                         shading="flat").display_list


@pytest.mark.parametrize("assignment", ASSIGNMENTS, ids=lambda each: each.name)
@pytest.mark.parametrize("nodes", [1, 3, 16])
def test_each_triangle_has_a_node(assignment, nodes):
    node = assignment.node_of(LIST, nodes)
    assert node.dtype == np.int64 and node.shape == (LIST.triangles,)
    assert node.min() == 0 and node.max() < nodes
    if not assignment.name.startswith("packets"):  # large ones leave nodes without any
        assert set(node.tolist()) == set(range(nodes))
    if assignment.keeps_order and assignment.name.startswith("runs"):
        assert (np.diff(node) >= 0).all()


def test_packets_are_those_of_the_machine():
    by_name = {each.name: each.node_of(LIST, 4) for each in ASSIGNMENTS}
    for name, packet in (("round robin", 1), ("packets of 30", 30), ("contiguous", "contiguous")):
        assert (by_name[name] == Shares(4, LIST.triangles, packet).node).all()


def test_runs_have_equal_costs():
    random = np.random.default_rng(2)
    for nodes in (1, 2, 7, 32):
        costs = random.integers(0, 40, 500).astype(float)
        node = runs(costs, nodes)
        assert (np.diff(node) >= 0).all()
        share = np.bincount(node, costs, nodes)
        # A triangle goes to the run that its middle is in: half of one too much at either end.
        assert abs(share - costs.sum() / nodes).max() <= costs.max()
        order = random.permutation(500)
        assert (runs(costs, nodes, order)[order] == runs(costs[order], nodes)).all()
    assert runs(np.zeros(5), 3).tolist() == [0] * 5
    assert runs(np.zeros(0), 3).tolist() == []


def test_what_triangles_cost():
    triangles = Triangles.of(LIST, Grid.of(LIST))
    rows, columns = triangles.bottom - triangles.top, triangles.right - triangles.left
    wanted, areas = np.zeros((2, LIST.triangles))
    wanted[triangles.primitive] = rows * columns
    assert boxes(LIST).tolist() == wanted.tolist()
    areas[triangles.primitive] = np.maximum(rows, abs(triangles.double_area) / 2 / 4**8)
    assert work(LIST) == pytest.approx(areas)


def test_nearest_first():
    nearest = LIST.depth[nearest_first(LIST)].min(axis=1)
    assert (np.diff(nearest) >= 0).all()
