"""Cages of nodes made wrong in ways that were thought out, each against one quick test:
``python -m testbenches.studies.node_mutants``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import click

from cardcage.testbenches.support.progress import step_bar
from cardcage.testbenches.support.text_table import TextTable

from .mutation.campaign_trial import Copy
from .mutation.mutants import Mutant
from .mutation_campaign import KILLED, ROOT, SURVIVED


class Thought(NamedTuple):
    """What is wrong; the file, a text that is in it once, and what takes its place; the test that
    has to notice."""

    what: str
    file: str
    right: str
    wrong: str
    test: str

    def mutant(self, root: Path) -> Mutant:
        """Raises ``ValueError`` where the text is not in the file once."""
        source = (root / self.file).read_bytes()
        right = self.right.encode()
        if source.count(right) != 1:
            raise ValueError(f"{self.file}: {self.right!r} is there {source.count(right)} times")
        begin = source.index(right)
        change = f"{self.right} → {self.wrong}"
        return Mutant(self.file, source.count(b"\n", 0, begin) + 1, self.right, change,
                      f"{self.file}: {change}", (begin, begin + len(right)), self.wrong)


_NEAREST = "hdl/merging/nearest_word.py"
_UNIT = "hdl/memory_unit/memory_unit.py"
_MAP = "hdl/merging/drawn_map.py"
_CHAIN = "hdl/nodes/chain_merge.py"
_GATE = "hdl/nodes/node_gate.py"
_LIST = "hdl/nodes/list_memory.py"
_GENERATOR = "hdl/video/video_scan_generator.py"
_SNOOP = "hdl/memory_unit/snoop_part.py"
_SNOOP_TEST = "tests/hdl/memory_unit/test_snoop_part.py"
_MAP_TEST = "tests/hdl/merging/test_drawn_map.py"
_LIST_TEST = "tests/hdl/nodes/test_list_memory.py"
_GATE_TEST = "tests/hdl/nodes/test_node_gate.py"
_TIES = "tests/hdl/nodes/test_chain_merge.py::test_ties"
_CROSSBAR = "hdl/direct/crossbar.py"
_CROSSBAR_TEST = "tests/hdl/direct/test_crossbar.py"
#: Frame units that ask whether a word has been written since the pictures changed places.
_KEEPS_FIRST = """\
        self._write(m, number)
        seen, front = Signal(self.memory.words), Signal()
        address = access.write_address
        m.d.sync += front.eq(pictures.front)
        with m.If(access.write):
            m.d.sync += seen.bit_select(address, 1).eq(1)
        with m.If(front != pictures.front):
            m.d.sync += seen.eq(0)
        with m.If(seen.bit_select(address, 1)):
            m.d.comb += access.write.eq(0)
