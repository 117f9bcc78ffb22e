"""Clocks of our decompositions, against the cycle model asked about each scene by itself."""

import numpy as np
import pytest

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.merge_clocks import predict_merge
from cardcage.golden.objects.making import link_words
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.testbenches.figures.blazek.our_machine import decompositions
from cardcage.testbenches.figures.blazek.our_machine.decompositions import (
    DECOMPOSITIONS,
    drawing_clocks,
    node_of_triangles,
    words_on_link,
)
from cardcage.testbenches.figures.blazek.our_machine.merging import merging_clocks
from cardcage.testbenches.figures.blazek.our_machine.our_scene import our_objects
from cardcage.testbenches.frames.setup_timing import setup_timing

SIZE = (128, 128)


@pytest.mark.parametrize("name", ["host initiated, 100", "node initiated", "broadcast, lines",
                                  "broadcast, strips"])
def test_all_at_once_as_one_by_one(name):
    asked, spheres = DECOMPOSITIONS[name], [1, 2, 4]
    machine = asked.configuration(SIZE, 4)
    found = drawing_clocks(asked, SIZE, 0, 4, spheres)
    assert found == [predict_cycles(
        machine, our_objects(SIZE, 0, count).display_list(),
        setup=setup_timing(machine)).cycles for count in spheres]


@pytest.mark.parametrize("name", ["host initiated, 100", "node initiated"])
def test_painted_pictures_merge_as_drawn_ones(name):
    asked, spheres = DECOMPOSITIONS[name], [1, 3, 6]
    machine = asked.configuration(SIZE, 4)
    node = node_of_triangles(asked, 4, spheres[-1])
    lists = [our_objects(SIZE, 0, count).display_list() for count in spheres]
    assert (organisation_of(machine).shares(lists[-1]).node == node).all()
    assert merging_clocks(machine, SIZE, 0, spheres, node) == [
        predict_merge(machine, listed) for listed in lists]


def test_more_than_are_followed(monkeypatch):
    """Beyond, each sphere takes as long as one of the second half."""
    asked = DECOMPOSITIONS["node initiated"]
    followed = drawing_clocks(asked, SIZE, 0, 2, [4, 8, 16, 32])
    monkeypatch.setattr(decompositions, "FOLLOWED", 8)
    found = drawing_clocks(asked, SIZE, 0, 2, [4, 8, 16, 32])
    assert found[:2] == followed[:2]
    assert found == pytest.approx(followed, rel=0.001)


def test_forwarded_objects_keep_no_element_waiting():
    """Strips of a broadcast wait for one another; where objects are passed on each draws what it
    has, and takes as long as that at least."""
    broadcast, forwarding = (drawing_clocks(DECOMPOSITIONS[f"{name}, strips"], SIZE, 0, 8, [16, 32])
                             for name in ("broadcast", "forwarding"))
    assert forwarding[0] < forwarding[1] < broadcast[1]
    machine = DECOMPOSITIONS["forwarding, strips"].configuration(SIZE, 8)
    prediction = predict_cycles(DECOMPOSITIONS["broadcast, strips"].configuration(SIZE, 8),
                                our_objects(SIZE, 0, 32).display_list(),
                                setup=setup_timing(machine))
    assert forwarding[1] > prediction.element_bound.max()


def test_one_mesh_is_sent_once():
    asked = DECOMPOSITIONS["node initiated"]
    machine = asked.configuration(SIZE, 4)
    assert words_on_link(asked, SIZE, 0, 4, [1, 5, 40]) == [
        link_words(machine, our_objects(SIZE, 0, count).display_list()).total
        for count in (1, 5, 40)]
    host = words_on_link(DECOMPOSITIONS["host initiated, 10"], SIZE, 0, 4, [1, 2])
    assert np.diff(host) == pytest.approx(512 * host[0] / 514)


def test_all_spheres_are_alike():
    listed = our_objects(SIZE, 2, 3)
    assert not listed.clipped.any()
    assert (listed.offset[:, :2] % (1 << listed.picture.sub_bits) == 0).all()
    assert (our_objects(SIZE, 2, 2).offset == listed.offset[:2]).all()
    depth = listed.display_list().depth
    assert depth.min() >= 0 and depth.max() <= listed.picture.depth_limit
