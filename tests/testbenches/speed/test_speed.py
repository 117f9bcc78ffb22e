"""The ruler: what it measures, what the model says of it, and that wrong pictures have no speed."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage import testbenches
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.planning.scene_needs import fitted
from cardcage.golden.reference.exact import depth_complexity, draw
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.command_line.command_group import EXIT_DIFFERENT
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.speed.cases import (
    DEFAULT_CASES,
    LEAST_TRIANGLES,
    MESH,
    ORDERS,
    CaseLists,
    case_lists,
    case_names,
    peers,
)
from cardcage.testbenches.speed.machines import ALL_MACHINES, bench_machines
from cardcage.testbenches.speed.measure import DifferentError, measure

SMALL = 20
#: What ``cardcage bench`` last printed: who makes the machine slower has to say so here.
BASELINE = Path(testbenches.__file__).parent / "data/bench_baseline.json"


def small_case(seed: int, triangles: int) -> CaseLists:
    """Random triangles on a small screen, each before the one before."""
    random = np.random.default_rng(seed)
    print(f"seed {seed}")

    def some(count: int, begin: int) -> DisplayList:
        depth = 100_000 - 100 * (begin + np.arange(count)[:, np.newaxis]) + random.integers(
            0, 99, (count, 3))
        corner = random.integers(0, SMALL - 8, (count, 1, 2)) + random.integers(0, 9, (count, 3, 2))
        color = random.integers(1, 256, (count, 1, 3), np.uint8).repeat(3, axis=1)
        return DisplayList(SMALL, SMALL, (256 * corner + 128).astype(np.int32), depth, color)

    return CaseLists(f"random {seed}", "visible", some(triangles, 0), some(2 * triangles,
                                                                           triangles))


@pytest.mark.parametrize("name", [name for name in case_names() if name != MESH])
@pytest.mark.parametrize("order", ORDERS)
def test_cases(name, order):
    lists = case_lists(name, order)
    n = lists.once.triangles
    assert n >= LEAST_TRIANGLES and lists.twice.triangles == 2 * n
    assert lists.frame.triangles == 3 * n and lists.frame.flat
    assert len({tuple(triangle) for triangle in lists.frame.depth.tolist()}) == 3 * n
    depth = lists.frame.depth
    assert (np.ptp(depth, axis=1) > 1000).all(), "sloped"
    if order == "visible":
        assert (depth[1:].max(axis=1) < depth[:-1].min(axis=1)).all()
    else:
        assert (depth[1:].max(axis=1) > depth[:-1].min(axis=1)).any()


def test_fragments_are_those_that_the_peers_drew():
    """By the top-left rule, from the same page as their figures."""
    for name, fragments in (("one_pixel", 1), ("right_TL_8", 36), ("right_TL_32", 528),
                            ("right_TL_128", 8256), ("random_bbox16", 23.5),
                            ("sliver_vert_2x480", 720), ("sliver_diag_480", 718)):
        once = case_lists(name).once
        assert depth_complexity(once).sum() / once.triangles == pytest.approx(fragments, abs=0.06)
    by_name = {peer.short: peer for peer in peers()}
    assert by_name["RasterIX"].cycles_per_triangle["one_pixel"] == 12
    assert by_name["natanbc"].depth_error_lsb == [240, 702]


@pytest.mark.parametrize("name", case_names())
def test_the_machines_are_for_the_screen_and_fit_every_case(name):
    """So does a triangle that ends on the screen's right and lower side; none beyond does."""
    machine = bench_machines(replace(ALL_MACHINES, elements=(1,)))[0].configuration
    assert machine.edges_on_screen and machine.stays_in_range
    for order in ORDERS:
        lists = case_lists(name, order)
        for listed in (lists.once, lists.twice):
            assert fitted(machine, listed) is listed
    once, end = lists.once, 512 << 8
    corners = np.array([[[0, 0], [end, 0], [0, end]], [[end, end], [end, 0], [0, end]]], np.int32)
    whole = replace(once, position=corners, depth=once.depth[:2], color=once.color[:2])
    assert fitted(machine, whole) is whole
    with pytest.raises(InputError, match="the machine is built for"):
        fitted(machine, replace(whole, position=corners + 256))


def test_the_mesh_lies_in_three_layers():
    lists = case_lists(MESH)
    assert 50_000 <= lists.once.triangles <= 70_000
    assert lists.twice.depth.max() < lists.once.depth.min()


@pytest.mark.parametrize(("cards", "options"), [
    ("PMM", {"skew": True}), pytest.param("2x(PMM)", {}, marks=EVERY),
    pytest.param("4x(PM)", {"block": 4, "memory_ports": 2}, marks=EVERY),
    pytest.param("PM", {}, marks=EVERY), pytest.param("PMPM", {}, marks=EVERY),
    pytest.param("2x(PMM)", {"lines": True}, marks=EVERY)])
