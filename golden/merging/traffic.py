"""What nodes send to merge their pictures, and which pieces of the backplane a send takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Send(NamedTuple):
    """``pixels`` pixels from one node to another, in one step of a merge.  On a bus there is no one
    receiver: all hear them, and the frame units right of the last node store them."""

    step: int
    sender: int
    receiver: int | None
    pixels: int


@dataclass(frozen=True)
class Traffic:
    """All sends of a merge among ``nodes`` nodes side by side; each pixel of them is a word of
    ``pixel_bits``, 0 where no machine says how many.

    A send takes every piece of the backplane between its two nodes, or all of it where it is for
    everybody; piece k lies between the nodes k and k + 1, on a bus the last one between the last
    node and the frame units.
    """

    nodes: int
    sends: Sequence[Send]
    pixel_bits: int = 0

    @property
    def pixels(self) -> int:
        """Pixels sent in all."""
        return sum(send.pixels for send in self.sends)

    @property
    def bits(self) -> int:
        """Bits sent in all."""
        return self.pixels * self.pixel_bits

    @property
    def sent(self) -> list[int]:
        """Pixels that each node sends."""
        sent = [0] * self.nodes
        for send in self.sends:
            sent[send.sender] += send.pixels
        return sent

    @property
    def steps(self) -> list[int]:
        """The longest send of each step: all nodes of a step wait for it."""
        longest: dict[int, int] = {}
        for send in self.sends:
            longest[send.step] = max(longest.get(send.step, 0), send.pixels)
        return [longest[step] for step in sorted(longest)]

    @property
    def pieces(self) -> NDArray[np.int64]:
        """int64 (nodes - 1,), one more on a bus: the pixels that pass over each piece of the
        backplane."""
        bus = any(send.receiver is None for send in self.sends)
        passed = np.zeros(self.nodes - 1 + bus, np.int64)
        for _, sender, receiver, pixels in self.sends:
            if receiver is None:
                passed += pixels
            else:
                passed[min(sender, receiver):max(sender, receiver)] += pixels
        return passed

    @property
    def busiest_piece(self) -> int:
        return int(self.pieces.max(initial=0))
