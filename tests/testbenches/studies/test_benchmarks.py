"""The benchmarks print what they should; their figures are not judged here."""

import re

import pytest
from click.testing import CliRunner

from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from testbenches.studies import golden_benchmark


def test_golden_benchmark():
    done = CliRunner().invoke(golden_benchmark.main, ["--triangles", "500", "--runs", "2"])
    assert done.exit_code == 0, done.output
    assert re.search(r"500 triangles, [\d,]+ fragments, 512x512", done.output)
    assert re.search(r"golden.exact +best +[\d.]+ ms, median +[\d.]+ ms", done.output)


def test_the_engines_command():
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    done = CliRunner().invoke(main, [
        "engines", "--preset", "tiny", "--scene", "random:n=9", "--runs", "1",
        "--pysim-cycles", "512"])
    assert done.exit_code == 0, done.output
    assert re.search(r"bare loop +[\d,]+ cycles a second; ratio [\d.]+", done.output)
    assert re.search(r"verilator is [\d,]+ times as fast", done.output)
