"""Sweeps whose processes are killed, whose points fail, or that are interrupted: the same results,
nothing kept that is wrong."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from atlas_sweeps import ONCE, SMALL, UNLUCKY, ends_always, ends_once, fails, labels

from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.atlas.atlas import AtlasOptions, make_atlas
from cardcage.testbenches.atlas.points.atlas_point import Failure
from cardcage.testbenches.atlas.points.measure import Batch, batches, measure
from cardcage.testbenches.atlas.running.sweep import KEPT, Sweep
from cardcage.testbenches.atlas.running.workers import LocalWorkers
from cardcage.testbenches.support.measurement_cache import package_hash


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """A cache of its own."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("CARDCAGE_CACHE", str(folder))
    monkeypatch.setenv(ONCE, str(tmp_path))
    return folder


@pytest.fixture(scope="module")
def wanted():
    """What one call after the other finds, in this process."""
    points = SMALL.points()
    outcomes = [outcome for batch in batches(points, package_hash()) for outcome in measure(batch)]
    return dict(zip((point.label for point in points), outcomes, strict=True))


def sweep(measuring=measure, points=None, processes=2):
    made = Sweep(SMALL.points() if points is None else points, LocalWorkers(processes), measuring)
    return made, labels(made.run())


def test_a_pool_finds_what_one_process_finds_and_the_next_sweep_remembers(wanted):
    first, found = sweep()
    assert found == wanted and list(found) == list(wanted)
    assert first.recalled == 0
    again, remembered = sweep(ends_always)  # who is never asked
    assert remembered == wanted
    assert again.recalled == len(wanted)


def test_a_process_killed_once_costs_nothing(wanted, tmp_path):
    _, found = sweep(ends_once)
    assert (tmp_path / "ended").exists(), "no process was killed: this shows nothing"
    assert found == wanted


def test_a_point_that_kills_its_process_is_reported_and_stops_no_other(wanted):
    _, found = sweep(ends_always)
    [unlucky] = [label for label in wanted if UNLUCKY in label]
    assert isinstance(found[unlucky], Failure) and found[unlucky].failed
    assert "ended from outside" in found[unlucky].reason
    assert {label: outcome for label, outcome in found.items() if label != unlucky} == {
        label: outcome for label, outcome in wanted.items() if label != unlucky}
    again, found = sweep()  # what failed was not kept
    assert found == wanted
    assert again.recalled == len(wanted) - 1


def test_a_call_that_goes_wrong_is_a_failure_of_its_points(wanted):
    _, found = sweep(fails, processes=1)
    failures = [label for label, outcome in found.items() if isinstance(outcome, Failure)]
    assert len(failures) == 1 and UNLUCKY in failures[0]
    assert found[failures[0]].reason == "ArithmeticError: nobody foresaw this"


def test_a_machine_that_there_cannot_be_is_refused(cache):
    asked = replace(SMALL, cages=("PM", "PMM PM"), sizes=((16, 16),))
    atlas = make_atlas(replace(asked, processes=1))
    assert [point.cage.label for point in atlas.figures] == ["PM"]
    assert not atlas.differences  # it is no fault of a machine's
    [line] = atlas.warnings
    assert line.startswith("tetra:depth=1 on PMM PM, 1 point: ")
    with pytest.raises(InputError, match="no such machine"):
        make_atlas(replace(asked, cages=("PMM PM",), processes=1))


def test_another_release_is_refused():
    batch = Batch(tuple(SMALL.points()[:1]), "another")
    with pytest.raises(InputError, match="another release"):
        measure(batch)


def test_a_full_disk_keeps_nothing_and_changes_nothing(wanted, cache, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("cardcage.testbenches.support.measurement_cache.store", full)
    made, found = sweep(processes=1)
    assert found == wanted
    assert made.not_kept == "No space left on device"
    assert "could not be kept (No space left on device)" in made.what_is_kept()
    assert not cache.exists()


#: Enough of them to be interrupted among.
COMMAND = [sys.executable, "-m", "cardcage", "atlas", "teapot", "terrain", "--size",
           "32x32", "--nodes", "2,4,8", "--fraction-bits", "exact", "--cages", "PMM",
           "--cages", "PMMC", "--cages", "PMMT", "--processes", "1", "--json", "--out", "report"]
SAME = AtlasOptions(scenes=("teapot", "terrain"), sizes=((32, 32),), nodes=(2, 4, 8),
                    fraction_bits=("exact",), cages=("PMM", "PMMC", "PMMT"))


def kept_in(cache):
    """Results with their last names: what is being written does not count yet."""
    return [path for path in cache.glob("*/measurement.json") if len(path.parent.name) == 32]


def test_an_interrupted_sweep_goes_on(tmp_path, cache):
    running = subprocess.Popen(COMMAND, cwd=tmp_path, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, start_new_session=True)
    deadline = time.monotonic() + 100
    while len(kept_in(cache)) < 3:
        assert running.poll() is None and time.monotonic() < deadline
        time.sleep(0.005)
    os.killpg(running.pid, signal.SIGINT)  # as a terminal does, to all of them
    _, errors = running.communicate(timeout=60)
    assert running.returncode == 130, errors
    assert errors.decode() == f"cardcage: interrupted: {KEPT}\n"
    assert not (tmp_path / "report").exists()
    assert not list(tmp_path.glob(".cardcage-*"))
    kept = len(kept_in(cache))

    done = subprocess.run(COMMAND, cwd=tmp_path, capture_output=True, text=True, timeout=300,
                          check=True)
    facts = json.loads(done.stdout)
    assert 3 <= facts["recalled"] == kept < len(facts["points"]) == 30
    assert Path(tmp_path, "report", "atlas.html").is_file()
    uninterrupted = [outcome for batch in batches(SAME.points(), package_hash())
                     for outcome in measure(batch)]
    for found, wanted in zip(facts["points"], uninterrupted, strict=True):
        assert {name: found[name] for name in wanted} == wanted
