"""The map, its tables and its files, of points whose figures are known."""

import csv
import io
import json
from dataclasses import replace

import pytest
from atlas_sweeps import SMALL
from matplotlib.backends.backend_agg import FigureCanvasAgg

from cardcage.testbenches.atlas.atlas import Atlas, AtlasOptions, _several
from cardcage.testbenches.atlas.atlas_facts import atlas_csv, atlas_facts
from cardcage.testbenches.atlas.atlas_map import atlas_map, kind_of, winners
from cardcage.testbenches.atlas.atlas_report import ATLAS_FILES, write_atlas
from cardcage.testbenches.atlas.atlas_table import headline, tables
from cardcage.testbenches.atlas.charts import error_figure, map_figure
from cardcage.testbenches.atlas.points.atlas_point import Failure
from cardcage.testbenches.atlas.points.measure import batches, measure
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.support.measurement_cache import package_hash


@pytest.fixture(scope="module")
def atlas():
    """Of real figures, but for clocks: the last cage is the fastest, the one before fails."""
    points = SMALL.points()
    figures = dict(zip(points, (outcome for batch in batches(points, package_hash())
                                for outcome in measure(batch)), strict=True))
    for place, point in enumerate(points):
        figures[point] = figures[point] | {"work": 1000 - 100 * place}
    failed = points[-2]
    del figures[failed]
    return Atlas(SMALL, figures, {failed: Failure("it burns", failed=True)}, 3, ["smoke"],
                 "cardcage atlas", 1.5)


def test_the_best_of_each_cell_comes_first(atlas):
    places = atlas_map(atlas)
    assert {cell.elements for cell in places["fastest"]} == {1, 2}
    [two] = [place for cell, place in places["fastest"].items() if cell.elements == 2]
    assert [ranked.point.cage.label for ranked in two.ranked] == [
        "2x(PM)/2x2", "2x(PMS)F", "2x(PMT)", "2x(PMC)"]
    assert two.best.figure == 500 and two.second == "bus" and two.ahead == 700 / 500
    [one] = [place for cell, place in places["fastest"].items() if cell.elements == 1]
    assert one.ahead is None
    for name in ("least_memory", "least_traffic", "smallest"):
        for place in places[name].values():
            found = [ranked.figure for ranked in place.ranked]
            assert found == sorted(found) and found[0] > 0
    assert winners(atlas)["fastest"] == {"host broadcast": 1, "regions 2x2": 1}


def test_kinds_have_names():
    assert [kind_of(cage) for cage in (
        Cage("4x(PMM)"), Cage("PM", regions=(8, 4)), Cage("2x(PMC)", retained=True),
        Cage("PPDMM"))] == ["host broadcast", "regions 8x4", "chain, lists", "direct"]
    assert [kind_of(Cage.named(name)) for name in (
        "4x(PMMT)@nodes", "4x(PMM)/1x4@elements", "PM@controller")] == [
        "tree, objects in nodes", "regions 1x4, objects in elements",
        "host broadcast, objects at the controller"]


def test_the_files_tell_the_same(atlas, tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    write_atlas(atlas, tmp_path)
    assert all((tmp_path / name).stat().st_size > 500 for name in ATLAS_FILES)
    facts = json.loads((tmp_path / "atlas.json").read_text("utf-8"))
    assert facts == json.loads(json.dumps(atlas_facts(atlas)))
    assert len(facts["points"]) == 5 and len(facts["failures"]) == 1
    assert facts["differences"] == [
        "tetra:depth=1 16x16 on 2xPD2xM, exact fraction bits: it burns"]
    rows = list(csv.DictReader(io.StringIO(atlas_csv(atlas))))
    assert (tmp_path / "atlas.csv").read_text("utf-8") == atlas_csv(atlas)
    assert [row["cage"] for row in rows] == [point["cage"] for point in facts["points"]]
    assert [int(row["traffic.all"]) for row in rows] == [
        point["traffic"]["all"] for point in facts["points"]]
    page = (tmp_path / "atlas.html").read_text("utf-8")
    for words in ("it burns", "smoke", "regions 2x2", "What limits each machine"):
        assert words in page
    assert page.count("<svg") == 2  # one precision has no curve
    assert "http" not in page.replace("http://www.w3.org", "")


def test_the_verdict_names_what_failed(atlas):
    lines = headline(atlas)
    assert lines[0].startswith("FAILED: tetra:depth=1 16x16 on 2xPD2xM")
    assert lines[1] == "5 points, 5 by the models; 3 remembered"
    assert [table.columns[3] for table in tables(atlas)] == ["best"] * 4


def test_every_bound_holds_the_clocks(atlas):
    """A frame takes as long as each of its parts at least, but for a clock or two at its ends."""
    for figures in atlas.figures.values():
        assert max(bound for name, bound in figures["bounds"].items() if name != "merge") <= \
            figures["draw"] + 2
        assert figures["limit"] in (*figures["bounds"], "waiting", "memory ports")


def test_a_reason_is_told_once(atlas):
    """With its scenes and cages; of many the first ones."""
    points = SMALL.points()
    reasons = dict.fromkeys(points, Failure("too large", failed=False))
    reasons[points[0]] = Failure("no elements", failed=False)
    reasons[points[-1]] = Failure("it burns", failed=True)
    assert replace(atlas, failures=reasons).refused == [
        "tetra:depth=1 on PM, 1 point: no elements",
        "tetra:depth=1 on 2x(PMC), 2x(PMT), 2x(PMS)F, 2xPD2xM, 4 points: too large"]
    assert _several(map(str, range(15))) == "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11 and 3 more"
    assert _several("aba") == "a, b"


def test_every_word_of_a_chart_is_on_it(atlas):
    """The legend of curves names kinds that the first scene lacks, and the title which machines;
    on the map the words of a cell are within it, though its kinds have long names."""
    points = [replace(point, scene=replace(point.scene, name=name), fraction_bits=bits, cage=cage)
              for point in list(atlas.figures)[:1] for name in ("first", "second")
              for bits in (0, "exact") for cage in (
                  Cage("PM"), Cage("PM", regions=(16, 16), objects="elements"),
                  Cage("PM", objects="controller"))]
    [some] = list(atlas.figures.values())[:1]
    options = replace(SMALL, fraction_bits=(0, "exact"),
                      cages=("PM", "PM/16x16@elements", "PM@controller"))
    shown = replace(atlas, options=options, figures={
        point: some | ({"work": 10**25} if point.cage.objects else {})
        for point in points if point.scene.name == "second" or not point.cage.objects})
    error, drawn = error_figure(shown), map_figure(shown)
    for figure in (error, drawn):
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        [legend] = figure.legends
        box = legend.get_window_extent()
        assert box.x0 >= 0 and box.x1 <= figure.bbox.x1
    assert [text.get_text() for text in error.legends[0].get_texts()] == [
        "host broadcast", "regions 16x16, objects in elements",
        "host broadcast, objects at the controller"]
    assert error.get_suptitle() == "1 element at 16x16: the most elements, the largest size"
    for axes in drawn.axes:
        cell = axes.patches[0].get_window_extent()
        for text in axes.texts:
            assert text.get_window_extent().width <= cell.width


def test_what_contradicts_itself_is_refused():
    with pytest.raises(ValueError, match="--processes: a cluster"):
        AtlasOptions(cluster="local", processes=2)
