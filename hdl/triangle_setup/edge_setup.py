"""Start and step of a triangle's edges, each from one division by the edge's height."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..arithmetic.delay import delayed
from ..arithmetic.divider import Divider
from ..arithmetic.pipelined_multiplier import PipelinedMultiplier
from .sampling_grid import grid_layout

__all__ = ["EdgeSetup", "position_bits"]


def position_bits(configuration: MachineConfiguration) -> int:
    """Bits of a signed difference of a vertex coordinate and half a pixel of the machine, which is
    no larger than the screen, however coarse the picture."""
    return configuration.coordinate_bits + 1


class EdgeSetup(wiring.Component):
    """Edges in, one after the other; start and step of each out, as they are carried.

    With the vertex at (x, y) and its first sample line ``distance`` below, the column there is
    the quotient of n = ceil((x · height + distance · run) / unit) + height - 1 by the height
    (``golden.reference.triangle_setup``); carried is its middle, (2n + 1) / 2 height.  The halves
    of a rounding to nearest come with a bit more of the quotient: floor(v + 1/2) = (floor(2v) + 1)
    >> 1.

    Latency: ``latency`` clocks to an edge's start, less to its step.  Throughput: an edge every
    ``interval`` clocks; nothing stalls.

    Members
    -------
    grid: In(grid_layout)
    begin: In(1)
        Prepare the edge that is at the inputs.
    x: In(signed(position_bits))
        The edge's upper end, from the centre of the machine's first column.
    run: In(signed(coordinate_bits + 1))
        Columns from the upper to the lower end.
    height: In(edge_height_bits)
        Rows from the upper to the lower end; positive.
    distance: In(edge_height_bits)
        From the upper end down to the first sample line.
    start_done, step_done: Out(1)
        High for one clock with each result.
    start_result, step_result: Out(edge_word_bits)
        As ``golden.reference.triangle_setup.carry_edges`` gives them.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = c = configuration
        position, height = position_bits(c), c.edge_height_bits
        grid = grid_layout(c)
        # x by height, and run, which has as many bits as x, by distance.
        self._product = PipelinedMultiplier(a_bits=position, b_bits=height + 1, pairs=2)
        common = {"divisor_bits": height, "fraction_bits": c.edge_fraction_bits,
                  "quotient_bits": c.edge_word_bits + 1, "interval": c.setup_interval}
        self._start_divider = Divider(dividend_bits=position + height - c.sub_bits + 3, **common)
        self._step_divider = Divider(
            dividend_bits=c.coordinate_bits + 2 + (grid["y_shift"].width > 0), **common)
        super().__init__({
            "grid": In(grid),
            "begin": In(1),
            "x": In(signed(position)),
            "run": In(signed(c.coordinate_bits + 1)),
            "height": In(height),
            "distance": In(height),
            "start_done": Out(1),
            "step_done": Out(1),
            "start_result": Out(c.edge_word_bits),
            "step_result": Out(c.edge_word_bits),
        })

    @property
    def interval(self) -> int:
        """Clocks between two edges."""
        return max(self._start_divider.interval, self._step_divider.interval)

    @property
    def latency(self) -> int:
        """Clocks from an edge to its start: product, ceiling, dividend, division, rounding."""
        return self._product.latency + 2 + self._start_divider.latency + 1

    def elaborate(self, platform):
        m = Module()
        c = self.configuration
        m.submodules.product = product = self._product
        m.submodules.start_divider = start_divider = self._start_divider
        m.submodules.step_divider = step_divider = self._step_divider

        m.d.comb += [
            product.a[0].eq(self.x), product.b[0].eq(self.height),
            product.a[1].eq(self.run), product.b[1].eq(self.distance),
        ]
        raised = product.sum + (C(1 << c.sub_bits) << self.grid.x_shift) - 1
        ceiling = Signal((raised >> c.sub_bits).shape(), reset_less=True)
        dividend = Signal.like(start_divider.dividend, reset_less=True)
        height = delayed(m, self.height, product.latency + 1, "height")
        divisor = delayed(m, height, 1, "divisor")
        begun = delayed(m, self.begin, product.latency + 2, "begun", reset_less=False)
        # A row is as high as a column is wide, or twice that.
        finer = (self.grid.y_shift - self.grid.x_shift)[:1]
        m.d.sync += [
            ceiling.eq(raised >> c.sub_bits >> self.grid.x_shift),
            dividend.eq(Cat(C(1, 1), ceiling + height - 1).as_signed()),
        ]
        m.d.comb += [
            start_divider.start.eq(begun),
            start_divider.dividend.eq(dividend),
            start_divider.divisor.eq(divisor),
            step_divider.start.eq(self.begin),
            step_divider.dividend.eq((self.run << 1) << finer),
            step_divider.divisor.eq(self.height),
        ]
        for name, divider in (("start", start_divider), ("step", step_divider)):
            m.d.sync += [
                getattr(self, f"{name}_done").eq(divider.done),
                getattr(self, f"{name}_result").eq((divider.quotient + 1) >> 1),
            ]
        return m
