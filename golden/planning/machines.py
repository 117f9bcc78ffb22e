"""Machines by name, and the machine for every triangle on the screen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..reference import bit_true
from ..reference.triangle_setup import scene_fraction_bits
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.edge_widths import fewest_edge_fraction_bits
from ..specification.errors import InputError
from ..specification.fixed_point import MAX_FRACTION_BITS, exact_fraction_bits
from ..specification.ranges import check_whole

#: Depths have at most 32 bits: no error is greater.
MAXIMUM_ERROR = (1 << 32) - 1

#: Named machines: ``tiny`` at one glance, ``small`` for quick tests, ``paper`` for 512x512.
PRESETS: dict[str, dict[str, Any]] = {
    "tiny": {"cards": "PM", "width": 16, "height": 16, "fraction_bits": 28,
             "clocks_per_pixel": 2},
    "small": {"cards": "2x(PMM)", "width": 64, "height": 64, "fraction_bits": 40},
    "paper": {"cards": "4x(PMMMM)", "width": 512, "height": 512, "fraction_bits": 50},
}


def configure(display_list: DisplayList, *, cards: str, fraction_bits: int | None = None,
              **rest: Any) -> MachineConfiguration:
    """The machine for one display list: its size, its formats, only the interpolants it needs.

    ``fraction_bits`` None picks the width at which this list is drawn exactly, at the resolution
    that the memory of the cards holds.
    """
    rest.setdefault("shading", "flat" if display_list.flat else "gouraud")
    machine = MachineConfiguration(
        cards=cards, width=display_list.width, height=display_list.height,
        sub_bits=display_list.sub_bits, depth_bits=display_list.depth_bits,
        fraction_bits=0 if fraction_bits is None else fraction_bits, **rest)
    if fraction_bits is not None:
        return machine
    interlace = machine.interlace
    return replace(machine, fraction_bits=scene_fraction_bits(
        display_list, x_shift=interlace.x_shift, y_shift=interlace.y_shift))



def preset(name: str, **changes: Any) -> MachineConfiguration:
    """A named machine, with ``changes`` to its fields; ``InputError`` for an unknown name."""
    if name not in PRESETS:
        raise InputError(f"preset: {name!r} is none of {', '.join(PRESETS)}")
    return MachineConfiguration(**PRESETS[name] | changes)



def error_fraction_bits(extent: int, max_error: int) -> int:
    """The fewest fraction bits at which no stored value is more than ``max_error``, at least 1,
    off, for triangles of that ``extent``: the error before the floor is at most that."""
    bits = 0
    while bit_true.error_bound(bits, extent) > max_error:
        bits += 1
    return bits



def on_screen_fraction_bits(width: int, height: int, sub_bits: int, max_error: int = 0) -> int:
    """Fraction bits at which every triangle with all its vertices on the screen is exact, or its
    depths at most ``max_error`` off.

    None has more area than half the screen, or covers more columns and rows.
    """
    extent = width + height - 2
    bits = exact_fraction_bits((width << sub_bits) * (height << sub_bits), extent)
    return min(bits, MAX_FRACTION_BITS, error_fraction_bits(extent, max_error)
               if max_error else MAX_FRACTION_BITS)



def full_machine(*, max_error: int = 0, **fields: Any) -> MachineConfiguration:
    """The machine for every triangle on the screen; ``fields`` are those of the configuration
    but for the fraction bits.  Raises ``InputError``."""
    check_max_error(max_error)
    machine = MachineConfiguration(**fields | {"fraction_bits": 0})
    return replace(machine, fraction_bits=on_screen_fraction_bits(
        machine.width, machine.height, machine.sub_bits, max_error))



def on_screen_machine(**fields: Any) -> MachineConfiguration:
    """``full_machine`` with no bit more than for triangles that have all vertices on the screen.

    They are drawn exactly; one of the guard band may be refused.
    """
    machine = full_machine(**fields)
    height = machine.height << machine.sub_bits
    farthest = max(machine.width, machine.height) << machine.sub_bits
    return replace(machine, coordinate_bits=1 + farthest.bit_length(),
                   edge_column_bits=machine.x_bits, edge_remainder_bits=height.bit_length(),
                   edge_fraction_bits=fewest_edge_fraction_bits(height, height * machine.height))



def check_max_error(max_error: int) -> None:
    """Raise ``InputError`` unless it is a number of depth LSB."""
    check_whole("max error", max_error, 0, MAXIMUM_ERROR)
