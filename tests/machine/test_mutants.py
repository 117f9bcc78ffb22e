"""The hardware made wrong on purpose: the frame check notices every time."""

import importlib
import inspect
import sys
import types

import numpy as np
import pytest
from frames import check_scans, draw, random_list, triangles

#: name → (module, its class, where it is used, right, wrong)
MUTANTS = {
    "comparator takes the farther": (
        "depth_test", "DepthTest", ["processing_element"],
        "compare.depth < nearest", "compare.depth > nearest"),
    "comparator lets ties replace": (
        "depth_test", "DepthTest", ["processing_element"],
        "compare.depth < nearest", "compare.depth <= nearest"),
    "comparison without forwarding": (
        "depth_test", "DepthTest", ["processing_element"],
        "Mux(waiting, write.depth, ", "Mux(0, write.depth, "),
    "a winner written last is forgotten too soon": (
        "depth_test", "DepthTest", ["processing_element"],
        "has_written.eq(1)", "has_written.eq(0)"),
    "a winner written last is remembered too long": (
        "depth_test", "DepthTest", ["processing_element"],
        "m.d.sync += has_written.eq(0)", "pass"),
    "depth steps one pixel instead of the lattice's stride": (
        "span_start", "SpanStart", ["processing_element"],
        "step_x << carried.x_stride_bits", "step_x"),
    "edge remainder never carries": (
        "edge_walker", "EdgeWalker", ["span_walker"],
        "total >= self.edge.denominator", "0"),
    "edge carry at equality missed": (
        "edge_walker", "EdgeWalker", ["span_walker"],
        "total >= self.edge.denominator", "total > self.edge.denominator"),
    "row step added twice": (
        "span_start", "SpanStart", ["processing_element"],
        "origin + along_x + along_y", "origin + along_x + along_y + along_y"),
    "ID chain does not count": (
        "id_increment", "IdIncrement", ["memory_unit"],
        "self.left + 1", "self.left"),
    "ID chain counts by two": (
        "id_increment", "IdIncrement", ["memory_unit"],
        "self.left + 1", "self.left + 2"),
    "scan slot ignored: the element has the port": (
        "memory_unit", "MemoryUnit", ["machine"],
        "with m.If(scan_read):", "with m.If(scan_read & ~write_here & ~read_here):"),
    "busy not shown to a read in a scan slot": (
        "memory_unit", "MemoryUnit", ["machine"],
        "(read_here & (scan_read | write_here))", "(read_here & write_here)"),
    "output register captured a clock early": (
        "memory_unit", "MemoryUnit", ["machine"],
        "with m.If(captured):", "with m.If(scan_read):"),
    "front and back colours exchanged": (
        "memory_unit", "MemoryUnit", ["machine"],
        "Mux(self.front, memory.color[1], memory.color[0])",
        "Mux(self.front, memory.color[0], memory.color[1])"),
    "survey takes silence for an answer": (
        "survey", "Survey", ["processing_element"],
        "memory.read_data != pattern", "memory.read_data == pattern"),
    "clear stops a word early": (
        "clear", "Clear", ["processing_element"],
        "address + 1 >= self.words", "address + 2 >= self.words"),
    "pictures are never swapped": (
        "central_broadcast_controller", "CentralBroadcastController", ["machine"],
        "self.front.eq(~self.front)", "self.front.eq(self.front)"),
    "a frame ends before all are done": (
        "central_broadcast_controller", "CentralBroadcastController", ["machine"],
        "self.broadcast.done & (settle == 0)", "settle == 0"),
    "columns step one pixel instead of the lattice's stride": (
        "fragment_stepper", "FragmentStepper", ["processing_element"],
        "span.x + (1 << span.x_stride_bits)", "span.x + 1"),
}


def mutate(monkeypatch, name):
    module_name, class_name, users, right, wrong = MUTANTS[name]
    module = importlib.import_module(f"cardcage.hdl.{module_name}")
    source = inspect.getsource(module)
    assert source.count(right) == 1, f"{right!r} is not in {module_name} exactly once"
    mutant = types.ModuleType(module.__name__)
    mutant.__package__ = module.__package__
    monkeypatch.setitem(sys.modules, module.__name__, mutant)
    exec(compile(source.replace(right, wrong), module.__file__, "exec"), mutant.__dict__)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    for user in users:
        monkeypatch.setattr(f"cardcage.hdl.{user}.{class_name}", getattr(mutant, class_name))


def check_machine():
    """The frames that tell every mutant from the machine."""
    draw(random_list(5, 12), cards="PMMPMM", seed=2)
    # Edges on the half-pixel grid with few sub-pixel bits, so that every kind of remainder
    # occurs, and equal depths.
    source = np.random.default_rng(3)
    draw(triangles(source.integers(-2, 20, (16, 3, 2)) / 2,
                   source.integers(0, 3, (16, 1)).repeat(3, axis=1),
                   source.integers(0, 256, (16, 3, 3)), sub_bits=1), cards="PMMPMM", seed=3)
    # Each pixel is hit twice in a row, the farther second, while the one port is a bottleneck.
    pixels = [[[x + 0.1, y + 0.1], [x + 1.4, y + 0.1], [x + 0.1, y + 1.4]]
              for y in range(8) for x in range(8)]
    draw(triangles(np.repeat(pixels, 2, axis=0), [[100] * 3, [200] * 3] * 64,
                   [[[1, 2, 3]] * 3, [[200, 100, 50]] * 3] * 64), cards="PM", seed=4)
    check_scans()  # the processing element is busy while the old picture is shown


def test_the_machine_itself_passes():
    check_machine()


@pytest.mark.parametrize("name", MUTANTS)
def test_mutant_is_caught(monkeypatch, name):
    mutate(monkeypatch, name)
    with pytest.raises((AssertionError, TimeoutError, RuntimeError, ValueError, IndexError)):
        check_machine()
