"""One display list through pysim, Verilator and cocotb: three identical frames."""

import numpy as np
import pytest
from frames import check, random_list
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.testbenches.cocotb_bench.engine import CocotbEngine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.frames.frame_job import frame_job
from cardcage.testbenches.frames.simulation import simulate


@EVERY
def test_three_identical_frames():
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulators verilator and cocotb: {missing}")
    display_list = random_list(17, 10, width=12, height=10)
    configuration = wide_machine(display_list, cards="PMPMMM", clocks_per_pixel=2)
    engines = [PysimEngine(), VerilatorEngine(), CocotbEngine()]
    job = frame_job(configuration, display_list, memory_seed=6)
    runs = [engine.run(job) for engine in engines]
    for run in runs[1:]:
        assert run.responses == runs[0].responses  # every depth among them, and its clock
        np.testing.assert_array_equal(run.scans[-1].picture, runs[0].scans[-1].picture)
    assert [run.engine for run in runs] == ["pysim", "verilator", "cocotb on verilator"]
    check(configuration, display_list,
          simulate(configuration, display_list, engines[1], memory_seed=6))
