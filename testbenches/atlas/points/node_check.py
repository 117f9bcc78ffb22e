"""One node of a cage that is too large to simulate, in RTL, with what the model says comes in.

A node of a chain or a tree is a cage by itself: of the others it hears the pixels that come in at
its merge card, and nothing else.  So a cage of two nodes stands for the large one.  One is the node
that is checked, with its share of the triangles in its list.  The other sends it what the model
says would come in there: in a chain the nearest pixels of all nodes left of it, in a tree what the
next node has drawn.  It draws the triangles that are seen in that picture, and no others: so every
pixel that comes in is the predicted one, though one node sends it and not fifty.

What leaves the checked node is compared with golden, colour for colour and depth for depth, and so
are its fragments and the pixels that it receives; the clocks of its elements stand beside the cycle
model's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....golden.cycles.cycle_model import predict_cycles
from ....golden.cycles.frame_clocks import most_frame_clocks
from ....golden.cycles.merge_clocks import merge_clocks
from ....golden.merging.cage import cage_pictures
from ....golden.merging.node_picture import NodePicture, higher_is_nearer, merged, nearer
from ....golden.merging.tree import TreeSend
from ....golden.organisations.organisation_of import organisation_of
from ....golden.planning.scene_needs import with_sub_bits
from ....golden.reference import triangle_words
from ....golden.reference.exact import depth_complexity
from ....golden.reference.triangle_setup import prepare
from ....golden.specification import commands
from ....golden.specification.card_order import CHAIN_MERGE, TREE_MERGE
from ....golden.specification.commands import Opcode
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.display_list import DisplayList
from ....golden.specification.errors import InputError
from ....golden.specification.picture import NO_PRIMITIVE
from ...comparison.cage import Cage
from ...engines.choose_engine import make_engine
from ...engines.engine import Job
from ...frames.conversation import responses_owed
from ...frames.responses import Answers, Simulation
from ...frames.simulation import engine_errors
from ...support.machine_error import MachineError
from .atlas_point import AtlasPoint

Int64 = NDArray[np.int64]

#: Nodes that stand for the large cage.
STAND_IN = 2


def can_check_node(cage: Cage) -> bool:
    """Nodes that merge in a chain or a tree and draw from lists: where the host sends triangles
    one node waits for another, which no single node shows."""
    spelled = cage.spelled or ""
    nodes = max(spelled.count(CHAIN_MERGE), spelled.count(TREE_MERGE))
    return cage.retained and (nodes == 2 or nodes > 3)


def node_check(point: AtlasPoint, configuration: MachineConfiguration) -> dict[str, Any]:
    """The busiest node of the cage, of those of a tree that receive once, in RTL.

    Raises ``InputError`` where none can be checked, ``MachineError`` where a picture or a count is
    not as the models have it.
    """
    if not can_check_node(point.cage):
        raise InputError(f"--check-node: {point.cage.label} is no chain or tree of two nodes or "
                         "more than three with lists; take one, or leave it out")
    assert point.engine is not None
    return CheckedNode(configuration, point.scene.load().display_list, point.engine).figures()


@dataclass(frozen=True, eq=False)
class CheckedNode:
    """Of ``configuration``, a cage of nodes that draws ``display_list`` exactly."""

    configuration: MachineConfiguration
    display_list: DisplayList
    engine: str

    @cached_property
    def listed(self) -> DisplayList:
        return with_sub_bits(self.display_list, self.configuration.sub_bits)

    @cached_property
    def pictures(self) -> list[NodePicture]:
        """What each node draws."""
        return cage_pictures(self.configuration, self.listed)

    @cached_property
    def node(self) -> int:
        """Of those that can stand beside one other node the one that draws longest: in a chain the
        whole frame waits for it."""
        nodes, chained = self.configuration.nodes, self.configuration.scans_rank
        able = [node for node in range(nodes) if (node > 0 if chained else
                                                  node + 1 < nodes and node % 4 == 2 % nodes)]
        return max(able, key=self._clocks)

    def _clocks(self, node: int) -> float:
        """That the cycle model has for a node alone."""
        return predict_cycles(self._cage(1, node), self.listed.chosen(self._own(node)),
                              retained=True).cycles

    def _own(self, node: int) -> Int64:
        """The triangles of a node."""
        return organisation_of(self.configuration).shares(self.listed).of_node(node)

    def _fragments(self, node: int) -> int:
        shifts = organisation_of(self.configuration).resolution.shifts
        return int(depth_complexity(self.listed.chosen(self._own(node)), **shifts).sum())

    @cached_property
    def coming(self) -> NodePicture:
        """What comes in at the merge card."""
        if self.configuration.scans_rank:
            return merged(self.pictures[:self.node])
        return self.pictures[self.node + 1]

    @property
    def place(self) -> int:
        """Of the checked node among the two: the other one is where its pixels come from."""
        return int(self.configuration.scans_rank)

    @cached_property
    def seen(self) -> Int64:
        """The triangles that are seen in the picture that comes in."""
        winners = np.unique(self.coming.picture.winner)
        return np.asarray(winners[winners != NO_PRIMITIVE], np.int64)

    def _cage(self, nodes: int, node: int, words: int = 0) -> MachineConfiguration:
        """So many nodes, each as that one of the large cage is; their lists hold ``words``, if
        those are more."""
        configuration = self.configuration
        cards = f"{nodes}x({configuration.node_cards[node]}{configuration.merge})"
        return replace(configuration, cards=cards, packet="contiguous",
                       list_words=max(words, configuration.list_words))

    def _simulated(self, stand_in: MachineConfiguration) -> Simulation:
        words = self._commands(stand_in)
        job = Job(configuration=stand_in, commands=words,
                  responses=responses_owed(organisation_of(stand_in), words),
                  maximum_cycles=most_frame_clocks(stand_in, len(words)))
        with engine_errors(self.engine):
            return Answers(stand_in, make_engine(self.engine).run(job)).frame(0, reading=0)

    def _commands(self, stand_in: MachineConfiguration) -> list[int]:
        """Both lists, one frame, everything read back."""
        own = self._own(self.node)
        shares = organisation_of(self.configuration).shares(self.listed)
        loads: list[int] = []
        for place, triangles in ((self.place, own), (1 - self.place, self.seen)):
            some = self.listed.chosen(triangles)
            share = {"node": np.full(len(triangles), place), "round": shares.round[triangles]}
            if stand_in.setup == "hardware":
                loads += list(triangle_words.triangles(stand_in, some, share))
                continue
            prepared = prepare(some, fraction_bits=stand_in.fraction_bits,
                               shading=stand_in.shading,
                               **organisation_of(stand_in).resolution.shifts)
            loads += list(triangle_words.prepared_triangles(stand_in, prepared, share))
        loads = [commands.with_opcode(word, Opcode.LOAD) for word in loads]
        clear, draw, end, depth, counters = (commands.command(opcode) for opcode in (
            Opcode.CLEAR_LISTS, Opcode.DRAW_LISTS, Opcode.FRAME_END, Opcode.READ_DEPTH,
            Opcode.READ_COUNTERS))
        start = commands.frame_start(self.listed.background)
        return [clear, *loads, start, draw, end, depth, counters]

    def figures(self) -> dict[str, Any]:
        """Of the checked node, ``model`` and ``rtl`` each: ``fragments``, ``clocks`` of its busiest
        element, ``pixels_in`` at its merge card, and in a tree ``merge``, the clocks to receive
        them."""
        node = self.node
        stand_in = self._cage(STAND_IN, node, len(self.seen))
        simulation = self._simulated(stand_in)
        own = self.pictures[node]
        lower, higher = (self.coming, own) if self.place else (own, self.coming)
        self._compare(simulation, stand_in, nearer(lower, higher))
        work = [each for each in simulation.work if each.node == self.place]
        counts = {
            "fragments": (self._fragments(node), sum(each.fragments for each in work)),
            "pixels_in": (self._pixels_in(stand_in), simulation.sent[1 - self.place]),
        }
        for name, (model, rtl) in counts.items():
            if model != rtl:
                raise MachineError(f"node {node}: {rtl:,} {name.replace('_', ' ')}, by the model "
                                   f"{model:,}")
        both = counts | {"clocks": (round(self._clocks(node)),
                                    max(each.busy_cycles for each in work))}
        if not self.place:
            assert simulation.merge_cycles is not None
            send = TreeSend(0, 1, 0, self.coming.drawn, higher_is_nearer(own, self.coming))
            both["merge"] = (sum(merge_clocks(stand_in, [send])),
                             simulation.merge_cycles - simulation.draw_cycles)
        return {"node": node, "nodes": self.configuration.nodes,
                "elements": self.configuration.processing_elements, "of_node": len(work),
                "triangles": len(self._own(node)), "engine": simulation.engine,
                "pixels_compared": int(simulation.video.shape[0] * simulation.video.shape[1]),
                **{name: {"model": int(model), "rtl": int(rtl)}
                   for name, (model, rtl) in both.items()}}

    def _pixels_in(self, stand_in: MachineConfiguration) -> int:
        """A chain sends every pixel of a scan."""
        if self.place:
            return stand_in.width * stand_in.height
        return int(np.count_nonzero(self.coming.drawn))

    def _compare(self, simulation: Simulation, stand_in: MachineConfiguration,
                 wanted: NodePicture) -> None:
        video = organisation_of(stand_in).video(np.where(
            wanted.drawn[..., None], wanted.picture.color,
            np.array(self.listed.background, np.uint8)))
        wrong = int((simulation.video != video).any(axis=2).sum())
        assert simulation.depth is not None
        deep = int((simulation.depth != wanted.picture.depth).sum())
        if wrong or deep:
            raise MachineError(f"node {self.node}: {wrong:,} colours and {deep:,} depths that "
                               "leave it are not golden's")
