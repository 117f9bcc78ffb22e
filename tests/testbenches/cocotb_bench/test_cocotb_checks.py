"""The checks of the take-home bench, on sequences made up to break one rule each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.video.video_scan_generator import VideoScanGenerator
from cardcage.testbenches.cocotb_bench import frame_run
from cardcage.testbenches.cocotb_bench.conversation_check import ConversationCheck
from cardcage.testbenches.cocotb_bench.pin_check import PinCheck, Pins
from cardcage.testbenches.cocotb_bench.scan_check import check_scans, masked, owned_pixels
from cardcage.testbenches.cocotb_bench.stream_check import StreamCheck
from cardcage.testbenches.cocotb_bench.violation import ProtocolError
from cardcage.testbenches.engines.engine import Scan

TINY = MachineConfiguration(cards="PMPM", width=4, height=4, clocks_per_pixel=3)


def watch(*edges):
    """What passed of (valid, ready, payload) edges."""
    check = StreamCheck("stream")
    return [payload for cycle, (valid, ready, payload) in enumerate(edges)
            if check.sample(cycle, valid, ready, payload)]


def test_a_stream_that_waits_and_passes():
    assert watch((0, 0, None), (1, 0, 5), (1, 0, 5), (1, 1, 5), (1, 1, 6), (0, 1, 7)) == [5, 6]


@pytest.mark.parametrize(("edges", "message"), [
    ([(1, 0, 5), (0, 0, 5)], "cycle 1: stream: valid fell before 0x5 was taken"),
    ([(1, 0, 5), (0, 1, 5)], "valid fell"),
    ([(1, 0, 5), (1, 0, 6)], "the payload changed from 0x5 to 0x6"),
    ([(1, 0, 5), (1, 1, 6)], "the payload changed"),
    ([(None, 0, 5)], "valid is unknown"),
    ([(0, None, 5)], "ready is unknown"),
    ([(1, 1, None)], "the payload is unknown"),
])
def test_a_stream_that_breaks_its_word(edges, message):
    with pytest.raises(ProtocolError, match=message):
        watch(*edges)


def raster(scans=2):
    """Every clock of the pins, as the timing has it: lists of pixel, active, syncs, colour."""
    timing = TINY.timing
    for _ in range(scans):
        for line in range(timing.vertical_total):
            for column in range(timing.horizontal_total):
                x = column - timing.horizontal_sync - timing.horizontal_back
                y = line - timing.vertical_sync - timing.vertical_back
                active = 0 <= x < TINY.width and 0 <= y < TINY.height
                for clock in range(TINY.clocks_per_pixel):
                    yield [int(clock == 0), int(active), int(column >= timing.horizontal_sync),
                           int(line >= timing.vertical_sync), 0x10203 if active else 0]


def watch_pins(clocks):
    check = PinCheck(TINY)
    for cycle, (pixel, *pins) in enumerate(clocks):
        check.sample(cycle, pixel, Pins(*pins))


def test_pins_as_documented():
    watch_pins(raster())
    clocks = list(raster())
    watch_pins([[0, 0, 0, 0, 0]] * 7 + clocks)  # after reset, before the first pixel
    unknown = [[*clock[:4], None if clock[1] else 0] for clock in clocks]
    watch_pins(unknown)  # memories before the boot


@pytest.mark.parametrize(("place", "field", "value", "message"), [
    (0, 0, None, "pixel is unknown"),
    (1, 1, None, "between two pixels"),
    (0, 1, None, "active or a sync is unknown"),
    (1, 0, 1, "a pixel 1 clocks after the last, not 3"),
    (2, 4, 1, "between two pixels"),
    (0, 4, 1, "not black during blanking"),
    (0, 4, None, "not black during blanking"),
    (0, 1, 1, "active is on in line 0, column 0"),
    (0, 3, 1, "vertical sync is off in line 0, column 0"),
    (0, 2, 1, "horizontal sync is off in line 0, column 0"),
])
def test_pins_that_are_wrong_once(place, field, value, message):
    clocks = list(raster(3))
    scan = len(clocks) // 3
    clocks[2 * scan + place][field] = value
    with pytest.raises(ProtocolError, match=f"cycle {2 * scan + place}: pins: .*{message}"):
        watch_pins(clocks)


def test_a_pixel_that_does_not_come():
    clocks = list(raster())
    clocks[-3][0] = 0
    with pytest.raises(ProtocolError, match="no pixel 3 clocks after the last"):
        watch_pins(clocks)


FRAME = [Opcode.FRAME_START, Opcode.PREPARED_TRIANGLE, Opcode.FRAME_END, Opcode.READ_COUNTERS, 15]
BOOT = [(ResponseKind.DOMAIN, 0 << 16 | 1), (ResponseKind.DOMAIN, 1 << 16 | 1),
        (ResponseKind.UNITS, 2 << 16 | 2), (ResponseKind.PICTURE, 4 << 16 | 4),
        (ResponseKind.BOOTED, 50)]
#: None is the next command.
TALK = [*BOOT, None, None, None, (ResponseKind.FRAME_DRAWN, 20), (ResponseKind.FRAME_SHOWN, 0),
        None, (ResponseKind.FRAGMENTS, 3), (ResponseKind.BUSY, 4), (ResponseKind.FRAGMENTS, 5),
        (ResponseKind.BUSY, 6), None, (ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)]


def talk(words, configuration=TINY, commands=FRAME):
    check = ConversationCheck(configuration, commands)
    for word in words:
        if word is None:
            check.command(100)
        else:
            check.response(100, *word)
    return check


def test_a_conversation_as_documented():
    assert talk(TALK).complete
    assert not talk(TALK[:-1]).complete
    depths = talk([*BOOT, None, *[(ResponseKind.DEPTH, (1 << 24) - 1)] * 16],
                  commands=[Opcode.READ_DEPTH])
    assert depths.complete


def test_the_way_from_a_read_to_the_pins_is_the_video_scan_generators():
    """A unit reads in the clock after its pixel was announced."""
    assert VideoScanGenerator.latency - 1 == frame_run.PIN_LATENCY


def changed(place, word):
    return [*TALK[:place], word, *TALK[place + 1:]]


@pytest.mark.parametrize(("words", "message"), [
    ([None], "command 0 is taken while DOMAIN is still due"),
    ([*BOOT[:4], None], "command 0 is taken while BOOTED"),
    ([*TALK[:9], None], "command 3 is taken while FRAME_SHOWN"),
    (changed(1, (ResponseKind.UNITS, 0)), "response 1 is kind 2, .*DOMAIN is due"),
    (changed(1, (ResponseKind.DOMAIN, 2)), "DOMAIN must be 0x10001"),
    (changed(3, (ResponseKind.PICTURE, 4 << 16 | 2)), "PICTURE must be 0x40004"),
    (changed(4, (ResponseKind.BOOTED, 101)), "BOOTED cannot be that large"),
    ([*TALK[:7], (ResponseKind.FRAME_DRAWN, 20)], "before its command 2 was taken"),
    (changed(8, (ResponseKind.FRAME_SHOWN, 0)), "FRAME_DRAWN is due"),
    (changed(8, (ResponseKind.ERROR, 4)), r"fault 4 \(LIST_FULL\); FRAME_DRAWN is due"),
    (changed(8, (ResponseKind.ERROR, 77)), "fault 77; FRAME_DRAWN is due"),
    (changed(9, (ResponseKind.FRAME_SHOWN, 99)), "FRAME_SHOWN cannot be that large"),
    (changed(16, (ResponseKind.ERROR, 2)), "ERROR must be 0x1"),
    ([*TALK, (ResponseKind.ERROR, 1)], "none is due"),
    (changed(0, (77, 0)), "kind 77, .*DOMAIN is due"),
])
def test_a_conversation_that_is_not(words, message):
    with pytest.raises(ProtocolError, match=message):
        talk(words)


@pytest.mark.parametrize("setup", ["host", "hardware"])
def test_vertices_are_for_machines_with_set_up(setup):
    """Others do not know the command."""
    machine = replace(TINY, setup=setup)
    refusal = [(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)] if setup == "host" else []
    assert talk([*BOOT, None, *refusal], machine, [Opcode.TRIANGLE]).complete


def test_depths_are_in_range():
    with pytest.raises(ProtocolError, match="DEPTH cannot be that large"):
        talk([*BOOT, None, (ResponseKind.DEPTH, 1 << 24)], commands=[Opcode.READ_DEPTH])


def test_an_unsupported_cage_refuses_everything():
    three = MachineConfiguration(cards="PMMM", width=4, height=4, words=16,
                                 allow_orphans=True)
    refusal = (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)
    assert talk([(ResponseKind.DOMAIN, 3), (ResponseKind.UNITS, 3 << 16 | 3), refusal,
                 None, refusal, None, refusal], three, [Opcode.FRAME_START, 15]).complete


@pytest.mark.parametrize("block", [1, 2])
def test_squares_are_refused_where_shares_differ(block):
    cage = MachineConfiguration(cards="PMMPMPM", width=4, height=4, block=block,
                                allow_orphans=True)
    found = [*((ResponseKind.DOMAIN, value) for value in (2, 2 << 16 | 1, 3 << 16 | 1)),
             (ResponseKind.UNITS, 4 << 16 | 4)]
    if block == 1:
        found += [(ResponseKind.PICTURE, 4 << 16 | 4), (ResponseKind.BOOTED, 0)]
    else:
        found += [(ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)]
    assert talk(found, cage, []).complete


def picture(level):
    return np.full((4, 4, 3), level, np.uint8)


TORN = np.concatenate([picture(1)[:2], picture(2)[2:]])


@pytest.mark.parametrize(("pictures", "message"), [
    ([9, 0, 0, 0, 1, 1, 1, 2], None),
    ([9, 0, 0, 1, 1, 1, 1, 2], None),
    ([9, 0, 1, 1, 1, 1, 1, 2], "cycle 20: this scan is not whole picture 0: pixel "),
    ([9, 0, 0, 0, 0, 1, 1, 2], "cycle 50: this scan is not whole picture 1: pixel "),
    ([9, 0, 0, 0, 1, 1, 1, 1], None),
    ([9, 0, 0, 0, 1, 1, TORN, 2], r"cycle 60: .* picture 1 or the next: pixel \(0, 2\)"),
    ([9, 0, 0, 0, 1, TORN, 2, 2], r"cycle 50: .* picture 1: pixel \(0, 2\)"),
])
def test_scans_show_whole_pictures(pictures, message):
    """Black from cycle 5; frames end at 25 and 55, and are shown at 35 and 65."""
    scans = [Scan(10 * number, picture(shown) if isinstance(shown, int) else shown)
             for number, shown in enumerate(pictures)]

    def check():
        check_scans(scans, 5, [25, 55], [35, 65])

    if message is None:
        check()
    else:
        with pytest.raises(ProtocolError, match=message):
            check()


def test_pixels_that_nobody_owns_are_left_out():
    owned = owned_pixels(MachineConfiguration(cards="MPM", width=4, height=4, words=8,
                                              allow_orphans=True))
    np.testing.assert_array_equal(owned, [[y == 1] * 4 for y in (0, 1, 0, 1)])
    [scan] = masked([Scan(3, picture(7))], owned)
    np.testing.assert_array_equal(scan.picture, picture(7) * owned[..., None])
