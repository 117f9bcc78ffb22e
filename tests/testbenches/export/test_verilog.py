"""The Verilog that leaves: what other people's tools say of it, and what is in it."""

import re

import pytest
from suite.cases import chosen
from verilog_tools import icarus, verilator_lint, yosys

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.backplane.connectors import memory_bus_bits
from cardcage.hdl.backplane.words import planes_layout, span_layout, walked_outline_layout
from cardcage.hdl.components import COMPONENTS
from cardcage.hdl.machine import BOARDS
from cardcage.hdl.rasteriser.interpolator import fragment_layout
from cardcage.testbenches.export.export_files import COMPONENT_NAMES, WAIVERS
from cardcage.testbenches.export.machine_json import component_for, describe
from cardcage.testbenches.export.port_meanings import described_ports
from cardcage.testbenches.export.verilog import component_ports, component_verilog, machine_verilog

MACHINES = [(name, shading) for name in ("tiny", "small", "paper")
            for shading in ("flat", "gouraud")]


@pytest.fixture(scope="module")
def texts():
    """Machines by preset and shading, each translated once."""
    made = {}

    def text(name, shading):
        if (name, shading) not in made:
            configuration = MachineConfiguration(**PRESETS[name], shading=shading)
            made[name, shading] = machine_verilog(configuration)
        return made[name, shading]

    return text


def declared_ports(text, module):
    """Name → (direction, width) as another reader of the module would see them."""
    body = re.search(rf"^module {module}\((.*?)\);(.*?)^endmodule", text, re.DOTALL | re.MULTILINE)
    listed = {name.strip().lstrip("\\").strip() for name in body[1].split(",")}
    ports = {name: (direction, int(top or 0) + 1) for direction, top, name in re.findall(
        r"^  (input|output) (?:\[(\d+):0\] )?\\?(\S+?) ?;$", body[2], re.MULTILINE)}
    assert set(ports) == listed
    return ports


@pytest.mark.parametrize("machine", chosen(MACHINES, *MACHINES[::2]), ids=str)
def test_accepted(texts, tmp_path, machine):
    """Verilator's strictest lint has nothing to say beyond the waivers."""
    (tmp_path / "machine.v").write_text(texts(*machine))
    (tmp_path / "machine.vlt").write_text(WAIVERS.read_text())
    assert verilator_lint(tmp_path, "machine.vlt", "machine.v") == (0, "")


def test_a_machine_that_sets_triangles_up_is_accepted(tmp_path):
    """And its description says how long that takes."""
    configuration = MachineConfiguration(**PRESETS["tiny"], setup="hardware", setup_interval=256)
    text = machine_verilog(configuration)
    assert "central_broadcast_controller__setup__depth_plane__divider" in text
    (tmp_path / "machine.v").write_text(text)
    (tmp_path / "machine.vlt").write_text(WAIVERS.read_text())
    assert verilator_lint(tmp_path, "machine.vlt", "machine.v") == (0, "")
    timing = describe(configuration, text)["timing"]["triangle_setup"]
    assert timing["interval_clocks"] > 3 * 28 and timing["latency_clocks"] > 28


#: Machines of which a part has nothing to choose from: one element, one unit, one pixel, one word.
SMALLEST = [
    {"cards": "PM", "width": 1, "height": 1, "setup": "hardware", "setup_interval": 1,
     "shading": "flat"},
    {"cards": "PM", "width": 1, "height": 16, "memory_ports": 1, "shading": "flat"},
    {"cards": "PMM", "width": 16, "height": 1, "memory_ports": 1, "skew": True},
    {"cards": "PM", "width": 8, "height": 7, "fraction_bits": 0},
    {"cards": "PMMMM", "width": 8, "height": 8, "words": 1, "shading": "flat", "fraction_bits": 0},
    {"cards": "PMPM", "width": 16, "height": 16, "block": 4, "setup": "hardware",
     "setup_interval": 256, "shading": "flat"},
    {"cards": "2x(PM)", "width": 8, "height": 8, "lines": True, "setup": "hardware",
     "setup_interval": 256, "shading": "flat", "objects": "controller", "meshes": 1,
     "mesh_triangles": 1},
]


@pytest.mark.parametrize("fields", chosen(SMALLEST, *SMALLEST[::3]),
                         ids=lambda fields: fields["cards"])
