"""How Verilator and the compiler are called, and how they fail.  Nothing is compiled here."""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path

import pytest

from cardcage.testbenches.engines.verilator_tool import ToolMissingError, VerilatorTool
from cardcage.testbenches.support.interruption import Interrupted, interruptible


def tool(folder: Path, script: str) -> VerilatorTool:
    """A Verilator that is a shell script."""
    (folder / "bin").mkdir()
    program = folder / "bin/verilator_bin"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    return VerilatorTool(folder, f"{program} compiler")


@pytest.mark.parametrize(("said", "message"), [
    ("%Error: odd", "%Error: odd"),
    ("first; main.cpp:1: fatal error: odd", "main.cpp:1: fatal error: odd"),
    ("only words", "only words"),
    (r"\\377 Error", " Error"),
    ("", "no message"),
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
