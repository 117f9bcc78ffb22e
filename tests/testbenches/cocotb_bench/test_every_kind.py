"""The take-home bench takes every kind of machine that ``export`` makes.

Most are simulated in Amaranth's simulator, and what passed there is shown to the bench's checks;
some go all the way: exported, built by a Verilog simulator, driven by cocotb.
"""

from __future__ import annotations

import pytest
from click.testing import CliRunner
from suite.cases import EVERY, chosen

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import (
    Fault,
    Opcode,
    ResponseKind,
    command,
    opcode_of,
)
from cardcage.testbenches.cocotb_bench.conversation_check import ConversationCheck
from cardcage.testbenches.cocotb_bench.exchange import read_configuration
from cardcage.testbenches.cocotb_bench.scan_check import check_scans, masked, owned_pixels
from cardcage.testbenches.cocotb_bench.simulators import SIMULATORS, find_simulator
from cardcage.testbenches.cocotb_bench.violation import ProtocolError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands, frame_job
from cardcage.testbenches.machine_options import MachineOptions, machine_for_scene

SCENE = "random:n=6,size=6,seed=2"

#: Each choice of ``export`` at least twice, each set-up with each number of ports.
KINDS = [
    {"cards": "PM", "setup": "host", "memory_ports": 1, "shading": "flat"},
    {"cards": "PMM", "setup": "host", "memory_ports": 2, "words": 8},
    {"cards": "PMM", "setup": "host", "memory_ports": 1, "skew": True},
    {"cards": "PM", "setup": "small", "memory_ports": 1},
    {"cards": "PMPM", "setup": "small", "memory_ports": 2, "block": 2, "shading": "flat"},
    {"cards": "PMPM", "setup": "fast", "memory_ports": 1, "block": 4, "words": 8},
    {"cards": "PMMPMM", "setup": "fast", "memory_ports": 2, "skew": True, "shading": "flat"},
    {"cards": "2x(PMC)", "setup": "host", "memory_ports": 1},
    {"cards": "2x(PMT)", "setup": "host", "memory_ports": 2},
    {"cards": "2x(PMS)F", "setup": "host", "memory_ports": 2},
    {"cards": "PPDM", "setup": "host", "memory_ports": 1, "queue": "element"},
    {"cards": "3x(PM)", "setup": "host", "memory_ports": 2, "regions": (4, 2), "shading": "flat"},
    {"cards": "2x(PMM)", "setup": "small", "memory_ports": 1, "regions": (2, 2),
     "balancer": "hardware"},
]


def named(kind):
    return "-".join(f"{name}={value}" for name, value in kind.items())


def talk(configuration, commands, run):
    """The bench's check of a conversation, after all that a recorded run said."""
    check = ConversationCheck(configuration, commands)
    said = [(cycle, False, ()) for cycle in run.accepted]
    said += [(cycle, True, (kind, value)) for kind, value, cycle in run.responses]
    for cycle, answered, word in sorted(said, key=lambda entry: entry[:2]):
        if answered:
            check.response(int(cycle), *word)
        else:
            check.command(int(cycle))
    return check


@pytest.mark.parametrize("kind", chosen(KINDS, *KINDS[1::3]), ids=named)
def test_the_checks_take_it(kind):
    loaded, configuration = machine_for_scene(SCENE, MachineOptions(size=(8, 8), **kind))
    job = frame_job(configuration, loaded.display_list, stall_seed=3)
    triangle = Opcode.PREPARED_TRIANGLE if kind["setup"] == "host" else Opcode.TRIANGLE
    assert triangle in {opcode_of(word) for word in job.commands}
    run = PysimEngine().run(job)
    assert talk(configuration, job.commands, run).complete
    [booted] = [cycle for kind, _, cycle in run.responses if kind == ResponseKind.BOOTED]
    [shown] = [cycle for kind, _, cycle in run.responses if kind == ResponseKind.FRAME_SHOWN]
    [ended] = [int(cycle) for cycle, word in zip(run.accepted, job.commands, strict=True)
               if opcode_of(word) == Opcode.FRAME_END]
    scans = masked(run.scans, owned_pixels(configuration))
    assert any(scan.cycle > shown for scan in scans)
    check_scans(scans, booted + 100, [ended], [shown])
    # A machine of that kind which does not know its triangles is caught.
    place = next(number for number, (kind, *_) in enumerate(run.responses)
                 if kind == ResponseKind.FRAME_DRAWN)
    run.responses.insert(place, (ResponseKind.ERROR, Fault.UNKNOWN_COMMAND,
                                 run.responses[place][2]))
    with pytest.raises(ProtocolError, match="FRAME_DRAWN is due"):
        talk(configuration, job.commands, run)


@pytest.mark.parametrize(("kind", "value", "said"), [
    (ResponseKind.REGION_COUNT, None, "before its command|FRAME_DRAWN is due"),
    (ResponseKind.REGION_COUNT, 1 << 20, "REGION_COUNT cannot be that large"),
    (ResponseKind.TABLE_ENTRY, 3, "TABLE_ENTRY cannot be that large")], ids=str)
