"""What nodes send on a snooped bus, for any assignment of the triangles, from one list of all
fragments.

The fragments of a pixel are put in the order of (depth, primitive), nearest first.  Node k still
has its pixel when its turn comes if no lower node has drawn a nearer one there: if every fragment
before its own nearest one in that order is of a higher node.  So a fragment is sent where its node
is less than those of all fragments before it.  The order is the same however the triangles are
dealt out, and each assignment takes one running minimum.

``merge_snoop`` says the same from the nodes' pictures.  Of what is equally near the earlier
triangle is sent: so it is where nodes have their triangles in the order of the list, and pixels
carry their round or lower nodes have the earlier ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..reference.exact import fragments
from ..specification.display_list import DisplayList

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class DepthOrder:
    """Every fragment of a display list, hidden ones too, pixel after pixel, nearest first.

    ``primitive``  int32 (n,): whose each is
    ``first``      int64 (pixels,): where the fragments of each pixel on which something was drawn
                   begin; pixels ascend, row by row
    ``triangles``  of the list
    """

    primitive: NDArray[np.int32]
    first: Int64
    triangles: int

    @classmethod
    def of(cls, display_list: DisplayList) -> DepthOrder:
        drawn = fragments(display_list, shading="flat")  # whose colours nobody asks for
        pixel = drawn.y.astype(np.int64) * display_list.width + drawn.x
        key = pixel << display_list.depth_bits | drawn.depth
        order = np.argsort(key, kind="stable")  # of equal ones the earlier triangle stays first
        pixel = pixel[order]
        return cls(drawn.primitive[order], np.flatnonzero(np.diff(pixel, prepend=-1)),
                   display_list.triangles)

    @property
    def fragments(self) -> int:
        return len(self.primitive)

    @property
    def pixels(self) -> int:
        """Pixels on which something was drawn: the least that can be sent for the picture."""
        return len(self.first)

    @cached_property
    def depths(self) -> Int64:
        """int64 (pixels,): how many fragments each has."""
        return np.diff(self.first, append=self.fragments)

    @cached_property
    def _below(self) -> Int64:
        """int64 (n,): less the later a fragment's pixel is."""
        return -np.repeat(np.arange(self.pixels), self.depths)

    @cached_property
    def fragments_of_triangle(self) -> Int64:
        """int64 (triangles,)."""
        return np.bincount(self.primitive, minlength=self.triangles)

    def drawn_by(self, node: Int64, nodes: int) -> Int64:
        """int64 (nodes,): the fragments of each node; ``node`` int64 (triangles,) says whose a
        triangle is."""
        return np.bincount(node, self.fragments_of_triangle, nodes).astype(np.int64)

    def sent_by(self, node: Int64, nodes: int) -> Int64:
        """int64 (nodes,): pixels that each node sends, in ascending order."""
        own = node[self.primitive]
        # Less than everything in the pixels before it: the running minimum begins anew in each.
        value = self._below * nodes + own
        sent = np.diff(np.minimum.accumulate(value), prepend=nodes) < 0
        return np.bincount(own[sent], minlength=nodes)
