"""The hardware made wrong on purpose: the frame check notices every time."""

import importlib
import inspect
import sys
import types
from dataclasses import replace

import numpy as np
import pytest
from frames import check_frames, check_scans, draw, many_frames, random_list, spans_twice, triangles
from suite.cases import EVERY

from cardcage.testbenches.engines.pysim_engine import PysimEngine

#: How a machine that is wrong shows.
FAILURES = (AssertionError, TimeoutError, RuntimeError, ValueError, IndexError)

#: name → (module, its class, where it is used, right, wrong); in lists by what tells them.
MUTANTS_IN_RANDOM_LISTS = {
    "edges without their fraction": (
        "rasteriser.edge_columns", "EdgeColumns", ["rasteriser.triangle_spans"],
        "first.eq(start + words[0])", "first.eq(start + (words[0]"
        " >> self.configuration.edge_fraction_bits << self.configuration.edge_fraction_bits))"),
    "the short edge counts rows from the top": (
        "rasteriser.triangle_rows", "TriangleRows", ["rasteriser.triangle_spans"],
        "Mux(in_upper, triangle.top, triangle.middle)", "triangle.top"),
    "a row skipped at the end": (
        "rasteriser.triangle_rows", "TriangleRows", ["rasteriser.triangle_spans"],
        "self._after_base >= self._triangle.bottom",
        "self._after_base + 1 >= self._triangle.bottom"),
    "row step added twice": (
        "rasteriser.interpolator", "Interpolator", ["processing_element.drawing_element"],
        "delayed(m, x + y, 1,", "delayed(m, x + y + y, 1,"),
    "survey takes silence for an answer": (
        "processing_element.survey", "Survey", ["processing_element.processing_element"],
        "answered.eq(memory.read_data == pattern)", "answered.eq(memory.read_data != pattern)"),
    "a frame ends before all are done": (
        "controller.central_broadcast_controller", "CentralBroadcastController", ["machine"],
        "self.broadcast.done & (self._settle == 0)", "self._settle == 0"),
    "columns step one pixel instead of the lattice's stride": (
        "rasteriser.fragment_stepper", "FragmentStepper", ["processing_element.drawing_element"],
        "1 if dealt else span.stride", "1"),
}

MUTANTS_ON_EDGES = {
    "comparator lets ties replace": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "compare.depth < nearest", "compare.depth <= nearest"),
}

MUTANTS_ON_PIXELS_HIT_TWICE = {
    "comparator takes the farther": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "compare.depth < nearest", "compare.depth > nearest"),
    "comparison without forwarding": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "Mux(waiting, write.depth, ", "Mux(0, write.depth, "),
    "a winner written last is forgotten too soon": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "has_written.eq(1)", "has_written.eq(0)"),
    "a span ends a pixel late": (
        "rasteriser.span_clip", "SpanClip", ["rasteriser.triangle_spans"],
        "end.eq(extent.beyond)", "end.eq(extent.beyond + 1)"),
    "a triangle kept from the element that has its last column": (
        "processing_element.share_filter", "ShareFilter", ["processing_element.broadcast_queue"],
        "< triangle.right", "< triangle.right - 1"),
    "ID chain does not count": (
        "backplane.id_increment", "IdIncrement", ["memory_unit.memory_unit"],
        "self.left + 1", "self.left"),
    "ID chain counts by two": (
        "backplane.id_increment", "IdIncrement", ["memory_unit.memory_unit"],
        "self.left + 1", "self.left + 2"),
    "busy not shown to a read in a scan slot": (
        "memory_unit.memory_unit", "MemoryUnit", ["machine"],
        "read_here & access.read_busy)", "read_here & access.write)"),
    "front and back colours exchanged": (
        "memory_unit.scan_part", "ScanPart", ["memory_unit.memory_unit"],
        "Mux(pictures.front, pictures_read[1].value, pictures_read[0].value)",
        "Mux(pictures.front, pictures_read[0].value, pictures_read[1].value)"),
    "pictures are never swapped": (
        "controller.one_node", "OneNode", ["controller.merge_control"],
        "front.eq(~pictures.front)", "front.eq(pictures.front)"),
}

