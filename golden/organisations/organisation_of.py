"""Which organisation a cage has."""

from __future__ import annotations

from functools import lru_cache

from ..specification.card_order import CHAIN_MERGE, DIRECT_MERGE, SNOOP_MERGE, TREE_MERGE
from ..specification.configuration import MachineConfiguration
from .dealt_regions import DealtRegions
from .direct_elements import DirectElements
from .host_broadcast import HostBroadcast
from .nodes import ChainedNodes, TreeOfNodes
from .organisation import Organisation
from .snooped_nodes import SnoopedNodes

#: By the merge card of a cage.
ORGANISATIONS: dict[str | None, type[Organisation]] = {
    None: HostBroadcast, CHAIN_MERGE: ChainedNodes, TREE_MERGE: TreeOfNodes,
    SNOOP_MERGE: SnoopedNodes, DIRECT_MERGE: DirectElements}


@lru_cache(maxsize=64)
def organisation_of(configuration: MachineConfiguration) -> Organisation:
    """Its merge cards tell; a cage without any is Fuchs and Johnson's, or Ellsworth's where regions
    are dealt out."""
    if configuration.regions is not None:
        return DealtRegions(configuration)
    return ORGANISATIONS[configuration.merge](configuration)
