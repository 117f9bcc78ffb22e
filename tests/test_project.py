"""The house rules that a tool can check."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SOURCES = sorted(path for folder in ("golden", "hdl", "testbenches", "tests")
                 for path in (ROOT / folder).rglob("*.py"))


def run(*arguments):
    return subprocess.run([sys.executable, "-m", *arguments], cwd=ROOT, capture_output=True,
                          text=True, timeout=300)


def test_ruff_has_nothing_to_say():
    done = run("ruff", "check", "--no-cache", "golden", "hdl", "testbenches", "tests")
    assert done.returncode == 0, done.stdout


def test_the_golden_models_type_check(tmp_path):
    done = run("mypy", "--cache-dir", str(tmp_path))
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("folder", ["golden", "hdl"])
def test_no_folder_imports_one_above_it(folder):
    """golden imports neither of the others, hdl only golden's shared specification."""
    above = {"golden": ("hdl", "testbenches"), "hdl": ("testbenches",)}[folder]
    for path in SOURCES:
        if path.relative_to(ROOT).parts[0] != folder:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or "", *(alias.name for alias in node.names)]
            elif isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            for name in names:
                assert not set(re.split(r"[.]", name)) & set(above), f"{path}: imports {name}"


def test_files_stay_short():
    for path in SOURCES:
        lines = path.read_text(encoding="utf-8").count("\n")
        assert lines <= 400, f"{path} has {lines} lines"


def test_hardware_uses_the_current_language():
    """Nothing that Amaranth has deprecated or that the project has ruled out."""
    banned = re.compile(r"\b(Record|Settle|add_sync_process|lib\.coding|hdl\.Memory)\b")
    for path in SOURCES:
        if path.relative_to(ROOT).parts[0] in ("hdl", "testbenches"):
            assert not banned.search(path.read_text(encoding="utf-8")), path
