"""Regions of the screen on the command line: what is asked, what is refused, what the help says."""

import json

import pytest
from click.testing import CliRunner
from refusals import refusal
from suite.cases import EVERY

from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.machine_options import MachineOptions, machine_without_scene, option_words

SCENE = "random:n=12,size=8,seed=5"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def refuses(*arguments):
    return refusal(run, *arguments)


@pytest.mark.parametrize(("words", "said"), [
    (["--cards", "3x(PM)"], "cards: 3 memory units are not supported yet"),
    (["--regions", "8"], "'8' is not a number of columns and of rows of regions such as 8x8"),
    (["--regions", "0x4"], "regions: columns: 0 is not a whole number from 1"),
    (["--regions", "7x4"], "no power-of-two size gives 7 columns of 64 pixels; take 4 or 8"),
    (["--regions", "64x64"], "4096 regions, at most 1024"),
    (["--regions", "8x8", "--slots", 3], "slots: 3 in each of 2 processing elements do not hold"),
    (["--regions", "8x8", "--cards", "2x(PMMM)"], "cards: where regions are dealt out"),
    (["--regions", "8x8", "--cards", "2x(PMC)"], "regions: PMCPMC has nodes"),
    (["--regions", "8x8", "--words", 99], "words: is settled by the regions"),
    (["--regions", "8x8", "--block", 2], "block: is settled by the regions"),
    (["--regions", "8x8", "--balance", "runs", "--balancer", "hardware"],
     "balancer: the hardware packs by what is counted"),
    (["--regions", "8x8", "--balance", "static", "--balancer", "hardware"],
     "balancer: the hardware packs by what is counted"),
    (["--slots", 3], "--slots: is for regions that are dealt out; give --regions"),
    (["--balance", "clocks"], "--balance: is for regions that are dealt out"),
    (["--balancer", "host"], "--balancer: is for regions that are dealt out"),
    (["--balance", "even"], "'even' is not one of 'static', 'runs', 'triangles', 'clocks', "
     "'learnt'"),
    (["--regions", "8x8", "--balance", "learnt", "--balancer", "hardware"],
     "--balance: learnt is for a host; the hardware packs the last picture's counts"),
])
def test_what_is_refused(words, said):
    assert said in refuses("plan", SCENE, *words)
    if "--regions" not in words and "--cards" not in words:
        return
    assert said in refuses("render", SCENE, *words)


def test_any_number_of_elements_is_a_way_out():
    assert refuses("plan", SCENE, "--cards", "3x(PM)").strip().endswith(
        "or deal regions of the screen out to any number of processing elements, as with "
        "--regions 8x8")


def test_cages_that_are_no_cages():
    said = refuses("compare", SCENE, "--cards", "2x(PM)/7x7", "--size", "16x16")
    assert "2x(PM)/7x7: regions: no power-of-two size gives 7 columns of 16" in said
    assert "cards" in refuses("compare", SCENE, "--cards", "2x(PM)/8", "--size", "16x16")


@pytest.mark.parametrize("command", ["render", "plan", "export", "precision"])
def test_the_help_teaches_by_example(command):
    words = " ".join(run(command, "--help").stdout.split())
    for part in ("--regions COLUMNSxROWS", "Blazek's decompositions", "'4x(PMM)' --regions 1x4 his "
                 "strips", "2x2 his grid", "Ellsworth's", "--slots", "--balance",
                 "[static|runs|triangles|clocks|learnt]", "--balancer", "[host|hardware]"):
        assert part in words, part


def test_the_help_of_commands_with_several_machines():
    compared = " ".join(run("compare", "--help").stdout.split())
    assert "4x(PMM)/8x8" in compared and "--balance" in compared
    assert " --regions " not in compared
    bench = " ".join(run("bench", "--help").stdout.split())
    assert "--regions none,8x16" in bench and "--balance WHAT" in bench


def test_the_options_in_words():
    options = MachineOptions(regions=(8, 4), slots=20, balance="triangles", balancer="hardware")
    assert option_words(options) == ["--regions", "8x4", "--slots", "20", "--balance", "triangles",
                                     "--balancer", "hardware"]