def test_what_is_said_of_regions(kind, value, said):
    """Of a table before the frame, and of counts and tables that cannot be."""
    loaded, configuration = machine_for_scene(SCENE, MachineOptions(
        size=(8, 8), cards="3x(PM)", regions=(4, 2),
        balancer="hardware" if kind == ResponseKind.TABLE_ENTRY else "host"))
    table = None if configuration.balancer == "hardware" else [2, 1, 0, 2, 1, 0, 2, 1]
    job = frame_job(configuration, loaded.display_list, stall_seed=3, table=table)
    run = PysimEngine().run(job)
    assert talk(configuration, job.commands, run).complete
    place = next(number for number, (found, *_) in enumerate(run.responses) if found == kind)
    entry = run.responses[place]
    if value is None:  # it comes before the picture is drawn
        drawn = next(number for number, (found, *_) in enumerate(run.responses)
                     if found == ResponseKind.FRAME_DRAWN)
        run.responses.insert(drawn, (kind, 0, run.responses[drawn][2]))
    else:
        run.responses[place] = (kind, value, entry[2])
    with pytest.raises(ProtocolError, match=said):
        talk(configuration, job.commands, run)


@pytest.mark.parametrize("way", chosen(
    [(cards, retain) for cards in ("2x(PMC)", "2x(PMT)", "2x(PMS)F", "PPDM")
     for retain in (False, True)], ("2x(PMC)", True), ("2x(PMS)F", False), ("PPDM", True)), ids=str)
def test_frames_that_are_shown_while_others_are_sent(way):
    """Where they are: a chain and a tree take new lists meanwhile, a bus a frame."""
    cards, retain = way
    loaded, configuration = machine_for_scene(SCENE, MachineOptions(
        size=(8, 8), cards=cards, retain=retain or None))
    organisation = organisation_of(configuration)
    frame = frame_commands(configuration, loaded.display_list)
    words = [*frame * 3, command(Opcode.READ_COUNTERS), command(Opcode.READ_DEPTH), *frame]
    run = PysimEngine().run(Job(configuration, words, responses_owed(organisation, words)))
    assert talk(configuration, words, run).complete
    kinds = [kind for kind, *_ in run.responses]
    drawn, shown = ([cycle for kind, _, cycle in run.responses if kind == wanted]
                    for wanted in (ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN))
    first = run.accepted[len(frame)]  # command of the second frame
    overlaps = configuration.snoops or (retain and first < shown[0])
    assert (first < shown[0]) == overlaps and len(drawn) == len(shown) == 4
    if configuration.snoops:
        assert drawn[1] < shown[0]
    # A picture that is shown before it was said to be drawn is caught.
    place = kinds.index(ResponseKind.FRAME_DRAWN)
    run.responses[place:place] = [(ResponseKind.MERGED, 0, run.responses[place][2])]
    with pytest.raises(ProtocolError, match="FRAME_DRAWN is due"):
        talk(configuration, words, run)
    # And a command for a frame for which there was no memory.
    run.responses.pop(place)
    run.accepted[2 * len(frame)] = run.accepted[2 * len(frame) - 1] + 1
    with pytest.raises(ProtocolError, match="is taken while FRAME_DRAWN is still due"):
        talk(configuration, words, run)


@pytest.fixture(scope="module")
def simulator():
    for name in SIMULATORS:
        try:
            find_simulator(name)
        except ToolMissingError:
            continue
        return name
    return pytest.skip("neither Verilator nor Icarus Verilog is here")


@pytest.mark.parametrize("options", [
    ["--cards", "PMM", "--setup", "small", "--skew", "--memory-ports", "1", "--words", "4"],
    pytest.param(["--cards", "3x(PM)", "--regions", "2x2", "--memory-ports", "2"], marks=EVERY),
], ids=lambda options: "-".join(options).replace("--", ""))
def test_from_export_to_the_verdict(tmp_path, simulator, options):
    """As the page says: export a machine for a list, check it, be told that it is equal."""
    make_display_list(SCENE, width=4, height=4, shading="flat").display_list.save(
        tmp_path / "list.npz")
    verilog = tmp_path / "machine.v"
    exported = CliRunner().invoke(main, ["export", str(tmp_path / "list.npz"), *options,
                                         "-o", str(verilog)])
    assert exported.exit_code == 0, exported.output
    own_setup = read_configuration(verilog.with_suffix(".json")).setup == "hardware"
    assert own_setup == ("small" in options)
    checked = CliRunner().invoke(main, ["check-verilog", str(verilog), str(tmp_path / "list.npz"),
                                        "--simulator", simulator])
    assert checked.exit_code == 0, checked.output
    assert checked.stdout.startswith("equal: 16 colours and ")
