"""Points of simulated machines, here ones that answer what they are told to."""

from types import SimpleNamespace

import pytest

from cardcage.testbenches.figures.blazek.our_machine import decompositions, in_rtl
from cardcage.testbenches.figures.blazek.our_machine.in_rtl import PointsJob, points_jobs

SIZE = (128, 128)


@pytest.fixture
def points(tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))
    monkeypatch.setattr(decompositions, "FOLLOWED", 16)

    def run(decomposition, merged, equal=True):
        monkeypatch.setattr(in_rtl, "simulate_frame", lambda machine, listed, engine: (
            SimpleNamespace(draw_cycles=listed.triangles, merge_cycles=merged)))
        monkeypatch.setattr(in_rtl, "compare",
                            lambda *compared: SimpleNamespace(equal=equal))
        return PointsJob(decomposition, SIZE, "pysim").run()

    return run


def test_clocks_of_a_machine_and_of_the_model(points):
    four, sixteen = points("node initiated", merged=10_000)
    assert (four.spheres, four.nodes, four.drawing, four.merging) == (4, 4, 2048, 7952)
    assert sixteen.clocks == 10_000
    assert four.off == (four.model_drawing + four.model_merging) / 10_000 - 1
    assert four.differences == []


def test_elements_that_share_a_picture_merge_nothing(points):
    four, _ = points("broadcast, lines", merged=None)
    assert four.merging == four.model_merging == 0


def test_a_picture_that_differs(points):
    four, _ = points("forwarding, grid", merged=None, equal=False)
    assert four.differences == ["forwarding, grid on 4 nodes, 4 spheres: the picture differs"]


def test_a_point_for_each_form():
    begins = {job.decomposition.split(",")[0] for job in points_jobs(SIZE, "auto")}
    assert begins == {"host initiated", "node initiated", "forwarding", "broadcast"}
