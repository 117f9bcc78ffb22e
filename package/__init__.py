"""Cardcage: parallel Z-buffer graphics machines as RTL, every pixel checked against a golden model.

What a program needs, by one name each:

>>> import cardcage
>>> rendering = cardcage.render("tetra:depth=1", cards="PM", size=(16, 16), engine="pysim")
>>> rendering.comparison.equal
True

A name is loaded when it is first used, so ``import cardcage`` itself takes no time; only
``Machine`` and what simulates or exports one load Amaranth.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # what type checkers and editors see; the same names as in _HOMES
    from .golden.balancing.learnt_counts import learnt_counts
    from .golden.organisations.region_table import packed_table
    from .golden.planning.machine_plan import plan
    from .golden.scene_display_list import make_display_list
    from .golden.specification.configuration import MachineConfiguration
    from .golden.specification.display_list import DisplayList
    from .golden.specification.errors import InputError
    from .hdl.machine import Machine
    from .testbenches.comparison.compare_cages import compare_cages
    from .testbenches.export.export_files import export
    from .testbenches.frames.compare import compare
    from .testbenches.frames.region_host import RegionHost
    from .testbenches.frames.simulation import simulate_frame
    from .testbenches.render import render
    from .testbenches.render_frames import render_frames
    from .testbenches.support.machine_error import MachineError

    __version__: str

__all__ = [
    "DisplayList",
    "InputError",
    "Machine",
    "MachineConfiguration",
    "MachineError",
    "RegionHost",
    "__version__",
    "compare",
    "compare_cages",
    "export",
    "learnt_counts",
    "make_display_list",
    "packed_table",
    "plan",
    "render",
    "render_frames",
    "simulate_frame",
]

#: The module in which each name is at home.
_HOMES = {
    "DisplayList": "golden.specification.display_list",
    "InputError": "golden.specification.errors",
    "Machine": "hdl.machine",
    "MachineConfiguration": "golden.specification.configuration",
    "MachineError": "testbenches.support.machine_error",
    "RegionHost": "testbenches.frames.region_host",
    "compare": "testbenches.frames.compare",
    "compare_cages": "testbenches.comparison.compare_cages",
    "export": "testbenches.export.export_files",
    "learnt_counts": "golden.balancing.learnt_counts",
    "make_display_list": "golden.scene_display_list",
    "packed_table": "golden.organisations.region_table",
    "plan": "golden.planning.machine_plan",
    "render": "testbenches.render",
    "render_frames": "testbenches.render_frames",
    "simulate_frame": "testbenches.frames.simulation",
}


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used (PEP 562)."""
    if name == "__version__":
        value: Any = import_module("importlib.metadata").version("cardcage")
    elif name in _HOMES:
        value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
