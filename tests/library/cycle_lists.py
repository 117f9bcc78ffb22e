"""Small display lists and machines for the tests of the cycle model and its parts."""

from __future__ import annotations

from cardcage.golden.cycles.element_spans import lattice_spans
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.sampling_grid import Grid

CARDS = ("PM", "PMM", "2x(PM)", "PMPMMM", "4x(PMM)")


def scene(seed: int, n: int = 40, size: int = 12) -> DisplayList:
    return make_display_list(f"random:n={n},size={size},seed={seed}", width=40,
                             height=28).display_list


def spans_of(configuration: MachineConfiguration, listed: DisplayList, row_limit: int = 64):
    triangles = Triangles.of(listed, Grid.of(listed))
    blocks = organisation_of(configuration).blocks
    return triangles, list(lattice_spans(triangles, blocks, row_limit))


def owner(configuration: MachineConfiguration, unit: int) -> int:
    """The processing element left of a unit."""
    seen = -1
    for place, card in enumerate(configuration.cards):
        seen += card == "M"
        if seen == unit:
            return configuration.cards[:place].count("P") - 1
    raise AssertionError(unit)
