"""How long a machine's own set-up takes, as its hardware states it."""

from __future__ import annotations

from functools import cache

from ...golden.cycles.broadcast import SetupTiming
from ...golden.specification.configuration import MachineConfiguration


@cache
def setup_timing(configuration: MachineConfiguration) -> SetupTiming | None:
    """The figures that ``golden.cycles`` wants; None where the host prepares the triangles."""
    if configuration.setup == "host":
        return None
    # They load Amaranth: only those whose machine has a set-up wait for it.
    from amaranth.hdl import Fragment

    from ...hdl.triangle_setup.triangle_setup import TriangleSetup

    unit = TriangleSetup(configuration=configuration)
    Fragment.get(unit, None)  # Amaranth warns of components that are never elaborated
    return SetupTiming(interval=unit.interval, latency=unit.preparation, inside=unit.depth,
                       leaving=unit.leaving)
