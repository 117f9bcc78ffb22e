"""Depth and colour at each pixel of a triangle."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS, COLOR_BITS
from ..arithmetic.delay import delayed
from ..arithmetic.limb_products import limb_products, side_by_side
from ..arithmetic.narrowing import floor_shift, saturate, to_signed
from ..backplane.connectors import memory_bus_bits
from ..backplane.words import planes_layout
from ..mapping.interlace import PixelAddress
from ..mapping.region_address import RegionAddress
from .fragment_stepper import pixel_layout

__all__ = ["Interpolator", "fragment_layout"]


def fragment_layout(*, id_bits: int, address_bits: int, depth_bits: int) -> data.StructLayout:
    """One pixel of one primitive, as it meets the memory; widths as those of the ``MemoryBus``."""
    return data.StructLayout({
        "unit": id_bits,
        "address": address_bits,
        "depth": depth_bits,
        "color": COLOR_BITS,
    })


class Interpolator(wiring.Component):
    """start + x_steps · step_x + y_steps · step_y, modulo the carried width.

    Nothing is carried from pixel to pixel: multipliers, of which an FPGA has more
    than of anything else, take the place of an adder along the row, of the choice
    between a row's first value and the next one, and of strides.  So the value
    does not depend on which lattice is walked.

    The value is floored.  Where precision is so low that it may leave the range of
    the vertices' (``MachineConfiguration.stays_in_range``), it is read as signed and
    saturated: depth to the greatest a vertex may have, so that every fragment is
    nearer than the background, channels to their eight bits.

    Latency: ``latency`` clocks (products, sums two by two, floor).  Throughput: a
    fragment a clock.  All stages move together.

    Members
    -------
    total: In(id_bits)
        Number of memory units; where regions are dealt out, ``element: In(element_bits)`` instead,
        the processing element's number.
    pixels: In(stream of pixel_layout)
        Those with ``none`` go no further.
    planes: In(stream of planes_layout)
        The interpolants of the triangle whose pixels come; taken with its last pixel.  They
        must be there before its pixels.
    fragments: Out(stream of fragment_layout)
    busy: Out(1)
        Holds a pixel.
    node: In(node_order_bits)
        The processing element's, only where pixels keep it.

    Fuchs & Johnson, after figure 13: the controller computes the increments, the
    processing elements only apply them.
    """

    latency = 5

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            **({"total": In(configuration.id_bits)} if configuration.regions is None
               else {"element": In(configuration.element_bits)}),
            "pixels": In(stream.Signature(pixel_layout(configuration))),
            "planes": In(stream.Signature(planes_layout(configuration))),
            "fragments": Out(stream.Signature(
                fragment_layout(**memory_bus_bits(configuration)))),
            "busy": Out(1),
            **({"node": In(configuration.node_order_bits)} if self._keeps_node else {}),
        })

    @property
    def _keeps_node(self):
        """The node is the lowest part of a pixel's order."""
        return bool(self.configuration.order_bits and self.configuration.node_order_bits)

    def elaborate(self, platform):
        m = Module()
        configuration = self.configuration
        pixel, planes, fragment = self.pixels.payload, self.planes.payload, self.fragments.payload
        stages = Signal(self.latency)
        move = Signal()
        m.d.comb += [
            move.eq(~self.fragments.valid | self.fragments.ready),
            self.pixels.ready.eq(move),
            self.planes.ready.eq(move & self.pixels.valid & pixel.last),
            self.fragments.valid.eq(stages[-1]),
            self.busy.eq(stages.any()),
        ]
        with m.If(move):
            m.d.sync += stages.eq(Cat(self.pixels.valid & ~pixel.none, stages))

        dealt = configuration.regions is not None
        m.submodules.address = address = (RegionAddress if dealt else PixelAddress)(
            configuration=configuration)
        sums = self.latency - 1
        m.d.comb += [
            address.element.eq(self.element) if dealt else address.total.eq(self.total),
            address.x.eq(delayed(m, pixel.x, sums, "x", enable=move)),
            address.y.eq(delayed(m, pixel.y, sums, "y", enable=move)),
        ]
        if dealt:
            m.d.comb += address.slot.eq(delayed(m, pixel.slot, sums, "slot", enable=move))
        depth = self._floored(self._value(m, planes.depth, pixel, move, "depth"),
                              configuration.depth_bits, configuration.depth_background - 1)
        if configuration.shading == "flat":
            color = [delayed(m, planes[name], sums, name, enable=move)
                     for name in commands.CHANNELS]
        else:
            color = [self._floored(self._value(m, planes[name], pixel, move, name),
                                   CHANNEL_BITS, (1 << CHANNEL_BITS) - 1)
                     for name in commands.CHANNELS]
        with m.If(move):
            m.d.sync += [
                fragment.unit.eq(address.unit),
                fragment.address.eq(address.address),
                fragment.depth.eq(self._rank(m, depth, planes, sums, move)),
                fragment.color.eq(Cat(color)),
            ]
        return m

    def _rank(self, m, depth, planes, moves, move):
        """Depth, and below it the order, where pixels keep one."""
        order = []
        if self._keeps_node:
            order.append(self.node)
        if self.configuration.round_bits:
            order.append(delayed(m, planes.round, moves, "round", enable=move))
        return Cat(*order, depth) if order else depth

    def _value(self, m, plane, pixel, move, name):
        """The interpolant at the pixel, four moves later: products, then sums of two numbers."""
        along = limb_products(m, plane.step_x, pixel.x_steps, advance=move, name=f"{name}_x")
        down = limb_products(m, plane.step_y, pixel.y_steps, advance=move, name=f"{name}_y")
        limbs = [delayed(m, x + y, 1, f"{name}_limb_{number}", enable=move)
                 for number, (x, y) in enumerate(zip(along, down, strict=True))]
        words = side_by_side(limbs)
        bits = len(plane.start)
        steps = delayed(m, sum(words[1:], words[0])[:bits], 1, f"{name}_steps", enable=move)
        start = delayed(m, plane.start, self.latency - 2, f"{name}_start", enable=move)
        return delayed(m, (start + steps)[:bits], 1, f"{name}_value", enable=move)

    def _floored(self, carried, value_bits, high):
        fraction_bits = self.configuration.fraction_bits
        if self.configuration.stays_in_range:
            return floor_shift(carried, fraction_bits)[:value_bits]
        whole = floor_shift(to_signed(carried, len(carried)), fraction_bits)
        return saturate(whole, 0, high)[:value_bits]
