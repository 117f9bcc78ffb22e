"""The house rules that a tool can check; ``test_house.py`` has those on where things are."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
FOLDERS = ("golden", "hdl", "package", "testbenches", "tests")


def run(*arguments):
    return subprocess.run([sys.executable, "-m", *arguments], cwd=ROOT, capture_output=True,
                          text=True, timeout=300)


def test_ruff_has_nothing_to_say():
    done = run("ruff", "check", "--no-cache", "setup.py", *FOLDERS)
    assert done.returncode == 0, done.stdout


def test_the_golden_models_type_check(tmp_path):
    done = run("mypy", "--cache-dir", str(tmp_path))
    assert done.returncode == 0, done.stdout


def test_hardware_uses_the_current_language():
    """Nothing that Amaranth has deprecated or that the project has ruled out."""
    banned = re.compile(r"\b(Record|Settle|add_sync_process|lib\.coding|hdl\.Memory)\b")
    for folder in ("hdl", "testbenches"):
        for path in (ROOT / folder).rglob("*.py"):
            assert not banned.search(path.read_text(encoding="utf-8")), path
