"""The tables of the page, for a terminal and for the page itself."""

from __future__ import annotations

from collections.abc import Sequence

from ...support.text_table import TextTable
from .claims import summary
from .dealing.cures import CURES
from .dealing.dealing_job import CEILING, CLOCKS, CURE_RATIO, HOW, SCATTERED, STATIC, THIS
from .dealing.model_dealing import ModelDealing
from .ellsworth import Ellsworth
from .findings import findings
from .frame_time import COSTS, RATIOS, SENDING, best_ratio, best_where_sending_costs, mean_times
from .in_rtl import Point
from .overlap import REGIONS, SHAPE_SIDE, by_regions, by_shape

#: Stands for a figure that there is none of.
NOTHING = "-"

#: Of the table of utilisation.
SHOWN_RATIOS = (1, 4, 8, 12)


def headline(found: Ellsworth) -> list[str]:
    """What machines did otherwise, then each claim of the paper, and what was found beyond it."""
    return [*(f"DIFFERENT: {line}" for line in found.differences),
            *map(str, summary(found.models, found.overlaps)), *findings(found.models)]


def tables(found: Ellsworth) -> list[TextTable]:
    """All that there are figures for."""
    made = [model_table(found), *(utilisation_table(model) for model in found.models)]
    if found.points:
        made.append(point_table(found.points))
    if any(model.cure_processors for model in found.models):
        made.append(cure_table(found.models))
    made.append(time_table(found.models))
    if found.overlaps:
        made.append(overlap_table(found))
    if by_shape(found.overlaps):
        made.append(shape_table(found))
    return made


def model_table(found: Ellsworth) -> TextTable:
    width, height = found.size
    return TextTable(
        f"models at {width}x{height}, mean of their frames",
        ("model", "scene", "frames", "degrees a frame", "facing the eye", "that may cover a pixel",
         "mean size", "mean box", "overlap at 256 regions"),
        tuple((each.model.name, each.model.scene, f"{each.model.frames}", f"{each.model.turn:g}",
               f"{each.given:,.0f}", f"{each.drawn:,.0f}", f"{each.mean_size:.2f}",
               "{:.1f}x{:.1f}".format(*each.box),
               f"{each.overlap(256):.2f}" if "256" in each.found["visits"] else NOTHING)
              for each in found.models))


def utilisation_table(model: ModelDealing) -> TextTable:
    """Figure 4."""
    return TextTable(
        f"figure 4, {model.model.name}: utilisation by processors",
        ("regions a processor, table by", *(f"{each}" for each in model.processors)),
        tuple((f"{ratio}, {how}", *(f"{value:.2f}" for value in model.curve(ratio, how)))
              for ratio in SHOWN_RATIOS for how in HOW))


def point_table(points: Sequence[Point]) -> TextTable:
    frames = range(1, len(points[0].utilisation))
    return TextTable(
        f"measured in RTL, {points[0].model}: utilisation by the machines' own counts of clocks",
        ("processors", "regions", "a processor", "static, frame 0",
         *(f"last frame's clocks, frame {frame}" for frame in frames), "golden's"),
        tuple((f"{point.processors}", f"{point.columns}x{point.rows}", f"{point.ratio:g}",
               *(f"{value:.3f}" for value in point.utilisation),
               "not equal" if point.differences else "equal") for point in points))


def cure_table(models: Sequence[ModelDealing]) -> TextTable:
    """Rows: what tables are made of; columns: models and processors."""
    columns = [(model, each) for model in models for each in model.cure_processors]
    rows = [(cure.name, cure.needs, *(f"{model.cured(cure.name, each):.3f}"
                                      for model, each in columns)) for cure in CURES]
    bounds = [(name, NOTHING, *(f"{model.utilisation(each, CURE_RATIO, how):.3f}"
                                for model, each in columns))
              for name, how in (("static", STATIC), (SCATTERED, SCATTERED),
                                ("this frame's clocks", f"{CLOCKS}, {THIS}"),
                                ("no table exceeds", CEILING))]
    return TextTable(
        f"cures for the last frame's loss: utilisation at {CURE_RATIO} regions a processor",
        ("table by", "needs", *(f"{model.model.name} on {each}" for model, each in columns)),
        (*bounds[:2], *rows, *bounds[2:]))


def time_table(models: Sequence[ModelDealing]) -> TextTable:
    return TextTable(
        f"figure 5: time of a frame over the mean, all processors together; transforming "
        f"{COSTS.transform:g}, sending {COSTS.send:g}, set-up {COSTS.set_up:g}, a region "
        f"{COSTS.region:g}",
        ("model", *(f"ratio {ratio}" for ratio in RATIOS), "best",
         *(f"best, sending x{factor:g}" for factor in SENDING)),
        tuple((model.model.name, *(f"{time:.3f}" for time in mean_times(model)),
               f"{best_ratio(model)}",
               *(f"{best_where_sending_costs(model, factor)}" for factor in SENDING))
              for model in models))


def overlap_table(found: Ellsworth) -> TextTable:
    return TextTable(
        "overlap factor: measured / Molnar / Molnar, of pixel centres",
        ("random triangles in squares of", *(f"{regions} regions" for regions in REGIONS)),
        tuple((f"{side}", *_cells([f"{each.measured:.2f} / {each.expected:.2f} / "
                                   f"{each.expected_of_centres:.2f}" for each in overlaps]))
              for side, overlaps in by_regions(found.overlaps).items()))


def _cells(words: Sequence[str]) -> tuple[str, ...]:
    """As many as there are columns."""
    return (*words, *[NOTHING] * (len(REGIONS) - len(words)))


def shape_table(found: Ellsworth) -> TextTable:
    return TextTable(
        f"overlap factor on 256 regions of several shapes, triangles in squares of {SHAPE_SIDE}",
        ("regions", "of pixels", "measured", "Molnar", "Molnar, of pixel centres"),
        tuple((f"{each.columns}x{each.rows}", "{:g}x{:g}".format(*each.region),
               f"{each.measured:.2f}", f"{each.expected:.2f}", f"{each.expected_of_centres:.2f}")
              for each in by_shape(found.overlaps)))
