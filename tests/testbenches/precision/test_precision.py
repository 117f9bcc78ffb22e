"""``cardcage precision``: what is measured, what is written, and how it ends."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from click.testing import CliRunner
from PIL import Image
from refusals import refusal

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.fpga.place_and_route import Placement
from cardcage.testbenches.frames.simulation import simulate
from cardcage.testbenches.precision import scene_precision as module
from cardcage.testbenches.precision.precision_chart import (
    PEER_CASE,
    PEER_FRAGMENTS,
    SpeedPoint,
    measured_peers,
    own_points,
    pareto_front,
    peer_points,
)
from cardcage.testbenches.precision.precision_facts import precision_facts
from cardcage.testbenches.precision.precision_report import PRECISION_FILES, precision_page
from cardcage.testbenches.precision.precision_table import (
    number,
    precision_table,
    precision_text,
    tables,
)
from cardcage.testbenches.precision.scene_precision import (
    Frame,
    PrecisionOptions,
    common_model,
    measure_precision,
)
from cardcage.testbenches.speed.cases import case_lists

SCENE = "random:n=12,size=8,seed=5"
TINY = {"cards": "PM", "size": (16, 16)}
ARGUMENTS = ["precision", SCENE, "--cards", "PM", "--size", "16x16"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    return tmp_path


@pytest.fixture
def recorded(recording, monkeypatch):
    """Frames are simulated once for all tests."""
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: recording})


@pytest.fixture
def study(recorded):
    return measure_precision(SCENE, PrecisionOptions(**TINY), "cardcage precision <&>")


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def test_rows(study):
    bits = [row.point.fraction_bits for row in study.rows]
    assert bits == sorted(bits) and bits[0] == 0 and bits[-1] == study.machine.fraction_bits
    assert study.problems() == []
    # With pysim three of them are simulated, and every pixel of these was compared.
    simulated = [row for row in study.rows if row.frame is not None]
    assert len(simulated) == 3 and {simulated[0], simulated[-1]} == {study.rows[0], study.rows[-1]}
    for row in simulated:
        assert row.frame.equal and row.frame.engine == "pysim" and row.frame.cycles > 100
    last = study.rows[-1]
    assert study.fragments_per_clock(last) == last.frame.fragments / last.frame.cycles
    # The others are as their nearest neighbour.
    assert study.frame(study.rows[-2]) in {row.frame for row in simulated}
    assert all(row.placement is None for row in study.rows)
    assert study.megafragments_per_second(last) is None


def test_one_model_draws_as_the_coarser_ones():
    """Told planes of fewer bits it does what a machine built for them does: every pixel, every
    count, every clock."""
    listed = make_display_list(SCENE, width=16, height=16).display_list
    machines = [plan(listed, cards="PM", clocks_per_pixel=2, fraction_bits=bits).configuration
                for bits in (None, 0)]
    model = common_model(machines)
    assert model.fraction_bits == machines[0].fraction_bits
    assert model.channel_plane_bits > machines[0].channel_plane_bits
    coarse = machines[1]
    built = simulate(coarse, listed, PysimEngine())
    told = simulate(model, listed, PysimEngine(), fraction_bits=0)
    assert (told.video == built.video).all() and (told.depth == built.depth).all()
    assert told.work == built.work
    assert (told.draw_cycles, told.cycles) == (built.draw_cycles, built.cycles)
    # And not what it draws of its own.
    assert (told.depth != simulate(model, listed, PysimEngine()).depth).any()


def test_machines_of_one_model_differ_in_precision_alone():
    listed = make_display_list(SCENE, width=16, height=16).display_list
    machine = plan(listed, cards="PM").configuration
    with pytest.raises(ValueError, match="too many values"):
        common_model([machine, replace(machine, fifo_depth=7, fraction_bits=3)])


def test_frames_are_kept(recorded, monkeypatch):
    first = measure_precision(SCENE, PrecisionOptions(**TINY))

    def no_more(*arguments, **options):
        raise AssertionError("simulated again")

    monkeypatch.setattr(module, "simulate_frame", no_more)
    second = measure_precision(SCENE, PrecisionOptions(**TINY))
    assert [row.frame for row in second.rows] == [row.frame for row in first.rows]
    with pytest.raises(AssertionError, match="simulated again"):
        measure_precision(SCENE, PrecisionOptions(**TINY, shading="flat"))


def test_an_interrupted_run_goes_on(recorded, monkeypatch):
    simulated = []
    frame = module.simulate_frame

    def once(*arguments, **options):
        if simulated:
            raise KeyboardInterrupt
        simulated.append(options["fraction_bits"])
        return frame(*arguments, **options)

    monkeypatch.setattr(module, "simulate_frame", once)
    assert run(*ARGUMENTS).exit_code != 0
    assert not Path("cardcage-out").exists()
    monkeypatch.setattr(module, "simulate_frame", lambda *arguments, **options: simulated.append(
        options["fraction_bits"]) or frame(*arguments, **options))
    assert run(*ARGUMENTS).exit_code == 0
    assert len(simulated) == len(set(simulated)) == 3


def test_all_are_simulated_if_asked(monkeypatch):
    simulated = Frame(100, 50, True, "verilator")
    monkeypatch.setattr(module, "_frame", lambda *arguments: simulated)
    for options in ({"simulate": "all"}, {}):
        done = measure_precision(SCENE, PrecisionOptions(**TINY, **options))
        assert all(row.frame == simulated for row in done.rows)
    done = measure_precision(SCENE, PrecisionOptions(**TINY, simulate="few"))
    assert sum(row.frame is not None for row in done.rows) == 3
    few = measure_precision(SCENE, PrecisionOptions(**TINY, engine="none"))
    assert all(row.frame is None for row in few.rows)
    assert few.fragments_per_clock(few.rows[0]) is None


class TagCounter(HTMLParser):
    def __init__(self, page):
        super().__init__()
        self.open, self.sources = [], []
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "br", "img", "use", "path"):
            self.open.append(tag)
        self.sources += [value for name, value in attributes if name in ("src", "href")]

    def handle_startendtag(self, tag, attributes):
        self.sources += [value for name, value in attributes if name in ("src", "href")]

    def handle_endtag(self, tag):
        if tag not in ("use", "path"):
            assert self.open.pop() == tag


def placed(study):
    """The study as if its machines had been placed: the coarser the faster."""
    rows = [replace(row, placement=Placement({"LUT4": 100, "CCU2C": 10, "TRELLIS_FF": 7},
                                             (90.0 - row.point.fraction_bits, 80.0, 95.0)))
            for row in study.rows]
    return replace(study, rows=tuple(rows))


def test_page(study):
    for shown in (study, placed(study)):
        page = precision_page(shown)
        parser = TagCounter(page)
        # Nothing is fetched from anywhere.
        assert all(source.startswith("#") for source in parser.sources)
        assert not re.search(r"https?://", page) and "<svg" in page
        assert "cardcage precision &lt;&amp;&gt;" in page
        for word in ("natanbc", "PixelForge", "pico-gs", "float32 Z-buffer", "good: 0 LSB"):
            assert word in page
    equipped = replace(study, missing_tools=None)
    assert "--place-and-route measures them" in precision_page(equipped)
    assert "--place-and-route measures them" not in page


def test_table(study):
    text = precision_text(study)
    [errors, _, speed] = tables(study)
    assert len(errors.rows) == len(study.rows) + 1 and errors.rows[-1][0] == "float32 Z-buffer"
    exact = errors.rows[-2]
    assert exact[0] == f"{study.machine.fraction_bits} exact" and exact[1:6] == ("0",) * 5
    assert all(len(row) == len(table.columns) for table in tables(study) for row in table.rows)
    assert [row[2] for row in speed.rows].count("simulated") == 3
    equipped = tables(replace(study, missing_tools=None))[2]
    assert {row[4] for row in equipped.rows} == {"--place-and-route"}
    assert "  nearest  " in text and text.startswith("good: ")
    assert all(line == line.rstrip() for line in text.splitlines())
    row = tables(placed(study))[2].rows[0]
    assert row[4:9] == ("120", "7", "0", "0", "0") and row[9] == "90.0"
    assert [number(value) for value in (0.0, 2.0, 0.1234, 5.55, 3690.9, 1e6)] == [
        "0", "2", "0.12", "5.5", "3,691", "1,000,000"]


def test_terminal_tables_lose_nothing(study, monkeypatch, capsys):
    """However narrow the terminal is."""
    monkeypatch.setenv("COLUMNS", "60")
    precision_table(placed(study))
    shown = capsys.readouterr().out
    assert "\N{HORIZONTAL ELLIPSIS}" not in shown
    for table in tables(placed(study)):
        for row in table.rows:
            assert re.search(r" +".join(map(re.escape, row)), shown), row


def test_without_the_extra(study):
    missing = replace(study, missing_tools="needs pip install 'cardcage[fpga]'")
    assert {row[4] for row in tables(missing)[2].rows} == {"needs pip install 'cardcage[fpga]'"}
    assert "area and clock: needs pip install 'cardcage[fpga]'" in precision_text(missing)
    assert "needs pip install &#39;cardcage[fpga]&#39;" in precision_page(missing)


def test_pareto_front():
    points = [SpeedPoint(*values) for values in (
        ("a", 0, 1), ("b", 1, 2), ("c", 1, 1.5), ("d", 2, 2), ("e", 3, 4), ("f", 0, 1))]
    assert [point.label for point in pareto_front(points)] == ["a", "f", "b", "e"]
    assert pareto_front([]) == []


def test_points(study):
    full = placed(study)
    clock, second = own_points(full, "clock"), own_points(full, "second")
    assert len(clock) == len(second) == len(full.rows)
    assert clock[-1].label == "exact" and clock[-1].error == second[-1].error == 0
    # Errors in LSB of 16 bits, whatever the picture's.
    assert clock[0].error == full.rows[0].point.error.depth_maximum / 256
    assert second[0].speed == pytest.approx(clock[0].speed * 90)
    assert precision_facts(full)["pareto_front"]["second"][-1] == "0"
    assert {point.label for point in peer_points("clock")} == {"natanbc", "PixelForge", "pico-gs"}
    [natanbc] = peer_points("second")
    assert (natanbc.error, round(natanbc.speed)) == (702, 44)
    assert all(rate < 1 for _, rate in measured_peers())


def test_the_peers_triangle_has_so_many_fragments():
    from cardcage.golden.reference.exact import depth_complexity

    once = case_lists(PEER_CASE, "visible").once
    assert depth_complexity(once).sum() == PEER_FRAGMENTS * once.triangles


def test_command(recorded):
    result = run(*ARGUMENTS, "--out", "study")
    assert result.exit_code == 0, result.output
    assert result.stderr == ""  # no terminal: no progress bar
    assert result.stdout.startswith("good: 0 LSB at exact, no bound exceeded at ")
    assert result.stdout.endswith(f"report: {Path('study', 'precision.html')}\n")
    assert sorted(path.name for path in Path("study").iterdir()) == sorted(PRECISION_FILES)
    facts = json.loads(Path("study/precision.json").read_text())
    assert facts["good"] is True and facts["problems"] == []
    assert facts["command_line"].startswith("cardcage precision random:n=12")
    assert facts["fraction_bits"][-1]["error"]["depth_maximum"] == 0
    assert facts["fraction_bits"][-1]["bound"] == 0
    assert all(row["within_bound"] for row in facts["fraction_bits"])
    assert {point["sub_bits"] for point in facts["formats"]} == {1, 2, 4, 6, 8}
    with Image.open("study/precision.png") as picture:
        assert picture.width > 800


def test_a_frame_that_differs(recording, tampering, monkeypatch):
    broken = tampering(recording, depths={3: 5})
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: broken})
    result = run(*ARGUMENTS)
    assert result.exit_code == 1
    assert result.stdout.startswith("FAILED: 0 fraction bits: the simulated frame differs")
    assert json.loads(Path("cardcage-out/precision.json").read_text())["good"] is False


def test_a_bound_that_is_exceeded(recorded, monkeypatch):
    monkeypatch.setattr("cardcage.golden.specification.fixed_point.error_bound",
                        lambda bits, extent: 1)
    result = run(*ARGUMENTS, "--engine", "none")
    assert result.exit_code == 1
    assert re.match(r"FAILED: 0 fraction bits: depth off by \d+ LSB, .*the bound is 1\n",
                    result.stdout)


@pytest.mark.parametrize(("arguments", "message"), [
    (["teapott"], "did you mean teapot"),
    (["hard:crossing"], "did you mean crossing"),
    ([SCENE, "--size", "0x9"], "width 0"),
    ([SCENE, "--seeds", "0"], "--seeds"),
    ([SCENE, "--fraction-bits", "3"], "--fraction-bits"),
    ([SCENE, "--out", "file"], "file is a file"),
])
def test_refuses(arguments, message):
    Path("file").write_text("")
    assert message in refusal(run, "precision", *arguments)
    assert [path.name for path in Path().iterdir()] == ["file"]


def test_without_the_tools_the_option_is_refused(monkeypatch):
    monkeypatch.setattr("cardcage.testbenches.fpga.place_and_route.importlib.util.find_spec",
                        lambda name: None)
    result = run(*ARGUMENTS, "--engine", "none", "--place-and-route")
    assert result.exit_code == 2
    assert "needs pip install 'cardcage[fpga]'" in result.stderr
    assert not Path("cardcage-out").exists()


def test_hard_case_and_empty_scene():
    result = run("precision", "hard:crossing-3-lsb", "--engine", "none", "--out", "crossing")
    assert result.exit_code == 0, result.output
    facts = json.loads(Path("crossing/precision.json").read_text())
    wrong = [row["error"]["wrong_pixels"] for row in facts["fraction_bits"]]
    assert wrong[0] > 100 and wrong[-1] == 0
    assert "no frame was simulated" in result.stdout
    result = run("precision", "hard:empty", "--engine", "none", "--out", "empty")
    assert result.exit_code == 0, result.output


