"""Who measures: the cores of this machine, or a cluster, both behind ``concurrent.futures``."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import suppress
from types import TracebackType
from typing import Any, Protocol

from ....golden.specification.errors import InputError
from ...support.interruption import Interrupted, interruptible, uninterrupted
from ...support.processes import cores

#: In place of an address: a cluster on this machine alone.
LOCAL = "local"

#: A cluster is given so many calls for each of its threads at a time, so that none waits for this
#: program.
AHEAD = 2

#: Seconds in which a scheduler has to answer.
ANSWER_SECONDS = 10


class Workers(Protocol):
    """Somebody who measures, between ``with`` and its end, which waits for nobody.

    ``width``  calls that they should have at a time
    """

    width: int

    def __enter__(self) -> Workers:
        """Begin.  Raises ``InputError`` where there is nobody."""

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """Nobody works any more."""

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        """The call's future."""

    def begin_again(self) -> None:
        """After a ``BrokenExecutor``, which all calls end with that were waiting: with others."""


class LocalWorkers:
    """A pool of ``processes`` of this machine, as many as there are cores where that is None.

    They are new ones, not copies of this: as with all of Python's, a program that uses them begins
    behind ``if __name__ == "__main__":``.
    """

    def __init__(self, processes: int | None = None) -> None:
        self.width = processes or cores()
        self._pool: Executor | None = None
        self._others: set[Any] = set()

    def __enter__(self) -> LocalWorkers:
        self._others = set(multiprocessing.active_children())
        return self

    def __exit__(self, *_: Any) -> None:
        self._end()

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(
                self.width, mp_context=multiprocessing.get_context("spawn"), initializer=_alone)
        return self._pool.submit(_interruptible, function, argument)

    def begin_again(self) -> None:
        self._end()

    def _end(self) -> None:
        """Whoever still works is told to end, which it does as a command that is interrupted."""
        if self._pool is None:
            return
        with uninterrupted():
            self._pool.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - self._others:
                process.terminate()
            self._pool.shutdown()
            self._pool = None


def _alone() -> None:
    """Ctrl-C is for the program that has the pool; it ends the others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _interruptible(function: Callable[[Any], Any], argument: Any) -> Any:
    """One that is told to end leaves no simulation and no temporary file behind."""
    try:
        with interruptible():
            return function(argument)
    except Interrupted as interruption:
        os._exit(interruption.status)  # the pool would hand it on as a result, and go on


class ClusterWorkers:
    """The workers of Dask's scheduler at ``address``, such as ``tcp://host:8786``, or ``local``.

    Where one of them ends, the scheduler gives its calls to others.  All need the same release of
    Cardcage.
    """

    width = 1

    def __init__(self, address: str) -> None:
        self.address = address
        self._client: Any = None
        self._cluster: Any = None
        self._executor: Any = None

    def __enter__(self) -> ClusterWorkers:
        try:
            from distributed import Client, LocalCluster
        except ImportError:
            raise InputError("--cluster: needs Dask; install Cardcage with it: pip install "
                             "'.[cluster]'") from None
        # A worker that ends is no news to whoever reads the results.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        try:
            if self.address == LOCAL:
                self._cluster = LocalCluster(  # type: ignore[no-untyped-call]
                    n_workers=cores(), threads_per_worker=1, dashboard_address=None)
            self._client = Client(  # type: ignore[no-untyped-call]
                self._cluster or self.address, timeout=ANSWER_SECONDS, set_as_default=False)
            threads = sum(self._client.nthreads().values())
        except (OSError, ValueError) as error:
            self.__exit__(None, None, None)
            raise InputError(f"--cluster: {self.address} does not answer "
                             f"({str(error) or type(error).__name__}); give a scheduler's address, "
                             f"such as tcp://host:8786, or {LOCAL}") from None
        self.width = AHEAD * max(1, threads)
        self._executor = self._client.get_executor(pure=False)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        with uninterrupted():
            for part in (self._client, self._cluster):
                if part is not None:
                    with suppress(TimeoutError, OSError):
                        part.close()

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        future: Future[Any] = self._executor.submit(function, argument)
        return future

    def begin_again(self) -> None:
        """A scheduler replaces its workers itself."""


def workers_for(cluster: str | None, processes: int | None) -> Workers:
    """A cluster's where there is an address, else this machine's."""
    return LocalWorkers(processes) if cluster is None else ClusterWorkers(cluster)
