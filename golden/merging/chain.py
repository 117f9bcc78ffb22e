"""Merging while the screen is scanned: each node passes on the nearer pixel (PixelFlow; Cox and
Hanrahan 1993, section 5)."""

from __future__ import annotations

from collections.abc import Sequence

from .node_picture import NodePicture, merged
from .traffic import Send, Traffic


def merge_chain(pictures: Sequence[NodePicture]) -> tuple[NodePicture, Traffic]:
    """The merged picture, and what each link carries in one scan: every pixel, drawn or not.

    Node k hands its pixel to node k + 1; all links work at the same time, so it is one step.
    """
    pixels = pictures[0].picture.depth.size
    links = range(len(pictures) - 1)
    return merged(pictures), Traffic(
        len(pictures), [Send(0, node, node + 1, pixels) for node in links])
