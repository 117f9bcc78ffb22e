"""``cardcage plan`` run in the tests' own process, and the machine that it names."""

from __future__ import annotations

import json

from click.testing import CliRunner

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.cocotb_bench.exchange import configuration_of
from cardcage.testbenches.command_line.cli import main


def run(*arguments, command="plan"):
    return CliRunner().invoke(main, [command, *map(str, arguments)])


def facts(*arguments) -> dict:
    """What ``plan`` says with ``--json``."""
    result = run(*arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def machine_of(planned: dict) -> MachineConfiguration:
    names = MachineConfiguration.__dataclass_fields__
    return configuration_of({name: value for name, value in planned["machine"].items()
                             if name in names})
