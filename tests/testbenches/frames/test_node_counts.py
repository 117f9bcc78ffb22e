"""What nodes count is compared with what the golden model says, count by count."""

from dataclasses import replace

from click.testing import CliRunner

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.frames.node_counts import (
    count_differences,
    node_figures,
    unit_differences,
)
from cardcage.testbenches.frames.simulation import simulate_frame

LIST = make_display_list("random:n=12,size=5,seed=5", width=8, height=8,
                         shading="flat").display_list


def lines(cards, **changes):
    machine = plan(LIST, cards=cards, clocks_per_pixel=2).configuration
    simulation = simulate_frame(machine, LIST, engine="pysim")
    simulation = replace(simulation, **{name: change(getattr(simulation, name))
                                        for name, change in changes.items()})
    golden = merge_cage(machine, LIST)[1]
    return [*count_differences(node_figures(machine, LIST, simulation, golden)),
            *unit_differences(simulation, golden)]


def one_more(counts):
    return [counts[0] + 1, *counts[1:]]


def test_every_count():
    assert lines("2x(PMS)F") == lines("PPDMM") == []
    [line] = lines("2x(PMT)", sent=lambda sent: [*sent[:-1], sent[-1] + 7])
    assert line.startswith("node 1 sent ") and "pixels, golden " in line
    [line] = lines("2x(PMC)", work=lambda work: [replace(work[0], fragments=3), *work[1:]])
    assert line.startswith("node 0 drew 3 fragments, golden ")
    [line] = lines("PPDMM", taken=one_more)
    assert line.startswith("memory unit 0 took ") and "fragments, golden " in line


def test_a_wrong_count_is_warned_of(tmp_path, monkeypatch):
    """It is no fault of the picture, which is said to be equal, and the status says that something
    is not."""
    monkeypatch.chdir(tmp_path)

    def miscounted(*arguments, **options):
        simulation = simulate_frame(*arguments, **options)
        return replace(simulation, sent=one_more(simulation.sent))

    monkeypatch.setattr("cardcage.testbenches.render.simulate_frame", miscounted)
    result = CliRunner().invoke(main, ["render", "random:n=12,size=5,seed=5", "--size", "8x8",
                                       "--cards", "2x(PMC)", "--engine", "pysim"])
    assert result.exit_code == 1 and result.stdout.startswith("equal: 64 colours")
    assert "node 0 sent 65 pixels, golden 64" in result.stderr
