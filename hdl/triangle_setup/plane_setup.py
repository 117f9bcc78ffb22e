"""Start and increments of an interpolant, from divisions by twice the triangle's area."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..arithmetic.delay import delayed
from ..arithmetic.divider import Divider
from ..arithmetic.pipelined_multiplier import PipelinedMultiplier
from .sampling_grid import grid_layout

__all__ = ["PlaneSetup", "Slot", "plane_division"]


class Slot:
    """What is computed of a plane, in this order; each takes a division."""

    STEP_X, STEP_Y, START = range(3)
    COUNT = 3


def slope_bits(configuration: MachineConfiguration, value_bits: int) -> int:
    """Bits of a signed slope: it is at most the area of the rectangle around the triangle in x
    (or y) and value."""
    return value_bits + configuration.coordinate_bits + 1


def plane_division(configuration: MachineConfiguration, *, value_bits: int,
                   word_bits: int) -> dict[str, int]:
    """The parameters of an interpolant's ``Divider``."""
    area_bits = 2 * configuration.coordinate_bits
    shift = max(picture.y_shift for picture in configuration.pictures())
    return {
        # The sum of three products, each below 2**(area and value), doubled; or a slope.
        "dividend_bits": max(area_bits + value_bits + 4, slope_bits(configuration, value_bits) + 1
                             + configuration.sub_bits + shift),
        "divisor_bits": area_bits,
        "fraction_bits": configuration.fraction_bits,
        "quotient_bits": word_bits + 1,
        "interval": configuration.setup_interval,
    }


