"""What the figures say beyond the paper's claims: sentences, made of the numbers."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import mean

from .dealing.cures import COUNTERS, CURES, LAST, Cure
from .dealing.dealing_job import CEILING, CLOCKS, CURE_RATIO, THIS, TRIANGLES
from .dealing.dealing_job import LAST as LAST_FRAME
from .dealing.model_dealing import ModelDealing

#: Utilisation above this is no loss that a table could avoid.
_WHOLE = 0.995


def findings(models: Sequence[ModelDealing]) -> list[str]:
    """Of all models together."""
    return [*_counts(models), *_cures(models), *_ceilings(models)]


def cure_gain(models: Sequence[ModelDealing], cure: Cure) -> float:
    """Of utilisation, against the last frame's clocks: the mean of all models and processors."""
    return mean(model.cured(cure.name, each) - model.cured(LAST, each)
                for model in models for each in model.cure_processors)


def best_cure(models: Sequence[ModelDealing], needs: str | None = None) -> Cure:
    """Of those that need no more than that, or of all."""
    return max((cure for cure in CURES if needs in (None, cure.needs)),
               key=lambda cure: cure_gain(models, cure))


def _counts(models: Sequence[ModelDealing]) -> list[str]:
    """Clocks against triangles."""
    gains = {frame: mean(model.utilisation(each, CURE_RATIO, f"{CLOCKS}, {frame}")
                         - model.utilisation(each, CURE_RATIO, f"{TRIANGLES}, {frame}")
                         for model in models for each in model.processors)
             for frame in (THIS, LAST_FRAME)}
    return [f"Counting clocks in place of triangles is worth {_points(gains[THIS])} of utilisation "
            f"with this frame's counts and {_points(gains[LAST_FRAME])} with the last frame's, at "
            f"{CURE_RATIO} regions a processor, the mean of all models and processors."]


def _cures(models: Sequence[ModelDealing]) -> list[str]:
    if not any(model.cure_processors for model in models):
        return []
    best, counted = best_cure(models), best_cure(models, COUNTERS)
    return [f"Best cure for the last frame's loss: {best.name}, {_gain(models, best)}.",
            f"Best of those that need no more hardware than counters: {counted.name}, "
            f"{_gain(models, counted)}."]


def _gain(models: Sequence[ModelDealing], cure: Cure) -> str:
    parts = [f"{model.model.name} on {each} from {model.cured(LAST, each):.3f} to "
             f"{model.cured(cure.name, each):.3f}"
             for model in models for each in model.cure_processors]
    return f"{_points(cure_gain(models, cure))} on average ({', '.join(parts)})"


def _ceilings(models: Sequence[ModelDealing]) -> list[str]:
    """Where one region alone is more than an even share."""
    lines = []
    for model in models:
        held = {each: model.utilisation(each, CURE_RATIO, CEILING) for each in model.processors}
        first = next((each for each, ceiling in held.items() if ceiling < _WHOLE), None)
        if first is not None:
            most = model.processors[-1]
            lines.append(f"{model.model.name}: from {first} processors on one region alone holds "
                         f"more than an even share in some frames; on {most} no table exceeds "
                         f"{held[most]:.2f} at {CURE_RATIO} regions a processor.")
    return lines


def _points(gain: float) -> str:
    return f"{100 * gain:+.1f} points"