def test_measured_and_predicted(cards, options):
    cases = [small_case(1, 20), small_case(2, 35)]
    configuration = replace(wide_machine(cases[1].frame, cards=cards, **options), observe=True,
                            fraction_bits=40)
    measurements = measure(configuration, cases, PysimEngine())
    for case, measured in zip(cases, measurements, strict=True):
        assert measured.fragments == depth_complexity(case.once).sum()
        assert sum(measured.element_fragments) == depth_complexity(case.twice).sum()
        assert measured.activity.clocks == measured.cycles_twice
        np.testing.assert_array_equal(measured.activity.by_element[:, 0],
                                      measured.element_fragments)
        assert measured.activity.shares()["service"] < 0.01
        assert measured.cycles_once == measured.sustained_cycles + measured.latency
        for cycles, listed in ((measured.cycles_once, case.once),
                               (measured.cycles_twice, case.twice)):
            predicted = predict_cycles(configuration, listed)
            assert predicted.cycles == pytest.approx(cycles, rel=0.05, abs=15)
            assert predicted.bound <= cycles * 1.05


class Tampering:
    """Another engine's run with one pixel of its last scan wrong."""

    name = "tampering"

    def run(self, job, progress=None):
        run = PysimEngine().run(job, progress)
        *scans, last = run.scans
        picture = last.picture.copy()
        picture[3, 4] ^= 1
        return replace(run, scans=[*scans, replace(last, picture=picture)])


def test_a_wrong_picture_has_no_speed():
    case = small_case(3, 4)
    configuration = wide_machine(case.frame, cards="PM")
    with pytest.raises(DifferentError, match=r"random 3.* on PM: 1 colours and 0 depths differ"):
        measure(configuration, [case], Tampering())
    assert (draw(case.frame).winner >= 0).any()


def bench(*arguments, status=0):
    result = CliRunner().invoke(main, ["bench", *map(str, arguments)])
    assert result.exit_code == status, result.output
    return result


def test_the_model_alone(tmp_path):
    result = bench("one_pixel", "right_TL_32", "--engine", "model", "--elements", "1,64", "--fifo",
                   "2,16", "--json", tmp_path / "b.json", "--plot", tmp_path / "b.png")
    assert re.search(r"64x\(PMM\).*FIFO of 2", result.output)
    rows = json.loads((tmp_path / "b.json").read_text())["rows"]
    assert len(rows) == 8 and all(row["predicted_cycles"] > 0 for row in rows)
    assert "cycles" not in rows[0] and rows[0]["peers"]["pico-gs"] == 160
    with Image.open(tmp_path / "b.png") as picture:
        assert picture.size[0] > 500


def test_all_is_what_no_option_restricts(tmp_path):
    machine = ["--all", "--elements", "1", "--units", "2", "--ports", "2", "--setup", "host",
               "--block", "1", "--engine", "model", "--json", tmp_path / "b.json"]
    for options, orders in ([], ORDERS), (["--order", "visible"], ["visible"]):
        bench("one_pixel", *machine, *options)
        rows = json.loads((tmp_path / "b.json").read_text())["rows"]
        assert [row["order"] for row in rows] == list(orders)


def test_the_mesh_can_be_looked_at_from_elsewhere(tmp_path):
    view = ["--view", "90,10", "--zoom", "1.5", "--cull", "--light", "0,0,1"]
    said = bench("mesh", *view, "--engine", "model", "--elements", "1", "--json",
                 tmp_path / "b.json").output
    assert "set-up by the host; mesh in list order\n" in said
    [row] = json.loads((tmp_path / "b.json").read_text())["rows"]
    assert row["case"] == "mesh --view 90,10 --zoom 1.5 --cull --light 0,0,1"
    looking = MachineOptions(view=(90.0, 10.0), zoom=1.5, cull=True, light=(0.0, 0.0, 1.0))
    lists = case_lists(MESH, looking=looking)
    assert row["triangles"] == lists.once.triangles < case_lists(MESH).once.triangles
    assert lists.repeated(2).once.triangles == lists.once.triangles  # one pass, whatever is asked


def test_set_up_in_hardware_has_its_own_bound(tmp_path):
    """Three clocks a triangle where that is what the fast one takes."""
    bench("one_pixel", "--engine", "model", "--elements", "16", "--setup", "host,fast", "--json",
          tmp_path / "b.json")
    host, fast = json.loads((tmp_path / "b.json").read_text())["rows"]
    assert (host["predicted_cycles"], fast["predicted_cycles"]) == (64, 3 * 64)
    assert fast["bound"] == {"cycles": 3 * 64, "binding": "set-up", "share": 1}


