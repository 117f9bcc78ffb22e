"""Objects on the command line: what is asked, planned, drawn, reported, and refused."""

import json
from dataclasses import replace

import pytest
from click.testing import CliRunner
from golden_machine import GoldenMachine
from refusals import refusal

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import ResponseKind
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.command_line.tables.render_summary import frames_summary, render_summary
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.comparison.compare_cages import CompareOptions
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.frames.object_figures import object_figures
from cardcage.testbenches.machine_options import MachineOptions, machine_without_scene, option_words
from cardcage.testbenches.render import render
from cardcage.testbenches.render_frames import render_frames
from cardcage.testbenches.reports.frame_facts import report_facts
from cardcage.testbenches.reports.frame_report import report_page
from cardcage.testbenches.views.scene_frames import SceneFrames

SCENE = ("obj cube scale 0.5 rot 20,30,0 num 3 seed 2 color random\n"
         "obj cone scale 3 position 2,1,0 recursion 0\n")
NODES = ["--objects", "nodes", "--cards", "2x(PMC)"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """A folder to work in, with a scene."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "some.scene").write_text(SCENE)
    (tmp_path / "far.scene").write_text(f"projection perspective\n{SCENE}")


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.mark.parametrize(("words", "said"), [
    (["teapot", *NODES], "objects: only a scene file without perspective"),
    (["far.scene", *NODES], "objects: only a scene file without perspective"),
    (["some.scene", *NODES, "--setup", "host"], "setup: the host prepares no triangle of an obj"),
    (["some.scene", *NODES, "--retain"], "--retain: where the machine makes the triangles"),
    (["some.scene", "--objects", "nodes"], "objects: PMMPMM has no nodes that keep meshes"),
    (["some.scene", "--objects", "nodes", "--cards", "PPDMM"], "objects: PPDMM has no nodes"),
    (["some.scene", "--objects", "controller", "--cards", "2x(PMC)"], "has nodes, which make"),
    (["some.scene", "--objects", "elements"], "objects: processing elements pass objects on to"),
    (["some.scene", "--objects", "host"], "'host' is not one of 'controller', 'nodes', 'elements'"),
    (["some.scene", "--meshes", 3], "meshes: is for machines that make triangles of objects"),
    (["some.scene", *NODES, "--meshes", 1], "meshes: the scene needs 2; give as many or more"),
    (["some.scene", *NODES, "--mesh-triangles", 3], "mesh_triangles: the scene needs "),
    (["some.scene", *NODES, "--meshes", 5000], "5000 is not in the range 1<=x<=4096"),
])
def test_what_is_refused(words, said):
    assert said in refusal(run, "plan", *words)


@pytest.mark.parametrize(("words", "said"), [
    (["teapot", "--cards", "2x(PMC)"], "objects: only a scene file without perspective"),
    (["some.scene", "--cards", "2x(PM)"], "objects: none of these cages makes triangles of objects "
     "in nodes; give one that does, such as 4x(PMMC)"),
    (["some.scene", "--cards", "2x(PMC)", "--retain"], "objects: none of these cages"),
    (["some.scene", "--cards", "2x(PM)@controller"], "objects: none of these cages"),
    (["some.scene", "--cards", "2x(PMC)@knots"], "'knots' is no place where triangles of objects "
     "are made, which comes last, as in 4x(PMM)/1x4@elements; did you mean nodes?"),
    (["some.scene", "--cards", "2x(PMC)@"], "'' is no place where triangles of objects are made"),
])
def test_nothing_to_compare(words, said):
    """Before anything is simulated."""
    assert said in refusal(run, "compare", *words, "--objects", "nodes")


@pytest.mark.parametrize(("words", "said"), [
    (["teapot", "--cards", "2x(PMC)@nodes"], "2x(PMC)@nodes: objects: only a scene file without "),
    (["far.scene", "--cards", "PM@controller"], "PM@controller: objects: only a scene file"),
    (["some.scene", "--cards", "PM@nodes"], "PM@nodes: objects: PM has no nodes that keep meshes"),
    (["some.scene", "--cards", "PM@elements"], "PM@elements: objects: processing elements pass"),
    (["some.scene", "--cards", "2x(PMC)@nodes", "--setup", "host"], "setup: the host prepares"),
])
def test_what_cannot_be_made_there(words, said):
    assert said in refusal(run, "compare", *words)


def test_what_is_planned():
    listed = make_display_list("some.scene", width=64, height=64).display_list
    planned = json.loads(run("plan", "some.scene", *NODES, "--json").stdout)
    machine = planned["machine"]
    assert (machine["objects"], machine["meshes"]) == ("nodes", 2)
    assert machine["mesh_triangles"] == sum(mesh.triangles for mesh in listed.objects.meshes)
    assert (machine["setup"], machine["setup_interval"]) == ("hardware", 1)
    text = run("plan", "some.scene", *NODES, "--mesh-triangles", 99, "--setup", "small").stdout
    assert "4 objects are 2 meshes, moved" in text and "in each of 2 nodes" in text
    [line] = [line for line in text.splitlines() if line.startswith("mesh triangles")]
    assert line.split()[2] == "99"
    assert "--objects nodes" in text.splitlines()[-1]


def test_without_a_scene():
    options = MachineOptions(cards="2x(PMC)", objects="nodes", mesh_triangles=40, meshes=3)
    machine = machine_without_scene(options)
    assert (machine.objects, machine.mesh_triangles, machine.meshes) == ("nodes", 40, 3)
    assert option_words(options)[-6:] == ["--objects", "nodes", "--mesh-triangles", "40",
                                          "--meshes", "3"]
    with pytest.raises(InputError, match=r"^--objects: without a scene .*--mesh-triangles and"):
        machine_without_scene(replace(options, meshes=None))


def test_what_is_drawn_and_reported(tmp_path):
    rendering = render("some.scene", out=tmp_path / "out", cards="2x(PMC)", size=(8, 6),
                       packet=1, objects="nodes")
    assert rendering.comparison.equal and not rendering.warnings
    facts = json.loads((tmp_path / "out" / "report.json").read_text())
    found = facts["objects"]
    assert found["equal"] and found["read"] and found["clipped"] == 1
    assert found["made"] == found["golden_made"] == 36
    assert [place["made"] for place in found["per_place"]] == [
        place["golden_made"] for place in found["per_place"]]
    assert found["link_words"] == found["golden_link_words"]
    page = (tmp_path / "out" / "report.html").read_text()
    assert "Made in node 1<" in page
    # The display list has no objects: it would not draw the same again.
    assert facts["replay"] is facts["command_line"] is None
    assert "to replay" not in page and "keeps no objects" in page and "the scene file.<" in page
    again = report_page(rendering, report_facts(replace(rendering, command_line="cardcage ABC")))
    assert "draws the same again is <code>cardcage ABC</code> with the scene file" in again
    line = next(line for line in render_summary(rendering).splitlines() if "objects " in line)
    assert "4 of 2 meshes, 36 triangles made in 2 nodes, 1 object sent as triangles" in line
    # Counts that are not golden's are told.
    wrong = replace(rendering.simulation, made=[24, 13], dropped=[9])
    figures = object_figures(rendering.configuration, rendering.scene.display_list, wrong)
    figures = replace(figures, words=replace(figures.words, frame=1))
    made = [each.made for each in figures.golden]
    assert figures.differences[0] == f"place 1 made 13 triangles, golden {made[1]}"
    assert "places that say what they dropped: 1, golden 2" in figures.differences
    assert "the frame took 1 word on the host link" in figures.differences[-1]


@pytest.fixture
def drawn(monkeypatch):
    """Two pictures of the scene on a machine that answers as golden says, but for ``change``."""
    def draw(out=None, change=lambda kind, number, value: value):
        asked = {"size": (12, 8), "depth": "all"}
        lists = SceneFrames("some.scene", MachineOptions(size=asked["size"]), frames=2, turn=40,
                            path=None)
        monkeypatch.setattr(choose_engine, "ENGINES",
                            {"golden": lambda: GoldenMachine(lists, change)})
        return render_frames("some.scene", out=out, frames=2, turn=40, cards="2x(PM)",
                             objects="elements", regions=(2, 2), engine="golden", **asked)

    return draw


def test_several_pictures_are_reported_each_with_its_objects(drawn, tmp_path):
    rendering = drawn(tmp_path / "out")
    assert rendering.equal and not rendering.shown.warnings
    facts = json.loads((tmp_path / "out" / "report.json").read_text())
    assert facts["replay"] is None
    words = []
    for frame, each in zip(facts["frames"], rendering.frames, strict=True):
        found = frame["objects"]
        assert found["equal"] and found["made"] == sum(each.simulation.made) > 30
        assert found["dropped"] == sum(each.simulation.dropped) == found["golden_dropped"]
        assert found["objects"] == 4 and found["link_words"] == found["golden_link_words"]
        words.append(found["link_words"]["total"])
    page = (tmp_path / "out" / "report.html").read_text()
    assert "Words on the host link</th>" in page
    assert all(f'<td class="number">{number:,}</td>' in page for number in words)
    assert "picture 1 alone, without its objects" in " ".join(page.split())
    line = next(line for line in frames_summary(rendering).splitlines() if "objects " in line)
    assert "4 of 2 meshes, " in line and " triangles made in 2 elements, " in line


def test_a_wrong_count_of_any_picture_is_told(drawn):
    rendering = drawn(change=lambda kind, number, value: (
        value + (kind == ResponseKind.MADE and number == 1)))
    [line] = rendering.shown.wrong_counts
    assert line.startswith("picture 0: place 1 made ") and not rendering.equal
    assert "COUNTS DIFFER in 1 picture" in frames_summary(rendering)


@pytest.mark.parametrize(("cage", "objects", "made"), [
    ("2x(PMC)", "nodes", "nodes"), ("2x(PM)", "nodes", None), ("2xPD2xM", "nodes", None),
    ("2x(PM)", "controller", "controller"), ("2x(PMC)", "controller", None),
    ("2x(PM)/4x4", "elements", "elements"), ("2x(PM)", "elements", None)])
def test_which_cages_of_a_comparison_make_triangles(cage, objects, made):
    """Others are sent triangles, and set them up by the same means."""
    options = Cage.named(cage).options(MachineOptions(objects=objects, meshes=4))
    assert (options.objects, options.setup) == (made, "fast")
    assert options.meshes == (4 if made else None)
    assert Cage.named(cage, retained=True).options(MachineOptions(objects=objects)).objects is None
    # Its own name goes before what is asked of all, be there such a place or not.
    for asked in (None, "controller", "nodes", "elements"):
        named = Cage.named(f"{cage}@{objects}", retained=True)
        options = named.options(MachineOptions(objects=asked, meshes=4))
        assert (options.objects, options.setup, options.meshes, options.retain) == (
            objects, "fast", 4, None)


def test_the_name_of_a_cage():
    cage = Cage.named(" 4x(PMM) / 8x4 @ elements ")
    assert cage == Cage(" 4x(PMM)", False, (8, 4), "elements")
    assert Cage.named("2x(PMT)@nodes") == Cage("2x(PMT)", objects="nodes")
    for name in ("2x(PMT)@nodes", "4x(PMM)/8x4@elements", "PM@controller"):
        assert Cage.named(name).label == name
    options = CompareOptions(MachineOptions(), ("2x(PMC)", "2x(PMC)@nodes"), nodes=(1, 2))
    assert [cage.label for cage in options.cages()] == ["2x(PMC)", "2x(PMC) retained",
                                                        "2x(PMC)@nodes"]
    assert [place.cage.label for place in options.points() if place.objects is not None] == [
        "PMC@nodes", "2x(PMC)@nodes"]


def test_what_the_controller_makes_is_reported(tmp_path):
    rendering = render("some.scene", out=tmp_path / "out", cards="2x(PM)", size=(8, 6), lines=True,
                       objects="controller", setup="small", shading="flat")
    assert rendering.comparison.equal and not rendering.warnings
    facts = json.loads((tmp_path / "out" / "report.json").read_text())["objects"]
    [place] = facts["per_place"]
    assert facts["equal"] and facts["place"] == "controller"
    assert place["made"] == place["golden_made"] == rendering.objects.made[0] > 30
    assert "Made in the controller<" in (tmp_path / "out" / "report.html").read_text()
