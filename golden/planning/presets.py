"""Machines by name: fields of ``MachineConfiguration``, and of what ``plan`` is asked for."""

from __future__ import annotations

from typing import Any

#: ``tiny`` can be seen at one glance, ``small`` is for quick tests, ``paper`` draws 512x512.
PRESETS: dict[str, dict[str, Any]] = {
    "tiny": {"cards": "PM", "width": 16, "height": 16, "fraction_bits": 28,
             "clocks_per_pixel": 2},
    "small": {"cards": "2x(PMM)", "width": 64, "height": 64, "fraction_bits": 40},
    "paper": {"cards": "4x(PMMMM)", "width": 512, "height": 512, "fraction_bits": 50},
}