class PlaneSetup(wiring.Component):
    """The plane through three vertex values, as it is carried, in three slots.

    Slot by slot, with the values' rises r clockwise from the upper vertex::

        slope    = r1 · factor_1 + r2 · factor_2        of x, of y, none
        product  = slope · offset                       for x, for y, area · upper value
        dividend = 2 · slope · unit                     for x, for y,
                   2 · sum of the products + area, odd  for the start

    so that the sum is ready when the third slot needs it, and two multipliers do for all.
    The dividends are those of ``golden.reference.triangle_setup``, over twice the area; the bit of
    the quotient that makes rounding to nearest of it is dropped here: floor(v + 1/2) = (floor(2v)
    + 1) >> 1.

    Latency: ``latency`` clocks.  Throughput: a slot every ``interval`` clocks; nothing stalls.

    Parameters
    ----------
    configuration: MachineConfiguration
    value_bits: int
        Bits of a vertex value.
    word_bits: int
        Bits of the carried words.

    Members
    -------
    grid: In(grid_layout)
    start: In(1)
        Prepare what is at the inputs.
    slot: In(2)
        One of ``Slot``, in turn.
    upper: In(value_bits)
        The upper vertex's value.
    first, second: In(signed(value_bits + 1))
        The rises from there to the two others, clockwise.
    factor_1, factor_2: In(signed(coordinate_bits + 1))
        What the rises are multiplied with in this slot.
    offset: In(signed(coordinate_bits + 1))
        From the upper vertex to the corner's centre, in x or in y.
    double_area: In(2 * coordinate_bits)
        Positive.
    done: Out(1)
        High for one clock with each result.
    result: Out(word_bits)
        As ``golden.reference.triangle_setup.Planes`` has it, modulo 2**word_bits.
    """

    def __init__(self, *, configuration: MachineConfiguration, value_bits: int, word_bits: int):
        for name, bits in (("value_bits", value_bits), ("word_bits", word_bits)):
            if bits < 1:
                raise ValueError(f"{name} must be positive, not {bits}")
        self.configuration = c = configuration
        self.value_bits = value_bits
        self.word_bits = word_bits
        grid = grid_layout(c)
        difference = c.coordinate_bits + 1
        self._area_bits = 2 * c.coordinate_bits
        self._slope_bits = slope_bits(c, value_bits)
        self._slope = PipelinedMultiplier(a_bits=value_bits + 1, b_bits=difference, pairs=2)
        self._product = PipelinedMultiplier(a_bits=max(self._slope_bits, self._area_bits + 1),
                                            b_bits=max(difference, value_bits + 1))
        self._divider = Divider(**plane_division(c, value_bits=value_bits, word_bits=word_bits))
        super().__init__({
            "grid": In(grid),
            "start": In(1),
            "slot": In(range(Slot.COUNT)),
            "upper": In(value_bits),
            "first": In(signed(value_bits + 1)),
            "second": In(signed(value_bits + 1)),
            "factor_1": In(signed(difference)),
            "factor_2": In(signed(difference)),
            "offset": In(signed(difference)),
            "double_area": In(self._area_bits),
            "done": Out(1),
            "result": Out(word_bits),
        })

    @property
    def interval(self) -> int:
        """Clocks between two slots."""
        return self._divider.interval

    @property
    def latency(self) -> int:
        """Clocks from a slot to its result: slope, product, sum, dividend, division, rounding."""
        return self._slope.latency + self._product.latency + 2 + self._divider.latency + 1

    def elaborate(self, platform):
        m = Module()
        m.submodules.slope = slope = self._slope
        m.submodules.product = product = self._product
        m.submodules.divider = divider = self._divider

        # Clocks from the inputs to each; the sum comes a clock after the product.
        at_slope = slope.latency
        at_product = at_slope + product.latency
        at_dividend = at_product + 2

        slot, started = [self.slot], [self.start]
        for clock in range(at_dividend):
            slot.append(delayed(m, slot[-1], 1, f"slot_{clock}"))
            started.append(delayed(m, started[-1], 1, f"started_{clock}", reset_less=False))

        m.d.comb += [
            slope.a[0].eq(self.first), slope.b[0].eq(self.factor_1),
            slope.a[1].eq(self.second), slope.b[1].eq(self.factor_2),
        ]
        steep = Signal(signed(self._slope_bits))
        m.d.comb += steep.eq(slope.sum)
        area = delayed(m, self.double_area, at_slope, "early_double_area")
        upper = delayed(m, self.upper, at_slope, "early_upper")
        offset = delayed(m, self.offset, at_slope, "early_offset")
        last = slot[at_slope] == Slot.START
        m.d.comb += [
            product.a[0].eq(Mux(last, area, steep)),
            product.b[0].eq(Mux(last, upper, offset)),
        ]

        total = Signal(signed(self._area_bits + self.value_bits + 3), reset_less=True)
        with m.If(started[at_product]):
            m.d.sync += total.eq(product.sum + Mux(slot[at_product] == Slot.STEP_X, 0, total))
        area = delayed(m, area, product.latency + 1, "area")
        steep = delayed(m, steep, product.latency + 1, "late_slope")
        sub_bits, grid = self.configuration.sub_bits, self.grid
        wide = steep.shift_left(sub_bits + 1)
        dividend = Signal.like(divider.dividend, reset_less=True)
        divisor = Signal.like(divider.divisor, reset_less=True)
        m.d.sync += divisor.eq(area)
        with m.Switch(slot[at_product + 1]):
            with m.Case(Slot.STEP_X):
                m.d.sync += dividend.eq(wide << grid.x_shift)
            with m.Case(Slot.STEP_Y):
                m.d.sync += dividend.eq(wide << grid.y_shift)
            with m.Default():
                # 2 · floor(area / 2) + 1: the bias of half a step, as in
                # golden.reference.triangle_setup.
                m.d.sync += dividend.eq(total.shift_left(1) + Cat(C(1, 1), area[1:]))

        m.d.comb += [
            divider.start.eq(started[at_dividend]),
            divider.dividend.eq(dividend),
            divider.divisor.eq(divisor),
        ]
        m.d.sync += [self.done.eq(divider.done), self.result.eq((divider.quotient + 1) >> 1)]
        return m
