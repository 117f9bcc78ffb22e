"""A point in RTL: three frames in a row, every pixel and every count compared with golden."""

from __future__ import annotations

from typing import Any

from ....golden.specification.errors import InputError
from ...comparison.cage import CageJob, CageRun, Refused
from ...support.machine_error import MachineError
from .atlas_point import AtlasPoint, Figures
from .model_figures import clock_figures


def rtl_figures(point: AtlasPoint, figures: Figures) -> Figures:
    """``figures`` of the models, with what the simulated machine takes in place of the clocks.

    Memory is as its Verilog has it, pixels sent are as its merge cards count them.  Raises
    ``MachineError`` where a picture or a count is not as golden has it, or there is none.
    """
    assert point.engine is not None
    run = CageJob(point.cage, point.scene.load(), point.asked, point.engine).run()
    if isinstance(run, Refused):
        raise (MachineError if run.failed else InputError)(run.reason)
    if run.differences:
        raise MachineError("; ".join(run.differences))
    return figures | {
        "source": "rtl",
        **clock_figures(run.configuration, run.clocks.draw, run.clocks.merge),
        "memory_bits": run.memory_bits,
        "simulated": _simulated(run, figures),
    }


def _simulated(run: CageRun, figures: Figures) -> dict[str, Any]:
    """What the model said, and what was compared."""
    return {
        "engine": run.simulation.engine,
        "frame": run.clocks.frame,
        "load": run.clocks.load,
        "model": {name: figures[name] for name in ("draw", "merge", "work", "memory_bits")},
        "pixels_compared": run.comparison.pixels_compared,
        "depths_compared": run.comparison.depths_compared,
        "fragments": run.fragments,
        "pixels_sent": run.traffic.pixels if run.configuration.merge else 0,
        "seconds": round(run.simulation.seconds + run.simulation.build_seconds, 3),
    }