"""
_COMPARED = "Value.cast(self.higher) < Value.cast(self.lower)"
_PASSED = "            leaving.pixel.eq(arriving.pixel),\n        ]\n"

THOUGHTS = (
    Thought("of equal words the higher node's stays", _NEAREST, _COMPARED,
            "Value.cast(self.higher) <= Value.cast(self.lower)", _TIES),
    Thought("the order is not looked at", _NEAREST, _COMPARED,
            "self.higher.depth < self.lower.depth", _TIES),
    Thought("the farther word stays", _NEAREST, _COMPARED,
            "Value.cast(self.higher) > Value.cast(self.lower)", _TIES),
    Thought("what a node has not drawn is as near as can be", _CHAIN,
            "arriving.pixel.active & self.scan.drawn & nearest.higher_stays",
            "arriving.pixel.active & nearest.higher_stays", _TIES),
    Thought("nodes draw over what is not the picture", _CHAIN,
            "arriving.pixel.active & self.scan.drawn & nearest.higher_stays",
            "self.scan.drawn & nearest.higher_stays",
            "tests/hdl/nodes/test_chain_merge.py::test_the_nearer_pixel_a_clock_later"),
    Thought("a merge card passes the sync on a clock before the pixel", _CHAIN, _PASSED,
            "            *(leaving.pixel[name].eq(arriving.pixel[name])\n"
            "              for name in ('begin', 'active', 'rank', 'color')),\n        ]\n"
            "        m.d.comb += [leaving.pixel[name].eq(arriving.pixel[name])\n"
            "                     for name in ('horizontal_sync', 'vertical_sync')]\n",
            "tests/hdl/nodes/test_chain_merge.py::test_the_nearer_pixel_a_clock_later"),
    Thought("sync on the pins as it leaves the generator", _GENERATOR,
            "(getattr(pins, name).eq(last[name])", "(getattr(pins, name).eq(first[name])",
            "tests/hdl/video/test_chained_scan.py"),
    Thought("sync a clock late", _GENERATOR, "looking_up + self.bus_latency, name",
            "looking_up + self.bus_latency + ('sync' in name), name",
            "tests/hdl/video/test_video_scan_generator.py"),
    Thought("what was sent is counted a clock later", _CHAIN, "self._count(m, arriving.pixel)",
            "self._count(m, leaving.pixel)", "tests/machine/nodes/test_faults_of_nodes.py"
            "::test_what_was_sent_is_known_as_soon_as_the_picture_is_shown"),
    Thought("depths of the picture that is shown are compared with", _UNIT,
            "back = Mux(front, access.pixel[0].value, access.pixel[1].value)",
            "back = Mux(front, access.pixel[1].value, access.pixel[0].value)",
            "tests/hdl/memory_unit/test_two_pictures.py"),
    Thought("the tags of both pictures are exchanged", _UNIT,
            "(Mux(front, current[0], current[1]),", "(Mux(front, current[1], current[0]),",
            "tests/hdl/memory_unit/test_two_pictures.py"),
    Thought("a pixel has the round of the next triangle", "hdl/rasteriser/interpolator.py",
            "planes.round, moves,", "planes.round, moves - 1,",
            "tests/hdl/rasteriser/test_interpolator.py"),
    Thought("a pixel that finds the queue full is left out", "hdl/video/scan_read_back.py",
            "                          & (scanned == taken)),\n", "                          ),\n",
            "tests/hdl/video/test_scan_read_back.py"),
    Thought("nodes draw the triangles of all others", _GATE, "Operation.LOAD)) & ~here)",
            "Operation.LOAD)) & here)", _GATE_TEST),
    Thought("every node draws every triangle", _GATE, "Operation.LOAD)) & ~here)",
            "Operation.LOAD)) & 0)", _GATE_TEST),
    Thought("other nodes' triangles wait for the elements", _GATE,
            "broadcast.ready.eq(own.ready | elsewhere)", "broadcast.ready.eq(own.ready)",
            _GATE_TEST),
    Thought("a list is done before its last triangle is under way", _GATE,
            "drawing.eq(list_.giving | (settle != 0))", "drawing.eq(list_.giving)", _GATE_TEST),
    Thought("lists are drawn in their first frame only", _LIST,
            "[self.giving.eq(1), place.eq(0)]", "[self.giving.eq(1)]", _LIST_TEST),
    Thought("the last triangle of a list is left out", _LIST, "place != count)",
            "place + 1 != count)", _LIST_TEST),
    Thought("a list has room for one less", _LIST, "(count != self.words)",
            "(count != self.words - 1)", _LIST_TEST),
    Thought("lists that are cleared stay full", _LIST, "[count.eq(0), self.full.eq(0)]",
            "[count.eq(0)]", _LIST_TEST),
    Thought("the largest step of a tree comes first", "hdl/merging/tree_link.py",
            "distance.eq(1 << lines.step)",
            "distance.eq(1 << ((self.nodes > 2) + (self.nodes > 4) - lines.step)[:2])",
            "tests/machine/nodes/test_tree_frames.py"),
    Thought("a tree's steps are one too few", "hdl/controller/tree_steps.py",
            "with m.If(distance < self.nodes):", "with m.If(distance + 1 < self.nodes):",
            "tests/hdl/controller/test_tree_steps.py"),
    Thought("of equal depths the one that is received stays", "hdl/depth_test/one_port_lane.py",
            "compare.depth < nearest", "compare.depth <= nearest",
            "tests/hdl/depth_test/test_one_port_lane.py"),
    Thought("the map of what was drawn is cleared but for its last word", _MAP,
            "place == lister.map_words - 1", "place == lister.map_words - 2", _MAP_TEST),
    Thought("what was listed is listed again with the next frame", "hdl/merging/bit_memory.py",
            "mask.eq((1 << bit) | takes.replicate(self.word_bits))", "mask.eq(1 << bit)",
            _MAP_TEST),
    Thought("golden: of equal words the higher node's stays", "golden/merging/node_picture.py",
            "(higher.order < lower.order)", "(higher.order <= lower.order)",
            "tests/golden/merging/test_merging.py"),
    Thought("the host sends triangles in the order of the list: as right, but slower",
            "golden/organisations/shares.py", "np.lexsort((self.node, position, self.round))",
            "position.argsort() * 0 + np.arange(self.triangles)",
            "tests/golden/organisations/test_shares.py"),
    Thought("a cage of nodes that differ draws", "hdl/controller/node_control.py",
            "known & (report.units != first)", "C(0)",
            "tests/machine/nodes/test_faults_of_nodes.py"
            "::test_boards_pulled_out_of_one_node_only"),
    Thought("lists that are too long are drawn as far as they go",
            "hdl/controller/node_control.py",
            "(Opcode.DRAW_LISTS, controller.lists_full)", "(Opcode.DRAW_LISTS, C(0))",
            "tests/machine/nodes/test_faults_of_nodes.py::test_a_list_that_is_too_long"),
    Thought("nodes draw the next picture before all show the last one",
            "hdl/controller/merge_control.py",
            "return shown if self.presenter is None else self._all_show & shown", "return C(1)",
            "tests/machine/nodes/test_many_nodes.py"),
    Thought("of two as near the snooped one stays", _SNOOP, "depth <= pixel.depth",
            "depth < pixel.depth", f"{_SNOOP_TEST}::test_ties_are_deleted"),
    Thought("nothing that is heard hides anything", _SNOOP, "depth <= pixel.depth", "C(0)",
            f"{_SNOOP_TEST}::test_ties_are_deleted"),
    Thought("whatever is heard hides what a node has", _SNOOP, "depth <= pixel.depth", "C(1)",
            f"{_SNOOP_TEST}::test_ties_are_deleted"),
    Thought("what is to be sent is listed before the last word is deleted", _SNOOP,
            "sender.settled & ~compares & ~sender.hidden", "C(1)", _SNOOP_TEST),
    Thought("the map keeps what was hidden", "hdl/merging/picture_maps.py",
            "self.hidden & free", "C(0)", "tests/hdl/merging/test_picture_maps.py"),
    Thought("a node sends while the one before it does", "hdl/snooping/snoop_merge.py",
            "ended == self.left.node", "ended + 1 >= self.left.node",
            "tests/hdl/snooping/test_snoop_merge.py"),
    Thought("frame units keep the first of two pixels", "hdl/snooping/frame_unit.py",
            "        self._write(m, number)\n", _KEEPS_FIRST,
            "tests/hdl/snooping/test_frame_unit.py"),
    Thought("a frame unit takes an address to be a row too far up", "hdl/mapping/unit_pixel.py",
            ">= 1 << shift:", ">= 4 << shift:", "tests/hdl/mapping/test_unit_pixel.py"),
    Thought("a frame is merged while the one before still is", "hdl/controller/snoop_control.py",
            "self._waiting & presenter.idle", "self._waiting",
            "tests/hdl/controller/test_snoop_control.py"),
    Thought("a tag is free while a frame unit shows it", "hdl/controller/frame_tags.py",
            "*(self.frame_color if self.frame_units else [])", "",
            "tests/hdl/controller/test_frame_tags.py"),
    Thought("depths are always of the picture that is drawn into",
            "hdl/controller/snoop_control.py", "self._reading & ~self._drawing", "C(0)",
            "tests/machine/nodes/test_snooped_frames.py"
            "::test_depths_are_those_of_the_picture_drawn_last"),
    Thought("an arbiter that starves", "hdl/direct/round_robin.py",
            "Mux(ahead.any(), _lowest(ahead), _lowest(requests))", "_lowest(requests)",
            "tests/hdl/direct/test_round_robin.py"),
    Thought("a fragment does not say who drew it", "hdl/rasteriser/interpolator.py",
            "order.append(self.node)", "order.append(C(0, len(self.node)))",
            "tests/machine/nodes/test_direct_frames.py::test_other_cages"),
    Thought("two units take from an element that has one queue", _CROSSBAR,
            "queue.waiting & free & (targets", "queue.waiting & (targets", _CROSSBAR_TEST),
    Thought("one more waits than there is a place for", "hdl/direct/fragment_queue.py",
            "count != self.depth", "count != self.depth + 1", _CROSSBAR_TEST),
    Thought("a fragment is given before the last one is taken", "hdl/direct/unit_feed.py",
            "self.grant.eq(Mux(move, arbiter.grant, 0))", "self.grant.eq(arbiter.grant)",
            _CROSSBAR_TEST),
    Thought("all is done while memory units still write", "hdl/direct/direct_merge.py",
            "crossbar.busy | Cat(own.busy for own in self.units).any()", "crossbar.busy",
            "tests/hdl/direct/test_direct_merge.py"),
    Thought("fragments that follow closely see what was there before",
            "hdl/depth_test/two_ports.py", "Mux(follows & winning, write.depth, stored)",
            "stored", "tests/hdl/memory_unit/test_own_depth_test.py"),
)


@click.command()
@click.option("--patience", type=click.FloatRange(1), default=300.0, show_default=True,
              help="Seconds that a test may take.")
@click.argument("words", nargs=-1)
def main(patience: float, words: tuple[str, ...]) -> None:
    """Make cages of nodes wrong, in a copy of the project, and run the test that has to notice.

    WORDS: only those of which one is in the file or in what is wrong.  Exit status 1 where one
    survives.

    \b
    Examples:
      python -m testbenches.studies.node_mutants
      python -m testbenches.studies.node_mutants gate list
    """
    chosen = [thought for thought in THOUGHTS
              if not words or any(word in thought.file + thought.what for word in words)]
    rows = []
    with tempfile.TemporaryDirectory() as folder, step_bar(len(chosen)) as begin:
        copy = Copy(ROOT, Path(folder))
        for thought in chosen:
            begin(thought.what)
            outcome = copy.run_mutant(thought.mutant(ROOT), [thought.test], patience)
            rows.append((thought.what, SURVIVED if outcome.passed else KILLED,
                         outcome.why or thought.test))
    click.echo(TextTable(f"{len(chosen)} mutants", ("what is wrong", "verdict", "test"),
                         tuple(rows)).text())
    sys.exit(any(verdict == SURVIVED for _, verdict, _ in rows))


if __name__ == "__main__":
    main(prog_name="python -m testbenches.studies.node_mutants")