MUTANTS_ON_SPANS_DRAWN_TWICE = {
    "depth of the span's first pixel all along": (
        "rasteriser.fragment_stepper", "FragmentStepper", ["processing_element.drawing_element"],
        "pixel.x_steps.eq(span.x - span.left)", "pixel.x_steps.eq(span.end - 1 - span.left)"),
    "odd limbs left out": (
        "rasteriser.interpolator", "Interpolator", ["processing_element.drawing_element"],
        "sum(words[1:], words[0])", "words[0]"),
    "output register captured a clock early": (
        "memory_unit.scan_part", "ScanPart", ["memory_unit.memory_unit"],
        "with m.If(captured):", "with m.If(scan_read):"),
    "memory is not initialised": (
        "memory_unit.tag_sweep", "TagSweep", ["memory_unit.sweep_part"],
        "Mux(overwritten, 0, left)", "Mux(overwritten | everything, 0, left)"),
    "passes stop half way": (
        "memory_unit.tag_sweep", "TagSweep", ["memory_unit.sweep_part"],
        "following[-1] if wraps", "following[-2] if wraps"),
    "with two ports the winner a clock ahead is not seen": (
        "depth_test.two_ports", "TwoPortDepthTest", ["processing_element.processing_element"],
        "Mux(follows & winning, write.depth, stored)", "stored"),
    "with two ports the winner two clocks ahead is not seen": (
        "depth_test.two_ports", "TwoPortDepthTest", ["processing_element.processing_element"],
        "Mux(writing, write.depth, ", "Mux(0, write.depth, "),
    "with two ports a read beside a write sees the old word": (
        "depth_test.two_ports", "TwoPortDepthTest", ["processing_element.processing_element"],
        "Mux(wrote, written.depth, ", "Mux(0, written.depth, "),
}

MUTANTS_IN_SCANS = {
    "a winner written last is remembered too long": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "m.d.sync += has_written.eq(0)", "pass"),
    "one row where there are two": (
        "processing_element.share_filter", "ShareFilter",
        ["processing_element.broadcast_queue"],
        "second_row >= kept.bottom", "second_row + 1 >= kept.bottom"),
    "scan slot ignored: the element has the port": (
        "memory_unit.one_port_memory", "OnePortMemory", ["memory_unit.memory_unit"],
        "with m.If(access.scan):", "with m.If(access.scan & ~access.write & ~access.read):"),
    "depths of all frames are compared": (
        "memory_unit.memory_unit", "MemoryUnit", ["machine"],
        "return current[place], access.depth.value",
        "return access.depth.tag.any(), access.depth.value"),
}

MUTANTS_IN_MANY_FRAMES = {
    "old tags are not swept out": (
        "memory_unit.tag_sweep", "TagSweep", ["memory_unit.sweep_part"],
        "Mux(overwritten, 0, left)", "Mux(everything, left, 0)"),
    "a tag is given out before a pass ends": (
        "controller.frame_tags", "FrameTags", ["controller.central_broadcast_controller"],
        "m.If(self.swept)", "m.If(1)"),
}

MUTANTS_OF_OLD_WORDS = {
    "colours of all frames are shown": (
        "memory_unit.scan_part", "ScanPart", ["memory_unit.memory_unit"],
        "drawn.eq(Mux(pictures.front, current[1], current[0]))",
        "drawn.eq(Mux(pictures.front, access.color[1].tag, access.color[0].tag).any())"),
    "a frame starts before all are done": (
        "controller.central_broadcast_controller", "CentralBroadcastController", ["machine"],
        "when=self.quiet & self.tags.ready", "when=self.tags.ready"),
}


