"""How Verilator and the compiler are called, and how they fail.  Nothing is compiled here."""

from __future__ import annotations

import os
import signal
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from cardcage.testbenches.engines import verilator_tool
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, VerilatorTool
from cardcage.testbenches.support.interruption import Interrupted, interruptible


def tool(folder: Path, script: str) -> VerilatorTool:
    """A Verilator that is a shell script."""
    (folder / "bin").mkdir()
    program = folder / "bin/verilator_bin"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    return VerilatorTool(folder, (str(program), "compiler"))


@pytest.mark.parametrize(("said", "message"), [
    ("%Error: odd", "%Error: odd"),
    ("first; main.cpp:1: fatal error: odd", "main.cpp:1: fatal error: odd"),
    ("only words", "only words"),
    (r"\\377 Error", " Error"),
    ("", "status 1 and no message"),
    ("error: " + "x" * 400, "error: x{293}"),
    ("error: \x1b[1mbold", r"error: \[1mbold"),
])
def test_a_failure_is_one_line(tmp_path, said, message):
    lines = " ".join(f"'{line.strip()}'" for line in said.split(";"))
    made = tool(tmp_path, rf"printf '%b\n' {lines} >&2; exit 1")
    with pytest.raises(ToolMissingError, match=f"cannot build the model: .*{message}$"):
        made.translate([], tmp_path)


def test_no_room_is_the_systems_fault(tmp_path):
    made = tool(tmp_path, 'echo "as: fatal error: x.s: No space left on device" >&2; exit 1')
    with pytest.raises(OSError, match="No space left on device") as caught:
        made.translate([], tmp_path)
    assert caught.value.filename == str(tmp_path)


def test_where_one_compiler_fails_the_others_end(tmp_path):
    made = tool(tmp_path, """shift
if [ "$1" = slow ]; then sleep 100 & echo $! > pid.new; mv pid.new pid; wait; fi
while [ ! -e pid ]; do sleep 0.01; done
echo "$1: error: odd" >&2; exit 1""")
    with pytest.raises(ToolMissingError, match=r"^verilator_bin cannot .* bad: error"):
        made.compile([["bad"], ["slow"]], tmp_path)
    assert_ends(int((tmp_path / "pid").read_text()))


def test_a_second_interruption_does_not_hinder_the_end_of_the_first(tmp_path, monkeypatch):
    """A closed terminal and a session that ends send two signals at once."""
    made = tool(tmp_path, "sleep 100 & echo $! > pid.new; mv pid.new pid; wait")
    kill = os.killpg

    def kill_and_signal(group, number):
        os.kill(os.getpid(), signal.SIGTERM)
        kill(group, number)

    def interrupt():
        while not (tmp_path / "pid").exists():
            time.sleep(0.01)
        monkeypatch.setattr(verilator_tool.os, "killpg", kill_and_signal)
        os.kill(os.getpid(), signal.SIGHUP)

    with pytest.raises(Interrupted), interruptible():
        threading.Thread(target=interrupt).start()
        made.translate([], tmp_path)
    assert_ends(int((tmp_path / "pid").read_text()))


def test_temporary_files_are_where_the_work_is(tmp_path):
    tool(tmp_path, 'echo "$TMPDIR" > said').translate([], tmp_path)
    assert (tmp_path / "said").read_text() == f"{tmp_path}\n"


def test_a_program_that_cannot_be_started(tmp_path):
    made = replace(tool(tmp_path, ""), compiler=(str(tmp_path / "no interpreter"),))
    Path(*made.compiler).write_text("#!/no/such/shell\n")
    Path(*made.compiler).chmod(0o755)
    with pytest.raises(ToolMissingError, match=r"no interpreter: No such file or directory$"):
        made.compile([[]], tmp_path)
    with pytest.raises(ToolMissingError, match=r"no interpreter: No such file or directory$"):
        made.versions()


def test_what_a_model_depends_on_is_both_versions(tmp_path):
    made = tool(tmp_path, 'echo "version 5 of $@"')
    program = tmp_path / "g++"
    said = []
    for version in (1, 2):
        program.write_text(f"#!/bin/sh\necho g++ {version} $@\n")
        program.chmod(0o755)
        verilator_tool._said.cache_clear()  # as in another process
        said.append(replace(made, compiler=(str(program), "-flto")).versions())
    assert said == [["version 5 of --version", str(program), "-flto",
                     f"g++ {version} -flto --version"] for version in (1, 2)]


@pytest.mark.parametrize("quoted", [False, True])
def test_a_compiler_by_its_path(tmp_path, monkeypatch, quoted):
    program = tmp_path / ("my compiler" if quoted else "compiler")
    program.touch(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CXX", f"'./{program.name}' -g" if quoted else f"./{program.name} -g")
    assert verilator_tool.find_verilator().compiler == (str(program), "-g")
    monkeypatch.setenv("CXX", "'./compiler")
    with pytest.raises(ToolMissingError, match=r"^CXX: '\./compiler: No closing quotation$"):
        verilator_tool.find_verilator()


def test_an_interruption_ends_the_compilers_too(tmp_path):
    made = tool(tmp_path, "sleep 100 & echo $! > pid.new; mv pid.new pid; wait")

    def interrupt():
        while not (tmp_path / "pid").exists():
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGTERM)

    with pytest.raises(Interrupted), interruptible():
        threading.Thread(target=interrupt).start()
        made.translate([], tmp_path)
    assert_ends(int((tmp_path / "pid").read_text()))


def assert_ends(child: int) -> None:
    deadline = time.monotonic() + 20
    while alive(child):
        assert time.monotonic() < deadline
        time.sleep(0.01)


def alive(process: int) -> bool:
    """Not a dead one that nobody has asked for yet either."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return False
        return not Path("/proc/self/stat").exists()
    return state != "Z"
