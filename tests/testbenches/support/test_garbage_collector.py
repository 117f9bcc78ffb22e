"""The garbage collector rests while a netlist is made, and only then."""

from __future__ import annotations

import gc

import pytest

from cardcage.testbenches.support.garbage_collector import collector_paused


def test_paused():
    with collector_paused():
        assert not gc.isenabled()
    assert gc.isenabled()


def test_goes_on_after_an_error():
    with pytest.raises(KeyError), collector_paused():
        raise KeyError
    assert gc.isenabled()


def test_stays_off_where_it_was():
    gc.disable()
    try:
        with collector_paused():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
