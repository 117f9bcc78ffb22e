"""Points that machines measure, here one that answers as the golden models say, or almost."""

import pytest
from golden_machine import GoldenMachine

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.figures.ellsworth.dealing.models import FigureModel
from cardcage.testbenches.figures.ellsworth.in_rtl import (
    POINT_FRAMES,
    PointJob,
    nearest_regions,
    point_jobs,
)

SIZE = (48, 40)
MODEL = FigureModel("pot", "teapot:tessellation=2", POINT_FRAMES, 30)


@pytest.fixture
def measure(tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))

    def run(**machine):
        lists = list(MODEL.lists(SIZE, 0, POINT_FRAMES, lit=True))
        monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                            {"pysim": lambda: GoldenMachine(lists, **machine)})
        return PointJob(MODEL, SIZE, 4, "pysim").run()

    return run


def test_as_golden(measure):
    point = measure()
    assert (point.columns, point.rows) == nearest_regions(SIZE, 4) == (6, 5)
    assert point.ratio == 7.5
    assert point.differences == [] and point.utilisation == point.golden
    assert len(point.utilisation) == POINT_FRAMES
    static, dealt = (point.by(how) for how in ("static", "clocks, last frame"))
    assert static == point.utilisation[0] and dealt == pytest.approx(
        sum(point.utilisation[1:]) / 3)
    assert dealt != static


def test_a_count_that_is_wrong(measure):
    point = measure(change=lambda kind, number, value: value + (
        kind == ResponseKind.REGION_COUNT and number == 0))
    [line] = point.differences
    assert line.startswith("pot on 4 processors, frame 0: processing element 0 counted")
    assert point.utilisation[0] != point.golden[0]


def test_regions_nearest_to_eight_a_processor():
    assert [nearest_regions((640, 512), each) for each in (2, 4, 8, 16)] == [
        (5, 4), (10, 4), (10, 8), (20, 8)]
    assert nearest_regions((512, 512), 16) == (16, 8)
    assert [job.processors for job in point_jobs([MODEL], SIZE, "auto")] == [16, 8, 4, 2]
