"""What Ellsworth says of his figures (1994), held against ours: a model each, then triangles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise, product

from ..verdict import Summary, Verdict, together
from .dealing.dealing_job import LAST, STATIC, TRIANGLES
from .dealing.model_dealing import ModelDealing
from .dealing.screen_grids import RATIOS as ALL_RATIOS
from .frame_time import (
    PAPERS,
    RATIOS,
    SENDING,
    best_ratio,
    best_where_sending_costs,
    mean_times,
)
from .overlap import SHAPE_SIDE, Overlap

#: Of utilisation, that count as none.
NEAR = 0.01

#: What the last frame's counts cost on the most processors: "only up to 7 percent", and of another
#: model 12.
DROP = 0.12

#: Of the two models at so many regions.
OVERLAP_REGIONS = 256
OVERLAP = (1.09, 1.4)

#: Of the time of a frame, within which one ratio is as good as another.
AS_GOOD = 0.01

#: The ratio that the paper chooses, and by how much longer a frame may take than at the best one.
COMPROMISE = 8
COMPROMISE_COST = 0.05

#: Of utilisation, that is asked of larger and larger machines.
ASKED = 0.75

RISES = "Utilisation increases as the granularity ratio increases."
FALLS = "Utilisation decreases with an increase in the number of processors."
DROPS = "On the most processors the last frame's counts cost up to 7 or 12 % of utilisation."
LARGER = "Large numbers of processors need a larger granularity ratio."
UNBALANCED = "With regions assigned statically the loads are not as balanced."
OVERLAPS = "At 256 regions the models have overlap factors from 1.09 to 1.4."
BEST = "The ratio that works best is 12 for the head, and 4 for the virus."
SENDS = "A high communication cost favours a smaller granularity ratio."
EIGHT = "Eight regions a processor are a compromise between what is best for each model."
SQUARE = "Square regions give the smallest overlap factor."


def claims_of(model: ModelDealing) -> list[Verdict]:
    """Those that are about a model, in the paper's order."""
    return [Verdict(claim, model.model.name, came_out, numbers)
            for claim, came_out, numbers in (*_of_figure_4(model), *_of_figure_5(model))]


def claims_of_overlap(overlaps: Sequence[Overlap]) -> list[Verdict]:
    """Those about triangles of any scene."""
    shapes = [each for each in overlaps if not each.nearly_square]
    if not shapes:
        return []
    least = min(shapes, key=lambda each: each.measured)
    square = min(shapes, key=lambda each: abs(each.region[0] / each.region[1] - 1))
    worst = max(shapes, key=lambda each: each.measured)
    return [Verdict(
        SQUARE, f"triangles in squares of {SHAPE_SIDE}", least is square,
        f"{square.measured:.2f} on {_cut(square)} regions, from {least.measured:.2f} "
        f"({_cut(least)}) to {worst.measured:.2f} ({_cut(worst)}) on as many of other shapes")]


def _cut(overlap: Overlap) -> str:
    return f"{overlap.columns}×{overlap.rows}"


def _of_figure_4(model: ModelDealing) -> Iterator[tuple[str, bool, str]]:
    rises = [after - before for each in model.processors for before, after in pairwise(
        [model.utilisation(each, ratio, PAPERS) for ratio in ALL_RATIOS])]
    yield RISES, min(rises) >= -NEAR, _steps(rises, "rises")
    falls = [before - after for ratio in ALL_RATIOS
             for before, after in pairwise(model.curve(ratio, PAPERS))]
    yield FALLS, min(falls) >= -NEAR, _steps(falls, "falls")
    most = model.processors[-1]
    drops = {ratio: model.drop(most, ratio, TRIANGLES) for ratio in ALL_RATIOS}
    ratio = max(drops, key=lambda each: drops[each])
    yield DROPS, drops[ratio] <= DROP + NEAR / 2, (
        f"by triangles at most {100 * drops[ratio]:.0f} points on {most} processors, at ratio "
        f"{ratio}; by clocks "
        f"{100 * max(model.drop(most, each, 'clocks') for each in ALL_RATIOS):.0f}")
    needed = [next((ratio for ratio in ALL_RATIOS
                    if model.utilisation(each, ratio, PAPERS) >= ASKED), None)
              for each in model.processors]
    order = [ALL_RATIOS[-1] + 1 if ratio is None else ratio for ratio in needed]
    yield LARGER, order[-1] > order[0] and all(a <= b for a, b in pairwise(order)), (
        f"for a utilisation of {ASKED} " + ", ".join(
            f"{'no ratio' if ratio is None else ratio} on {each}"
            for each, ratio in zip(model.processors, needed, strict=True)))
    pairs = [(model.utilisation(each, ratio, STATIC), model.utilisation(each, ratio, PAPERS))
             for each, ratio in product(model.processors, ALL_RATIOS) if ratio > 1]
    worse = sum(static <= packed + NEAR for static, packed in pairs)
    yield UNBALANCED, worse == len(pairs), (
        f"in {worse} of {len(pairs)} cases; at ratios above 1 utilisation is "
        f"{_mean([static for static, _ in pairs]):.2f} on average, by the last frame's triangles "
        f"{_mean([packed for _, packed in pairs]):.2f}")
    if str(OVERLAP_REGIONS) in model.found["visits"]:
        overlap = model.overlap(OVERLAP_REGIONS)
        yield OVERLAPS, OVERLAP[0] <= overlap <= OVERLAP[1], (
            f"{overlap:.2f}, of triangles of {model.mean_size:.1f} pixels")


def _of_figure_5(model: ModelDealing) -> Iterator[tuple[str, bool, str]]:
    best, times = best_ratio(model), mean_times(model)
    if model.model.best_ratio is not None:
        by_clocks = best_ratio(model, how=f"clocks, {LAST}")
        papers = times[RATIOS.index(model.model.best_ratio)]
        longer = "" if papers == min(times) else (
            f", and {model.model.best_ratio} takes {_more(papers, min(times))} longer")
        yield BEST, papers <= (1 + AS_GOOD) * min(times), (
            f"{best} is best by our costs{longer}; with tables by the last frame's clocks "
            f"{by_clocks} is")
    ratios = [best_where_sending_costs(model, factor) for factor in SENDING]
    yield SENDS, ratios[-1] < ratios[0] and all(a >= b for a, b in pairwise(ratios)), (
        "best " + ", ".join(f"{ratio} where sending costs {factor:g} times as much"
                            for factor, ratio in zip(SENDING, ratios, strict=True)))
    eight = times[RATIOS.index(COMPROMISE)]
    yield EIGHT, eight <= (1 + COMPROMISE_COST) * min(times), (
        f"a frame takes {_more(eight, min(times))} longer than at {best}")


def _steps(steps: Sequence[float], word: str) -> str:
    against = [step for step in steps if step < -NEAR]
    if not against:
        return f"in all {len(steps)} steps it {word}, or stays within a point"
    return (f"in {len(steps) - len(against)} of {len(steps)} steps it {word}, or stays within a "
            f"point; otherwise by {-100 * min(against):.0f} points at most")


def _more(time: float, least: float) -> str:
    return f"{100 * (time / least - 1):.2f} %"


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)


def summary(models: Sequence[ModelDealing], overlaps: Sequence[Overlap]) -> list[Summary]:
    """Each claim once."""
    return together([*(verdict for model in models for verdict in claims_of(model)),
                     *claims_of_overlap(overlaps)])
