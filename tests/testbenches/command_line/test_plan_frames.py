"""``plan`` and ``export`` for several pictures: the one machine that ``render --frames`` draws."""

import json
import shlex
from pathlib import Path

import pytest
from command_bench.plan import facts, machine_of, run
from refusals import refusal

from cardcage.golden.planning.scene_needs import fitted
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.tables.plan_table import plan_text
from cardcage.testbenches.command_line.tables.scene_plan import plan_scene
from cardcage.testbenches.machine_options import MachineOptions, machine_for_scene
from cardcage.testbenches.render_frames import FramesOptions, prepare_frames
from cardcage.testbenches.views.asked_views import AskedViews

SCENE = "tetra:depth=2"
TINY = ["--cards", "PM", "--size", "16x16"]
SMALL = {"cards": "PM", "size": (16, 16)}
#: Small, then large: what one triangle needs grows.
PATH = "azimuth,elevation,zoom\n25,30,0.25\n25,30,1\n10,20,3\n"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("views.csv").write_text(PATH)
    make_display_list("tetra:depth=0", width=16, height=16).display_list.save("list.npz")
    return tmp_path


@pytest.mark.parametrize(("words", "asked"), [
    (["--frames", "4", "--turn", "60"], {"frames": 4, "turn": 60.0}),
    (["--frames", "2", "--cards", "2x(PMC)", "--retain"],
     {"frames": 2, "cards": "2x(PMC)", "retain": True}),
    (["--path", "views.csv"], {"path": Path("views.csv")}),
])
def test_it_is_the_machine_that_render_draws_and_export_writes(words, asked):
    planned = facts(SCENE, *TINY, *words)
    rendered = prepare_frames(SCENE, FramesOptions(**SMALL | asked)).configuration
    assert machine_of(planned) == rendered
    # The words that it gives are complete.
    given = shlex.split(planned["command"])
    assert given[:3] == ["cardcage", "render", SCENE] and facts(*given[2:]) == planned
    result = run(*given[2:], "--component", "id_increment", command="export")
    assert result.exit_code == 0, result.output
    exported = json.loads(Path("machine.json").read_text())
    for field in ("cards", "fraction_bits", "coordinate_bits", "edge_height_bits", "fifo_depth",
                  "edge_fraction_bits", "depth_integer_bits", "shading", "words", "list_words"):
        assert exported["configuration"][field] == getattr(rendered, field), field
    count = planned["pictures"]["count"]
    assert exported["precision"].endswith(f", exact for each of {count} pictures of {SCENE}")
    header = " ".join(line.strip("/ ") for line in Path("machine.v").read_text().split("\n")[:4])
    assert " ".join(words[:2]) in header


def test_the_first_picture_alone_needs_less():
    """Its machine takes no other picture, and has too few fraction bits for the last one; that of
    all of them draws each exactly."""
    options = MachineOptions(**SMALL)
    lists = AskedViews(path=Path("views.csv")).lists(SCENE, options)
    machine = plan_scene(SCENE, options, asked=AskedViews(path=Path("views.csv"))
                         ).plan.configuration
    _, first = machine_for_scene(SCENE, MachineOptions(**SMALL, view=(25.0, 30.0), zoom=0.25))
    assert first.fraction_bits < machine.fraction_bits
    for number, one in enumerate(lists):
        right = exact.draw(one)
        own, firsts = (bit_true.draw(fitted(machine, one), fraction_bits=bits).depth
                       for bits in (machine.fraction_bits, first.fraction_bits))
        assert (own == right.depth).all()
        assert (firsts != right.depth).any() == (number == 2)
        if number:
            with pytest.raises(InputError, match="the machine is built for"):
                fitted(first, one)


def test_what_is_said_of_which_picture():
    pictures = facts(SCENE, *TINY, "--path", "views.csv")["pictures"]
    alone = [facts(SCENE, *TINY, "--view", view, "--zoom", zoom)
             for view, zoom in (("25,30", "0.25"), ("25,30", "1"), ("10,20", "3"))]
    cycles = [each["cycles"]["estimated"] for each in alone]
    slowest = cycles.index(max(cycles))
    counts = [each["needs"]["triangles"] for each in alone]
    assert max(counts) > counts[slowest]  # of what is so near, less is on the screen
    assert pictures == {"count": 3, "exact": True, "cycles": cycles, "slowest": slowest,
                        "slowest_triangles": counts[slowest]}
    assert slowest > 0 and all("pictures" not in each for each in alone)
    text = run(SCENE, *TINY, "--path", "views.csv").stdout
    assert text.startswith(f"{SCENE}: 3 pictures of up to {max(counts)} triangles at 16x16, one "
                           "machine that is exact for each; full is a machine for every")
    assert (f"the slowest picture, {slowest} of 0 to 2, of {counts[slowest]} triangles, takes "
            f"about {cycles[slowest]:,} cycles") in text
    assert f"of a picture's up to {max(counts)} triangles may cover a pixel" in text
    assert text.endswith("--path views.csv\n")


def test_one_that_is_not_exact_does_not_say_so():
    planned = plan_scene(SCENE, MachineOptions(**SMALL, max_error=2), asked=AskedViews(2, 60.0))
    text = plan_text(planned)
    assert not planned.exact and "one machine for each; full" in text
    assert "at most 2 LSB asked for" in text


def test_cards_that_are_fast_enough_for_every_picture():
    """The first is small and would be content with the least cage."""
    asked = AskedViews(path=Path("views.csv"))
    slow = plan_scene(SCENE, MachineOptions(size=(32, 32)), 10**6, asked=asked)
    assert slow.plan.configuration.processing_elements == 1
    budget = (slow.pictures.cycles[0] + max(slow.pictures.cycles)) // 2
    fast = plan_scene(SCENE, MachineOptions(size=(32, 32)), budget, asked=asked)
    assert max(fast.pictures.cycles) <= budget
    assert (plan_scene(SCENE, MachineOptions(size=(32, 32), view=(25.0, 30.0), zoom=0.25), budget)
            .plan.configuration.cards != fast.plan.configuration.cards)


@pytest.mark.parametrize(("arguments", "words"), [
    ([SCENE, "--turn", "4"], "--turn: is for several pictures; give --frames as well"),
    ([SCENE, "--frames", "0"], "--frames"),
    ([SCENE, "--path", "views.csv", "--frames", "2"], "--frames: 2, but views.csv has 3 views"),
    ([SCENE, "--path", "views.csv", "--zoom", "2"], "leave out --turn, --view and --zoom"),
    (["list.npz", "--frames", "2", "--turn", "4"], "list.npz is no mesh and cannot be turned"),
    (["list.npz", "--path", "views.csv"], "view: a display list is already projected and lit"),
])
def test_refused_with_the_sentence_of_render(arguments, words):
    refused = {refusal(lambda *given, to=command: run(*given, command=to), *arguments)
               for command in ("plan", "export", "render")}
    assert len(refused) == 1 and words in refused.pop()


@pytest.mark.parametrize("words", [["--frames", "3"], ["--turn", "3"], ["--path", "views.csv"]])
def test_an_export_without_a_scene_has_nothing_to_look_at(words):
    assert (f"{words[0]}: without a scene there is nothing to look at; give a scene"
            in refusal(lambda *given: run(*given, command="export"), *words))
