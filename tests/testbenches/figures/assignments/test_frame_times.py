"""Frame times against the cycle model of whole cages."""

from math import prod

import numpy as np
import pytest

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.snoop_clocks import snoop_clocks
from cardcage.golden.merging.node_picture import node_pictures
from cardcage.golden.merging.snoop import merge_snoop
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference.exact import depth_complexity
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.figures.assignments.assignment import ASSIGNMENTS
from cardcage.testbenches.figures.assignments.frame_times import (
    MAP_NODES,
    MAP_SCENES,
    NODE,
    AssignmentTimes,
    FrameTime,
    TimesJob,
    draw_clocks,
    mean_times,
)
from cardcage.testbenches.figures.figure_scenes import FigureScene, figure_scenes

SCENE = FigureScene("spheres", "spheres:count=12,depth=1")


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))


@pytest.mark.parametrize("packet", [1, 7, "contiguous"])
def test_drawing_is_that_of_a_cage_of_such_nodes(packet):
    display_list = SCENE.display_list((64, 64))
    cage = plan(display_list, cards="4x(PMMC)", memory_ports=2, packet=packet,
                retain=True).configuration
    machine = plan(display_list, **NODE).configuration
    node = Shares(4, display_list.triangles, packet).node
    assert draw_clocks(machine, display_list, node, 4) == round(
        predict_cycles(cage, display_list, retained=True).cycles)


def test_times_of_a_scene():
    maps = TimesJob(SCENE, (48, 48)).run()
    assert [each.nodes for each in maps] == list(MAP_NODES)
    display_list = SCENE.display_list((48, 48))
    for each in maps:
        assert [time.assignment for time in each.times] == [one.name for one in ASSIGNMENTS]
        _, traffic = merge_snoop(node_pictures(display_list,
                                               Shares(each.nodes, display_list.triangles)))
        time = each.of("round robin")
        assert time.merge == sum(snoop_clocks(traffic)) > traffic.pixels
        assert time.sent == traffic.pixels / np.count_nonzero(depth_complexity(display_list))
        assert time.in_turn == time.draw + time.merge
        assert time.overlapped == max(time.draw, time.merge)
        assert 1 / each.nodes <= time.busiest <= 1 <= time.sent
    assert TimesJob(SCENE, (48, 48)).run() == maps  # that were kept


def test_means():
    def times(scene, factor):
        return AssignmentTimes(scene, 4, [
            FrameTime(each.name, True, 10 * (factor if number else 1), 50, 1.0, 1.0)
            for number, each in enumerate(ASSIGNMENTS)])

    means = mean_times([times("one", 2), times("other", 8)], ASSIGNMENTS[0].name)
    assert means[ASSIGNMENTS[0].name] == (1, 1, 1)
    assert means[ASSIGNMENTS[1].name] == pytest.approx(
        (4, prod((70 / 60, 130 / 60)) ** 0.5, prod((50 / 50, 80 / 50)) ** 0.5))


def test_the_scenes_of_the_map_are_among_those_of_the_figures():
    assert set(MAP_SCENES) <= {scene.name for scene in figure_scenes((128, 128))}


def test_a_picture_that_no_node_holds():
    with pytest.raises(InputError, match="words"):
        TimesJob(SCENE, (2048, 2048)).run()
