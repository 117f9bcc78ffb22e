"""Elements that pass objects on, on the command line: asked, planned, drawn, reported, refused."""

import json
from dataclasses import replace

import pytest
from click.testing import CliRunner
from refusals import refusal
from suite.cases import EVERY

from cardcage.golden.objects.object_words import frame_words
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.planning.object_needs import ObjectNeeds, fields_of_objects
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.command_line.tables.render_summary import render_summary
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.frames.object_figures import object_figures
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.render import render

SCENE = ("obj cube scale 0.5 rot 20,30,0 num 5 seed 2 color random\n"
         "obj cone scale 3 position 2,1,0 recursion 0\n")
ELEMENTS = ["--objects", "elements", "--cards", "3x(PM)"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """A folder to work in, with a scene."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "some.scene").write_text(SCENE)


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.mark.parametrize(("words", "said"), [
    (["teapot", *ELEMENTS, "--regions", "4x4"], "objects: only a scene file without perspective"),
    (["some.scene", *ELEMENTS[:2]], "; give regions as well, or make triangles at the controller"),
    (["some.scene", *ELEMENTS, "--regions", "4x4", "--balance", "clocks"],
     "--balance: elements that pass objects on have a run of regions each, not clocks; take runs"),
    (["some.scene", *ELEMENTS, "--regions", "4x4", "--balancer", "hardware"],
     "balancer: the hardware packs by what is counted, and static counts nothing"),
    (["some.scene", "--cards", "2x(PM)", "--regions", "4x4", "--packet", 2],
     "--packet: 2x(PM) has no merge card"),
])
def test_what_is_refused(words, said):
    assert said in refusal(run, "plan", *words)


def test_what_is_planned():
    found = json.loads(run("plan", "some.scene", *ELEMENTS, "--regions", "1x8", "--packet", 2,
                           "--json").stdout)
    machine = found["machine"]
    assert (machine["objects"], machine["balance"], machine["packet"]) == ("elements", "static", 2)
    [line] = [line for line in found["lines"] if line["item"] == "order bits"]
    assert line["value"] == "3" and "keeps the number of its own" in line["reason"]
    assert found["command"].endswith("--packet 2 --regions 1x8 --objects elements")
    with pytest.raises(InputError, match=r"^objects: .* take 65,535 at most, the scene has 65"):
        fields_of_objects(ObjectNeeds(65_537, 1, 1, 1), {"objects": "elements"})
    listed = make_display_list("some.scene", width=16, height=16).display_list
    narrow = plan(listed, cards="2x(PM)", regions=(4, 4), balance="static", objects="elements",
                  setup="hardware", order_bits=2).configuration
    with pytest.raises(InputError, match=r"^objects: .* tell 4 apart, the scene has 6: export"):
        frame_words(narrow, listed)


@EVERY
def test_what_is_drawn_and_reported(tmp_path):
    rendering = render("some.scene", out=tmp_path / "out", cards="2x(PM)", size=(8, 6),
                       packet=2, objects="elements", regions=(1, 6), setup="small", shading="flat")
    assert rendering.comparison.equal and not rendering.warnings
    found = json.loads((tmp_path / "out" / "report.json").read_text())
    objects = found["objects"]
    assert objects["equal"] and objects["read"] and objects["clipped"] == 1
    assert found["regions"]["balance"] == "runs"
    assert found["regions"]["table"] == [0, 0, 0, 1, 1, 1]
    passed = [place["forwarded"] for place in objects["per_place"]]
    assert passed == [place["golden_forwarded"] for place in objects["per_place"]]
    assert sum(map(sum, passed)) > 2
    assert "objects passed left" in (tmp_path / "out" / "report.html").read_text()
    summary = render_summary(rendering)
    assert "a run for each" in summary
    assert f"made in 2 elements, {sum(map(sum, passed))} times passed on, 1 object " in summary
    # Counts that are not golden's are told.
    wrong = replace(rendering.simulation, forwarded=[(0, 9), *map(tuple, passed[1:])])
    [line] = object_figures(rendering.configuration, rendering.scene.display_list,
                            wrong).differences
    assert line == (f"processing element 0 passed 0 objects left and 9 right, golden 0 and "
                    f"{passed[0][1]}")


def test_cages_that_pass_objects_on_are_asked_for_packets():
    asked = MachineOptions(objects="elements", packet=3)
    assert Cage.named("2x(PM)/4x4").options(asked).packet == 3
    assert Cage.named("2x(PM)").options(asked).packet is None
