"""How the program ends: status 1 says that a picture differs, and nothing else does."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import click
import pytest
from click.testing import CliRunner
from refusals import assert_one_line

from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.command_line.command_group import TRACEBACK_VARIABLE, OneLineErrors, warn

PROGRAM = [sys.executable, "-m", "cardcage"]
TINY = ["--cards", "PM", "--size", "8x8", "--engine", "pysim"]
SCENE = "random:n=3,size=4,seed=1"


@pytest.fixture
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def program(*arguments, **options):
    return subprocess.run([*PROGRAM, *arguments], stdin=subprocess.DEVNULL, **{
        "stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options)


# An output that takes nothing


@pytest.mark.parametrize("arguments", [
    ["scenes", "--hard", "--json"], ["--version"],
    ["render", SCENE, *TINY, "--out", "report"],
])
def test_a_full_output(place, arguments):
    with Path("/dev/full").open("w") as full:
        done = program(*arguments, stdout=full)
    assert done.returncode == 2
    assert done.stderr == b"cardcage: error: standard output: No space left on device\n"


@pytest.mark.parametrize("arguments", [["scenes", "--hard", "--json"], ["--help"]])
def test_nobody_reads_the_output(arguments):
    reading, writing = os.pipe()
    os.close(reading)
    done = program(*arguments, stdout=writing)
    os.close(writing)
    assert done.returncode == 2
    assert done.stderr == b"cardcage: error: standard output: nobody reads it any more\n"


def closed(descriptor):
    return program("scenes", "wrong", preexec_fn=lambda: os.close(descriptor))


def test_closed_outputs():
    without_output, without_errors = closed(1), closed(2)
    assert (without_output.returncode, without_errors.returncode) == (2, 2)
    assert without_output.stderr == b"cardcage: error: standard output: it is closed\n"
    assert without_errors.stdout == b""


@pytest.mark.parametrize(("arguments", "status"), [
    (["scenes", "wrong"], 2),
    (["render", SCENE, *TINY, "--words", "16", "--out", "report"], 0)])
def test_full_errors(place, arguments, status):
    """What cannot be said is still in the status; a warning that cannot be said is none."""
    with Path("/dev/full").open("w") as full:
        assert program(*arguments, stderr=full).returncode == status


# What nobody foresaw


@click.command(cls=OneLineErrors)
@click.argument("kind")
def failing(kind: str) -> None:
    warn("about to fail")
    raise {
        "unforeseen": ZeroDivisionError("division\nby zero"),
        "assertion": AssertionError("never"),
        "memory": MemoryError(),
        "system": OSError(28, "No space left on device", "some/file"),
        "nameless": OSError(5, "Input/output error"),
        "bare": OSError("only words"),
        "abort": click.Abort(),
    }[kind]


@pytest.mark.parametrize(("kind", "line"), [
    ("unforeseen", "ZeroDivisionError: division by zero (set CARDCAGE_TRACEBACK=1 to see where"),
    ("assertion", "AssertionError: never ("),
    ("memory", "MemoryError: ("),
    ("system", "some/file: No space left on device\n"),
    ("nameless", "Input/output error\n"),
    ("bare", "OSError: only words ("),
    ("abort", "Abort: ("),
])
def test_whatever_happens_is_one_line(monkeypatch, kind, line):
    monkeypatch.delenv(TRACEBACK_VARIABLE, raising=False)
    result = CliRunner().invoke(failing, [kind])
    assert result.exit_code == 2
    warning, error = result.stderr.splitlines(keepends=True)
    assert warning == "cardcage: warning: about to fail\n"
    assert_one_line(error)
    assert error.startswith(f"cardcage: error: {line}")


def test_the_traceback_can_be_had(monkeypatch):
    monkeypatch.setenv(TRACEBACK_VARIABLE, "1")
    result = CliRunner().invoke(failing, ["unforeseen"])
    assert result.exit_code == 2
    assert "Traceback" in result.stderr and f"{Path(__file__).name}\", line" in result.stderr
    assert result.stderr.splitlines()[-1].startswith("cardcage: error: ZeroDivisionError")


# Names


@pytest.mark.parametrize("name", ["Würfel", os.fsdecode(b"r\xfc"), "line\nbreak",
                                  "<b>&amp;"])
def test_names_of_any_bytes(place, recording, monkeypatch, name):
    """Of a report, a list, an export: they are written, and what is printed names them."""
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: recording})

    def run(*arguments):
        done = CliRunner().invoke(main, arguments)
        assert (done.exit_code, done.stderr) == (0, "")
        return done.stdout_bytes

    assert os.fsencode(name) + b"/report.html" in run("render", SCENE, *TINY, "--out", name)
    assert "random:n=3" in Path(name, "report.html").read_text(encoding="utf-8")
    Path(name, "display_list.npz").rename(f"{name}.npz")
    assert os.fsencode(name) in run("render", f"{name}.npz", *TINY, "--out", name)
    assert Path(name, "report.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    run("export", f"{name}.npz", "--cards", "PM", "--component", "survey", "-o", f"{name}.v")
    assert Path(f"{name}.v").read_text(encoding="utf-8").startswith("// Cardcage ")


@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_names_of_any_bytes_on_any_terminal(place, encoding):
    name = b"W\xfcrfel \xc3\x97"
    done = program("render", SCENE, *TINY, "--out", name, "--waveform", name + b".vcd",
                   env=os.environ | {"PYTHONIOENCODING": encoding})
    assert (done.returncode, done.stderr) == (0, b"")
    assert encoding == "ascii" or name + b"/report.html" in done.stdout
    assert sorted(os.fsencode(path.name) for path in Path().iterdir()) == [name, name + b".vcd"]


def test_a_name_that_is_not_there(place):
    done = program("render", b"W\xfcrfel.npz")
    assert done.returncode == 2
    assert done.stderr == b"cardcage: error: W\xfcrfel.npz: no such file\n"


# Ways to start it


@pytest.mark.parametrize("module", ["cardcage", "cardcage.testbenches.command_line.cli"])
def test_as_a_module(place, module):
    done = subprocess.run([sys.executable, "-m", module, "render", "nofile.obj"],
                          capture_output=True, text=True)
    assert done.returncode == 2
    assert_one_line(done.stderr)


def test_as_a_function():
    assert CliRunner().invoke(main, ["scenes", "wrong"]).exit_code == 2


# Signals


def test_who_asks_to_survive_the_terminal_does(place):
    """As with nohup: an ignored SIGHUP stays ignored."""
    script = ("import os, signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
              "from cardcage.testbenches.support.interruption import interruptible, uninterrupted\n"
              "with interruptible():\n"
              "    os.kill(os.getpid(), signal.SIGHUP)\n"
              "    with uninterrupted(): os.kill(os.getpid(), signal.SIGHUP)\n"
              "assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN\n"
              "print('alive')")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "alive\n"), done.stderr


def test_a_count_that_is_not_goldens(place, monkeypatch):
    monkeypatch.setattr("cardcage.testbenches.render.count_differences",
                        lambda nodes: ["node 1 sent 3 pixels, golden 4"])
    done = CliRunner().invoke(main, ["render", SCENE, *TINY[2:], "--cards", "2x(PMC)"])
    assert done.exit_code == 1, done.output
    assert done.stderr == "cardcage: warning: node 1 sent 3 pixels, golden 4\n"
