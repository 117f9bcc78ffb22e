"""What is exported by itself is what the machine has."""

from amaranth.hdl import Fragment
from amaranth.lib import wiring
from hdl_bench.pictures import small_machine

from cardcage.hdl.components import COMPONENTS
from cardcage.hdl.machine import Machine
from cardcage.testbenches.export.verilog import component_ports


def test_every_component_is_a_part_of_a_machine(monkeypatch):
    """Of its class, with its ports: in a machine that sets triangles up, of one kind of memory or
    the other, of one node, or of nodes that merge in one way or the other, or that deals regions
    out; or in nodes, or elements, that make triangles of objects."""
    parts = []
    made = wiring.Component.__init__

    def note(self, *arguments, **named):
        made(self, *arguments, **named)
        parts.append(self)

    lonely = set(COMPONENTS)
    classes = {}
    for cards, changes in (
            ("PMMPMM", {}), ("PMMPMM", {"memory_ports": 2}), ("PMMC", {}), ("PMMT", {}),
            ("PMMSF", {}), ("PPDMM", {"memory_ports": 2}),
            ("PMMC", {"objects": "nodes", "mesh_triangles": 9, "meshes": 2}),
            ("PMMPMM", {"regions": (3, 4), "balance": "static", "objects": "elements",
                        "mesh_triangles": 9, "meshes": 2, "order_bits": 3}),
            ("PMMPMM", {"regions": (3, 4), "balancer": "hardware"})):
        configuration = small_machine(cards, 9, 7, shading="gouraud", setup="hardware",
                                      **{"memory_ports": 1} | changes)
        with monkeypatch.context() as patch:
            patch.setattr(wiring.Component, "__init__", note)
            Fragment.get(Machine(configuration=configuration), None)
        there = {type(part) for part in parts}
        for name in sorted(lonely):
            if classes.get(name, object) not in there | {object}:
                continue
            alone = COMPONENTS[name](configuration)
            classes[name] = type(alone)
            if any(type(part) is type(alone) and component_ports(part) == component_ports(alone)
                   for part in parts):
                lonely.remove(name)
            Fragment.get(alone, None)  # Amaranth wants each elaborated once
        parts.clear()
    assert not lonely
