"""One comparison of five small cages, simulated once, that all tests look at."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cardcage.testbenches.comparison.compare_cages import compare_cages

SCENE = "random:n=12,size=5,seed=5"
CARDS = ("2x(PM)", "2x(PMC)", "2x(PMT)")
#: ``processes``: none that would not see the recordings.
SMALL = {"size": (8, 8), "shading": "flat", "processes": 1}


@pytest.fixture(scope="session")
def cache(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def recorded(recording, cache, monkeypatch):
    """Each machine and list is simulated once for all tests, and each Verilog made once."""
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: recording})
    monkeypatch.setenv("CARDCAGE_CACHE", str(cache))


@pytest.fixture
def small(recorded):
    """A function: compare ``CARDS``, or others, drawing ``SCENE``."""

    def run(cards=CARDS, scene=SCENE, **options):
        return compare_cages(scene, cards, **SMALL | options)

    return run


class TamperingRuns:
    """Another engine's runs, those of machines with ``cards`` changed by ``change``."""

    name = "pysim"

    def __init__(self, engine, cards, change) -> None:
        self._engine, self._cards, self._change = engine, cards, change

    def run(self, job, progress=None):
        run = self._engine.run(job, progress)
        return replace(run, **self._change(run)) if job.configuration.cards == self._cards else run


@pytest.fixture
def tampered(small, recording, monkeypatch):
    """A function: the comparison where runs of one machine, by its cards, have other values."""

    def run(machine, change, **options):
        engine = TamperingRuns(recording, machine, change)
        monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                            {"pysim": lambda: engine})
        return small(**options)

    return run
