"""What is translated and compiled for a machine, and what is not done twice."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines import compiled_model
from cardcage.testbenches.engines.compiled_model import compile_model
from cardcage.testbenches.engines.model_runtime import headers, include
from cardcage.testbenches.engines.model_wrapper import machine_numbers, model_wrapper
from cardcage.testbenches.engines.verilator_tool import (
    ToolMissingError,
    VerilatorTool,
    find_verilator,
)
from cardcage.testbenches.export.verilog import machine_verilog
from cardcage.testbenches.support import cache

try:
    find_verilator()
except ToolMissingError as missing:
    pytest.skip(f"simulator verilator: {missing}", allow_module_level=True)


@dataclass(frozen=True)
class Recorder(VerilatorTool):
    """Translates in truth, and only notes what would be compiled.

    ``compiled``    the arguments of every compiler
    ``translated``  bytes of the source text that runs in every clock, for each machine
    """

    compiled: list = field(default_factory=list, compare=False)
    translated: list = field(default_factory=list, compare=False)

    def translate(self, arguments, folder):
        super().translate(arguments, folder)
        assert not [path for path in folder.glob("*.cpp") if "ico_sequent" in path.read_text()], (
            "logic behind the model's inputs is evaluated at both edges of the clock")
        self.translated.append(sum(path.stat().st_size for path in folder.glob("*.cpp")
                                   if not path.stem.endswith("Slow")))

    def compile(self, units, folder):
        self.compiled.extend(units)
        for unit in units:
            for part in unit:
                if part.endswith(".cc"):  # all that a unit names is there
                    for name in re.findall('#include "(.*)"', (folder / part).read_text()):
                        assert (folder / name).exists()
                    (folder / part).with_suffix(".o").touch()
            if "-o" in unit:
                (folder / unit[unit.index("-o") + 1]).touch()


@pytest.fixture
def tool(tmp_path, monkeypatch):
    monkeypatch.setenv(cache.ENVIRONMENT_VARIABLE, str(tmp_path / "cache"))
    found = find_verilator()
    return Recorder(found.root, found.compiler)


def build(tool, folder, cards):
    configuration = MachineConfiguration(cards=cards, width=32, height=32, clocks_per_pixel=2)
    folder.mkdir()
    compile_model(tool, {"machine.v": machine_verilog(configuration),
                         "model.v": model_wrapper(configuration),
                         "machine_numbers.h": machine_numbers(configuration)}, folder)
    assert [path.name for path in folder.iterdir()] == ["machine"]


def test_pieces_that_elements_have_in_common_are_written_once(tool, tmp_path, monkeypatch):
    build(tool, tmp_path / "cut", "8x(PM)")
    place = compiled_model.TRANSLATE.index("--output-split-cfuncs")
    monkeypatch.setattr(compiled_model, "TRANSLATE", compiled_model.TRANSLATE[:place])
    build(tool, tmp_path / "whole", "8x(PM)")
    cut, whole = tool.translated
    assert cut < 0.93 * whole  # more in larger machines


def test_what_models_have_in_common_is_compiled_once(tool, tmp_path):
    for number in range(2):
        build(tool, tmp_path / str(number), "PM")
    keeps_headers = len(headers(tool)) > len(include(tool))  # where the compiler can
    for common, wanted in (("verilated.cpp", 1), ("verilator_main.cpp", 1),
                           ("verilated.h", keeps_headers)):
        assert len([unit for unit in tool.compiled
                    if any(Path(part).name == common for part in unit)]) == wanted, common
    links = [unit for unit in tool.compiled if "../machine" in unit]
    assert len(links) == 2
    assert links[0] == links[1]


def test_a_compiler_that_makes_nothing_is_not_kept(tmp_path, monkeypatch):
    monkeypatch.setenv(cache.ENVIRONMENT_VARIABLE, str(tmp_path / "cache"))
    (tmp_path / "compiler").write_text("#!/bin/sh\n")
    (tmp_path / "compiler").chmod(0o755)
    tool = VerilatorTool(find_verilator().root, (str(tmp_path / "compiler"), "-S"))
    for number in range(2):
        with pytest.raises(ToolMissingError, match=r"compiler -S made no \w+\.o: is it a C\+\+"):
            build(tool, tmp_path / str(number), "PM")
    assert not [path for path in (tmp_path / "cache").iterdir() if path.is_dir()]
