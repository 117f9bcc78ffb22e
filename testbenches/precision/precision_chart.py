"""Speed against error as a plot: our machine's precisions and what others reach."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..reports.page import chart_style, svg_element
from ..speed.cases import Peer, peers
from .scene_precision import Precision, PrecisionRow

OWN_COLOR = "#3b82c4"
PEER_COLOR = "#d98a2b"
FLOAT_COLOR = "#8a5fb0"

#: The case of ``speed.cases`` that the peers are shown at, how many fragments its triangle has,
#: and the depth bits of their errors, which is also what errors are shown in.
PEER_CASE = "right_TL_512"
PEER_FRAGMENTS = 130_816
PEER_DEPTH_BITS = 16

_WAITING = "needs clock rates: --place-and-route"


@dataclass(frozen=True)
class SpeedPoint:
    """``error`` in LSB of ``PEER_DEPTH_BITS``; ``speed`` in the panel's unit."""

    label: str
    error: float
    speed: float


def pareto_front(points: Sequence[SpeedPoint]) -> list[SpeedPoint]:
    """The points than which none is both faster and better (and in one of these strictly), by
    error."""
    front = [point for point in points if not any(
        other.error <= point.error and other.speed >= point.speed
        and (other.error, other.speed) != (point.error, point.speed) for other in points)]
    return sorted(front, key=lambda point: (point.error, point.speed))


def precision_svg(precision: Precision) -> str:
    """The plot as an element of a page."""
    with chart_style():
        return svg_element(_figure(precision), "Speed of a processing element against its "
                           "greatest depth error, and the errors of the sweep")


def save_precision_png(precision: Precision, path: Path) -> None:
    _figure(precision).savefig(path, dpi=110, metadata={"Software": None})


def own_points(precision: Precision, panel: str) -> list[SpeedPoint]:
    """The rows of which the panel's speed is known: ``clock`` or ``second``."""
    speed = {"clock": precision.fragments_per_clock,
             "second": precision.megafragments_per_second}[panel]
    scale = 2.0 ** (PEER_DEPTH_BITS - precision.scene.display_list.depth_bits)
    return [SpeedPoint(_label(precision, row), row.point.error.depth_maximum * scale, rate)
            for row in precision.rows if (rate := speed(row)) is not None]


def measured_peers() -> list[tuple[Peer, float]]:
    """The peers whose error is known, and their fragments a clock."""
    return [(peer, PEER_FRAGMENTS / peer.cycles_per_triangle[PEER_CASE]) for peer in peers()
            if peer.depth_error_lsb is not None]


def peer_points(panel: str) -> list[SpeedPoint]:
    """The peers whose speed is known in the panel's unit, at the worst error found."""
    points = []
    for peer, rate in measured_peers():
        if panel == "second":
            if peer.ecp5_mhz is None:
                continue
            rate *= sum(peer.ecp5_mhz) / len(peer.ecp5_mhz)
        points.append(SpeedPoint(peer.short, max(peer.depth_error_lsb or [0.0]), rate))
    return points


def _label(precision: Precision, row: PrecisionRow) -> str:
    bits = row.point.fraction_bits
    return "exact" if bits == precision.machine.fraction_bits else f"{bits}"


def _figure(precision: Precision) -> Figure:
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    errors, clock, second = figure.subplots(1, 3)
    _sweep(errors, precision)
    _speeds(clock, precision, "clock", "fragments / clock / processing element")
    _speeds(second, precision, "second", "Mfragments / s / processing element")
    return figure


def _sweep(axes: Axes, precision: Precision) -> None:
    bits = [row.point.fraction_bits for row in precision.rows]
    points = [row.point for row in precision.rows]
    axes.plot(bits, [point.bound for point in points], color="#999999", linestyle="--",
              label="bound")
    axes.plot(bits, [point.error.depth_maximum for point in points], color=OWN_COLOR, marker="o",
              markersize=4, label="depth, greatest")
    axes.plot(bits, [point.error.depth_mean for point in points], color=OWN_COLOR, alpha=0.5,
              label="depth, mean")
    axes.plot(bits, [point.error.wrong_pixels for point in points], color="#b3261e", marker="x",
              markersize=4, label="wrong pixels")
    axes.axhline(precision.float32.error.depth_maximum, color=FLOAT_COLOR, linestyle=":",
                 label="float32 Z-buffer, greatest")
    axes.set_yscale("symlog", linthresh=0.1)
    axes.set_ylim(bottom=0)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("fraction bits")
    axes.set_ylabel(f"LSB of {precision.scene.display_list.depth_bits} depth bits; pixels")
    axes.legend(fontsize=8, frameon=False)
    _bare(axes)


def _speeds(axes: Axes, precision: Precision, panel: str, label: str) -> None:
    own, others = own_points(precision, panel), peer_points(panel)
    # A symmetric logarithm has a place for 0, where exact is; it begins at the least decade.
    errors = [1.0, *(point.error for point in own + others if point.error > 0)]
    decades = range(floor(log10(min(errors))), floor(log10(max(errors))) + 2)
    axes.set_xscale("symlog", linthresh=10.0 ** decades[0])
    axes.set_xlim(-0.3 * 10.0 ** decades[0], 10.0 ** decades[-1])
    front = pareto_front(own)
    axes.plot([point.error for point in front], [point.speed for point in front],
              color=OWN_COLOR, linewidth=1, zorder=1)
    axes.scatter([point.error for point in own], [point.speed for point in own], s=22,
                 color=OWN_COLOR, zorder=2, label="ours, by fraction bits; line: Pareto front")
    for place, labels in _together(front).items():
        axes.annotate(labels, place, xytext=(4, 5), fontsize=8, textcoords="offset points")
    axes.scatter([point.error for point in others], [point.speed for point in others], marker="s",
                 s=22, color=PEER_COLOR, zorder=2, label="others, on a 500-pixel triangle")
    for point in others:
        axes.annotate(point.label, (point.error, point.speed), xytext=(-4, -12), fontsize=8,
                      ha="right", textcoords="offset points")
    if not own:
        axes.text(0.5, 0.5, _WAITING if panel == "second" else "no frame was simulated",
                  ha="center", transform=axes.transAxes, fontsize=9)
    axes.set_ylim(0, max([point.speed for point in own + others] or [1.0]) * 1.35)
    axes.set_xticks([0.0, *(10.0 ** decade for decade in decades[:-1])])
    axes.set_xlabel(f"greatest depth error, LSB of {PEER_DEPTH_BITS} bits")
    axes.set_ylabel(label)
    axes.legend(fontsize=8, frameon=False, loc="upper right")
    _bare(axes)


def _together(points: Sequence[SpeedPoint]) -> dict[tuple[float, float], str]:
    """One label for each place on the plot: the first and the last point there."""
    labels: dict[tuple[float, float], list[str]] = {}
    for point in points:
        labels.setdefault((point.error, point.speed), []).append(point.label)
    return {place: names[0] if len(names) == 1 else f"{names[0]} to {names[-1]}"
            for place, names in labels.items()}


def _bare(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
