"""What planning saves, counted in the netlists of both processing elements."""

import re

import pytest
from suite.cases import EVERY, chosen
from verilog_tools import verilator_lint

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.hdl.backplane.id_increment import IdIncrement
from cardcage.hdl.memory_unit.one_port_memory import OnePortMemory
from cardcage.hdl.processing_element.processing_element import ProcessingElement
from cardcage.hdl.rasteriser.edge_columns import EdgeColumns
from cardcage.testbenches.export.cell_count import count_cells
from cardcage.testbenches.export.export_files import WAIVERS
from cardcage.testbenches.export.verilog import component_verilog

#: Flat; a mesh of small triangles; large ones with a colour at each vertex.
SCENES = {"flat": "tetra:depth=3", "small": "sphereflake:depth=1",
          "large": "random:n=12,size=90,seed=4"}
SIZE = {"width": 64, "height": 64}


@pytest.fixture(scope="module")
def plans():
    return {kind: plan(make_display_list(scene, **SIZE).display_list, cards="2x(PMM)")
            for kind, scene in SCENES.items()}


@EVERY
def test_every_kind_of_cell_is_saved(plans, capsys):
    """All three are held to the one machine for every triangle on the screen."""
    full_machine, = {planned.full for planned in plans.values()}
    full = count_cells(ProcessingElement(configuration=full_machine))
    counted = {kind: count_cells(ProcessingElement(configuration=planned.configuration))
               for kind, planned in plans.items()}
    for kind, cells in counted.items():
        with capsys.disabled():
            print(f"\n{SCENES[kind]}: {cells.total:,} cells instead of {full.total:,}: {cells}")
        assert cells.flip_flops < full.flip_flops
        assert cells.gates < full.gates
        assert cells.multipliers < full.multipliers
        assert cells.memory < full.memory
    # A flat scene saves most; the fragments that wait, of all machines alike, are not its gain.
    assert counted["flat"].total < 0.55 * full.total
    assert counted["flat"].multipliers < full.multipliers / 3


def color_interpolators(configuration):
    """Names in the Verilog that are the red channel's start, products or sums."""
    text = component_verilog(ProcessingElement(configuration=configuration), "element")
    return set(re.findall(r"\bred_(?:start|steps|limb|value|x|y)\w*", text))


def test_a_flat_netlist_has_no_color_interpolator(plans):
    assert color_interpolators(plans["large"].configuration)
    assert not color_interpolators(plans["flat"].configuration)


@pytest.mark.parametrize("max_error", chosen([0, 3], 3))
@pytest.mark.parametrize("kind", SCENES)
def test_lint_has_nothing_to_say(tmp_path, kind, max_error):
    """Words of any width: no constant comparison, no operand cut short."""
    scene = make_display_list(SCENES[kind], **SIZE).display_list
    machine = plan(scene, cards="2x(PMM)", max_error=max_error).configuration
    (tmp_path / "element.v").write_text(
        component_verilog(ProcessingElement(configuration=machine), "processing_element"))
    (tmp_path / "machine.vlt").write_text(WAIVERS.read_text())
    assert verilator_lint(tmp_path, "machine.vlt", "element.v") == (0, "")


def test_the_weights_of_small_netlists():
    """By hand: a number that grows by one; a memory; registers with as many bits as they have."""
    increment = count_cells(IdIncrement(bits=5))
    assert (increment.flip_flops, increment.multipliers, increment.memory) == (0, 0, 0)
    assert 4 <= increment.gates <= 10
    memory = count_cells(OnePortMemory(words=16, depth_bits=24, tag_bits=2))
    assert memory.memory == 16 * (26 + 2 * 26)


def test_an_edges_registers(plans):
    """Fewer of them by what the plan says of the widths."""
    narrow, wide = (count_cells(EdgeColumns(configuration=configuration))
                    for configuration in (plans["flat"].configuration, plans["flat"].full))
    assert narrow.flip_flops < wide.flip_flops and narrow.gates < wide.gates
