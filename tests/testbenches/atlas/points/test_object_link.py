"""Decompositions side by side: points of cages that make the triangles of objects themselves."""

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.objects.forwarding import forwarded_objects
from cardcage.golden.objects.making import link_words
from cardcage.golden.scenes.scene_files.object_list import ObjectMesh
from cardcage.hdl.forwarding.reach import object_bits, reaching_object_layout
from cardcage.testbenches.atlas.atlas import AtlasOptions
from cardcage.testbenches.atlas.points.atlas_point import Failure
from cardcage.testbenches.atlas.points.atlas_scene import _hash
from cardcage.testbenches.atlas.points.measure import batches, measure
from cardcage.testbenches.atlas.points.object_link import passed_object_bits
from cardcage.testbenches.atlas.running.sweep import Sweep
from cardcage.testbenches.atlas.running.workers import LocalWorkers
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.support.measurement_cache import package_hash

CUBES = "obj cube scale 0.3 rot 20,30,0 num 6 seed 2 color random\n"
MAKING = ("2x(PMT)@nodes", "2x(PM)/1x2@elements", "2x(PM)@controller")


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """Of a scene of objects the host's own way, and the three others; two that there cannot be."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "some.scene").write_text(CUBES, encoding="utf-8")
    return AtlasOptions(
        scenes=("some.scene",), sizes=((16, 16),), fraction_bits=(0, "exact"),
        cages=("2x(PMT)", *MAKING, "2x(PM)@nodes", "2x(PM)@elements"), retain=False,
        machine=MachineOptions(shading="flat"))


def measured(options):
    points = options.points()
    return dict(zip(points, (outcome for batch in batches(points, package_hash())
                             for outcome in measure(batch)), strict=True))


def by_cage(found, bits="exact"):
    return {point.cage.label: (point, figures) for point, figures in found.items()
            if point.fraction_bits == bits}


def test_four_decompositions_by_the_models(asked):
    found = by_cage(measured(asked))
    assert [label for label, (_, figures) in found.items() if isinstance(figures, Failure)] == [
        "2x(PM)@nodes", "2x(PM)@elements"]
    assert not any(figures.failed for _, figures in found.values() if isinstance(figures, Failure))
    sent = found["2x(PMT)"][1]
    assert sent["memory"]["meshes"] == sent["traffic"]["once"] == 0
    for name in MAKING:
        point, figures = found[name]
        machine, listed = point.machine(), point.scene.load().display_list
        words, traffic = link_words(machine, listed), figures["traffic"]
        assert (traffic["host"], traffic["once"]) == (32 * words.frame, 32 * words.meshes)
        assert traffic["host"] < sent["traffic"]["host"] / 5
        assert figures["memory"]["meshes"] > 0 < figures["bounds"]["set-up"]
        assert figures["cells"] > sent["cells"] and figures["fragments"] == sent["fragments"]
        assert traffic["all"] == traffic["host"] + traffic["nodes"]
    assert found["2x(PM)@controller"][1]["traffic"]["nodes"] == 0


def test_what_is_passed_on_is_traffic(asked):
    [point] = [point for point in asked.points() if point.cage.objects == "elements"
               and point.cage.regions and point.fraction_bits == "exact"]
    figures = measured(replace(asked, cages=(point.cage.label,), fraction_bits=("exact",)))[point]
    machine, listed = point.machine(), point.scene.load().display_list
    passed = forwarded_objects(machine, listed)
    both = int(passed.left.sum() + passed.right.sum())
    bits = passed_object_bits(machine)
    assert bits == reaching_object_layout(machine, object_bits(machine)).size
    assert figures["traffic"]["nodes"] == figures["traffic"]["busiest_link"] == both * bits > 0


def test_a_set_up_takes_longer_the_more_bits_it_finds(asked):
    found = measured(replace(asked, cages=("2x(PMT)", "2x(PM)@controller")))
    coarse, fine = by_cage(found, 0), by_cage(found)
    assert coarse["2x(PMT)"][1]["draw"] == fine["2x(PMT)"][1]["draw"]
    assert coarse["2x(PM)@controller"][1]["draw"] < fine["2x(PM)@controller"][1]["draw"]


def test_no_point_is_taken_for_another(asked):
    """Where triangles are made is part of what a result is kept by, and so is what of a scene is an
    object: other ones may have the same triangles."""
    points = asked.points()
    sweep = Sweep(points, LocalWorkers(1))
    assert len({sweep.key(point) for point in points}) == len(points) == 12
    listed = points[0].scene.load().display_list
    assert _hash(listed) == points[0].scene.identity
    objects = listed.objects
    split = replace(listed, counts=np.array([len(listed.depth)]), objects=replace(
        objects, meshes=(ObjectMesh(listed.position, listed.depth, listed.color),),
        mesh=objects.mesh[:1], offset=0 * objects.offset[:1], color=objects.color[:1]))
    assert len({_hash(each) for each in (
        listed, listed.chosen(np.arange(listed.triangles)), split)}) == 3


def test_a_simulated_point(asked):
    """Its picture and counts are golden's, or it had none.  The memories of its Verilog are all
    that there can be: meshes and their boxes, and queues of objects, outlines and triangles; beside
    a picture so small the bits by which queues are off weigh more than elsewhere."""
    [(_, figures)] = by_cage(measured(replace(
        asked, cages=("PM/1x2@elements",), sizes=((8, 8),), fraction_bits=(2,), simulate=True,
        engine="pysim")), 2).values()
    found = figures["simulated"]
    assert figures["source"] == "rtl"
    assert found["pixels_compared"] == found["depths_compared"] == 64
    assert found["fragments"] == figures["fragments"] > 10
    assert abs(figures["draw"] - found["model"]["draw"]) <= 4
    assert np.isclose(figures["memory_bits"], found["model"]["memory_bits"], rtol=0.025)
    assert figures["memory"]["meshes"] > 0.05 * figures["memory_bits"]
