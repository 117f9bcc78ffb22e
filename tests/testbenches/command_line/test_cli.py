"""The command line: what it says, what it writes, and how it ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from refusals import BAD_SCENES_AND_MACHINES, assert_one_line, listing, refusal

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.reports.frame_report import REPORT_FILES

SCENE = "random:n=12,size=8,seed=5"
TINY = ["--cards", "PM", "--size", "16x16"]
COMMAND = [sys.executable, "-c", "from cardcage.testbenches.command_line.cli import main; main()"]
#: Long enough to be interrupted on any machine.
LONG = ["render", "random:n=3000,size=60", "--size", "256x256", "--cards", "PM",
        "--engine", "pysim"]


@pytest.fixture
def place(tmp_path, monkeypatch) -> Path:
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def engine(recording, monkeypatch):
    """A function: the engine that the command line uses, at first the recording one."""

    def use(chosen) -> None:
        monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                            {"pysim": lambda: chosen})

    use(recording)
    return use


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def refuses(*arguments) -> str:
    return refusal(run, *arguments)


# A frame from end to end


def test_render(place, engine):
    result = run("render", SCENE, *TINY, "--out", "report")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("equal: 256 colours and 256 depths compared, 0 different\n")
    for word in ("12 triangles", "16x16", "fraction bits (exact)", "to draw", "efficiency"):
        assert word in result.stdout
    assert str(Path("report", "report.html")) in result.stdout
    assert result.stderr == ""  # no terminal: no progress bar
    assert sorted(path.name for path in (place / "report").iterdir()) == sorted(REPORT_FILES)
    facts = json.loads((place / "report/report.json").read_text())
    assert facts["equal"] is True
    assert facts["command_line"] == f"cardcage render {SCENE} --cards PM --size 16x16 --out report"
    assert [path.name for path in place.iterdir()] == ["report"]


def test_random_memory(place):
    """Whatever the memories hold at power-on, the picture is the same."""
    result = run("render", "random:n=5,size=8", "--preset", "tiny", "--random-memory", 11,
                 "--out", "a/deep/folder")
    assert result.exit_code == 0, result.output
    assert (place / "a/deep/folder/report.html").exists()


def test_a_mesh_file_by_path(place):
    Path("my mesh.obj").write_text(
        "v 0 0 0\nv 4 0 0\nv 0 3 0\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n")
    result = run("render", place / "my mesh.obj", "--size", "16x12", "--cards", "PMPM")
    assert result.exit_code == 0, result.output
    facts = json.loads(Path("cardcage-out/report.json").read_text())
    assert facts["scene"] == "my mesh.obj"
    assert facts["pixels"]["compared"] == facts["depth"]["compared"] == 16 * 12
    assert facts["fragments"] > 20


def test_degenerate_faces_only(place, engine):
    Path("flat.obj").write_text("v 0 0 0\nv 0 0 0\nv 1 0 0\nf 1 2 3\n")
    result = run("render", "flat.obj", *TINY)
    assert result.exit_code == 0
    assert result.stderr.startswith("cardcage: warning: ") and "degenerate" in result.stderr
    facts = json.loads(Path("cardcage-out/report.json").read_text())
    assert (facts["equal"], facts["triangles"], facts["fragments"]) == (True, 0, 0)


def test_replay(place, engine):
    """The display list of a report draws the same picture; a preset leaves its size alone."""
    assert run("render", SCENE, *TINY, "--out", "first").exit_code == 0
    result = run("render", "first/display_list.npz", "--preset", "small", "--cards", "PM",
                 "--clocks-per-pixel", 2, "--out", "second")
    assert result.exit_code == 0, result.output
    for name in ("rtl.png", "golden.png"):
        assert Path("first", name).read_bytes() == Path("second", name).read_bytes()


def test_options_override_the_preset(place, engine):
    result = run("render", SCENE, "--preset", "tiny", "--fraction-bits", 3, "--words", 64,
                 "--clocks-per-pixel", 3, "--shading", "flat", "--engine", "pysim")
    assert result.exit_code == 0, result.output
    assert "coarser" in result.stderr
    machine = json.loads(Path("cardcage-out/report.json").read_text())["machine"]
    assert machine["cards"] == "PM" and machine["width"] == 16
    assert machine["fraction_bits"] == 3 and machine["exact_fraction_bits"] > 3
    assert machine["words"] == 64 and machine["picture_width"] == 8
    assert machine["clocks_per_pixel"] == 3
    assert machine["shading"] == "flat"


@pytest.mark.parametrize(("setup", "interval"), [("host", 1), ("small", 256)])
def test_who_sets_triangles_up(place, setup, interval):
    result = run("render", SCENE, "--preset", "tiny", "--setup", setup, "--engine", "pysim",
                 "--shading", "flat")
    assert result.exit_code == 0, result.output
    facts = json.loads(Path("cardcage-out/report.json").read_text())
    assert facts["equal"] is True
    assert facts["machine"]["setup"] == ("host" if setup == "host" else "hardware")
    assert facts["machine"]["setup_interval"] == interval


def test_waveform(place):
    result = run("render", "random:n=1,size=4", "--size", "4x4", "--cards", "PM",
                 "--waveform", "wave.vcd")
    assert result.exit_code == 0, result.output
    assert "$timescale" in Path("wave.vcd").read_text()[:2000]
    assert sorted(path.name for path in place.iterdir()) == ["cardcage-out", "wave.vcd"]


def test_unrelated_files_are_kept(place, engine):
    Path("report").mkdir()
    Path("report/mine.txt").write_text("mine")
    Path("report/rtl.png").write_text("old")
    assert run("render", SCENE, *TINY, "--out", "report").exit_code == 0
    assert Path("report/mine.txt").read_text() == "mine"
    assert Path("report/rtl.png").read_bytes().startswith(b"\x89PNG")
    assert len(list(Path("report").iterdir())) == len(REPORT_FILES) + 1


# Frames that are wrong


def test_different(place, engine, recording, tampering):
    engine(tampering(recording, colors={(6, 5): (1, 2, 3)}))
    result = run("render", SCENE, *TINY)
    assert result.exit_code == 1
    assert result.stdout.startswith("DIFFERENT: 1 of 256 colours, 0 of 256 depths\n")
    assert "pixel (6, 5)" in result.stdout
    first = json.loads(Path("cardcage-out/report.json").read_text())["first_difference"]
    assert first["pixel"] == [6, 5]


@pytest.mark.parametrize("error", [TimeoutError("no end after 9 cycles"),
                                   AssertionError("a scan of 9 pixels")])
def test_no_frame(place, engine, error):
    """A machine that hangs: one line, status 1, no report; but the waveform so far."""

    class Hanging:
        name = "hanging"

        def run(self, job, progress=None):
            job.waveform.write_text("so far")
            raise error

    engine(Hanging())
    result = run("render", SCENE, *TINY, "--waveform", "wave.vcd")
    assert result.exit_code == 1
    assert result.stderr == f"cardcage: error: the machine failed: {error}\n"
    assert [path.name for path in place.iterdir()] == ["wave.vcd"]
    assert Path("wave.vcd").read_text() == "so far"


# Bad input


@pytest.mark.parametrize(("arguments", "words"), [
    *BAD_SCENES_AND_MACHINES,
    (["teapot:steps=3"], "steps"),
    (["teapot:tessellation=many"], "tessellation"),
    (["--cards", "MM"], "no processing element"),
    (["--cards", "PP"], "no memory unit"),
    (["--cards", "MPM"], "left of the first processing element"),
    (["--cards", "PQM"], "'Q'"),
    (["--cards", ""], "cards"),
    (["--cards", "2x(PM"], "parentheses"),
    (["--size", "0x16"], "width 0"),
    (["--size", "16x-1"], "16x-1"),
    (["--size", "5000x16"], "5000"),
    (["--fraction-bits", "-1"], "fraction-bits"),
    (["--fraction-bits", "some"], "fraction-bits"),
    (["--words", "0"], "words"),
    (["--block", "6"], "block: must be a power of two"),
    (["--block", "64"], "block"),
    (["--block", "4", "--skew"], "skew: in squares of 4x4 pixels"),
    (["--cards", "PMMMPM", "--block", "4"], "block: squares of 4x4 pixels want as many memory"),
    (["--cards", "3x(PM)", "--lines"], "as with --regions 1x"),
    (["--lines", "--block", "4"], "block: processing elements that have lines in turn"),
    (["--clocks-per-pixel", "1"], "clocks-per-pixel"),
    (["--random-memory", "-1"], "random-memory"),
    (["--engine", "abacus"], "abacus"),
    (["--shading", "phong"], "phong"),
    (["--colour"], "--colour"),
    (["teapot", "tetra"], "tetra"),
])
def test_bad_arguments(place, arguments, words):
    assert words in refuses("render", *arguments)


def test_bad_command(place):
    assert "draw" in refuses("draw")


@pytest.mark.parametrize(("name", "contents"), [
    ("empty.obj", b""),
    ("no_faces.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
    ("nan.obj", b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ("infinite.obj", b"v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ("garbage.glb", bytes(range(256)) * 8),
    ("garbage.stl", bytes(range(255, -1, -1)) * 8),
    ("garbage.ply", bytes(range(256)) * 8),
    ("truncated.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n"),
    ("garbage.npz", bytes(range(256)) * 8),
])
def test_bad_files(place, name, contents):
    Path(name).write_bytes(contents)
    assert name in refuses("render", name)


def saved_list(**changes) -> None:
    """A display list on disk with some arrays replaced."""
    make_display_list(SCENE, width=16, height=16).display_list.save("list.npz")
    with np.load("list.npz") as archive:
        arrays = dict(archive)
    np.savez("list.npz", **arrays | changes)


@pytest.mark.parametrize(("changes", "field"), [
    ({"position": np.zeros((12, 3, 2))}, "position"),
    ({"depth": np.zeros((12, 2), np.int64)}, "depth"),
    ({"color": np.zeros((11, 3, 3), np.uint8)}, "color"),
    ({"version": np.int64(99)}, "version"),
    ({"width": np.int64(0)}, "width"),
])
def test_bad_display_list(place, changes, field):
    saved_list(**changes)
    assert field in refuses("render", "list.npz")


def test_display_list_of_another_size(place):
    saved_list()
    assert "16" in refuses("render", "list.npz", "--size", "32x32")


def test_unwritable_output_is_found_before_the_simulation(place, engine):
    class Never:
        name = "never"

        def run(self, job, progress=None):
            raise AssertionError("simulated")

    engine(Never())
    Path("file").write_text("")
    Path("report/report.json").mkdir(parents=True)
    for arguments in (["--out", "file"], ["--out", "file/below"], ["--out", "report"],
                      ["--waveform", "file/wave.vcd"], ["--waveform", "."],
                      ["--waveform", os.devnull]):
        assert arguments[0] in refuses("render", SCENE, *TINY, *arguments)


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write anywhere")
def test_folder_without_permission(place, engine):
    Path("locked").mkdir(mode=0o555)
    for arguments in (["--out", "locked"], ["--out", "locked/report"],
                      ["--waveform", "locked/wave.vcd"]):
        assert "locked" in refuses("render", SCENE, *TINY, *arguments)


def test_a_failed_run_leaves_the_last_report(place, engine, monkeypatch):
    assert run("render", SCENE, *TINY, "--out", "report").exit_code == 0
    before = listing()

    def full_disk(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("cardcage.testbenches.reports.frame_report.png", full_disk)
    assert "No space left" in refuses("render", SCENE, *TINY, "--out", "report")
    assert listing() == before


# Interruption, as the system does it


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143),
                                              (signal.SIGHUP, 129)])
def test_interrupted(place, number, status):
    Path("report").mkdir()
    Path("report/report.html").write_text("the last one")
    before = listing()
    with subprocess.Popen([*COMMAND, *LONG, "--out", "report", "--waveform", "wave.vcd"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          # Whoever runs the tests with nohup has the signal ignored.
                          preexec_fn=lambda: signal.signal(number, signal.SIG_DFL)) as process:
        try:
            deadline = time.monotonic() + 60
            while not (list(Path("report").glob(".cardcage-*"))
                       and list(Path().glob(".cardcage-*"))):
                assert process.poll() is None and time.monotonic() < deadline
                time.sleep(0.05)
            process.send_signal(number)
            output, errors = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == status
    assert output == ""
    assert "Traceback" not in errors
    assert listing() == before


@pytest.mark.parametrize("scene", ["teapott", "truncated.npz"])
def test_as_a_program(place, scene):
    Path("truncated.npz").write_bytes(b"PK\x03\x04")
    result = subprocess.run([*COMMAND, "render", scene], capture_output=True, text=True)
    assert result.returncode == 2
    assert result.stdout == ""
    assert_one_line(result.stderr)
    assert scene in result.stderr
    assert list(listing()) == ["truncated.npz"]


# Help and scenes


@pytest.mark.parametrize("arguments", [[], ["--help"], ["render", "--help"], ["scenes", "-h"]])
def test_help_teaches_by_example(arguments):
    result = run(*arguments)
    assert result.exit_code == 0
    assert "Examples:\n  " in result.stdout.replace("    cardcage", "  cardcage")
    assert "cardcage render" in result.stdout


def test_version():
    result = run("--version")
    assert result.exit_code == 0
    assert result.stdout.startswith("cardcage")


def test_scenes():
    text = run("scenes").stdout
    listed = json.loads(run("scenes", "--json").stdout)
    names = [scene["name"] for scene in listed]
    assert {"teapot", "sphereflake", "tetra", "spheres", "random"} <= set(names)
    for scene in listed:
        assert scene["triangles"] > 0
        assert scene["description"] in text
        for parameter in scene["parameters"]:
            assert f"{parameter['name']}={parameter['default']}" in text
    assert "\x1b" not in text  # plain where it is piped


def test_display_list_of_the_report_is_the_scene(place, engine):
    assert run("render", SCENE, *TINY).exit_code == 0
    saved = DisplayList.load("cardcage-out/display_list.npz")
    made = make_display_list(SCENE, width=16, height=16).display_list
    assert np.array_equal(saved.position, made.position)
    assert np.array_equal(saved.depth, made.depth)
