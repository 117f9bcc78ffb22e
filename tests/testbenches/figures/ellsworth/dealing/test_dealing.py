"""Utilisation of the frames of a model, against what is worked out one table after the other."""

from itertools import pairwise
from statistics import mean

import numpy as np
import pytest

from cardcage.golden.balancing.region_counts import counts_of, utilisation
from cardcage.golden.organisations.region_table import packed_table, static_table
from cardcage.golden.scene_display_list import make_display_list, read_scene
from cardcage.golden.scenes.camera import View
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.figures.ellsworth.dealing.cures import CURES
from cardcage.testbenches.figures.ellsworth.dealing.dealing_job import (
    HOW,
    DealingJob,
    merge_lists,
    scattered_table,
)
from cardcage.testbenches.figures.ellsworth.dealing.model_dealing import dealing_jobs, model_dealing
from cardcage.testbenches.figures.ellsworth.dealing.models import (
    FigureModel,
    figure_models,
    triangles_of,
)
from cardcage.testbenches.figures.ellsworth.dealing.screen_grids import screen_grid

SIZE = (96, 64)
MODEL = FigureModel("pot", "teapot:tessellation=3", 3, 20)


@pytest.fixture(scope="module")
def dealing(tmp_path_factory):
    patch = pytest.MonkeyPatch()
    patch.setenv("CARDCAGE_CACHE", str(tmp_path_factory.mktemp("cache")))
    jobs = dealing_jobs(MODEL, SIZE)
    yield model_dealing(jobs, [job.run() for job in jobs])
    patch.undo()


def frame(number):
    """As ``render --frames`` has it."""
    view = View((25.0 + 20 * number, 30.0))
    return make_display_list(MODEL.scene, width=SIZE[0], height=SIZE[1], view=view,
                             cull=True).display_list


@pytest.mark.parametrize("ratio", [1, 3, 8])
@pytest.mark.parametrize("processors", [2, 16])
def test_utilisation(dealing, processors, ratio):
    grid = screen_grid(SIZE, processors * ratio)
    counts = [counts_of(triangles_of(frame(number)), grid) for number in (-1, 0, 1, 2)]
    slots = -(-5 * grid.count // (4 * processors))
    wanted = {how: [] for how in HOW}
    for last, now in pairwise(counts):
        tables = {"static": static_table(grid.count, processors),
                  "static, scattered": scattered_table(grid, processors)}
        for when, of in (("this frame", now), ("last frame", last)):
            for name in ("triangles", "clocks"):
                tables[f"{name}, {when}"] = packed_table(of.of(name), processors, slots)
        for how, table in tables.items():
            wanted[how].append(utilisation(now.clocks, table, processors))
        share = now.clocks.sum() / processors
        wanted["ceiling"].append(min(1, share / now.clocks.max()))
    for how in HOW:
        assert dealing.utilisation(processors, ratio, how) == pytest.approx(mean(wanted[how])), how
    assert dealing.overlap(grid.count) == pytest.approx(
        sum(each.triangles.sum() for each in counts[1:]) / sum(each.drawn for each in counts[1:]))
    assert dealing.clocks(grid.count) == mean(int(each.clocks.sum()) for each in counts[1:])


def test_no_table_exceeds_the_ceiling(dealing):
    for processors in dealing.processors:
        for ratio in (1, 8):
            assert max(dealing.utilisation(processors, ratio, how) for how in HOW) == (
                dealing.utilisation(processors, ratio, "ceiling"))
        assert dealing.drop(processors, 1, "clocks") == pytest.approx(0, abs=1e-12)


def test_cures_that_are_curves_of_figure_4_too(dealing):
    assert dealing.cure_processors == [16]
    for name, how in (("last frame's clocks", "clocks, last frame"),
                      ("last frame's triangles", "triangles, last frame")):
        assert dealing.cured(name, 16) == dealing.utilisation(16, 8, how)
    ceiling = dealing.utilisation(16, 8, "ceiling")
    assert all(0 < dealing.cured(cure.name, 16) <= ceiling for cure in CURES)


def test_a_model_in_portions_is_the_same(dealing, tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))
    parts = [DealingJob(MODEL, SIZE, first, 1).run() for first in range(3)]
    assert merge_lists(parts) == dealing.found
    assert DealingJob(MODEL, SIZE, 1, 1).run() == parts[1]  # as it was kept


def test_what_frames_are(dealing):
    lists = list(MODEL.lists(SIZE, -1, 2, lit=True))
    for number, display_list in zip((-1, 0), lists, strict=True):
        assert np.array_equal(display_list.position, frame(number).position)
    assert np.array_equal(lists[1].position, next(MODEL.lists(SIZE, 0, 1)).position)
    drawn = len(triangles_of(lists[1]))
    assert dealing.found["drawn"][0] == drawn <= dealing.found["given"][0] == lists[1].triangles
    assert 1 < dealing.mean_size < 100 and min(dealing.box) > 1


def test_scattered_tables_share_evenly():
    for processors in (2, 16, 64):
        grid = screen_grid((640, 512), 8 * processors)
        held = np.bincount(scattered_table(grid, processors), minlength=processors)
        assert held.sum() == 8 * processors and 6 <= held.min() <= held.max() <= 10
        neighbours = scattered_table(grid, processors).reshape(grid.rows, grid.columns)
        assert (neighbours[1:] != neighbours[:-1]).all()


def test_models():
    head, virus = figure_models()
    assert head.load().mesh.triangles == 59_168 and head.frames == 80 and head.turn == 4.5
    assert virus.scene == "capsid:count=394,depth=4" and figure_models(3)[1].frames == 3
    with pytest.raises(InputError, match="random is no mesh and cannot be turned; take a mesh"):
        FigureModel("random", "random", 1, 4.5).load()


@pytest.mark.parametrize("view", ["", "projection perspective\neye 0,1,4\n"])
def test_a_scene_file_turns_as_render_turns_it(tmp_path, view):
    path = tmp_path / "small.scene"
    path.write_text(f"{view}obj cube scale 0.4 num 3\n")
    model = FigureModel("small", str(path), 3, 20)
    loaded = read_scene(path)
    azimuth, elevation = loaded.direction
    lists = list(model.lists(SIZE, -1, 3))
    assert not np.array_equal(lists[0].position, lists[2].position)
    for number, display_list in zip((-1, 0, 1), lists, strict=True):
        wanted = make_display_list(
            loaded, width=SIZE[0], height=SIZE[1], shading="flat", cull=True,
            view=View((azimuth + 20 * number, elevation))).display_list
        assert np.array_equal(display_list.position, wanted.position) and wanted.triangles >= 6
    before = model.identity(SIZE)
    path.write_text(f"{view}obj cube scale 0.3 num 3\n")
    assert model.identity(SIZE) != before
