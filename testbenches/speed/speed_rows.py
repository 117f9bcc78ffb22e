"""Cases on machines: measured in simulation, predicted by the cycle model, beside the peers."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from ...golden.balancing.region_counts import utilisation
from ...golden.cycles.cycle_model import CyclePrediction, predict_cycles
from ...golden.cycles.one_port.scan_reads import clocks_per_row, scan_shares
from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.configuration import RANGES, MachineConfiguration
from ..engines.engine import Engine
from ..frames.region_figures import RegionTables
from ..frames.setup_timing import setup_timing
from ..machine_options import MachineOptions
from .cases import AS_IT_IS, CaseLists, Order, case_lists
from .machines import BenchMachine
from .measure import Measurement, measure, packed_tables

#: Cases that share a simulation: more save boots, and keep more depths at once.
_TOGETHER = 4

#: What binds a machine that more triangles waiting would make faster, by so much at least.
QUEUE = "queue"
_QUEUE_HELPS = 1.05

#: A list that one-port units bound takes the scan of so many rows at least, and two of the periods
#: in which it is with each unit.
_LEAST_ROWS = 16


@dataclass(frozen=True)
class BenchRow:
    """One case on one machine.

    ``measured``            None where only the model was asked
    ``predicted``           T(2n) - T(n) by the cycle model
    ``bound``               T(2n) - T(n) at the bounds of both: ``CyclePrediction.bounds``
    ``binding``             which of those it is, of 2n; or ``QUEUE``, where more places in that
                            would help
    ``prediction_seconds``  what the cycle model took
    ``region_utilisation``  of what is counted of the regions in 3n, by golden; None without regions
    """

    machine: BenchMachine
    case: str
    order: Order
    triangles: int
    measured: Measurement | None
    predicted: float
    bound: float
    binding: str
    prediction_seconds: float
    region_utilisation: float | None = None

    @property
    def cycles(self) -> float:
        """Sustained cycles for n triangles: measured where they were, else predicted."""
        return self.predicted if self.measured is None else self.measured.sustained_cycles

    @property
    def prediction_error(self) -> float | None:
        """Relative to the measured cycles."""
        if self.measured is None:
            return None
        return self.predicted / self.measured.sustained_cycles - 1

    @property
    def key(self) -> str:
        """What names this row in a baseline."""
        return f"{self.machine.label}; {self.case}; {self.order}"


def bench(machines: Sequence[BenchMachine], cases: Sequence[str], orders: Sequence[Order],
          engine: Engine | None, step: Callable[[str], None] = lambda doing: None,
          looking: MachineOptions = AS_IT_IS) -> Iterator[BenchRow]:
    """Every case in every order on every machine; by the model alone where ``engine`` is None.

    ``step`` is told what comes next; ``looking`` says how a mesh is looked at.  Raises what
    ``case_lists`` and ``measure.measure`` raise.
    """
    shortest = [case_lists(case, order, looking=looking) for order in orders for case in cases]
    for machine in machines:
        for begin in range(0, len(shortest), _TOGETHER):
            some = shortest[begin:begin + _TOGETHER]
            names = ", ".join(case.name for case in some)
            step(f"{machine.label}: {names}")
            predicted = [_predicted(machine, case) for case in some]
            measured: Sequence[Measurement | None] = [None] * len(some)
            if engine is not None:
                measured = measure(machine.configuration, [case for case, _ in predicted], engine)
            for (_, row), measurement in zip(predicted, measured, strict=True):
                yield replace(row, measured=measurement)


def steps(machines: Sequence[BenchMachine], cases: Sequence[str], orders: Sequence[Order]) -> int:
    """How often ``bench`` tells what comes next."""
    return len(machines) * -(-len(cases) * len(orders) // _TOGETHER)


def _times(configuration: MachineConfiguration, prediction: CyclePrediction) -> int:
    """How often the list must be repeated, so that every unit is scanned about as often."""
    if prediction.binding != "busiest port":
        return 1
    rows = max(_LEAST_ROWS, 2 * len(scan_shares(organisation_of(configuration))))
    return math.ceil(rows * clocks_per_row(configuration) / prediction.bound)


def _predicted(machine: BenchMachine, case: CaseLists) -> tuple[CaseLists, BenchRow]:
    """``case``, longer where it must be, and what the model says of that."""
    configuration = machine.configuration
    began = time.perf_counter()
    tables = packed_tables(configuration, case)
    once = _once(configuration, case, tables)
    if (times := _times(configuration, once)) > 1:
        case = case.repeated(times)
        tables = packed_tables(configuration, case)
        once = _once(configuration, case, tables)
    twice = _twice(configuration, case, tables)
    predicted, bound, binding = twice.cycles - once.cycles, twice.bound - once.bound, twice.binding
    if predicted > _QUEUE_HELPS * bound:
        patient = replace(configuration, fifo_depth=RANGES["fifo_depth"][1])
        waiting = (_twice(patient, case, tables).cycles - _once(patient, case, tables).cycles)
        binding = QUEUE if predicted > _QUEUE_HELPS * waiting else binding
    return case, BenchRow(
        machine, case.title, case.order, case.once.triangles, measured=None, predicted=predicted,
        bound=bound, binding=binding, prediction_seconds=time.perf_counter() - began,
        region_utilisation=None if tables is None else utilisation(
            tables.counts(1), tables.table(1), configuration.processing_elements))


def _once(configuration: MachineConfiguration, case: CaseLists,
          tables: RegionTables | None) -> CyclePrediction:
    return predict_cycles(configuration, case.once, setup=setup_timing(configuration),
                          table=None if tables is None else tables.table(1))


def _twice(configuration: MachineConfiguration, case: CaseLists,
           tables: RegionTables | None) -> CyclePrediction:
    return predict_cycles(configuration, case.twice, after=case.once,
                          setup=setup_timing(configuration),
                          table=None if tables is None else tables.table(1))
