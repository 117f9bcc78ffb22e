"""A cage in software around a controller that deals regions out."""

import numpy as np

from cardcage.golden.organisations.region_table import slots_of
from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.controller.central_broadcast_controller import CentralBroadcastController

from .bench import Drive, simulate
from .cage import Cage, Run, Scans, Units
from .pictures import small_machine
from .region_tables import RegionLinesWatch
from .streams import Sink, Source, no_pause, pauses

MACHINES = {
    "three": ("3x(PMM)", (4, 2), {}),
    "four, full": ("4x(PM)", (2, 4), {"slots": 2}),
    "one slot": ("6x(PM)", (2, 3), {"slots": 1, "height": 12}),
    "a row": ("2x(PMM)", (4, 1), {"height": 2}),
    "a column": ("3x(PM)", (1, 4), {"width": 2}),
    "one element": ("PMM", (3, 3), {"width": 11, "height": 9}),
    "one region": ("2x(PMM)", (1, 1), {}),
}


def machine(name, **changes):
    cards, regions, fields = MACHINES[name]
    cards = changes.pop("cards", cards)
    return small_machine(cards, regions=regions, **{"width": 8, "height": 8} | fields | changes)


class RegionCage(Cage):
    """Answers ``READ_REGIONS`` with what ``counts`` gives for all slots."""

    def __init__(self, dut, *, counts=range, **options):
        super().__init__(dut, **options)
        self.slots = dut.configuration.slots
        self.counts = counts

    def answer(self, operation):
        if operation == Operation.READ_REGIONS:
            return [(ResponseKind.REGION_COUNT, count)
                    for count in self.counts(len(self.domains) * self.slots)]
        return super().answer(operation)


class RegionRun(Run):
    """As ``Run``, with the region lines watched."""

    def __init__(self, configuration, words, responses, *, elements=None, seed=None, work=0,
                 period=50, depth=20, counts=range):
        self.dut = dut = CentralBroadcastController(configuration=configuration)
        share = 1 << configuration.share_bits
        elements = configuration.processing_elements if elements is None else elements
        pause = (lambda end: no_pause) if seed is None else (lambda end: pauses(f"{end} {seed}"))
        self.source = Source(dut.commands, words, pause("in"))
        self.sink = Sink(dut.responses, responses, pause("out"))
        self.cage = RegionCage(dut, domains=[(number * share, share) for number in range(elements)],
                               seed=seed, work=work, counts=counts)
        self.scans = Scans(dut, period)
        self.units = Units(dut, depth)
        self.lines = RegionLinesWatch(dut, configuration)
        simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, elements * share)), self.source,
                 self.sink, self.cage, self.scans, self.units, self.lines, after=10, limit=60_000)
        self.booted = elements + 3

    @property
    def answers(self):
        return self.responses[self.booted:]


def placed(table):
    """Each region's processing element and slot."""
    table = np.asarray(table)
    return tuple(zip(table.tolist(), slots_of(table).tolist(), strict=True))
