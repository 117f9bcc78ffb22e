"""Calls of one function, each in a process of its own, as many at a time as there are cores."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout, suppress
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import wait
from operator import methodcaller
from typing import Any, TypeVar

from .interruption import Interrupted, interruptible, uninterrupted

Argument = TypeVar("Argument")
Result = TypeVar("Result")

#: What a new process of the same Python runs; it finds what this one finds.
_PROGRAM = [sys.executable, "-P", "-c", f"from {__name__} import serve; serve()"]


@dataclass(frozen=True)
class _Raised:
    """What a call ended with in place of a result."""

    error: Exception


def cores() -> int:
    """The cores that this program may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_processes(function: Callable[[Argument], Result], arguments: Sequence[Argument],
                 processes: int | None = None, done: Callable[[], None] = lambda: None
                 ) -> list[Result]:
    """What ``function`` makes of each argument.

    ``function``   of a module, not a local one; it, arguments and results can be pickled
    ``processes``  at the same time, as many as there are cores by default; with 1, or for a single
                   argument, there is no other process
    ``done``       is called as each result is there

    What a call raises is raised here.  Then, and where this is interrupted, the other calls are
    told to end, which they do as a command does that is interrupted, and waited for.
    """
    processes = min(cores() if processes is None else processes, len(arguments))
    if processes <= 1:
        return [_told(function(argument), done) for argument in arguments]
    waiting = iter(enumerate(arguments))
    running: dict[Any, tuple[int, subprocess.Popen[bytes]]] = {}
    results: dict[int, Result] = {}
    try:
        while len(results) < len(arguments):
            while len(running) < processes and (call := next(waiting, None)) is not None:
                place, argument = call
                with uninterrupted():
                    process = _start(function, argument)
                    running[process.stdout] = place, process
            for output in wait(list(running)):
                place, process = running[output]
                results[place] = _told(_result(process), done)
                del running[output]
    finally:
        with uninterrupted():
            for _, process in running.values():
                process.terminate()
            for _, process in running.values():
                with process:  # which closes its output and waits for it
                    pass
    return [results[place] for place in range(len(arguments))]


def run_jobs(jobs: Sequence[Any], kind: str, processes: int | None = None,
             step: Callable[[str], None] = lambda doing: None) -> list[Any]:
    """What each job's ``run`` returns, as ``in_processes`` has it.

    ``kind``  what jobs are called where there are many
    ``step``  is called as the work begins, and as each result is there, with what is being done
    """
    doing = f"{len(jobs)} {kind}, {min(len(jobs), processes or cores())} at a time"
    step(doing)
    return in_processes(methodcaller("run"), jobs, processes, partial(step, doing))


def _told(result: Result, done: Callable[[], None]) -> Result:
    done()
    return result


def _start(function: Callable[[Argument], Result], argument: Argument) -> subprocess.Popen[bytes]:
    """A session of its own keeps Ctrl-C from it: this process ends it, once."""
    with tempfile.TemporaryFile() as call:
        pickle.dump((function, argument), call)
        call.seek(0)
        path = os.pathsep.join(filter(None, sys.path))
        return subprocess.Popen(_PROGRAM, stdin=call, stdout=subprocess.PIPE,
                                start_new_session=True, env=os.environ | {"PYTHONPATH": path})


def _result(process: subprocess.Popen[bytes]) -> Any:
    answer, _ = process.communicate()
    if process.returncode:
        raise RuntimeError(f"a process of {__name__} ended with {process.returncode}")
    result = pickle.loads(answer)
    if isinstance(result, _Raised):
        raise result.error
    return result


def serve() -> None:
    """In the other process: one call from the standard input, its result to the standard output."""
    try:
        with interruptible(), redirect_stdout(sys.stderr):
            function, argument = pickle.load(sys.stdin.buffer)
            try:
                result = function(argument)
            except Exception as error:
                error.add_note("".join(traceback.format_exception(error)))
                result = _Raised(error)
            answer = pickle.dumps(result)
    except Interrupted as interruption:
        sys.exit(interruption.status)
    with suppress(BrokenPipeError):  # nobody waits any more
        sys.stdout.buffer.write(answer)
        sys.stdout.flush()
