"""Points through whoever measures; what is found is kept as it comes, by the hash of its inputs.

A sweep that was interrupted goes on where it was, since what was kept is not measured again.  Only
figures are kept: a point that failed is tried again the next time.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from contextlib import ExitStack
from typing import Any

from ....golden.specification.errors import InputError
from ...support.cache import content_hash
from ...support.measurement_cache import keep_or_raise, package_hash, recall
from ..points.atlas_point import AtlasPoint, Failure
from ..points.measure import Batch, Outcome, batches, measure
from .workers import Workers

#: What becomes of an interrupted sweep.
KEPT = "what was measured is kept; the same command goes on from there"

#: Told of points that are there: how many, and of which batch.
Done = Callable[[int, str], None]


class Sweep:
    """``points``, each once, measured by ``workers``, or remembered.

    ``found``     by point, as it comes
    ``recalled``  points that were measured before
    ``not_kept``  why the results cannot be kept, where they cannot
    """

    def __init__(self, points: Sequence[AtlasPoint], workers: Workers,
                 measuring: Callable[[Batch], list[Outcome]] = measure) -> None:
        self.points = list(dict.fromkeys(points))
        self.found: dict[AtlasPoint, Outcome] = {}
        self.recalled = 0
        self.not_kept: str | None = None
        self._workers = workers
        self._measuring = measuring
        self._release = package_hash()

    def run(self, done: Done = lambda points, label: None) -> dict[AtlasPoint, Outcome]:
        """Everything.  Raises ``InputError`` where nobody can be asked; what was found until then,
        or until an interruption, is kept."""
        for point in self.points:
            figures = recall(self.key(point))
            if figures is not None:
                self.found[point] = figures
                self.recalled += 1
        done(self.recalled, "")
        missing = [point for point in self.points if point not in self.found]
        if missing:
            with ExitStack() as working:
                working.enter_context(self._workers)
                self._measure_all(batches(missing, self._release), done)
        return {point: self.found[point] for point in self.points}

    def what_is_kept(self) -> str:
        """For who interrupts it."""
        return KEPT if self.not_kept is None else (
            f"some results could not be kept ({self.not_kept}); the same command measures those "
            "again")

    def key(self, point: AtlasPoint) -> tuple[str, ...]:
        """All that the point's figures depend on."""
        return "atlas point", self._release, content_hash([repr(point)])

    def _measure_all(self, wanted: Sequence[Batch], done: Done) -> None:
        waiting = deque(wanted)
        suspects: deque[Batch] = deque()  # one of them ended its process; each is tried alone
        running: dict[Future[Any], Batch] = {}
        while waiting or suspects or running:
            alone = bool(suspects)
            if alone and not running:
                running[self._submit(suspects[0])] = suspects[0]
            while not alone and waiting and len(running) < self._workers.width:
                batch = waiting.popleft()
                running[self._submit(batch)] = batch
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            broken = []
            for future in finished:
                batch = running.pop(future)
                if isinstance(future.exception(), BrokenExecutor):
                    broken.append(batch)
                    continue
                if alone and suspects and batch is suspects[0]:
                    suspects.popleft()
                self._take(batch, future)
                done(len(batch.points), batch.label)
            if broken:
                self._workers.begin_again()
                broken += self._all_broken(running, done)
                if alone and broken == [suspects[0]]:
                    self._give_up(suspects.popleft(), "its process was ended from outside, or for "
                                  "want of memory, twice", done)
                else:
                    suspects += [batch for batch in broken if batch not in suspects]

    def _submit(self, batch: Batch) -> Future[Any]:
        try:
            return self._workers.submit(self._measuring, batch)
        except BrokenExecutor as error:  # its processes ended while nothing ran
            broken: Future[Any] = Future()
            broken.set_exception(error)
            return broken

    def _all_broken(self, running: dict[Future[Any], Batch], done: Done) -> list[Batch]:
        """The other calls of a pool that broke: most ended with it, some just before."""
        broken = []
        for future, batch in running.items():
            if future.cancelled() or isinstance(future.exception(), BrokenExecutor):
                broken.append(batch)
            else:
                self._take(batch, future)
                done(len(batch.points), batch.label)
        running.clear()
        return broken

    def _take(self, batch: Batch, future: Future[Any]) -> None:
        error = future.exception()
        if isinstance(error, InputError):
            raise error
        outcomes: list[Outcome] = (
            [Failure(f"{type(error).__name__}: {error}", failed=True)] * len(batch.points)
            if error is not None else future.result())
        for point, outcome in zip(batch.points, outcomes, strict=True):
            self.found[point] = outcome
            if not isinstance(outcome, Failure):
                self._keep(point, outcome)

    def _keep(self, point: AtlasPoint, figures: dict[str, Any]) -> None:
        try:
            keep_or_raise(self.key(point), figures)
        except OSError as error:
            self.not_kept = error.strerror or type(error).__name__

    def _give_up(self, batch: Batch, reason: str, done: Done) -> None:
        self.found |= dict.fromkeys(batch.points, Failure(reason, failed=True))
        done(len(batch.points), batch.label)
