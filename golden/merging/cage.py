"""How the nodes of a cage merge what they draw of a display list."""

from __future__ import annotations

from dataclasses import replace

from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.ranges import COLOR_BITS
from .chain import merge_chain
from .node_picture import NodePicture, node_pictures
from .traffic import Traffic
from .tree import merge_tree


def sent_pixel_bits(configuration: MachineConfiguration) -> int:
    """Bits of a pixel that a merge card sends: depth, order and colour; of a tree its unit and
    address as well."""
    bits = configuration.rank_bits + COLOR_BITS
    if organisation_of(configuration).merges_after_drawing:
        bits += configuration.id_bits + configuration.address_bits
    return bits


def cage_pictures(configuration: MachineConfiguration,
                  display_list: DisplayList) -> list[NodePicture]:
    """What each node of a cage draws of a display list, at the cage's resolution.  Nodes draw
    exactly."""
    organisation = organisation_of(configuration)
    return node_pictures(
        display_list, organisation.shares(display_list.triangles),
        order_bits=configuration.order_bits, shading=configuration.shading,
        **organisation.resolution.shifts)


def merge_cage(configuration: MachineConfiguration,
               display_list: DisplayList) -> tuple[NodePicture, Traffic]:
    """The merged picture, at the cage's resolution, and what its merge cards send for it.

    A chain sends, in each scan, every pixel of the video output, a tree what was drawn, each with
    the place where it belongs.
    """
    pictures = cage_pictures(configuration, display_list)
    if organisation_of(configuration).merges_after_drawing:
        picture, traffic = merge_tree(pictures)
        return picture, replace(traffic, pixel_bits=sent_pixel_bits(configuration))
    picture, traffic = merge_chain(pictures)
    scanned = configuration.width * configuration.height
    return picture, replace(traffic, pixel_bits=sent_pixel_bits(configuration), sends=[
        send._replace(pixels=scanned) for send in traffic.sends])
