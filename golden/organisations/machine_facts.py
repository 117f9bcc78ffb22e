"""A machine as plain data, for reports and for ``machine.json``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from ..specification.configuration import MachineConfiguration
from .organisation_of import organisation_of


def machine_facts(configuration: MachineConfiguration) -> dict[str, Any]:
    """Every field of the configuration, and what follows from it: words, numbers and objects of
    these."""
    organisation = organisation_of(configuration)
    return {
        **asdict(configuration),
        "organisation": organisation.name,
        "nodes": organisation.nodes,
        "memory_units": configuration.units,
        "processing_elements": configuration.processing_elements,
        "picture_width": organisation.resolution.width,
        "picture_height": organisation.resolution.height,
        "depth_plane_bits": configuration.depth_plane_bits,
        "scan_reads_per_line": organisation.scan_reads_per_line,
        "cycles_per_scan": configuration.cycles_per_scan,
    }
