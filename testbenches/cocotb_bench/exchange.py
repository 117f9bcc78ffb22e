"""The files that go between the engine and the bench inside the simulator."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ...golden.organisations.machine_facts import FOLLOWING
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError
from ...golden.specification.video_timing import VideoTiming
from ..engines.engine import Job, Scan

#: Environment variable that names the folder.
FOLDER_VARIABLE = "CARDCAGE_BENCH"

_JOB, _COMMANDS, _PROGRESS, _SCANS, _OUTCOME = (
    "job.json", "commands.hex", "progress.txt", "scans.npz", "outcome.json")


@dataclass(frozen=True)
class Outcome:
    """What the bench saw.

    ``end``        ``done``, ``violation`` of a protocol, or ``timeout``
    ``message``    one sentence, unless done
    ``responses``  kind, value, cycle of each
    """

    end: Literal["done", "violation", "timeout"]
    message: str
    cycles: int
    responses: Sequence[tuple[int, int, int]]
    scans: Sequence[Scan]


def write_job(folder: Path, job: Job) -> None:
    (folder / _JOB).write_text(json.dumps({
        "configuration": asdict(job.configuration),
        "responses": job.responses,
        "stall_seed": job.stall_seed,
        "maximum_cycles": job.maximum_cycles,
    }, indent=1))
    (folder / _COMMANDS).write_text("".join(f"{int(word):x}\n" for word in job.commands))


def read_job(folder: Path) -> Job:
    """What ``write_job`` wrote; memory seed and waveform are the simulator's business."""
    job = json.loads((folder / _JOB).read_text())
    return Job(
        configuration=configuration_of(job["configuration"]),
        commands=[int(line, 16) for line in (folder / _COMMANDS).read_text().split()],
        responses=job["responses"],
        stall_seed=job["stall_seed"],
        maximum_cycles=job["maximum_cycles"],
    )


def write_progress(folder: Path, cycles: int, responses: int) -> None:
    (folder / _PROGRESS).write_text(f"{cycles} {responses}\n")


def read_progress(folder: Path) -> tuple[int, int] | None:
    """None as long as nothing, or only half, has been written."""
    try:
        text = (folder / _PROGRESS).read_text()
    except FileNotFoundError:
        return None
    if not text.endswith("\n"):
        return None
    cycles, responses = text.split()
    return int(cycles), int(responses)


def write_outcome(folder: Path, outcome: Outcome) -> None:
    np.savez_compressed(folder / _SCANS, cycle=[scan.cycle for scan in outcome.scans],
                        picture=[scan.picture for scan in outcome.scans])
    (folder / _OUTCOME).write_text(json.dumps({
        "end": outcome.end, "message": outcome.message, "cycles": outcome.cycles,
        "responses": list(outcome.responses)}))


def read_outcome(folder: Path) -> Outcome | None:
    """None where the bench did not come to an end."""
    if not (folder / _OUTCOME).exists():
        return None
    outcome = json.loads((folder / _OUTCOME).read_text())
    with np.load(folder / _SCANS) as arrays:
        scans = [Scan(int(cycle), picture) for cycle, picture in
                 zip(arrays["cycle"], arrays["picture"], strict=True)]
    return Outcome(outcome["end"], outcome["message"], outcome["cycles"],
                   [tuple(response) for response in outcome["responses"]], scans)


def read_configuration(path: Path) -> MachineConfiguration:
    """The object ``configuration`` of a ``machine.json``; ``InputError`` names the field."""
    try:
        described = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; it is written beside the Verilog") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: not a readable JSON file: {error}") from None
    if not isinstance(described, dict) or not isinstance(described.get("configuration"), dict):
        raise InputError(f"{path}: configuration: missing; is this a machine's description?")
    try:
        return configuration_of(described["configuration"])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def configuration_of(values: dict[str, Any]) -> MachineConfiguration:
    """A configuration from ``dataclasses.asdict`` of one, or from the fields that have no
    default; figures that follow from these may be among them.  ``InputError`` where another
    name is: the machine would not be the one described."""
    for name in ("cards", "width", "height"):
        if name not in values:
            raise InputError(f"configuration: {name}: missing")
    known = {field.name for field in fields(MachineConfiguration)}
    for name in sorted(values.keys() - known - FOLLOWING.keys()):
        raise InputError(f"configuration: {name}: unknown to this version of Cardcage; export the "
                         "machine again")
    values = {name: value for name, value in values.items() if name in known}
    if values.get("timing") is not None:
        try:
            values["timing"] = VideoTiming(**values["timing"])
        except (TypeError, ValueError) as error:
            raise InputError(f"configuration: timing: {error}") from None
    if values.get("regions") is not None:
        try:
            columns, rows = values["regions"]
        except (TypeError, ValueError):
            raise InputError(f"configuration: regions: {values['regions']!r} is not a number of "
                             "columns and of rows; export the machine again") from None
        values["regions"] = columns, rows
    return MachineConfiguration(**values)