@pytest.mark.parametrize(("arguments", "message"), [
    (["sliver"], "there is no 'sliver'; take sliver_"),
    (["one_pixel", "--against", "nowhere.json"], "no such file; write one with --json"),
    (["one_pixel", "--against", __file__], "not a file that cardcage bench --json wrote"),
    (["one_pixel", "--against", "b.json", "--engine", "model"], "only what is simulated is comp"),
    (["one_pixel", "--elements", "3"], "power of two"),
    (["one_pixel", "--elements", "x"], "not a valid integer"),
    (["mesh", "one_pixel", "--view", "0,0", "--engine", "model"],
     "--view: the triangles of one_pixel are made on the"),
    (["one_pixel", "--plot", "p.png", "--elements", "1", "--engine", "model"], "nothing to draw"),
])
def test_wrong_input(arguments, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = bench(*arguments, status=2)
    assert message in result.stderr and result.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_lists_for_one_port_see_as_much_of_the_scan_in_every_unit(tmp_path):
    """Sixteen of its lines, each of which is with a quarter of the units only."""
    bench("one_pixel", "--engine", "model", "--elements", "16", "--ports", "1,2", "--json",
          tmp_path / "b.json")
    one, two = json.loads((tmp_path / "b.json").read_text())["rows"]
    assert one["bound"]["binding"] == "busiest port"
    assert two["triangles"] == LEAST_TRIANGLES
    assert one["triangles"] % LEAST_TRIANGLES == 0
    line = 4 * 512  # and the blanking
    assert 16 * line <= one["predicted_cycles"] <= 17 * line


def test_lists_are_no_longer_where_ports_do_not_bind(tmp_path):
    """Set-up takes a hundred times as long, or the broadcast does."""
    for case, binding, options in (("one_pixel", "set-up", ["16", "--setup", "small"]),
                                   ("random_bbox16", "broadcast", ["256"])):
        bench(case, "--engine", "model", "--ports", "1", "--json", tmp_path / "b.json",
              "--elements", *options)
        (row,) = json.loads((tmp_path / "b.json").read_text())["rows"]
        assert row["bound"]["binding"] == binding
        assert row["triangles"] == case_lists(case).once.triangles


@pytest.fixture
def verilator_alone(monkeypatch):
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"verilator": VerilatorEngine})


@EVERY
@pytest.mark.usefixtures("verilator_alone")
def test_one_port_within_five_percent_of_its_bound(tmp_path):
    """Small triangles: rows without fragments, unequal work, and two accesses a fragment."""
    bench("random_bbox16", "--elements", "8", "--units", "1", "--ports", "1", "--json",
          tmp_path / "b.json")
    (row,) = json.loads((tmp_path / "b.json").read_text())["rows"]
    print(row["bound"], row["prediction_error"])
    assert row["bound"]["binding"] == "busiest port" and 0.95 <= row["bound"]["share"] <= 1
    assert abs(row["prediction_error"]) < 0.02


@pytest.mark.usefixtures("verilator_alone")
def test_peer_cases_within_two_percent_and_against_a_baseline(tmp_path):
    """On the compiled machine: the four cases of the default, and what a slower commit shows."""
    file = tmp_path / "now.json"
    machine = ["--elements", "1"]
    result = bench(*DEFAULT_CASES, *machine, "--json", file, "--against", BASELINE)
    assert "where the processing elements' clocks went" in result.output
    assert "0 slower, 0 faster, 4 the same, 0 not in it" in result.output
    assert re.search(r"simulations [\d.]+ s without compiling: \d+ times as long", result.output)
    facts = json.loads(file.read_text())
    assert len(facts["rows"]) == len(DEFAULT_CASES)
    for row in facts["rows"]:
        print(row["case"], row["cycles"], row["prediction_error"])
        assert abs(row["prediction_error"]) < 0.02, row["case"]
        assert row["cycles"]["sustained"] >= 0.98 * row["bound"]["cycles"]
        assert sum(row["clocks_of_elements"].values()) == pytest.approx(1)

    again = bench("one_pixel", *machine, "--against", file)
    assert "0 slower, 0 faster, 1 the same" in again.output
    facts["rows"][0]["cycles"]["sustained"] -= 1
    facts["rows"].append(facts["rows"][0] | {"triangles": 2 * LEAST_TRIANGLES})
    file.write_text(json.dumps(facts))
    slower = bench("one_pixel", *machine, "--against", file, status=EXIT_DIFFERENT)
    assert "1 slower" in slower.output and "slower  1x(PMM)" in slower.output
