"""How long a machine's own set-up takes, as its hardware states it."""

from __future__ import annotations

from functools import cache

from amaranth.hdl import Fragment

from ...golden.cycles.cycle_model import SetupTiming
from ...golden.specification.configuration import MachineConfiguration
from ...hdl.triangle_setup.triangle_setup import TriangleSetup


@cache
def setup_timing(configuration: MachineConfiguration) -> SetupTiming | None:
    """For the models of ``golden.cycles``; None where the host prepares the triangles."""
    if configuration.setup == "host":
        return None
    unit = TriangleSetup(configuration=configuration)
    Fragment.get(unit, None)  # Amaranth warns of components that are never elaborated
    return SetupTiming(interval=unit.interval, latency=unit.preparation, inside=unit.depth,
                       leaving=unit.leaving)
