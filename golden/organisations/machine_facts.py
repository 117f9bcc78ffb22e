"""A machine as plain data, for reports and for ``machine.json``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from ..specification.configuration import MachineConfiguration
from .organisation import Organisation
from .organisation_of import organisation_of

#: What follows from the fields of a configuration, by the name of the fact.
FOLLOWING: dict[str, Callable[[MachineConfiguration, Organisation], Any]] = {
    "organisation": lambda configuration, organisation: organisation.name,
    "nodes": lambda configuration, organisation: organisation.nodes,
    "memory_units": lambda configuration, organisation: organisation.memory_units,
    "frame_units": lambda configuration, organisation: configuration.frame_units,
    "processing_elements": lambda configuration, organisation: configuration.processing_elements,
    "picture_width": lambda configuration, organisation: organisation.resolution.width,
    "picture_height": lambda configuration, organisation: organisation.resolution.height,
    "diagonal_step": lambda configuration, organisation: (
        configuration.interlace.diagonal_step if configuration.merges_directly else 0),
    "depth_plane_bits": lambda configuration, organisation: configuration.depth_plane_bits,
    "scan_reads_per_line": lambda configuration, organisation: organisation.scan_reads_per_line,
    "cycles_per_scan": lambda configuration, organisation: configuration.cycles_per_scan,
}


def machine_facts(configuration: MachineConfiguration) -> dict[str, Any]:
    """Every field of the configuration, and what follows from it: words, numbers and objects of
    these."""
    organisation = organisation_of(configuration)
    return asdict(configuration) | {
        name: fact(configuration, organisation) for name, fact in FOLLOWING.items()}
