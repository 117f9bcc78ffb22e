"""Which organisation a cage has."""

from __future__ import annotations

from functools import lru_cache

from ..specification.configuration import MachineConfiguration
from .host_broadcast import HostBroadcast
from .organisation import Organisation


@lru_cache(maxsize=64)
def organisation_of(configuration: MachineConfiguration) -> Organisation:
    """Every cage of processing elements and memory units is Fuchs and Johnson's."""
    return HostBroadcast(configuration)
