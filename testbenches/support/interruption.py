"""Ctrl-C, SIGTERM and a closed terminal as an exception that leaves nothing half-done."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_AGAIN_SECONDS = 0.01


class Interrupted(BaseException):
    """The user or the system wants the program to end.

    ``number`` is the signal's, ``status`` the exit status by the shell's custom: 130 for Ctrl-C,
    143 for SIGTERM, 129 for SIGHUP, which a terminal sends when it is closed.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number
        self.status = 128 + number


def _raise(number: int, _frame: object) -> None:
    raise Interrupted(number)


def _in_main_thread() -> bool:
    # Python runs signal handlers, and lets them be changed, in the main thread only.
    return threading.current_thread() is threading.main_thread()


@contextmanager
def _handlers(handler: object) -> Iterator[None]:
    # Who starts a program with nohup wants it to survive the terminal.
    heard = [number for number in SIGNALS if number != signal.SIGHUP
             or signal.getsignal(number) != signal.SIG_IGN]
    before = {number: signal.signal(number, handler) for number in heard}  # type: ignore[arg-type]
    try:
        yield
    finally:
        for number, previous in before.items():
            signal.signal(number, previous)


@contextmanager
def _again_if_swallowed() -> Iterator[None]:
    # Where a signal falls into a finaliser or a weak reference's callback, Python prints the
    # exception and goes on. The signal is sent again a little later, when the program is elsewhere.
    before = sys.unraisablehook
    timers: list[threading.Timer] = []

    def hook(swallowed: sys.UnraisableHookArgs) -> None:
        if not isinstance(swallowed.exc_value, Interrupted):
            before(swallowed)
            return
        again = os.getpid(), swallowed.exc_value.number
        timers.append(threading.Timer(_AGAIN_SECONDS, os.kill, again))
        timers[-1].start()

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before
        for timer in timers:
            timer.cancel()


@contextmanager
def interruptible() -> Iterator[None]:
    """Within, each of ``SIGNALS`` raises ``Interrupted``; no effect outside the main thread."""
    if not _in_main_thread():
        yield
        return
    with _again_if_swallowed(), _handlers(_raise):
        yield


@contextmanager
def saying(kept: Callable[[], str]) -> Iterator[None]:
    """A command that is interrupted within ends with a line: what ``kept`` says is left of it."""
    try:
        yield
    except Interrupted as interruption:
        interruption.add_note(kept())
        raise


@contextmanager
def uninterrupted() -> Iterator[None]:
    """A signal that arrives within takes effect at the end: for clean-up and renaming."""
    if not _in_main_thread():
        yield
        return
    arrived: list[int] = []
    try:
        with _handlers(lambda number, _frame: arrived.append(number)):
            yield
    finally:
        if arrived:
            signal.raise_signal(arrived[0])