#: Of what only squares of pixels use.
MUTANTS_IN_SQUARES = {
    "a square ends a pixel late": (
        "rasteriser.span_clip", "SpanClip", ["rasteriser.triangle_spans"],
        "with m.If(square_end < extent.beyond):", "with m.If(square_end + 1 < extent.beyond):"),
    "a row has spans in its first square only": (
        "rasteriser.span_clip", "SpanClip", ["rasteriser.triangle_spans"],
        "ended.eq(empty | (following >= extent.beyond) if square_bits else 1)", "ended.eq(1)"),
    "every square begins where the last one does": (
        "rasteriser.span_clip", "SpanClip", ["rasteriser.triangle_spans"],
        "x.eq(Mux(underway, current, x_first))", "x.eq(x_first)"),
    "rows of other squares are not skipped": (
        "mapping.lattice", "next_owned", ["rasteriser.triangle_rows"],
        "Mux(after[:square_bits] == 0, mask << square_bits, 0)", "0"),
    "the first square begins at its second column": (
        "mapping.lattice", "first_owned", ["rasteriser.span_clip"],
        "(square + ahead) << square_bits)", "((square + ahead) << square_bits) + 1)"),
    "the scan reads half its groups": (
        "mapping.interlace", "ScanAddress", ["memory_unit.scan_part"],
        "self.x[:group_bits] == 0", "self.x[:group_bits + 1] == 0"),
    "addresses leave out a bit inside the square": (
        "mapping.interlace", "PixelAddress", ["rasteriser.interpolator"],
        'without(self.x, interlace.unit_mask("x"))', "self.x >> 1"),
}


def mutate(monkeypatch, module_name, class_name, users, right, wrong):
    module = importlib.import_module(f"cardcage.hdl.{module_name}")
    source = inspect.getsource(module)
    assert source.count(right) == 1, f"{right!r} is not in {module_name} exactly once"
    mutant = types.ModuleType(module.__name__)
    mutant.__package__ = module.__package__
    monkeypatch.setitem(sys.modules, module.__name__, mutant)
    exec(compile(source.replace(right, wrong), module.__file__, "exec"), mutant.__dict__)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    for user in users:
        used = importlib.import_module(f"cardcage.hdl.{user}")
        right_class, wrong_class = getattr(used, class_name), getattr(mutant, class_name)
        monkeypatch.setattr(used, class_name, wrong_class)
        for name, board in getattr(used, "BOARDS", {}).items():
            if board is right_class:
                monkeypatch.setitem(used.BOARDS, name, wrong_class)


def check_random_lists():
    draw(random_list(5, 12), cards="PMMPMM", seed=2)


def check_edges():
    """On the half-pixel grid with few sub-pixel bits, so that every kind of remainder occurs; and
    equal depths."""
    source = np.random.default_rng(3)
    draw(triangles(source.integers(-2, 20, (16, 3, 2)) / 2,
                   source.integers(0, 3, (16, 1)).repeat(3, axis=1),
                   source.integers(0, 256, (16, 3, 3)), sub_bits=1), cards="PMMPMM", seed=3)


def check_pixels_hit_twice():
    """In a row, the farther second, while the one port is a bottleneck."""
    pixels = [[[x + 0.1, y + 0.1], [x + 1.4, y + 0.1], [x + 0.1, y + 1.4]]
              for y in range(8) for x in range(8)]
    draw(triangles(np.repeat(pixels, 2, axis=0), [[100] * 3, [200] * 3] * 64,
                   [[[1, 2, 3]] * 3, [[200, 100, 50]] * 3] * 64), cards="PM", seed=4)


def check_two_ports():
    draw(spans_twice(), cards="PM", seed=5, memory_ports=2)


def check_many_frames(ports=1, tag_bits=2):
    """Past the last tag more than once; some frames are started over before they are drawn."""
    check_frames(many_frames(9), tag_bits=tag_bits, memory_ports=ports, abandoned={2, 5, 6}, seed=6)


