"""How Verilator is called: under which paths, and how it fails.  Nothing is compiled here."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest

from cardcage.testbenches.engines import plain_paths
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, VerilatorTool
from cardcage.testbenches.support.interruption import Interrupted, interruptible

ODD = ["with blank", "two  blanks", "Wäsche", "hash#", "dollar$x", "colon:x", "per%cent", "quo'te",
       "semi;colon", os.fsdecode(b"W\xfcrfel"), "tab\there"]


@pytest.mark.parametrize("name", ODD)
def test_odd_paths_get_plain_names(tmp_path, name):
    odd = tmp_path / name
    odd.mkdir()
    assert not plain_paths.is_plain(odd)
    with plain_paths.plain_paths(odd, tmp_path) as (link, other):
        assert plain_paths.is_plain(link) and plain_paths.is_plain(other)
        assert link.resolve() == odd.resolve()
    assert not os.path.lexists(link)
    with plain_paths.plain_folder(odd) as folder:
        assert plain_paths.is_plain(folder.resolve())
        (folder / "inner").mkdir()
        (folder / "inner/program").write_text("#!/bin/sh\n")
        (folder / "inner/program").chmod(0o755)
    assert not folder.exists() and os.access(odd / "inner/program", os.X_OK)


def test_plain_paths_stay(tmp_path):
    with plain_paths.plain_paths(tmp_path) as [path], plain_paths.plain_folder(tmp_path) as folder:
        assert path == folder == tmp_path


def test_a_link_to_an_odd_folder_does_not_hide_it(tmp_path):
    (tmp_path / "with blank").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "with blank")
    with plain_paths.plain_folder(tmp_path / "link") as folder:
        assert folder != tmp_path / "link"


def test_an_odd_folder_for_temporary_files(tmp_path, monkeypatch):
    (tmp_path / "with blank").mkdir()
    monkeypatch.setattr(plain_paths.tempfile, "tempdir", str(tmp_path / "with blank"))
    with plain_paths.plain_paths(tmp_path / "with blank") as [path]:
        assert plain_paths.is_plain(path)


def tool(folder: Path, script: str) -> VerilatorTool:
    """A Verilator that is a shell script."""
    (folder / "bin").mkdir()
    program = folder / "bin/verilator"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    return VerilatorTool(folder, "g++", Path(sys.executable))


def test_the_tools_own_script_sees_plain_paths(tmp_path):
    """The wheel's is Perl that hands the real path of its folder to a shell."""
    odd = tmp_path / "my home"
    odd.mkdir()
    made = tool(odd, 'exec $VERILATOR_BIN "$@"')
    (odd / "bin/verilator_bin").write_text("#!/bin/sh\necho version $1\n")
    (odd / "bin/verilator_bin").chmod(0o755)
    assert made.version() == "version --version"


def test_the_makefile_sees_plain_paths(tmp_path):
    odd = tmp_path / "my home"
    odd.mkdir()
    made = tool(odd, 'echo "$VERILATOR_ROOT" "$@" > said')
    with made.plain() as plain:
        plain.run(plain.make_flags, tmp_path)
    said = (tmp_path / "said").read_text()
    assert "PYTHON3=" in said and "my home" not in said


@pytest.mark.parametrize(("said", "message"), [
    ("%Error: odd", "%Error: odd"),
    ("first; main.cpp:1: fatal error: odd", "main.cpp:1: fatal error: odd"),
    ("first; verilated.mk:73: *** Unsupported: odd", r"\*\*\* Unsupported: odd"),
    ("only words", "only words"),
    (r"\\377 Error", " Error"),
    ("", "no message"),
])
def test_a_failure_is_one_line(tmp_path, said, message):
    lines = " ".join(f"'{line.strip()}'" for line in said.split(";"))
    made = tool(tmp_path, rf"printf '%b\n' {lines} >&2; exit 1")
    with pytest.raises(ToolMissingError, match=f"cannot build the model: .*{message}$"):
        made.run([], tmp_path)


def test_no_room_is_the_systems_fault(tmp_path):
    made = tool(tmp_path, 'echo "as: fatal error: x.s: No space left on device" >&2; exit 1')
    with pytest.raises(OSError, match="No space left on device") as caught:
        made.run([], tmp_path)
    assert caught.value.filename == str(tmp_path)


def test_an_interruption_ends_the_compilers_too(tmp_path):
    made = tool(tmp_path, "sleep 100 & echo $! > pid.new; mv pid.new pid; wait")

    def interrupt():
        while not (tmp_path / "pid").exists():
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGTERM)

    with pytest.raises(Interrupted), interruptible():
        threading.Thread(target=interrupt).start()
        made.run([], tmp_path)
    child = int((tmp_path / "pid").read_text())
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
