"""A picture that takes longer than a scan: the old one is repeated whole, never torn."""

import numpy as np
from frames import golden_picture, random_list

from cardcage.golden.commands import ResponseKind
from cardcage.golden.configuration import configure
from cardcage.testbenches.engine import Job
from cardcage.testbenches.pysim_engine import PysimEngine
from cardcage.testbenches.simulation import frame_commands


def test_a_late_picture_repeats_the_old_one_whole():
    quick, slow = random_list(1, 2), random_list(2, 150)
    configuration = configure(slow, cards="PM", clocks_per_pixel=2)
    job = Job(
        configuration,
        commands=[*frame_commands(configuration, quick), *frame_commands(configuration, slow),
                  *frame_commands(configuration, quick)],
        responses=4 + 3 * 2,
        memory_seed=9,
        maximum_cycles=200 * configuration.cycles_per_scan,
    )
    run = PysimEngine().run(job)
    repeated = [value for kind, value, _ in run.responses if kind == ResponseKind.FRAME_SHOWN]
    drawn = [value for kind, value, _ in run.responses if kind == ResponseKind.FRAME_DRAWN]
    assert drawn[1] > 3 * configuration.cycles_per_scan, "the slow picture is slow"
    assert repeated[1] >= 3

    # Every scan on the pins is one of the pictures, whole; and in this order.
    whole = {
        "dark": np.zeros((8, 8, 3), np.uint8),  # what the boot leaves in both buffers
        "quick": golden_picture(configuration, quick).color,
        "slow": golden_picture(configuration, slow).color,
    }
    seen = []
    for scan in run.scans:
        names = [name for name, picture in whole.items() if (picture == scan.picture).all()]
        assert len(names) == 1 or scan is run.scans[0], f"torn scan at cycle {scan.cycle}"
        seen += names
    changes = [name for place, name in enumerate(seen) if place == 0 or seen[place - 1] != name]
    assert changes[-3:] == ["quick", "slow", "quick"]
    assert seen.count("quick") >= 1 + repeated[1]
