"""The exported Verilog, read back by another program, is the Amaranth design.

Gold is the RTLIL that Amaranth itself emits, memories included; gate is our Verilog text, read by
yosys' Verilog parser.  Registers, outputs and every internal signal of the same name are shown
equal, for every input and from every state in which the registers agree; start values are compared
beside that, because induction does not look at them.
"""

import re
from dataclasses import replace

import pytest
from amaranth.back import rtlil
from suite.cases import EVERY, chosen
from verilog_tools import yosys

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.components import COMPONENTS
from cardcage.testbenches.export.verilog import component_verilog

SMALL = MachineConfiguration(cards="2x(PMM)", width=8, height=8, sub_bits=2, depth_bits=4,
                             fraction_bits=3, fifo_depth=4, words=2)

#: The same for parts that keep meshes, of which there are few.
KEEPS_MESHES = ("mesh_memory", "object_reader")
SMALL_MESHES = replace(SMALL, cards="2x(PMMC)", maximum_units=0, maximum_nodes=0, shading="flat",
                       setup="hardware", objects="nodes", mesh_triangles=2, meshes=2)

#: Without those that are put together of others here and take minutes, and without the queue, whose
#: registers the two name differently.
PROVED = [name for name in COMPONENTS if name not in (
    "processing_element", "direct_merge", "direct_element", "crossbar", "frame_unit",
    "one_port_depth_test", "balancer", "merge_sorter", "large_visits", "region_visits",
    "region_spans", "forwarding_element", "element_gate", "object_forwarder",
    "object_setup",
    "edge_setup", "plane_setup", "triangle_outline", "triangle_setup", "result_queue")]

#: Of these, what takes the time of ten others and more.
LONG = {"picture_maps", "broadcast_queue", "object_reader", "drawn_map", "region_order",
        "object_reach"}

FLAT = """
setattr -mod -unset top {top}
hierarchy -top {top}
proc
flatten
memory_map
opt_expr
opt_clean
write_rtlil {top}.flat
"""

PROVE = """
read_rtlil gold.flat
read_rtlil gate.flat
async2sync
equiv_make gold gate equiv
hierarchy -top equiv
opt_clean
equiv_simple -undef
equiv_induct -undef
equiv_status -assert
"""


def proof(folder, component, verilog):
    """yosys' verdict on ``verilog``, a module ``gate``: exit status and output."""
    (folder / "gold.il").write_text(rtlil.convert(component, name="gold", emit_src=False))
    (folder / "gate.v").write_text(verilog)
    status, output = yosys(folder, f"read_rtlil gold.il{FLAT.format(top='gold')}design -reset\n"
                                   f"read_verilog gate.v{FLAT.format(top='gate')}")
    assert status == 0, output
    flat = (folder / "gate.flat").read_text()
    # Names that the export changed: memories are modules, and no name begins with a dollar sign.
    flat = flat.replace(".ram.words[", "[")
    flat = re.sub(r"\\(\S*[.])?_(?=\$)", lambda found: f"\\{found[1] or ''}", flat)
    (folder / "gate.flat").write_text(flat)
    return yosys(folder, PROVE)


def start_values(folder, design):
    """Start value of each register that has one; words of memories have none in the Verilog."""
    text = (folder / f"{design}.flat").read_text()
    return {name: value for value, name in re.findall(
        r"^  attribute \\init (\S+)\n(?:  attribute .*\n)*  wire .*?(\S+)$", text, re.MULTILINE)
        if name.startswith("\\") and not name.endswith("]")}


def check_start_values(folder):
    """The same for every register that both have by name; few are merged or renamed."""
    gate, gold = (start_values(folder, design) for design in ("gate", "gold"))
    shared = gate.keys() & gold.keys()
    assert len(shared) >= 0.6 * max(len(gate), len(gold))
    assert all(gate[name] == gold[name] for name in shared)


@pytest.mark.parametrize("name", chosen(
    PROVED, *[name for name in PROVED if name not in LONG][::2]))
def test_equivalent(tmp_path, name):
    configuration = SMALL_MESHES if name in KEEPS_MESHES else SMALL
    status, output = proof(tmp_path, COMPONENTS[name](configuration),
                           component_verilog(COMPONENTS[name](configuration), "gate"))
    assert status == 0, output
    check_start_values(tmp_path)


@pytest.mark.parametrize(("name", "right", "wrong"), [
    ("id_increment", r"left \+ 3'h1", "left + 3'h3"),
    pytest.param("one_port_lane", r" < ", " <= ", marks=EVERY),
    ("two_port_depth_test", r" < ", " <= "),
    ("interpolator", r"depth_start_3 \+ ", "depth_start_3 - "),
    pytest.param("edge_columns", r"long_start_1 \+ ", "long_start_1 - ", marks=EVERY),
    pytest.param("survey", r"<= (_\d+_);", r"<= ~\1;", marks=EVERY),
    ("response_link", r"left__payload <=", "left__payload <= ~"),
    ("video_scan_generator", r"assign (\S+) = (\S+) \? (\S+) : (\S+);",
     r"assign \1 = \2 ? \4 : \3;"),
])
def test_a_mutation_fails(tmp_path, name, right, wrong):
    """One operator, one constant, one branch: the proof is not of nothing."""
    text, count = re.subn(right, wrong, component_verilog(COMPONENTS[name](SMALL), "gate"),
                          count=1)
    assert count == 1
    status, output = proof(tmp_path, COMPONENTS[name](SMALL), text)
    assert status != 0 and "unproven" in output


def test_a_wrong_start_value_is_seen(tmp_path):
    text = component_verilog(COMPONENTS["central_broadcast_controller"](SMALL), "gate")
    text, count = re.subn(r"initial settle = 2'h0", "initial settle = 2'h1", text)
    assert count == 1
    proof(tmp_path, COMPONENTS["central_broadcast_controller"](SMALL), text)
    assert start_values(tmp_path, "gate") != start_values(tmp_path, "gold")
