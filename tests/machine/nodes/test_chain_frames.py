"""Nodes that merge in a chain, as they are scanned: how long a frame takes."""

import pytest
from frame_paces import pace, screens
from frames import random_list
from suite.cases import chosen
from wide_machines import wide_machine

#: Triangles over the whole screen, and how many scans their drawing takes.
PACES = {"a scan": (2, 1), "drawing": (60, 3)}


@pytest.mark.parametrize("retained", chosen([False, True], True))
@pytest.mark.parametrize("bound", PACES)
def test_a_frame_takes_whole_scans(bound, retained, record_property):
    """As many as drawing takes; merging takes none besides.  Each picture begins with a scan, and
    the next one is drawn into what the screen has left then."""
    count, scans = PACES[bound]
    cards = "4x(PMMC)"
    machine = wide_machine(random_list(0, 4, width=16, height=16), cards=cards, packet=1,
                           clocks_per_pixel=4, memory_ports=2, fraction_bits=40,
                           list_words=64 if retained else 0)
    found = pace(machine, screens(machine, count, 2, "rising"), retained=retained)
    record_property("measured", f"{cards}{', lists' * retained}: {found}")
    assert found.bound == bound and found.merge == 0
    assert found.frame == found.scans == scans * found.scan
