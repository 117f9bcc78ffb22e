"""The benchmarks print what they should; their figures are not judged here."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from suite.cases import EVERY

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.support.cache import ENVIRONMENT_VARIABLE
from testbenches.studies import (
    equal_work,
    golden_benchmark,
    merge_traffic,
    model_building,
    word_fuzz,
)

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("name", ["bound_search", "equal_work", "golden_benchmark",
                                  "interpolator_benchmark",
                                  "merge_traffic", "model_building", "mutation_campaign",
                                  "node_mutants", "node_speed", "word_fuzz"])
def test_a_study_runs_from_a_clone(name):
    done = subprocess.run([sys.executable, "-m", f"testbenches.studies.{name}", "--help"],
                          cwd=ROOT, capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stderr
    assert f"python -m testbenches.studies.{name}" in done.stdout


def test_runs_of_equal_work_that_are_sent():
    """Shares dealt out by hand are those of packets; a list that begins with most of the work is
    drawn sooner than by contiguous shares."""
    display_list = make_display_list("sphereflake:depth=1,tessellation=1", width=64, height=64,
                                     shading="flat").display_list
    machine = equal_work.planned(display_list, "contiguous")
    shares = organisation_of(machine).shares(display_list)
    by_hand = equal_work.dealt(shares.node, shares.host_order)
    assert (by_hand.host_place == shares.host_place).all()
    assert all((by_hand.of_node(node) == shares.of_node(node)).all() for node in range(16))
    found = equal_work.draw_clocks(display_list)
    assert found["contiguous"] == round(predict_cycles(machine, display_list).cycles)
    assert found["equal work, sent by work"] < found["contiguous"]


def test_what_nodes_send():
    """Of two nodes one sends what it has drawn, or each of them half of it."""
    done = CliRunner().invoke(merge_traffic.main, ["--case", "random_bbox16", "--nodes", "2"])
    assert done.exit_code == 0, done.output
    rows = [line.split() for line in done.output.splitlines()[2:]]
    (tree, *sent), (binary, swap, *halves) = rows
    assert (tree, binary, swap) == ("tree", "binary", "swap")
    longest, busiest, in_all, only = (int(pixels.replace(",", "")) for pixels in sent)
    assert longest == busiest == in_all == only > 0
    # Both send the half that they give away.
    assert 0 < int(halves[0].replace(",", "")) < longest


def test_golden_benchmark():
    done = CliRunner().invoke(golden_benchmark.main, ["--triangles", "500", "--runs", "2"])
    assert done.exit_code == 0, done.output
    assert re.search(r"500 triangles, [\d,]+ fragments, 512x512", done.output)
    assert re.search(r"exact +best +[\d.]+ ms, median +[\d.]+ ms", done.output)


@EVERY
def test_model_building(monkeypatch):
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    monkeypatch.setenv(ENVIRONMENT_VARIABLE, "")  # set back at the end
    done = CliRunner().invoke(model_building.main, ["--machine", "PM", "--size", "8",
                                                    "--cycles", "1000"])
    assert done.exit_code == 0, done.output
    [with_runtime] = re.findall(r"^the runtime, once, and +([\d.]+) s", done.output, re.MULTILINE)
    [alone] = re.findall(r"^PM +([\d.]+) s +[\d.]+ s +1.0 +[\d.]+$", done.output, re.MULTILINE)
    assert float(alone) < float(with_runtime)


def test_word_fuzz(monkeypatch):
    def fuzz(seed):
        return CliRunner().invoke(word_fuzz.main, ["--minutes", "0.0001", "--machine", "PM",
                                                   "--seed", str(seed)])
    done = fuzz(7)
    assert done.exit_code == 0, done.output
    assert re.search(r"seeds 7 to 7 on 1 machines: 1 trials, [\d,]+ words, [\d,]+ clocks; every "
                     r"good frame exact; go on with --seed 8\n$", done.output)
    monkeypatch.setattr(word_fuzz, "make_trial", lambda *_, **__: _no_end())
    done = fuzz(9)
    assert done.exit_code == 1 and done.stderr == "seed 9, machine PM: no end\n"


def _no_end():
    raise TimeoutError("no end")


def test_the_engines_command():
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    done = CliRunner().invoke(main, [
        "engines", "--preset", "tiny", "--scene", "random:n=9", "--runs", "1",
        "--pysim-cycles", "512"])
    assert done.exit_code == 0, done.output
    assert re.search(r"bare loop +[\d,]+ cycles a second; ratio [\d.]+", done.output)
    assert re.search(r"verilator is [\d,]+ times as fast", done.output)
