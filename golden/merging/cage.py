"""How the nodes of a cage merge what they draw of a display list."""

from __future__ import annotations

from dataclasses import replace

from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.ranges import COLOR_BITS
from .chain import merge_chain
from .direct import direct_traffic, merge_direct
from .node_picture import NodePicture, node_pictures
from .snoop import merge_snoop
from .traffic import Traffic
from .tree import merge_tree


def sent_pixel_bits(configuration: MachineConfiguration) -> int:
    """Bits of a pixel that is sent to be merged: depth, order and colour, and, but where every
    pixel has its turn in a scan, its unit and address."""
    bits = configuration.rank_bits + COLOR_BITS
    if not configuration.scans_rank:
        bits += configuration.id_bits + configuration.address_bits
    return bits


def cage_pictures(configuration: MachineConfiguration,
                  display_list: DisplayList) -> list[NodePicture]:
    """What each node of a cage draws of a display list, at the cage's resolution.  Nodes draw
    exactly."""
    organisation = organisation_of(configuration)
    return node_pictures(
        display_list, organisation.shares(display_list),
        order_bits=configuration.round_bits, shading=configuration.shading,
        **organisation.resolution.shifts)


def merge_cage(configuration: MachineConfiguration,
               display_list: DisplayList) -> tuple[NodePicture, Traffic]:
    """The merged picture, at the cage's resolution, and what is sent for it.

    A chain sends, in each scan, every pixel of the video output; a tree and a
    bus what was drawn, and elements that have no pixels every fragment, each with the place where
    it belongs.
    """
    organisation = organisation_of(configuration)
    pictures = cage_pictures(configuration, display_list)
    traffic: Traffic
    if configuration.merges_directly:
        picture = merge_direct(
            pictures, configuration.node_order_bits if configuration.order_bits else 0)
        traffic = direct_traffic(organisation, display_list)
    elif configuration.scans_rank:
        picture, traffic = merge_chain(pictures)
        scanned = configuration.width * configuration.height
        traffic = replace(traffic, sends=[send._replace(pixels=scanned) for send in traffic.sends])
    else:
        picture, traffic = (merge_snoop if configuration.snoops else merge_tree)(pictures)
    return picture, replace(traffic, pixel_bits=sent_pixel_bits(configuration))