def test_the_smallest_machines_are_accepted(tmp_path, fields):
    text = machine_verilog(MachineConfiguration(**fields))
    assert_all_used(text, "machine")
    (tmp_path / "machine.v").write_text(text)
    (tmp_path / "machine.vlt").write_text(WAIVERS.read_text())
    assert verilator_lint(tmp_path, "machine.vlt", "machine.v") == (0, "")


@pytest.mark.parametrize("ports", ["one_port", "two_port"])
def test_the_only_word_of_a_memory_is_word_0(ports):
    """Its address has no bits, but for the one that Verilog asks for."""
    configuration = MachineConfiguration(cards="PM", width=1, height=1, fraction_bits=0)
    assert configuration.words == 1
    name = f"{ports}_memory"
    text = component_verilog(component_for(configuration, name), name)
    assert set(re.findall(r"\.(?:read|write)_address\((.*?)\)", text)) == {"1'h0"}


def assert_all_used(text, top):
    """Every module but the first is instantiated."""
    modules = re.findall(r"^module (\S+?)\(", text, re.MULTILINE)
    assert modules[0] == top
    for module in modules[1:]:
        assert re.search(rf"^  {re.escape(module)} \S+ \($", text, re.MULTILINE), module


def test_what_nobody_instantiates_is_not_written():
    """In a cage of one unit there is nothing to walk block by block."""
    one, two = (component_verilog(component_for(MachineConfiguration(
        **PRESETS["tiny"] | {"cards": cards}), "triangle_rows"), "triangle_rows")
        for cards in ("PM", "PMM"))
    module = "\nmodule triangle_rows__block("
    assert module in two and module not in one


def test_each_waiver_is_needed(texts, tmp_path):
    (tmp_path / "machine.v").write_text(texts("tiny", "flat"))
    waivers = WAIVERS.read_text()
    rules = re.findall(r"^lint_off -rule (\w+)$", waivers, re.MULTILINE)
    assert 0 < len(rules) <= 3
    for rule in rules:
        (tmp_path / "less.vlt").write_text(waivers.replace(f"lint_off -rule {rule}\n", ""))
        _, said = verilator_lint(tmp_path, "less.vlt", "machine.v")
        assert set(re.findall(r"%Warning-(\w+)", said)) == {rule}


@pytest.mark.parametrize(("name", "shading"), MACHINES)
def test_icarus_accepts_it(texts, tmp_path, name, shading):
    (tmp_path / "machine.v").write_text(texts(name, shading))
    assert icarus(tmp_path, "machine.v") == (0, "")


def test_synthesis_accepts_it(tmp_path):
    """For Lattice's ECP5: memories become block RAM, products become multipliers."""
    configuration = MachineConfiguration(
        **PRESETS["tiny"] | {"shading": "flat", "fraction_bits": 4})
    (tmp_path / "machine.v").write_text(machine_verilog(configuration))
    status, output = yosys(tmp_path, "read_verilog machine.v\nsynth_ecp5 -top machine "
                           "-run :map_ffs\ncheck -assert\ntee -o stat.txt stat\n")
    assert status == 0, output
    cells = (tmp_path / "stat.txt").read_text()
    assert "DP16KD" in cells and "MULT18X18D" in cells


@pytest.mark.parametrize("name", chosen(COMPONENTS, *BOARDS, *list(COMPONENTS)[::4]))
def test_ports_come_from_the_signature(tmp_path, name):
    """Of every component, in the smallest machine too, where some signals have no bits; and
    each passes the lint by itself."""
    configuration = MachineConfiguration(**PRESETS["tiny"])
    component = component_for(configuration, name)
    expected = component_ports(component)
    described = described_ports(component)
    text = component_verilog(component, name)
    assert_all_used(text, name)
    ports = declared_ports(text, name)
    clocked = {"clk": ("input", 1), "rst": ("input", 1)}
    assert {port.name: (port.direction, port.width) for port in expected} == {
        port: kind for port, kind in ports.items() if port not in clocked}
    assert [(port["name"], port["direction"], port["width"]) for port in described] == [
        (port.name, port.direction, port.width) for port in expected]
    assert all(port["meaning"] for port in described)
    (tmp_path / f"{name}.v").write_text(text)
    (tmp_path / "machine.vlt").write_text(WAIVERS.read_text())
    assert verilator_lint(tmp_path, "machine.vlt", f"{name}.v") == (0, "")


