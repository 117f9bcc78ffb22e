"""Exact ways to carry depth along spans, and spans to compare them on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import floor
from typing import Any

import numpy as np
from amaranth.hdl import Module, Signal, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from cardcage.golden.precision.worst_case_search import biased_value
from cardcage.golden.reference import exact
from cardcage.golden.reference.coverage import Triangles, spans
from cardcage.golden.reference.triangle_setup import prepare
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.fixed_point import exact_fraction_bits
from cardcage.golden.specification.sampling_grid import Grid
from cardcage.hdl.backplane.words import planes_layout, span_layout
from cardcage.hdl.rasteriser.fragment_stepper import FragmentStepper
from cardcage.hdl.rasteriser.interpolator import Interpolator

from .remainder_interpolator import PipelinedRemainderInterpolator, RemainderInterpolator

_SPAN_FIELDS = ("x", "end", "left", "y_steps", "stride")


class FixedPointInterpolator(wiring.Component):
    """Depth alone of the machine's own parts: spans in, the value of every pixel out.

    Latency and throughput are those of ``FragmentStepper`` and ``Interpolator``.

    Members
    -------
    spans: In(stream of a struct)
        ``plane``, and ``x``, ``end``, ``left``, ``y_steps``, ``stride`` as in ``span_layout``.
    values: Out(stream of unsigned(depth_bits))
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        members = span_layout(configuration).members
        super().__init__({
            "spans": In(stream.Signature(data.StructLayout({
                "plane": planes_layout(configuration).members["depth"],
                **{name: members[name] for name in _SPAN_FIELDS},
            }))),
            "values": Out(stream.Signature(unsigned(configuration.depth_bits))),
        })

    def elaborate(self, platform: Any) -> Module:
        m = Module()
        m.submodules.stepper = stepper = FragmentStepper(configuration=self.configuration)
        m.submodules.interpolator = interpolator = Interpolator(configuration=self.configuration)
        wiring.connect(m, stepper.pixels, interpolator.pixels)
        span, given = stepper.spans.payload, self.spans.payload
        # Each span is a triangle of its own, whose plane goes along with its pixels.
        held, plane = (Signal(given.plane.shape(), name=name) for name in ("held", "plane"))
        with m.If(stepper.spans.ready):
            m.d.sync += held.eq(given.plane)
        with m.If(~stepper.pixels.valid | stepper.pixels.ready):
            m.d.sync += plane.eq(held)
        m.d.comb += [
            span.last.eq(1),
            *(span[name].eq(given[name]) for name in _SPAN_FIELDS),
            stepper.spans.valid.eq(self.spans.valid),
            self.spans.ready.eq(stepper.spans.ready),
            interpolator.planes.payload.depth.eq(plane),
            interpolator.planes.valid.eq(1),
            self.values.payload.eq(interpolator.fragments.payload.depth),
            self.values.valid.eq(interpolator.fragments.valid),
            interpolator.fragments.ready.eq(self.values.ready),
        ]
        return m


@dataclass(frozen=True)
class Runs:
    """Runs of pixels, at strides of 1, 2 and 4, and the exact depth of each pixel in order.

    Each of these arrays has a number for each run:

    ``primitive``    its triangle
    ``x``, ``y``     its first pixel
    ``more``         pixels after that
    ``stride_bits``  log2 of the distance between neighbouring pixels
    """

    primitive: list[int]
    x: list[int]
    y: list[int]
    more: list[int]
    stride_bits: list[int]
    depth: list[int]

    @classmethod
    def of(cls, display_list: DisplayList, count: int, longest: int = 12) -> Runs:
        """``count`` spans of the list, evenly chosen; of each at most ``longest`` pixels."""
        triangles = Triangles.of(display_list, Grid.of(display_list))
        every = next(spans(triangles, row_limit=1 << 20))
        chosen = np.linspace(0, len(every) - 1, count).astype(int)
        stride_bits = np.arange(count) % 3
        pixels = np.minimum(-(-every.length[chosen] >> stride_bits), longest)
        primitive, x, y = (part[chosen].tolist() for part in (
            triangles.primitive[every.triangle], every.first, every.row))
        known = exact.fragments(display_list)
        depth = dict(zip(zip(known.primitive.tolist(), known.x.tolist(), known.y.tolist(),
                             strict=True), known.depth.tolist(), strict=True))
        runs = zip(primitive, x, y, pixels.tolist(), stride_bits.tolist(), strict=True)
        return cls(primitive, x, y, (pixels - 1).tolist(), stride_bits.tolist(),
                   [depth[triangle, column + (step << stride), row]
                    for triangle, column, row, length, stride in runs for step in range(length)])