def check_old_words():
    """So many tags that old words stay."""
    check_many_frames(ports=2, tag_bits=4)


def check_squares():
    simulation = draw(random_list(11, 8, width=13, height=9), cards="4x(PM)", block=2, seed=2)
    assert sum(work.fragments for work in simulation.work) > 150


#: In a skewed machine of one unit each.
MUTANTS_SKEWED = {
    "a unit number without the bit of x": (
        "mapping.interlace", "PixelAddress", ["rasteriser.interpolator"],
        "number[0] ^= x[interlace.skew_bit]", "pass"),
    "rows that are not shifted": (
        "mapping.lattice", "row_offset", ["rasteriser.span_clip"],
        "further = lattice.shifted &", "further = 0 &"),
    "a filter that looks for the columns of every other row": (
        "mapping.lattice", "rows_mask", ["processing_element.share_filter"],
        "lattice.x_mask >> 1, lattice.x_mask)", "lattice.x_mask, lattice.x_mask)"),
}


def check_skewed():
    draw(random_list(11, 20), cards="4x(PM)", skew=True, seed=2)


#: Of the two lanes that share the memory bus to one-port units.
MUTANTS_OF_LANES = {
    "fragments of a pixel in either lane": (
        "depth_test.one_port", "OnePortDepthTest", ["processing_element.processing_element"],
        "fragment.unit[0] == number", "fragment.depth[0] == number"),
    "both lanes write at once": (
        "depth_test.one_port", "OnePortDepthTest", ["processing_element.processing_element"],
        " | (writer != number)", ""),
    "both lanes read at once": (
        "depth_test.one_port", "OnePortDepthTest", ["processing_element.processing_element"],
        " | (reader != number)", ""),
    "comparison without forwarding": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "Mux(waiting, write.depth, ", "Mux(0, write.depth, "),
    "a winner written last is not looked at": (
        "depth_test.one_port_lane", "OnePortLane", ["depth_test.one_port"],
        "has_written.eq(1)", "has_written.eq(0)"),
}


def check_lanes():
    """Rows twice in a row, with even and with odd depths."""
    rows = spans_twice(8, 6, seed=2)
    depth = rows.depth + np.arange(len(rows.depth))[:, np.newaxis] % 2
    draw(replace(rows, depth=depth), cards="PMM", skew=True, seed=4)


#: The frames that tell each mutant from the machine, the shortest that do.
CHECKS = {check_random_lists: MUTANTS_IN_RANDOM_LISTS, check_edges: MUTANTS_ON_EDGES,
          check_pixels_hit_twice: MUTANTS_ON_PIXELS_HIT_TWICE,
          check_two_ports: MUTANTS_ON_SPANS_DRAWN_TWICE,
          check_scans: MUTANTS_IN_SCANS,  # the element is busy while the old picture is shown
          check_many_frames: MUTANTS_IN_MANY_FRAMES, check_old_words: MUTANTS_OF_OLD_WORDS,
          check_squares: MUTANTS_IN_SQUARES, check_skewed: MUTANTS_SKEWED,
          check_lanes: MUTANTS_OF_LANES}


class Impatient(PysimEngine):
    """The longest of these runs takes the machine itself 4,230 cycles; one that hangs is not
    waited for much longer."""

    def run(self, job, progress=None):
        return super().run(replace(job, maximum_cycles=5000), progress)


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    monkeypatch.setattr("frames.PysimEngine", Impatient)


@EVERY
@pytest.mark.parametrize("check", CHECKS)
def test_the_machine_itself_passes(check):
    check()


@pytest.mark.parametrize(("check", "name"), [
    pytest.param(check, name, id=name, marks=[EVERY] * bool((place + number) % 10))
    for place, (check, group) in enumerate(CHECKS.items()) for number, name in enumerate(group)])
def test_mutant_is_caught(monkeypatch, check, name):
    mutate(monkeypatch, *CHECKS[check][name])
    with pytest.raises(FAILURES):
        check()
