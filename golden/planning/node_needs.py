"""What a display list asks of a cage whose nodes share its triangles."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..merging.ties import nodes_tie, order_matters
from ..organisations.organisation_of import organisation_of
from ..organisations.shares import Shares
from ..reference import bit_true, exact
from ..reference.triangle_setup import outline
from ..specification.configuration import MAXIMUM_ORDER_BITS, MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from ..specification.picture import Picture
from ..specification.ranges import MAXIMUM_WORDS
from ..specification.sampling_grid import Grid


class Lack(NamedTuple):
    """A field of a machine of which a list needs more.

    ``reason``  why it does
    ``remedy``  for whoever has the machine
    """

    field: str
    needed: int
    reason: str
    remedy: str


class NodeNeeds:
    """The needs of ``display_list`` on ``configuration``, a cage of nodes.

    The list is in the formats of the machine, and exact from ``exact_fraction_bits`` on; what the
    machine has of the fields that are asked for here does not matter.  Drawing, which is what
    ``ties`` and ``meets`` take, is put off until it is asked for.
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 exact_fraction_bits: int) -> None:
        self._configuration = configuration
        self._display_list = display_list
        self._exact = configuration.fraction_bits >= exact_fraction_bits
        self._shifts = organisation_of(configuration).resolution.shifts

    @cached_property
    def shares(self) -> Shares:
        return organisation_of(self._configuration).shares(self._display_list)

    def _draw(self, display_list: DisplayList) -> Picture:
        """As the machine does: where its depths err a little so do its ties.  The winners count,
        and no colours."""
        if self._exact:
            return exact.draw(display_list, shading="flat", **self._shifts)
        return bit_true.draw(display_list, fraction_bits=self._configuration.fraction_bits,
                             shading="flat", **self._shifts)

    @cached_property
    def ties(self) -> bool:
        """Without a round some pixel would go to another triangle."""
        return order_matters(self._display_list, self.shares, self._draw)

    @cached_property
    def meets(self) -> bool:
        """Fragments of different nodes meet in memory, and tie where they are seen."""
        return self._configuration.node_order_bits > 0 and nodes_tie(
            self._display_list, self.shares, self._draw)

    @property
    def order_bits(self) -> int:
        """The fewest; ``InputError`` where they are more than a machine may have."""
        node_bits = self._configuration.node_order_bits
        if node_bits and not self.meets:
            return 0
        return self.bits_of_rounds if self.ties else node_bits

    @property
    def keeps_rounds(self) -> bool:
        """The fewest order bits hold a round."""
        return self.order_bits > self._configuration.node_order_bits

    @property
    def bits_of_rounds(self) -> int:
        """Order bits that hold every round, whether triangles tie or not; ``InputError`` where they
        are more than a machine may have."""
        node_bits, shares = self._configuration.node_order_bits, self.shares
        most = MAXIMUM_ORDER_BITS - node_bits
        if shares.order_bits > most:
            fewest = -(-shares.items // (shares.nodes << most))
            raise InputError(
                f"packet: {shares.packet} makes {shares.rounds:,} rounds, at most "
                f"{1 << most:,} keep ties between nodes in order; take {fewest} at "
                "least, or contiguous")
        return node_bits + shares.order_bits

    @cached_property
    def list_words(self) -> int:
        """Triangles of the largest share that set-up leaves in it, 1 at least; ``InputError``
        where they are more than a list memory may hold."""
        boxes = outline(self._display_list, Grid.of(self._display_list, **self._shifts)).boxes
        largest = int(np.bincount(self.shares.node[boxes.primitive], minlength=1).max())
        if largest > MAXIMUM_WORDS:
            raise InputError(f"list_words: the largest of {self.shares.nodes} shares is "
                             f"{largest:,} triangles, a list memory holds {MAXIMUM_WORDS:,} at "
                             "most; add nodes, or send the list every frame")
        return max(1, largest)

    def lacks(self, configuration: MachineConfiguration) -> Iterator[Lack]:
        """What that machine, which differs only in the fields asked for here, has too few of."""
        shares = self.shares
        most = configuration.node_order_bits + shares.order_bits
        if 0 < configuration.round_bits < shares.order_bits:
            yield self._lacks_order(most, f"for {shares.rounds:,} rounds")
        elif configuration.order_bits < most and configuration.order_bits < self.order_bits:
            yield self._lacks_order(self.order_bits, "since nodes tie")
        if 0 < configuration.list_words < self.list_words:
            yield Lack("list_words", self.list_words, "for the largest share",
                       "export a machine for this list")

    def _lacks_order(self, needed: int, reason: str) -> Lack:
        contiguous = "take --packet contiguous, or " if self.shares.rounds > 1 else ""
        return Lack("order_bits", needed, reason, f"{contiguous}export a machine for this list")
