"""Figure 5: how long a frame takes by the paper's performance model, at each granularity ratio.

The paper names what its model consists of, and prints no cost.  These are ours, in the time of a
fragment, or of a row without one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import mean

from .dealing.dealing_job import LAST, TRIANGLES
from .dealing.model_dealing import ModelDealing

#: Ratios of figure 5.
RATIOS = (2, 3, 4, 6, 8, 12)

#: By what the tables of the paper's machine are made.
PAPERS = f"{TRIANGLES}, {LAST}"

#: Times that sending costs as much: by which it is asked what that does to the best ratio.
SENDING = (0.25, 1, 4, 16)


@dataclass(frozen=True)
class Costs:
    """``transform``  of each triangle, in the geometry stage
    ``send``          of each triangle and region that it overlaps: it is sent and received
    ``set_up``        of each triangle and region, before its rows and fragments are gone through
    ``region``        of each region, whatever lies in it
    """

    transform: float = 20.0
    send: float = 5.0
    set_up: float = 10.0
    region: float = 10.0


COSTS = Costs()


def frame_time(model: ModelDealing, processors: int, ratio: int, costs: Costs = COSTS,
               how: str = PAPERS) -> float:
    """Transforming and sending are shared evenly, rasterising as the regions are dealt out."""
    regions = processors * ratio
    visits = model.visits(regions)
    evenly = costs.transform * model.given + costs.send * visits
    rasterising = costs.set_up * visits + model.clocks(regions)
    return ((evenly + rasterising / model.utilisation(processors, ratio, how)) / processors
            + costs.region * ratio)


def relative_times(model: ModelDealing, costs: Costs = COSTS, how: str = PAPERS
                   ) -> dict[int, list[float]]:
    """By processors, for each of ``RATIOS``: over the mean of them all."""
    found = {}
    for processors in model.processors:
        times = [frame_time(model, processors, ratio, costs, how) for ratio in RATIOS]
        found[processors] = [time / mean(times) for time in times]
    return found


def mean_times(model: ModelDealing, costs: Costs = COSTS, how: str = PAPERS) -> list[float]:
    """Of all numbers of processors together, for each of ``RATIOS``."""
    curves: Sequence[list[float]] = list(relative_times(model, costs, how).values())
    return [mean(times) for times in zip(*curves, strict=True)]


def best_ratio(model: ModelDealing, costs: Costs = COSTS, how: str = PAPERS) -> int:
    times = mean_times(model, costs, how)
    return RATIOS[times.index(min(times))]


def best_where_sending_costs(model: ModelDealing, factor: float) -> int:
    return best_ratio(model, replace(COSTS, send=COSTS.send * factor))
