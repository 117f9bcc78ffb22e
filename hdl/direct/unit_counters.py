"""How many fragments went to each memory unit."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS, ResponseKind
from ..backplane.words import response_layout

__all__ = ["UnitCounters"]


class UnitCounters(wiring.Component):
    """Counts for each memory unit, and reports unit by unit ``TAKEN`` and ``FOLLOWED``.

    Latency: a clock from ``start`` to the first word.  Throughput: a word a clock.

    Parameters
    ----------
    units: int, positive
        How many there may be.

    Members
    -------
    clear: In(1)
        Count from the next clock on.
    taken, followed: In(units)
        In this clock a unit takes a fragment; a fragment followed closely on another one
        (``FragmentLines``).
    end: In(range(units + 1))
        How many units there are.
    start: In(1)
        Report, if there are any; only while not ``busy``, and nothing is counted.
    busy: Out(1)
        It has something to say.
    responses: Out(stream of response_layout)
        0 while not valid.

    Raises ``ValueError`` when ``units`` is not positive.
    """

    latency = 1

    def __init__(self, *, units: int):
        if units < 1:
            raise ValueError(f"units must be positive, not {units!r}")
        self.units = units
        super().__init__({
            "clear": In(1),
            "taken": In(units),
            "followed": In(units),
            "end": In(range(units + 1)),
            "start": In(1),
            "busy": Out(1),
            "responses": Out(stream.Signature(response_layout())),
        })

    def elaborate(self, platform):
        m = Module()
        unit = Signal(range(self.units))
        second = Signal()  # the turn of FOLLOWED
        response, value = self.responses.payload, Signal(RESPONSE_VALUE_BITS)
        with m.Switch(unit):
            for number in range(self.units):
                counts = [self._count(m, kind, number) for kind in ("taken", "followed")]
                with m.Case(number):
                    m.d.comb += value.eq(Mux(second, counts[1], counts[0]))
        m.d.comb += self.responses.valid.eq(self.busy)
        with m.If(self.busy):
            m.d.comb += [
                response.kind.eq(Mux(second, ResponseKind.FOLLOWED, ResponseKind.TAKEN)),
                response.value.eq(value),
            ]
            with m.If(self.responses.ready):
                m.d.sync += [second.eq(~second), unit.eq(unit + second)]
                with m.If(second & (unit + 1 == self.end)):
                    m.d.sync += self.busy.eq(0)
        with m.If(self.start):
            m.d.sync += [unit.eq(0), self.busy.eq(self.end != 0)]
        return m

    def _count(self, m, kind, number):
        count = Signal(RESPONSE_VALUE_BITS, name=f"{kind}_{number}")
        m.d.sync += count.eq(Mux(self.clear, 0, count + getattr(self, kind)[number]))
        return count
