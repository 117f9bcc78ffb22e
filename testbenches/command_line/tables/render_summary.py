"""What ``cardcage render`` says at the end."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ....golden.organisations.organisation_of import organisation_of
from ...frames.compare import FirstDifference
from ...frames.object_figures import ObjectFigures
from ...frames.region_figures import RegionFigures
from ...frames.rendering import Rendering
from ...render_frames import FramesRendering
from ...support.counted import counted


def render_summary(rendering: Rendering) -> str:
    """The verdict and the main figures, in a few lines."""
    simulation, configuration = rendering.simulation, rendering.configuration
    width, height, *_ = organisation_of(configuration).resolution
    lines = [
        _verdict(rendering),
        _line("scene", f"{rendering.scene.name}: "
              f"{counted(rendering.scene.display_list.triangles, 'triangle')}, "
              f"{counted(rendering.fragments, 'fragment')} at {width}x{height}"),
        _line("machine", f"{configuration.cards}, {_precision(rendering)}"),
        *([] if rendering.regions is None else [_line("regions", _regions([rendering.regions]))]),
        *([] if rendering.objects is None else [_line("objects", _objects([rendering.objects]))]),
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
            f"got {got.color} depth {got.depth}; "
            f"{counted(len(difference.fragments), 'fragment')} fell on it")


def _span(numbers: Sequence[int], one: str = "", many: str | None = None) -> str:
    """From the least to the greatest of these, of things if it is said of what."""
    least = f"{min(numbers):,} to " if min(numbers) < max(numbers) else ""
    return least + (counted(max(numbers), one, many) if one else f"{max(numbers):,}")


def _regions(figures: Sequence[RegionFigures]) -> str:
    """How they were dealt out, and how evenly."""
    configuration, what = figures[0].configuration, figures[0].counted
    regions = configuration.dealt_regions
    shares = sorted(each.utilisation for each in figures)
    balance = {"static": "one table", "runs": "a run for each",
               "learnt": "balanced by learnt clocks, by the host"}.get(
        figures[0].policy, f"balanced by {what}, by the {configuration.balancer}")
    span = (f"{100 * shares[0]:.0f} %" if len(shares) == 1 else
            f"{100 * shares[0]:.0f} to {100 * shares[-1]:.0f} %, "
            f"{100 * sum(shares) / len(shares):.0f} % on average")
    wrong = sum(bool(each.differences) for each in figures)
    return (f"{regions.columns}x{regions.rows} of {1 << regions.x_bits}x{1 << regions.y_bits} "
            f"pixels, {balance}; utilisation {span}"
            + (f"; COUNTS DIFFER in {counted(wrong, 'picture')}" if wrong else ""))


def _objects(figures: Sequence[ObjectFigures]) -> str:
    """What was sent and made, of each picture."""
    def of(figure: Callable[[ObjectFigures], int], one: str = "", many: str | None = None) -> str:
        return _span([figure(each) for each in figures], one, many)

    first = figures[0]
    place = {"nodes": counted(len(first.golden), "node"), "controller": "the controller",
             "elements": counted(len(first.golden), "element")}[str(first.configuration.objects)]
    passed = of(lambda each: sum(map(sum, each.golden_forwarded)), "time")
    clipped = of(lambda each: each.clipped, "object")
    wrong = sum(bool(each.differences) for each in figures)
    return (f"{of(lambda each: each.objects)} of {of(lambda each: each.meshes, 'mesh', 'meshes')}, "
            f"{of(lambda each: sum(place.made for place in each.golden), 'triangle')} made in "
            f"{place}"
            + (f", {passed} passed on" if first.golden_forwarded else "")
            + (f", {clipped} sent as triangles" if any(each.clipped for each in figures) else "")
            + f"; {of(lambda each: each.words.total, 'word')} on the host link, "
            f"{of(lambda each: each.words.meshes)} of them meshes, instead of "
            f"{of(lambda each: each.triangle_words)}"
            + (f"; COUNTS DIFFER in {counted(wrong, 'picture')}" if wrong else ""))


def frames_summary(rendering: FramesRendering) -> str:
    """The same of a sequence of pictures."""
    frames, shown = rendering.frames, rendering.shown
    pixels = sum(frame.comparison.pixels_compared for frame in frames)
    depths = sum(frame.comparison.depths_compared for frame in frames)
    wrong = [frame.number for frame in frames if not frame.equal]
    verdict = (f"equal: {counted(len(frames), 'picture')}, {pixels:,} colours and {depths:,} "
               "depths compared, 0 different")
    if wrong:
        verdict = (f"DIFFERENT: {len(wrong):,} of {counted(len(frames), 'picture')}, first picture "
                   f"{wrong[0]}")
    draw = [frame.simulation.draw_cycles for frame in frames]
    scans = [frame.scans for frame in frames[:-1]]
    simulation = shown.simulation
    lines = [
        verdict,
        _line("scene", f"{shown.scene.name}: "
              f"{_span([frame.triangles for frame in frames], 'triangle')}"),
        _line("machine", f"{shown.configuration.cards}, {_precision(shown)}"),
        *([] if shown.regions is None else [_line("regions", _regions(
            [frame.regions for frame in frames if frame.regions is not None]))]),
        *([] if shown.objects is None else [_line("objects", _objects(
            [frame.objects for frame in frames if frame.objects is not None]))]),
        _line("cycles", f"{_span(draw)} to draw a picture; {simulation.cycles:,} simulated "
              f"by {simulation.engine} in {simulation.seconds:.1f} s"
              + (f", after {simulation.build_seconds:.0f} s of compiling the model"
                 if simulation.build_seconds else "")),
    ]
    if scans:
        lines.append(_line("shown", f"{_span(scans, 'scan')} each but the last; "
                           f"{scans.count(1):,} of {len(scans):,} on one scan, which is the "
                           "least"))
    if shown.comparison.first_difference is not None:
        lines.insert(1, _line("first", _first(shown.comparison.first_difference)))
    if rendering.report is not None:
        lines.append(_line("report", str(rendering.report)))
    return "\n".join(lines)
