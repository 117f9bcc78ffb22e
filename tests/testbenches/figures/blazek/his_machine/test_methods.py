"""His methods where most things cost nothing, so that a frame can be worked out."""

from dataclasses import replace

import pytest

from cardcage.testbenches.figures.blazek.his_machine.costs import COSTS
from cardcage.testbenches.figures.blazek.his_machine.methods import (
    Scene,
    broadcast,
    forwarding,
    host_initiated,
    node_initiated,
)

SIZE = (64, 64)
PIXELS = 64 * 64
FREE = replace(COSTS, byte=0.0, message=0.0, parse=0.0, tessellate=0.0, discard=0.0, polygon=0.0,
               line=0.0, pixel=0.0, merge_pixel=0.0)


def scene(spheres=6, **costs):
    return Scene.of(SIZE, 0, spheres, replace(FREE, **costs))


def test_messages():
    assert COSTS.message_time(100) == pytest.approx(400e-6)
    assert COSTS.message_time([100, 101]).tolist() == pytest.approx([400e-6, 679e-6])


def test_work_is_shared():
    of_six = scene(tessellate=1.0, polygon=2.0)
    assert node_initiated(of_six, 1).seconds == pytest.approx(6 * 3 * 5120)
    assert node_initiated(of_six, 4).seconds == pytest.approx(2 * 3 * 5120)
    assert node_initiated(of_six, 32).seconds == pytest.approx(3 * 5120)
    # The host alone tessellates; the last packet of a polygon or more is then still to be drawn.
    assert host_initiated(of_six, 32, 1000).seconds == pytest.approx(6 * 5120 + 2 * 720)
    assert host_initiated(of_six, 1, 10).seconds == pytest.approx(10 + 6 * 2 * 5120)


def test_on_one_node_three_methods_are_one():
    costly = Scene.of(SIZE, 1, 9)
    expected = node_initiated(costly, 1).seconds
    for method in (forwarding, broadcast):
        for parts in ("strips", "lines") if method is broadcast else ("strips", "grid"):
            assert method(costly, 1, parts).seconds == pytest.approx(expected)


def test_packets_are_sent():
    sending = scene(1, byte=1.0, message=7.0, parse=3.0)
    packets = -(-5120 // 100)
    assert host_initiated(sending, 4, 100).host == pytest.approx(
        3 + 7 * packets + sending.costs.polygon_bytes * 5120)
    assert node_initiated(scene(5, byte=1.0, message=7.0, parse=3.0), 2).host == 5 * (100 + 3)


def test_pictures_come_together():
    """Whole pictures in two steps, parts of one a quarter and then a half."""
    merged = node_initiated(scene(1, byte=1.0, object_bytes=0, merge_pixel=0.5), 4)
    assert merged.seconds == pytest.approx(2 * PIXELS * (10 + 0.5))
    pasted = broadcast(scene(1, byte=1.0, object_bytes=0), 4)
    assert pasted.drawn == 0 and pasted.seconds == pytest.approx(3 * PIXELS * (1 / 4 + 1 / 2))


def test_a_broadcast_tessellates_everywhere():
    found = broadcast(scene(4, tessellate=1.0, discard=0.25), 8)
    assert found.drawn == pytest.approx(4 * 5120 * 1.25) and found.busy == 8 * found.drawn
    assert found.passed == 4 * 7
    # By log2 steps the last node has an object later than by one message.
    by_steps = broadcast(scene(1, byte=1.0), 8)
    assert by_steps.drawn == pytest.approx(4 * 100)
    assert broadcast(scene(1, byte=1.0), 8, hierarchical=False).drawn == pytest.approx(8 * 100)


def test_an_object_is_tessellated_where_it_is_drawn_and_where_it_came_first():
    found = forwarding(scene(40, tessellate=1.0), 16)
    drawn = scene(40, polygon=1.0).drawing(16, "strips") > 0
    elsewhere = sum(not drawn[number, number % 16] for number in range(40))
    assert found.busy == pytest.approx(5120 * (drawn.sum() + elsewhere))
    assert found.passed == drawn.sum() + elsewhere - 40
