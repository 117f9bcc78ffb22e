"""cocotb's own runner in a process of its own: ``python -m …runner FILE.json``.

It moves environment variables, prints, and ends the process where something fails: none of that
belongs into the caller's.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from cocotb_tools.runner import get_runner

TOP = "machine"
TEST_MODULE = f"{__package__}.frame_run"


def main(request: dict[str, Any]) -> None:
    """Build the Verilog, or run the test on what was built; ``request`` comes from the engine."""
    runner = get_runner(request["simulator"])
    if request["action"] == "build":
        runner.build(
            sources=[request["verilog"]], hdl_toplevel=TOP, always=True, waves=request["waves"],
            build_dir=request["build_folder"], build_args=request["arguments"],
            timescale=("1ns", "1ns"))
    else:
        runner.test(
            hdl_toplevel=TOP, hdl_toplevel_lang="verilog", test_module=TEST_MODULE,
            waves=request["waves"], build_dir=request["build_folder"],
            test_dir=request["folder"], plusargs=request["plus_arguments"],
            results_xml=str(Path(request["folder"], "results.xml")))


if __name__ == "__main__":
    main(json.loads(Path(sys.argv[1]).read_text()))
