"""A sweep on a real Dask scheduler with two workers on the loopback, one of which is killed."""

import json
import signal
import subprocess
import sys
import time
from contextlib import ExitStack

import pytest
from atlas_sweeps import SMALL, labels

from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.atlas.points.measure import batches, measure
from cardcage.testbenches.atlas.running.sweep import Sweep
from cardcage.testbenches.atlas.running.workers import ClusterWorkers, workers_for
from cardcage.testbenches.support.measurement_cache import package_hash

HERE = ("--host", "127.0.0.1", "--no-dashboard")
SECONDS = 100


def start(running, name, *words):
    process = subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{name}", *words],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def end():
        process.terminate()
        process.wait(SECONDS)

    running.callback(end)
    return process


@pytest.fixture
def cluster(tmp_path):
    """The address of a scheduler, and its two workers."""
    with ExitStack() as running:
        file = tmp_path / "scheduler.json"
        start(running, "scheduler", *HERE, "--port", "0", "--scheduler-file", str(file))
        deadline = time.monotonic() + SECONDS
        address = None
        while address is None:
            assert time.monotonic() < deadline
            time.sleep(0.05)
            try:
                address = json.loads(file.read_text(encoding="utf-8"))["address"]
            except (OSError, ValueError):
                continue  # it is not there, or not whole yet
        yield address, [start(running, "worker", address, *HERE, "--nthreads", "1", "--no-nanny")
                        for _ in range(2)]


def test_a_killed_worker_loses_nothing(cluster, tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    address, workers = cluster
    points = SMALL.points()
    wanted = [outcome for batch in batches(points, package_hash()) for outcome in measure(batch)]
    sweep = Sweep(points, _Both(address))
    came = []

    def done(more, label):
        came.append(label)
        if len(came) == 2:  # after the first result
            workers[0].send_signal(signal.SIGKILL)
            workers[0].wait(SECONDS)

    found = sweep.run(done)
    assert workers[0].returncode == -signal.SIGKILL
    assert workers[1].poll() is None
    assert list(found.values()) == wanted
    again = Sweep(points, ClusterWorkers("tcp://127.0.0.1:1"))  # nobody is asked
    assert labels(again.run()) == labels(found)
    assert again.recalled == len(points)


class _Both(ClusterWorkers):
    """Begins when both workers have come."""

    def __enter__(self):
        super().__enter__()
        self._client.wait_for_workers(2, timeout=SECONDS)
        self.width = 4
        return self


def test_nobody_there_is_one_line(monkeypatch):
    monkeypatch.setattr("cardcage.testbenches.atlas.running.workers.ANSWER_SECONDS", 1)
    sweep = Sweep(SMALL.points()[:1], workers_for("tcp://127.0.0.1:1", None))
    monkeypatch.setattr("cardcage.testbenches.atlas.running.sweep.recall", lambda parts: None)
    with pytest.raises(InputError, match="does not answer") as error:
        sweep.run()
    assert str(error.value).startswith("--cluster: tcp://127.0.0.1:1 does not answer")
    assert "\n" not in str(error.value)