@dataclass(frozen=True)
class Form:
    """One way to carry depth: makes a component with ``spans`` and ``values``; its spans."""

    name: str
    component: Callable[[], wiring.Component]
    spans: list[dict[str, Any]]


def _remainder_planes(display_list: DisplayList, primitive: int, left: int, top: int
                      ) -> dict[str, Any]:
    """Start at the centre of (left, top) and increments of a triangle, as multiples of 1 / D."""
    corners = display_list.position[primitive].tolist()
    values = display_list.depth[primitive].tolist()
    (x0, y0), (x1, y1), (x2, y2) = corners
    area: int = abs((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    unit = 1 << display_list.sub_bits

    def multiple(right: int, down: int) -> Fraction:
        return area * biased_value(corners, values, (left + right) * unit + unit // 2,
                                   (top + down) * unit + unit // 2)

    start = multiple(0, 0)
    return {"denominator": area, **{
        name: {"quotient": floor(number) // area % (1 << display_list.depth_bits),
               "remainder": floor(number) % area}
        for name, number in (("start", start), ("step_x", multiple(1, 0) - start),
                             ("step_y", multiple(0, 1) - start))}}


def forms(display_list: DisplayList, runs: Runs, *, units: int, double_area: int) -> list[Form]:
    """All forms, exact for every triangle of the screen up to ``double_area``.

    ``units`` of memory decide how long a stride may be.
    """
    fraction_bits = exact_fraction_bits(double_area, display_list.width + display_list.height - 2)
    configuration = MachineConfiguration(
        cards="P" + "M" * units, width=display_list.width, height=display_list.height,
        sub_bits=display_list.sub_bits, depth_bits=display_list.depth_bits,
        fraction_bits=fraction_bits, shading="flat")
    prepared = prepare(display_list, fraction_bits=fraction_bits, shading="flat")
    row_of = {primitive: row for row, primitive in enumerate(prepared.primitive.tolist())}
    fixed_spans, remainder_spans = [], []
    for primitive, x, y, more, stride_bits in zip(runs.primitive, runs.x, runs.y, runs.more,
                                                  runs.stride_bits, strict=True):
        row = row_of[primitive]
        left, top = int(prepared.left[row]), int(prepared.top[row])
        fixed_spans.append({
            "x": x, "end": x + (more << stride_bits) + 1, "left": left, "y_steps": y - top,
            "stride": 1 << stride_bits, "plane": {
                part: getattr(prepared.depth, part)[row] % (1 << configuration.depth_plane_bits)
                for part in ("start", "step_x", "step_y")}})
        remainder_spans.append({
            "x_steps": x - left, "y_steps": y - top, "more": more, "x_stride_bits": stride_bits,
            **_remainder_planes(display_list, primitive, left, top)})
    return [
        Form(f"fixed point, F = {fraction_bits}",
             lambda: FixedPointInterpolator(configuration=configuration), fixed_spans),
        *(Form(name, partial(component, value_bits=display_list.depth_bits,
                             area_bits=double_area.bit_length(),
                             steps_bits=max(configuration.x_bits, configuration.y_bits),
                             stride_bits_bits=units.bit_length().bit_length()), remainder_spans)
          for name, component in (("remainder, pipelined", PipelinedRemainderInterpolator),
                                  ("remainder, digit by digit", RemainderInterpolator))),
    ]
