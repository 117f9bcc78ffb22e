"""What the scan leaves to a lane, counted clock by clock."""

import numpy as np
import pytest

from cardcage.golden.cycles.one_port.free_clocks import FreeClocks
from cardcage.golden.cycles.one_port.scan_reads import lane_slots, scan_shares, shown_scan_shares
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.configuration import MachineConfiguration

#: A unit for all pixels; units that alternate; a coarser picture; squares; regions.
MACHINES = {
    "one": MachineConfiguration("PM", 7, 5),
    "two in lines": MachineConfiguration("PMM", 8, 6, clocks_per_pixel=2),
    "four, coarser": MachineConfiguration("PMMPMM", 16, 12, words=12, clocks_per_pixel=3),
    "squares": MachineConfiguration("2x(PMM)", 9, 7, block=4, clocks_per_pixel=2),
    "regions": MachineConfiguration("3x(PM)", 24, 16, regions=(3, 4), clocks_per_pixel=2),
}


def reads(organisation, element, lane):
    """bool: clock by clock of a scan whether the lane is read, from its first line on; pixel by
    pixel as the picture is shown."""
    configuration, resolution = organisation.configuration, organisation.resolution
    timing, pace = configuration.timing, configuration.clocks_per_pixel
    found = np.zeros(configuration.cycles_per_scan, bool)
    _, first, units = organisation.domains[element]
    two = max(domain.units for domain in organisation.domains) > 1
    for line in range(timing.vertical_active):
        y, last = line >> resolution.y_shift, None
        for column in range(resolution.width):
            if column % organisation.scan_group:
                continue
            place = line * timing.horizontal_total + (column << resolution.x_shift)
            for x in range(column, min(column + organisation.scan_group, resolution.width)):
                unit = int(organisation.unit(x, y))
                if first <= unit < first + units and (not two or unit % 2 == lane):
                    found[place * pace] = lane == 0 or two
            last = place
        assert last is not None
    return found


@pytest.mark.parametrize("name", MACHINES)
def test_clock_by_clock(name):
    """From anywhere in a scan, for any amount of work, over the end of the scan and many."""
    organisation = organisation_of(MACHINES[name])
    slots = lane_slots(organisation)
    pick = np.random.default_rng(5)
    for element in range(len(organisation.domains)):
        for lane in range(2):
            free = ~np.tile(reads(organisation, element, lane), 3)
            counted = np.pad(free.cumsum(), (1, 0))
            for begin in pick.integers(0, len(free) // 3, 4).tolist():
                clocks = FreeClocks(organisation, slots[:, :, element, lane], begin)
                for clock in pick.integers(0, len(free) // 3, 8).tolist():
                    passed = counted[begin + clock] - counted[begin]
                    assert clocks.before(clock) == passed
                    work = int(pick.integers(1, len(free) // 3))
                    after = clocks.after(clock, work)
                    # The last of them is the clock before.
                    assert clocks.before(after) == passed + work
                    assert clocks.before(after - 1) == passed + work - 1
                    assert clocks.after(clock, work - 0.5) == after - 0.5


@pytest.mark.parametrize("name", MACHINES)
def test_on_average_it_is_the_share(name):
    organisation = organisation_of(MACHINES[name])
    slots, shares = lane_slots(organisation), shown_scan_shares(organisation)
    assert slots.shape[::2] == shares.shape[::2] or len(slots) == len(shares)
    wide = slots.mean(axis=1) / (MACHINES[name].clocks_per_pixel
                                 << organisation.resolution.x_shift)
    np.testing.assert_allclose(wide.sum(), shares.sum(), rtol=0.15)
    assert (scan_shares(organisation) <= shares).all()