@pytest.mark.parametrize(("balance", "balancer", "counted", "policy"), [
    (None, None, "clocks", "learnt"), ("learnt", "host", "clocks", "learnt"),
    ("clocks", None, "clocks", "clocks"), ("triangles", None, "triangles", "triangles"),
    (None, "hardware", "clocks", "clocks"), ("static", "host", "static", "static"),
    ("runs", None, "static", "runs")])
def test_what_is_counted_and_what_tables_are_made_of(balance, balancer, counted, policy):
    options = MachineOptions(regions=(8, 8), balance=balance, balancer=balancer)
    configuration = machine_without_scene(options)
    assert configuration.balance == counted and options.policy(configuration) == policy


def test_pictures_of_a_machine():
    result = run("render", SCENE, "--size", "8x8", "--cards", "3x(PM)", "--regions", "4x2",
                 "--frames", 2, "--balancer", "hardware", "--engine", "pysim")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("equal: 2 pictures, 128 colours and 64 depths compared")
    assert "  regions     4x2 of 2x4 pixels, balanced by clocks, by the hardware; utilisation " in (
        result.stdout)
    assert result.stderr == ""


@pytest.mark.parametrize(("words", "said"), [
    ([], "balanced by learnt clocks, by the host"),
    (["--balance", "runs"], "4x2 of 2x4 pixels, a run for each; utilisation"),
    (["--balance", "clocks"], "balanced by clocks, by the host")], ids=str)
def test_the_tables_of_a_sequence(tmp_path, words, said):
    result = run("render", "tetra:depth=1", "--size", "8x8", "--cards", "3x(PM)", "--regions",
                 "4x2", "--frames", 2, "--engine", "pysim", *words)
    assert result.exit_code == 0, result.output
    assert said in result.stdout
    folder = tmp_path / "cardcage-out"
    [report] = folder.rglob("report.json")
    assert json.loads(report.read_text())["regions"]["balance"] == (
        words[-1] if words else "learnt")


@EVERY
def test_cages_side_by_side():
    """What is asked of all is asked of those that can be."""
    result = run("compare", SCENE, "--size", "8x8", "--cards", "PM", "--cards", "3x(PM)/4x2",
                 "--cards", "2x(PMC)", "--immediate", "--packet", "contiguous", "--balance",
                 "triangles", "--engine", "pysim", "--json")
    assert result.exit_code == 0, result.output
    facts = json.loads(result.stdout)
    assert facts["identical"] and facts["pictures"] == [["PM", "3x(PM)/4x2", "2x(PMC)"]]
    alone, dealt, chained = facts["cages"]
    assert alone["regions"] is None and dealt["regions"]["equal"]
    assert dealt["machine"]["balance"] == "triangles"
    assert chained["machine"]["packet"] == "contiguous"
    assert dealt["machine"]["regions"] == [4, 2] and dealt["cycles"]["draw"] > 0


def test_a_plan():
    result = run("plan", SCENE, "--size", "32x32", "--cards", "3x(PMM)", "--regions", "4x4",
                 "--json")
    assert result.exit_code == 0, result.output
    facts = json.loads(result.stdout)
    lines = {line["item"]: line for line in facts["lines"]}
    assert lines["regions"]["value"] == "4x4" and "8x8 pixels" in lines["regions"]["reason"]
    assert lines["slots"]["value"] == "7" and "even share is 6" in lines["slots"]["reason"]
    assert lines["words a memory unit"]["value"] == f"{7 * 32}"
    assert facts["command"].endswith("--cards '3x(PMM)' --size 32x32 --regions 4x4")
    assert facts["machine"]["regions"] == [4, 4] and facts["cycles"]["estimated"] > 0


@pytest.mark.parametrize(("words", "said"), [
    (["compare", SCENE, "--cards", "2x(PM)", "--slots", 2],
     "--slots: is for cages whose regions are dealt out; name one, as in 4x(PMM)/8x8"),
    (["compare", SCENE, "--cards", "2x(PM)", "--balance", "static"], "--balance: is for cages"),
    (["bench", "one_pixel", "--engine", "model", "--balance", "static"],
     "--balance: is for regions that are dealt out; give --regions as well"),
], ids=str)
def test_what_no_cage_or_machine_was_asked_for(words, said):
    assert said in refuses(*words)
