"""The house rules that a tool can check; ``test_house.py`` has those on where things are."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FOLDERS = ("golden", "hdl", "package", "testbenches", "tests")


def run(*arguments, **environment):
    return subprocess.run([sys.executable, "-m", *arguments], cwd=ROOT, capture_output=True,
                          text=True, timeout=300, env=os.environ | environment)


def test_ruff_has_nothing_to_say():
    done = run("ruff", "check", "--no-cache", "setup.py", *FOLDERS)
    assert done.returncode == 0, done.stdout


def test_the_types_of_the_package(tmp_path):
    """All of it under its own name, as it is installed: links to the folders give it that."""
    package = tmp_path / "cardcage"
    package.mkdir()
    for source in (*(ROOT / "package").glob("*.py"),
                   *(ROOT / wing for wing in ("golden", "hdl", "testbenches"))):
        (package / source.name).symlink_to(source)
    done = run("mypy", "-p", "cardcage", "--cache-dir", str(tmp_path / "cache"),
               MYPYPATH=str(tmp_path))
    assert done.returncode == 0, done.stdout.replace(f"{package}/", "") + done.stderr


@pytest.mark.parametrize(("folder", "words", "found"), [
    ("tests", ["golden/planning"], True),
    (".", ["tests/golden/specification"], True),
    (".", ["hdl"], False),
    ("golden/specification", [], False),
    ("tests/library", [], False),
    (".", ["-m", "quick", "tests/hdl/backplane"], True),
    (".", ["-m", "quick", "tests/hdl/test_machine.py"], False),
])
def test_pytest_collects_from_anywhere(folder, words, found):
    """Tests where there are some, and never a source that looks like one."""
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", *words],
        cwd=ROOT / folder, capture_output=True, text=True, timeout=100)
    wanted = pytest.ExitCode.OK if found else pytest.ExitCode.NO_TESTS_COLLECTED
    assert done.returncode == wanted, done.stdout[-1000:] + done.stderr


def test_hardware_uses_the_current_language():
    """Nothing that Amaranth has deprecated or that the project has ruled out."""
    banned = re.compile(r"\b(Record|Settle|add_sync_process|lib\.coding|hdl\.Memory)\b")
    for folder in ("hdl", "testbenches"):
        for path in (ROOT / folder).rglob("*.py"):
            assert not banned.search(path.read_text(encoding="utf-8")), path
