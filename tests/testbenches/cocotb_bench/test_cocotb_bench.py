"""The take-home bench: one frame on every simulator there is, and it fails when it should."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from suite.cases import EVERY, chosen

from cardcage.golden.organisations.machine_facts import machine_facts
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.cocotb_bench import simulators
from cardcage.testbenches.cocotb_bench.engine import CocotbEngine
from cardcage.testbenches.cocotb_bench.exchange import configuration_of, read_configuration
from cardcage.testbenches.cocotb_bench.simulators import SIMULATORS, find_simulator
from cardcage.testbenches.cocotb_bench.violation import ProtocolError
from cardcage.testbenches.command_line.check_verilog_command import check_verilog_command
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError
from cardcage.testbenches.export.machine_json import describe
from cardcage.testbenches.export.verilog import machine_verilog
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.frame_job import frame_commands, frame_job
from cardcage.testbenches.frames.simulation import simulate

DOCUMENT = Path(__file__).parents[3] / "docs" / "simulate-the-verilog.md"
LISTED = make_display_list("random:n=10,size=8,seed=5", width=8, height=8).display_list
MACHINE = plan(LISTED, cards="PMMPMM", clocks_per_pixel=2).configuration
SPOILT_ADDRESS = 5


def found(name):
    """The simulator's engine, or a skip that names it and how to get it."""
    try:
        find_simulator(name)
    except ToolMissingError as missing:
        pytest.skip(f"{name}: {missing}")
    return CocotbEngine(name)


def some_simulator():
    """One that needs no compiling where there is one."""
    for name in reversed(SIMULATORS):
        try:
            find_simulator(name)
        except ToolMissingError:
            continue
        return name
    return pytest.skip("neither Icarus Verilog nor Verilator is here")


def spoilt():
    """The machine with the lowest bit of red, above the tag, wrong at one address of every memory
    unit."""
    text, count = re.subn(
        r"(words\[write_address\]\[(?:55:28|83:56)\] <= write_data\[\d+:\d+\])",
        rf"\1 ^ ((write_address == {SPOILT_ADDRESS}) << {MACHINE.tag_bits})",
        machine_verilog(MACHINE))
    assert count == 2, "front and back colours"
    return text


@pytest.mark.parametrize("name", chosen(SIMULATORS, "verilator"))
def test_every_simulator_agrees_with_golden_and_pysim(name):
    engine = found(name)
    comparison = compare(MACHINE, LISTED, simulate(MACHINE, LISTED, engine, memory_seed=7))
    assert comparison.equal
    assert comparison.pixels_compared == comparison.depths_compared == 64
    # Two frames, the depths of the second: in between each scan is whole, the one or the other.
    second = frame_job(MACHINE, LISTED)
    job = replace(second, commands=[*frame_commands(MACHINE, LISTED), *second.commands],
                  responses=second.responses + 2, stall_seed=1, memory_seed=7)
    here, pysim = engine.run(job), PysimEngine().run(job)
    # The same pauses, so the same clocks: not only every value, also when it came.
    assert here.responses == pysim.responses
    assert here.cycles == pysim.cycles
    assert [scan.cycle for scan in here.scans] == [scan.cycle for scan in pysim.scans]
    np.testing.assert_array_equal(here.scans[-1].picture, pysim.scans[-1].picture)
    with pytest.raises(TimeoutError, match="no end after 101 cycles: "):
        engine.run(replace(job, maximum_cycles=100))


@EVERY
def test_a_spoilt_netlist_is_told_by_its_first_wrong_pixel(tmp_path):
    name = some_simulator()
    verilog, listed = tmp_path / "machine.v", tmp_path / "list.npz"
    verilog.write_text(spoilt())
    verilog.with_suffix(".json").write_text(json.dumps(describe(MACHINE, spoilt())))
    LISTED.save(listed)
    done = subprocess.run(
        [Path(sys.executable).parent / "cardcage", "check-verilog", verilog, listed,
         "--simulator", name], capture_output=True, text=True, timeout=300)
    pixels = [MACHINE.interlace.pixel(unit, SPOILT_ADDRESS) for unit in range(4)]
    assert done.returncode == 1, done.stderr
    assert done.stdout.startswith("DIFFERENT: 4 of 64 colours, 0 of 64 depths")
    assert f"first wrong pixel {min(pixels, key=lambda pixel: pixel[::-1])}:" in done.stdout
    assert f"cocotb on {name}" in done.stdout


