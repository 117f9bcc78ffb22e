"""How many fragments a clock reach memory through a direct merge."""

import pytest
from node_frames import compiled
from suite.cases import EVERY

from cardcage.golden.planning.machine_plan import plan
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.simulation import simulate
from cardcage.testbenches.speed.cases import case_lists

ELEMENTS = 4


@pytest.mark.parametrize(("queue", "least"), [
    pytest.param(4, 0.9, marks=EVERY), pytest.param("element", 0.7, marks=EVERY)])
def test_elements_that_draw_the_same_at_the_same_time(queue, least, record_property):
    """Small triangles, the worst for a crossbar, so that elements want one unit again and again;
    of sixteen elements ``python -m testbenches.studies.direct_speed`` prints the figures."""
    listed = case_lists("random_bbox16", order="random", times=ELEMENTS).once
    machine = plan(listed, cards=f"{ELEMENTS}x(P)D{ELEMENTS}x(M)", memory_ports=2,
                   packet="contiguous", retain=True, queue=queue).configuration
    simulation = simulate(machine, listed, compiled())
    assert compare(machine, listed, simulation).equal
    fragments = sum(work.fragments for work in simulation.work)
    assert sum(simulation.taken) == fragments and sum(simulation.followed) > 0
    rate = fragments / simulation.draw_cycles
    record_property("measured", f"direct merge 4x4, queue {queue}: {rate:.2f} fragments a clock")
    assert rate >= least * ELEMENTS
