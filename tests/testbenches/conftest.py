"""One small frame, simulated once, and engines that replay it or tamper with it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.engines.engine import EngineRun, Job, Progress, Scan
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.render import RenderOptions, prepare_render

#: Every machine of these tests draws this.
SCENE = "random:n=12,size=8,seed=5"
OPTIONS = {"cards": "PM", "size": (16, 16)}
ARGUMENTS = [SCENE, "--cards", "PM", "--size", "16x16"]


@pytest.fixture(autouse=True)
def only_pysim(monkeypatch):
    """No model is compiled where a test does not ask for it."""
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": PysimEngine})


class RecordingEngine:
    """Simulates each machine and frame once and hands out the recording from then on."""

    name = "pysim"

    def __init__(self) -> None:
        self._runs: dict[tuple, EngineRun] = {}

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun:
        key = (job.configuration, tuple(job.commands), job.memory_seed)
        if key not in self._runs or job.waveform is not None:
            self._runs[key] = PysimEngine().run(job, progress)
        return self._runs[key]


class TamperingEngine:
    """Another engine's run with wrong values.

    ``colors``  (x, y) → red, green, blue on the video pins
    ``depths``  place in the read-back → depth
    """

    name = "tampering"

    def __init__(self, engine, colors=None, depths=None) -> None:
        self._engine = engine
        self._colors = colors or {}
        self._depths = depths or {}

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun:
        run = self._engine.run(job, progress)
        picture = run.scans[-1].picture.copy()
        for (x, y), color in self._colors.items():
            picture[y, x] = color
        responses = list(run.responses)
        places = [place for place, (kind, _, _) in enumerate(responses)
                  if kind == ResponseKind.DEPTH]
        for word, depth in self._depths.items():
            kind, _, cycle = responses[places[word]]
            responses[places[word]] = kind, depth, cycle
        return replace(run, responses=responses,
                       scans=[*run.scans[:-1], Scan(run.scans[-1].cycle, picture)])


@pytest.fixture(scope="session")
def recording() -> RecordingEngine:
    return RecordingEngine()


@pytest.fixture
def draw(recording, monkeypatch):
    """A function: render ``SCENE`` with an engine, by default the recording one."""

    def run(engine=None, out=None, scene=SCENE, **options):
        chosen = engine or recording
        monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                            {"pysim": lambda: chosen})
        return prepare_render(scene, RenderOptions(**OPTIONS | options)).run(out)

    return run


@pytest.fixture
def tampering():
    return TamperingEngine