@EVERY
def test_a_machine_that_takes_an_offer_back_is_caught():
    wrapper = """
module machine(input clk, rst, commands__valid, responses__ready,
    input [{top}:0] commands__payload, output commands__ready, responses__valid,
    output [39:0] responses__payload, output pins__pixel, pins__active, pins__horizontal_sync,
    pins__vertical_sync, output [7:0] pins__red, pins__green, pins__blue);
  reg blink = 0;
  wire valid;
  always @(posedge clk) blink <= ~blink;
  assign responses__valid = valid & blink;
  honest hidden(.*, .responses__valid(valid), .responses__ready(responses__ready & blink));
endmodule
"""
    honest = machine_verilog(MACHINE)
    width = int(re.search(r"input \[(\d+):0\] commands__payload", honest)[1])
    verilog = re.sub(r"\bmodule machine\(", "module honest(", honest) + wrapper.format(top=width)
    engine = CocotbEngine(some_simulator(), verilog=verilog)
    # Nobody is ever kept waiting: nothing to take back.
    engine.run(frame_job(MACHINE, LISTED))
    with pytest.raises(ProtocolError, match=r"cycle \d+: responses: valid fell before 0x"):
        engine.run(frame_job(MACHINE, LISTED, stall_seed=1))
    with pytest.raises(ProtocolError, match="they are of different machines"):
        engine.run(frame_job(plan(LISTED, cards="PMMPMM", fraction_bits=3).configuration, LISTED))


def test_verilog_that_does_not_build_is_one_sentence():
    name = some_simulator()
    with pytest.raises(ToolMissingError, match=f"^{name} cannot build the Verilog: .*machine.v:2"):
        CocotbEngine(name, verilog="module machine(input clk);\nwire = ;\nendmodule\n").run(
            frame_job(MACHINE, LISTED))


def test_verilog_of_something_else_is_one_sentence():
    engine = CocotbEngine(some_simulator(), verilog="module machine(input clk); endmodule\n")
    with pytest.raises(ProtocolError, match="no port rst: it is no machine"):
        engine.run(frame_job(MACHINE, LISTED))


def test_what_is_missing_is_named(tmp_path, monkeypatch):
    (tmp_path / "g++").touch(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CXX", raising=False)
    with pytest.raises(ToolMissingError, match="iverilog is not on PATH; install"):
        find_simulator("icarus")
    with pytest.raises(ToolMissingError, match="by make, which is not on PATH"):
        find_simulator("verilator")
    monkeypatch.setattr(simulators.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ToolMissingError, match=r"pip install 'cardcage\[cocotb\]'"):
        find_simulator("icarus")


def test_a_configuration_survives_its_description(tmp_path):
    described = tmp_path / "machine.json"
    described.write_text(json.dumps({"configuration": machine_facts(MACHINE), "top": ""}))
    assert read_configuration(described) == MACHINE
    short = {"cards": "PM", "width": 8, "height": 8}
    assert configuration_of(short).words == 64


@pytest.mark.parametrize(("text", "message"), [
    (None, "no such file"),
    ("{", "not a readable JSON file"),
    ("[]", "configuration: missing"),
    ('{"configuration": {"cards": "PM", "width": 8}}', "height: missing"),
    ('{"configuration": {"cards": "PM", "width": 0, "height": 8}}', "width: 0"),
    ('{"configuration": {"cards": "PM", "width": 8, "height": 8, "timing": {}}}', "timing: "),
    ('{"configuration": {"cards": "PM", "width": 8, "height": 8, "edge_remainder_bits": 9}}',
     "edge_remainder_bits: unknown to this version of Cardcage; export the machine again"),
])
def test_a_wrong_description_is_one_line(tmp_path, text, message):
    described = tmp_path / "machine.json"
    if text is not None:
        described.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_configuration(described)
    assert str(described) in str(caught.value)


def test_a_list_for_another_machine_is_refused(tmp_path):
    described = tmp_path / "machine.json"
    described.write_text(json.dumps({"configuration": {"cards": "PM", "width": 16, "height": 8}}))
    listed = tmp_path / "list.npz"
    LISTED.save(listed)
    done = CliRunner().invoke(main, ["check-verilog", str(tmp_path / "machine.v"), str(listed)])
    assert done.exit_code == 2
    assert done.output == ("cardcage: error: display list: width 8, the machine is built for 16: "
                           "export a machine for this list\n")


def test_the_document_names_real_options():
    text = DOCUMENT.read_text(encoding="utf-8")
    options = set(re.findall(r"(?<![\w-])--[a-z-]+", text.partition("## Options")[2]))
    assert options == {option for parameter in check_verilog_command.params
                       for option in parameter.opts if option.startswith("--")}
