"""The figures of a scene against the golden merges of its nodes' pictures."""

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.merging.node_picture import node_pictures
from cardcage.golden.merging.snoop import merge_snoop
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.reference.exact import depth_complexity
from cardcage.testbenches.figures.figure_scenes import FigureScene, figure_scenes
from cardcage.testbenches.figures.paper_table import paper_rows
from cardcage.testbenches.figures.scene_traffic import (
    CONTIGUOUS,
    NODES,
    PACKETS,
    ROUND_ROBIN,
    SHUFFLED,
    TrafficJob,
)

SIZE = (32, 24)
SCENES = (FigureScene("spheres", "spheres:count=20,depth=1"),
          FigureScene("first", "random:n=40,size=9", background="first"),
          FigureScene("last", "random:n=40,size=9", background="last"))


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def cache(kept, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(kept))


@pytest.fixture(params=SCENES, ids=lambda scene: scene.name)
def scene(request):
    return request.param


def test_table_1(scene):
    display_list = scene.display_list(SIZE)
    found = TrafficJob(scene, SIZE).run()
    complexity = depth_complexity(display_list)
    assert found.given == scene.given >= display_list.triangles >= found.triangles > 0
    assert found.fragments == complexity.sum()
    assert found.pixels == np.count_nonzero(complexity) and found.area == 32 * 24
    assert found.depth == pytest.approx(complexity.mean())
    assert found.drawn_depth == pytest.approx(complexity[complexity > 0].mean())
    assert found.mean_size == found.fragments / found.triangles


def test_traffic(scene):
    display_list = scene.display_list(SIZE)
    found = TrafficJob(scene, SIZE).run()
    for name, packet in PACKETS.items():
        for place, nodes in enumerate(NODES):
            shares = Shares(nodes, display_list.triangles, packet)
            _, traffic = merge_snoop(node_pictures(display_list, shares))
            curve = found.curve(name)
            assert curve.sent[place] == curve.least[place] == curve.most[place] == traffic.pixels
            drawn = [depth_complexity(display_list.chosen(shares.of_node(node))).sum()
                     for node in range(nodes)]
            assert curve.busiest[place] == pytest.approx(max(drawn) / sum(drawn))
    assert found.observed(1) == found.observed(1, CONTIGUOUS) == found.observed(1, SHUFFLED) == 1
    assert found.reduction(16) == pytest.approx(
        found.fragments / found.curve(ROUND_ROBIN).sent[NODES.index(16)])
    shuffled = found.curve(SHUFFLED)
    assert all(least <= sent <= most for least, sent, most in zip(
        shuffled.least, shuffled.sent, shuffled.most, strict=True))


def test_expectations():
    """Whatever distribution of depth there is, an even one has more traffic, and over the whole
    screen more than over the pixels drawn."""
    found = TrafficJob(SCENES[0], SIZE).run()
    assert 1 < found.expected_by_pixel < found.expected < found.expected_of_screen <= found.maximum
    assert found.expected_among == sorted(found.expected_among)
    assert found.among(64) < found.expected_by_pixel
    # Shares at random are what is expected of them, within some percent.
    assert found.observed(16, SHUFFLED) == pytest.approx(found.among(16), rel=0.1)


def test_what_was_found_is_kept(scene, monkeypatch):
    found = TrafficJob(scene, SIZE).run()
    monkeypatch.setattr(FigureScene, "display_list", None)
    assert TrafficJob(scene, SIZE).run() == found
    with pytest.raises(TypeError):
        TrafficJob(replace(scene, scene="tetra"), SIZE).run()


def test_the_background_is_behind_everything_and_everywhere():
    first, last = (scene.display_list(SIZE) for scene in SCENES[1:])
    assert first.triangles == last.triangles == 41
    for number, display_list in ((0, first), (40, last)):
        alone = depth_complexity(display_list.chosen(np.array([number])))
        assert (alone == 1).all()
        others = np.delete(display_list.depth, number, axis=0)
        assert others.max() < display_list.depth[number].min()


def test_random_triangles_are_like_the_rows_of_the_table():
    scenes = {scene.row: scene for scene in figure_scenes((256, 256)) if scene.row}
    assert list(scenes) == [row.name for row in paper_rows()]
    for row in paper_rows():
        if row.name in ("Cube", "Capitol", "Zinnia"):
            found = TrafficJob(scenes[row.name], (256, 256)).run()
            assert found.mean_size == pytest.approx(row.found_size, rel=0.12)
            assert found.depth == pytest.approx(row.found_depth, rel=0.12)
