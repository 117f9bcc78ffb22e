"""Nodes that take messages, against a clock that is moved by hand."""

import numpy as np
import pytest

from cardcage.testbenches.figures.blazek.his_machine.queues import forwarded, served


def test_one_after_another():
    random = np.random.default_rng(1)
    arrival, work = np.sort(random.uniform(0, 60, 50)), random.uniform(0, 2, 50)
    done, expected = 0.0, []
    for comes, takes in zip(arrival, work, strict=True):
        done = max(done, comes) + takes
        expected.append(done)
    assert served(arrival, work) == pytest.approx(expected)
    assert len(served(arrival[:0], work[:0])) == 0


def test_without_forwarding_it_is_a_queue():
    random = np.random.default_rng(2)
    arrival, drawing = np.sort(random.uniform(0, 40, 30)), random.uniform(0, 2, 30)
    home = (np.arange(30) % 3).tolist()
    done, busy = forwarded(arrival, home, [[node] for node in home], 0.5,
                           [[each] for each in drawing.tolist()], 0.1, 3)
    for node in range(3):
        assert done[node] == pytest.approx(served(arrival[node::3], 0.5 + drawing[node::3])[-1])
    assert sum(busy) == pytest.approx(15 + drawing.sum())


def test_objects_are_passed_on():
    """Node 0 has both from the host: one that is node 1's alone, and one that both draw."""
    done, busy = forwarded(np.array([1.0, 1.5]), [0, 0], [[1], [0, 1]], 10.0,
                           [[3.0], [5.0, 7.0]], 1.0, 2)
    # 1 + 10 + 1 for the first; 10 + 1 + 5 for the second.
    assert done[0] == 28
    # From 12 on 10 + 3, and from 25 on, for which it came at 23, 10 + 7.
    assert done[1] == 42
    assert busy == [27, 30]


def test_the_host_has_no_turn_of_its_own():
    """What comes first is taken first, whoever sends it."""
    done, _ = forwarded(np.array([0.0, 3.5]), [0, 1], [[1], [1]], 1.0, [[2.0], [4.0]], 1.0, 2)
    assert done[1] == 2 + 1 + 2 + 1 + 4
