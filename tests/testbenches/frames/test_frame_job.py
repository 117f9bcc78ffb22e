"""What a host is refused before it sends anything."""

import pytest

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.frames.frame_job import frame_commands

LIST = make_display_list("tetra:depth=0", width=16, height=16).display_list


@pytest.mark.parametrize(("cards", "fault"), [
    ("PMMM", "fault 2 (UNITS_UNSUPPORTED)"), ("PMMMC", "fault 2 (UNITS_UNSUPPORTED)"),
    ("PP", "fault 2 (UNITS_UNSUPPORTED)"), ("PMMT PMT", "fault 3 (NODES_DIFFER)")])
def test_a_machine_that_draws_nothing_gets_no_frame(cards, fault):
    machine = MachineConfiguration(cards=cards, width=16, height=16, fraction_bits=28, words=256,
                                   allow_orphans=True)
    with pytest.raises(InputError, match=r"^cards: P[PMCT]+: ") as refused:
        frame_commands(machine, LIST)
    assert fault in str(refused.value) and "power of two" in str(refused.value)
