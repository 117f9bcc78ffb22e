"""Machines that make triangles of objects: what they derive, and what they refuse."""

import pytest

from cardcage.golden.specification import commands
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError

SIZE = {"width": 16, "height": 16}
OBJECTS = {"setup": "hardware", "mesh_triangles": 8, "meshes": 3}


@pytest.mark.parametrize(("fields", "message"), [
    ({"objects": "host"}, "^objects: 'host' is none of controller, nodes, elements$"),
    ({"objects": "nodes", "setup": "host"}, "^setup: .* set-up in hardware"),
    ({"objects": "nodes", "mesh_triangles": 0}, "^mesh_triangles: 0 is not .* from 1 "),
    ({"objects": "nodes", "meshes": 0}, "^meshes: 0 is not .* from 1 "),
    ({"objects": "nodes", "meshes": 4097}, "^meshes: 4097 is not .* to 4096$"),
    ({"objects": "nodes", "list_words": 4}, "^list_words: .*; leave one of the two out$"),
    ({"objects": "nodes", "cards": "2x(PM)"}, "^objects: PMPM has no nodes .*; end them "),
    ({"objects": "nodes", "cards": "2xPD2xM"}, "^objects: PPDMM has no nodes .*; end them "),
    ({"objects": "controller"}, r"^objects: PMCPMC has nodes, .*; take nodes, or"),
    ({"objects": "elements"}, r"^objects: PMCPMC has nodes, .*; take nodes, or"),
    ({"objects": "elements", "cards": "2x(PM)"}, "^objects: .*; give regions as well"),
    ({"objects": "elements", "cards": "2x(PM)", "regions": (4, 1)},
     "^balance: clocks deals regions out anew, .*; take static$"),
    ({"mesh_triangles": 3, "meshes": 0}, "^mesh_triangles: is for .*; give objects as well"),
    ({"mesh_triangles": 0}, "^meshes: is for .*; give objects as well"),
])
def test_refused(fields, message):
    with pytest.raises(InputError, match=message) as raised:
        MachineConfiguration(**{"cards": "2x(PMC)"} | SIZE | OBJECTS | fields)
    assert "\n" not in str(raised.value)


def test_what_follows():
    of_nodes = MachineConfiguration("2x(PMC)", **SIZE, **OBJECTS, objects="nodes")
    assert (of_nodes.mesh_bits, of_nodes.controller_sets_up) == (2, False)
    broadcast = MachineConfiguration("2x(PM)", **SIZE, **OBJECTS, objects="controller")
    assert not broadcast.controller_sets_up and broadcast.order_bits == 0
    # Objects come in any order: their number is kept beside the depth.
    forwarding = MachineConfiguration("2x(PM)", **SIZE, **OBJECTS, objects="elements",
                                      regions=(4, 1), balance="static")
    assert (forwarding.order_bits, forwarding.round_bits, forwarding.rank_bits) == (16, 16, 40)
    layout = commands.object_layout(forwarding)
    assert (layout["round"], layout["element"]) == (16, 2) and "node" not in layout
    assert MachineConfiguration("2x(PM)", **SIZE, setup="hardware").controller_sets_up


def test_all_commands_have_one_length():
    """An object is no longer than a triangle."""
    for cards in ("2x(PMC)", "2x(PMT)"):
        plain = MachineConfiguration(cards, **SIZE, setup="hardware", fraction_bits=0)
        of_nodes = MachineConfiguration(cards, **SIZE, **OBJECTS, objects="nodes", fraction_bits=0)
        assert commands.command_words(plain) == commands.command_words(of_nodes)


def test_elements_that_pass_objects_on_have_room_for_their_own_regions_alone():
    """Their table stays; where it is made anew for each picture there is a quarter more."""
    fields = {"cards": "4x(PM)", "width": 16, "height": 16, "regions": (4, 4)}
    assert MachineConfiguration(**fields).slots == 5
    passing = MachineConfiguration(**fields, **OBJECTS, objects="elements", balance="static")
    assert passing.slots == 4
