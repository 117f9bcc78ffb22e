"""Calls in processes: their results, what they raise, and that they end when nobody waits."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import time

import pytest

from cardcage.golden.specification.card_order import parse_cards
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.support.interruption import Interrupted
from cardcage.testbenches.support.processes import in_processes


@pytest.fixture
def started(monkeypatch):
    """The processes that were started in the test."""
    found = []

    class Popen(subprocess.Popen):
        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            found.append(self)

    monkeypatch.setattr(subprocess, "Popen", Popen)
    return found


def all_ended(started, number):
    return len(started) == number and all(process.returncode is not None for process in started)


def test_every_result_has_its_place(started):
    done = []
    assert in_processes(math.factorial, [3, 5, 4], 2, lambda: done.append(1)) == [6, 120, 24]
    assert done == [1, 1, 1]
    assert all_ended(started, 3)


@pytest.mark.parametrize(("numbers", "processes"), [([4], 8), ([4, 5], 1), ([], None)])
def test_alone_there_is_no_other_process(started, numbers, processes):
    done = []
    sums = in_processes(lambda number: number + os.getpid(), numbers, processes,
                        lambda: done.append(1))
    assert sums == [number + os.getpid() for number in numbers]
    assert len(done) == len(numbers)
    assert started == []


def test_what_a_call_raises_is_raised(started):
    with pytest.raises(InputError, match="'Q' at position 2 is no card") as raised:
        in_processes(parse_cards, ["PQ", "PM"], processes=2)
    assert "Traceback" in raised.value.__notes__[0]
    assert all_ended(started, 2)


def test_a_process_that_dies_is_no_result(started):
    with pytest.raises(RuntimeError, match="ended with -9"):
        in_processes(signal.raise_signal, [signal.SIGKILL] * 2, processes=2)
    assert all_ended(started, 2)


def test_an_interruption_ends_all(started):
    """A call is told with SIGTERM, and ends as a command does."""
    began = time.perf_counter()

    def interrupt():
        raise Interrupted(signal.SIGINT)

    with pytest.raises(Interrupted):
        in_processes(time.sleep, [0.01, 60], processes=2, done=interrupt)
    assert time.perf_counter() - began < 30
    assert all_ended(started, 2)
