"""A processing element with its memory units as one component, in the shadow of a machine's."""

from functools import reduce
from operator import and_, or_

import pytest
from amaranth.hdl import Assert, Cat, Value
from amaranth.lib.wiring import In

from cardcage.hdl.machine import Machine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.fpga.domain import Domain
from cardcage.testbenches.support.machine_error import MachineError

CAGE = {"cards": "PMMPMM", "size": (16, 16), "memory_ports": 2}


class Shadowed(Machine):
    """A machine in which a ``Domain`` hears all that the first cards hear; whatever it says must
    be what they say, in every clock."""

    def elaborate(self, platform):
        m = super().elaborate(platform)
        m.submodules.shadow = shadow = Domain(configuration=self.configuration)
        element, first, last = self.cards[:3]
        assert len(shadow.units) == 2
        m.d.comb += shadow.total.eq(element.total)
        said = []
        for own, others, wired in (
            (shadow.left, [element.left], None),
            (shadow.right, [last.right], None),
            (shadow.broadcast, [element.broadcast], None),
            (shadow.scan, [first.scan, last.scan], or_),
            (shadow.pictures, [first.pictures, last.pictures], and_),
        ):
            for (_, member, line), *answers in zip(
                    *(list(end.signature.flatten(end)) for end in (own, *others)), strict=True):
                if member.flow == In:
                    m.d.comb += line.eq(answers[0][2])
                else:
                    said.append((line, reduce(wired, (Value.cast(answer)
                                                      for _, _, answer in answers))))
        ours, theirs = (Cat(Value.cast(value) for value in values)
                        for values in zip(*said, strict=True))
        m.d.sync += Assert(ours == theirs)
        return m


@pytest.fixture
def shadowed(monkeypatch, draw):
    """A function: a frame of a machine with a shadow."""
    monkeypatch.setattr("cardcage.testbenches.engines.pysim_engine.Machine", Shadowed)
    return lambda: draw(PysimEngine(), **CAGE)


def test_does_what_the_cards_of_a_machine_do(shadowed):
    report = shadowed()
    assert report.comparison.equal
    assert all(work.fragments > 20 for work in report.simulation.work)


@pytest.mark.parametrize("lines", ["scan", "pictures"])
def test_a_unit_that_hears_nothing_is_noticed(shadowed, monkeypatch, lines):
    connect = Domain._to_all_units

    def leave_out(self, m, name, wired):
        units = self.units
        self.units = units[:1] if name == lines else units
        connect(self, m, name, wired)
        self.units = units

    monkeypatch.setattr(Domain, "_to_all_units", leave_out)
    with pytest.raises(MachineError, match="Assertion violated"):
        shadowed()
