"""Signals that fall where Python swallows exceptions."""

import gc
import signal
import time
import weakref

import pytest

from cardcage.testbenches.support.interruption import SIGNALS, Interrupted, interruptible


class Finalised:
    """Sends itself a signal as it goes."""

    def __init__(self, number):
        self.number = number

    def __del__(self):
        signal.raise_signal(self.number)


class Anything:
    pass


def finaliser(number):
    Finalised(number)


def weak_reference(number):
    thing = Anything()
    reference = weakref.ref(thing, lambda _: signal.raise_signal(number))
    del thing
    assert reference() is None


def cycle(number):
    thing = Finalised(number)
    thing.itself = thing
    del thing
    gc.collect()


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize("place", [finaliser, weak_reference, cycle])
def test_a_swallowed_interruption_comes_again(number, place):
    finished = False
    with pytest.raises(Interrupted) as interruption, interruptible():
        place(number)
        finished = True
        time.sleep(20)
    assert finished, "the signal was not swallowed: this shows nothing"
    assert interruption.value.status == 128 + number


def test_other_exceptions_are_reported_as_before(monkeypatch):
    seen = []
    monkeypatch.setattr("sys.unraisablehook", lambda swallowed: seen.append(swallowed.exc_type))

    class Wrong:
        def __del__(self):
            raise LookupError

    with interruptible():
        Wrong()
    Wrong()
    assert seen == [LookupError, LookupError]