def test_one_module_per_component(texts):
    """The top first, each card once, readable names, and size that does not grow with memory."""
    text = texts("paper", "gouraud")
    modules = re.findall(r"^module (\S+?)\(", text, re.MULTILINE)
    assert modules[0] == "machine" and len(set(modules)) == len(modules)
    for name in COMPONENT_NAMES[:4]:
        assert modules.count(name) == 1
    assert "processing_element__walker" in modules and "processing_element__depth_test" in modules
    assert text.count("\n") < 8000
    # Only Verilog's own words need escaping.
    assert set(re.findall(r"\\(\S+)", text)) <= {"edge", "end", "output"}


def test_no_memory_has_contents(texts):
    text = texts("paper", "gouraud")
    memories = re.findall(r"^module memory_\d.*?^endmodule", text, re.DOTALL | re.MULTILINE)
    assert len(memories) == 5
    for memory in memories:
        assert "initial" not in memory and len(re.findall(r"reg \[.*\] words \[", memory)) == 1
    assert text.count("words [0:") == 5


def test_description(texts):
    configuration = MachineConfiguration(**PRESETS["paper"])
    facts = describe(configuration, texts("paper", "gouraud"))
    ports = declared_ports(texts("paper", "gouraud"), "machine")
    assert {port["name"]: (port["direction"], port["width"]) for port in facts["ports"]} == ports
    assert all(port["meaning"] for port in facts["ports"])
    [response] = [port for port in facts["ports"] if port["name"] == "responses__payload"]
    assert response["fields"] == [{"name": "kind", "offset": 0, "width": 8},
                                  {"name": "value", "offset": 8, "width": 32}]
    responses = facts["commands"]["responses"]
    assert (responses["bits"], responses["fields"]) == (response["width"], response["fields"])
    kinds = {kind["name"]: kind["fields"] for kind in facts["commands"]["responses"]["kinds"]}
    assert kinds["PICTURE"] == [{"name": "width", "offset": 8, "width": 16},
                                {"name": "height", "offset": 24, "width": 16}]
    assert kinds["DEPTH"] == [{"name": "depth", "offset": 8, "width": 32}]
    formats = {entry["name"]: entry for entry in facts["number_formats"]}
    assert formats["depth_plane"]["bits"] == configuration.depth_plane_bits
    assert formats["depth_plane"]["fraction_bits"] == 50
    # Of no more fraction bits than are needed, and nothing to tell too low from too high.
    assert not formats["depth_plane"]["signed"]
    assert formats["depth_plane"]["integer_bits"] == configuration.depth_bits
    assert formats["vertex_coordinate"]["integer_bits"] == configuration.coordinate_bits - 8
    kept, spans = walked_outline_layout(configuration), span_layout(configuration)
    memories = {"memory_16384x84_lanes_3_no_rw_check": 16,
                f"memory_15x{kept.size}": 4, f"memory_15x{planes_layout(configuration).size}": 4,
                # Before each of two lanes.
                f"memory_15x{fragment_layout(**memory_bus_bits(configuration)).size}": 8,
                # Its read is not clocked: look-up tables, not block RAM.
                f"memory_16x{spans.size}_asynchronous_read": 4}
    assert {memory["module"]: memory["instances"] for memory in facts["memories"]} == memories
    for memory in facts["memories"]:
        words, bits = re.match(r"memory_(\d+)x(\d+)", memory["module"]).groups()
        assert (memory["words"], memory["bits"]) == (int(words), int(bits))
        assert memory["contents_at_power_on"] == "unknown"
    assert facts["timing"]["video_scan_generator"]["latency_clocks"] == 5
    assert all(timing["stated"] for timing in facts["timing"].values())
    [triangle] = [entry for entry in facts["commands"]["opcodes"]
                  if entry["name"] == "PREPARED_TRIANGLE"]
    assert triangle["fields"][0] == {"name": "top", "offset": 8, "width": configuration.y_bits}
    ends = [field["offset"] + field["width"] for field in triangle["fields"]]
    assert ends[:-1] == [field["offset"] for field in triangle["fields"]][1:]
    assert ends[-1] <= facts["commands"]["bits"] == {
        port["name"]: port["width"] for port in facts["ports"]}["commands__payload"]


def test_the_command_lines_names_are_the_components():
    assert tuple(COMPONENTS) == COMPONENT_NAMES


def test_every_register_has_a_name():
    """Amaranth calls a signal that it found no name for ``$signal`` or ``$like``."""
    text = machine_verilog(MachineConfiguration(**PRESETS["tiny"]))
    assert not re.findall(r"\$(?:signal|like)\b", text)
