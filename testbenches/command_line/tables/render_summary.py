"""What ``cardcage render`` says at the end."""

from __future__ import annotations

from collections.abc import Sequence

from ....golden.organisations.organisation_of import organisation_of
from ...frames.compare import FirstDifference
from ...frames.object_figures import ObjectFigures
from ...frames.region_figures import RegionFigures
from ...frames.rendering import Rendering
from ...render_frames import FramesRendering


def render_summary(rendering: Rendering) -> str:
    """The verdict and the main figures, in a few lines."""
    simulation, configuration = rendering.simulation, rendering.configuration
    width, height, *_ = organisation_of(configuration).resolution
    lines = [
        _verdict(rendering),
        _line("scene", f"{rendering.scene.name}: {rendering.scene.display_list.triangles:,} "
              f"triangles, {rendering.fragments:,} fragments at "
              f"{width}x{height}"),
        _line("machine", f"{configuration.cards}, {_precision(rendering)}"),
        *([] if rendering.regions is None else [_line("regions", _regions([rendering.regions]))]),
        *([] if rendering.objects is None else [_line("objects", _objects(rendering.objects))]),
        _line("cycles", f"{simulation.boot_cycles:,} to boot, {simulation.draw_cycles:,} to draw"
              + ("" if simulation.merge_cycles is None else
                 f", {simulation.merge_cycles - simulation.draw_cycles:,} to merge") + "; "
              f"{simulation.cycles:,} simulated by {simulation.engine} in "
              f"{simulation.seconds:.1f} s"
              + (f", after {simulation.build_seconds:.0f} s of compiling the model"
                 if simulation.build_seconds else "")),
        _line("efficiency", f"{100 * rendering.efficiency:.1f} % (fragments per cycle and "
              "processing element)"),
    ]
    if rendering.comparison.first_difference is not None:
        lines.insert(1, _line("first", _first(rendering.comparison.first_difference)))
    if rendering.report is not None:
        lines.append(_line("report", str(rendering.report)))
    return "\n".join(lines)


def _line(label: str, text: str) -> str:
    return f"  {label:11} {text}"


def _verdict(rendering: Rendering) -> str:
    comparison = rendering.comparison
    if comparison.equal:
        return (f"equal: {comparison.pixels_compared:,} colours and "
                f"{comparison.depths_compared:,} depths compared, 0 different")
    return (f"DIFFERENT: {comparison.pixels_different:,} of {comparison.pixels_compared:,} "
            f"colours, {comparison.depths_different:,} of {comparison.depths_compared:,} depths")


def _precision(rendering: Rendering) -> str:
    comparison, bits = rendering.comparison, rendering.configuration.fraction_bits
    if bits >= comparison.exact_fraction_bits:
        return f"{bits} fraction bits (exact)"
    return (f"{bits} fraction bits (exact from {comparison.exact_fraction_bits}; now at most "
            f"{comparison.depth_max_error:,} LSB of depth and {comparison.color_max_error} of "
            "colour off)")


def _first(difference: FirstDifference) -> str:
    expected, got = difference.expected, difference.got
    return (f"pixel {difference.pixel}: expected colour {expected.color} depth {expected.depth}, "
            f"got {got.color} depth {got.depth}; {len(difference.fragments)} fragments fell on it")


def _regions(figures: Sequence[RegionFigures]) -> str:
    """How they were dealt out, and how evenly."""
    configuration, counted = figures[0].configuration, figures[0].counted
    regions = configuration.dealt_regions
    shares = sorted(each.utilisation for each in figures)
    balance = {"static": "one table", "runs": "a run for each",
               "learnt": "balanced by learnt clocks, by the host"}.get(
        figures[0].policy, f"balanced by {counted}, by the {configuration.balancer}")
    span = (f"{100 * shares[0]:.0f} %" if len(shares) == 1 else
            f"{100 * shares[0]:.0f} to {100 * shares[-1]:.0f} %, "
            f"{100 * sum(shares) / len(shares):.0f} % on average")
    wrong = sum(bool(each.differences) for each in figures)
    return (f"{regions.columns}x{regions.rows} of {1 << regions.x_bits}x{1 << regions.y_bits} "
            f"pixels, {balance}; utilisation {span}"
            + (f"; COUNTS DIFFER in {wrong:,} pictures" if wrong else ""))


def _objects(figures: ObjectFigures) -> str:
    """What was sent and made."""
    made = [each.made for each in figures.golden]
    return (f"{figures.objects:,} of {figures.meshes:,} meshes, {sum(made):,} triangles made "
            f"in {len(made)} {figures.configuration.objects}"
            + (f", {sum(map(sum, figures.golden_forwarded)):,} times passed on"
               if figures.golden_forwarded else "")
            + (f", {figures.clipped:,} objects sent as triangles" if figures.clipped else "")
            + f"; {figures.words.total:,} words on the host link, {figures.words.meshes:,} of them "
            f"meshes, instead of {figures.triangle_words:,}"
            + ("; COUNTS DIFFER" if figures.differences else ""))


def frames_summary(rendering: FramesRendering) -> str:
    """The same of a sequence of pictures."""
    frames, shown = rendering.frames, rendering.shown
    pixels = sum(frame.comparison.pixels_compared for frame in frames)
    depths = sum(frame.comparison.depths_compared for frame in frames)
    wrong = [frame.number for frame in frames if not frame.equal]
    verdict = (f"equal: {len(frames):,} pictures, {pixels:,} colours and {depths:,} depths "
               "compared, 0 different")
    if wrong:
        verdict = f"DIFFERENT: {len(wrong):,} of {len(frames):,} pictures, first picture {wrong[0]}"
    draw = [frame.simulation.draw_cycles for frame in frames]
    scans = [frame.scans for frame in frames[:-1]]
    simulation = shown.simulation
    lines = [
        verdict,
        _line("scene", f"{shown.scene.name}: {min(frame.triangles for frame in frames):,} to "
              f"{max(frame.triangles for frame in frames):,} triangles"),
        _line("machine", f"{shown.configuration.cards}, {_precision(shown)}"),
        *([] if shown.regions is None else [_line("regions", _regions(
            [frame.regions for frame in frames if frame.regions is not None]))]),
        *([] if shown.objects is None else [_line("objects", _objects(shown.objects))]),
        _line("cycles", f"{min(draw):,} to {max(draw):,} to draw a picture; {simulation.cycles:,} "
              f"simulated by {simulation.engine} in {simulation.seconds:.1f} s"
              + (f", after {simulation.build_seconds:.0f} s of compiling the model"
                 if simulation.build_seconds else "")),
    ]
    if scans:
        lines.append(_line("shown", f"{min(scans)} to {max(scans)} scans each but the last; "
                           f"{scans.count(1):,} of {len(scans):,} on one scan, which is the "
                           "least"))
    if shown.comparison.first_difference is not None:
        lines.insert(1, _line("first", _first(shown.comparison.first_difference)))
    if rendering.report is not None:
        lines.append(_line("report", str(rendering.report)))
    return "\n".join(lines)
