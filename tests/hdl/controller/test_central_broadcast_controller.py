"""The controller with a cage in software: boot, broadcasts, done, swap, answers."""

import random

import pytest
from hdl_bench.bench import Drive, simulate
from hdl_bench.cage import (
    COUNTS,
    DEPTHS,
    Cage,
    Run,
    Scans,
    Units,
    boot_responses,
)
from hdl_bench.pictures import prepare, random_triangles, small_machine
from hdl_bench.streams import Sink, Source

from cardcage.golden.reference import triangle_words
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.controller.central_broadcast_controller import CentralBroadcastController

BOOTS = {
    "one": ("PM", {}, [(0, 1)]),
    "two": ("PMMPMM", {}, [(0, 2), (2, 2)]),
    "an empty domain": ("PPMMPMM", {}, [(0, 0), (0, 2), (2, 2)]),
    "orphans": ("MMPMM", {"allow_orphans": True}, [(2, 2)]),
    "coarser": ("PMMMM", {"words": 3}, [(0, 4)]),
    "not square": ("PMM", {"width": 16, "height": 4}, [(0, 2)]),
}


@pytest.mark.parametrize("name", BOOTS)
@pytest.mark.parametrize("seed", [None, 1])
def test_boot(name, seed):
    cards, changes, domains = BOOTS[name]
    configuration = small_machine(cards, **changes)
    expected = boot_responses(configuration, domains)
    run = Run(configuration, [], len(expected) + 1, domains=domains, seed=seed,
              work=0 if seed is None else 20)
    assert run.responses[:-1] == expected
    kind, cycles = run.responses[-1]
    assert kind == ResponseKind.BOOTED
    # Clocks from reset until the pictures were black.
    [began], [ended] = run.units.initialised, run.units.ended
    assert cycles == ended + 1 == began + 21
    assert cycles < run.sink.clocks[-2]
    if seed is None:
        assert cycles == run.sink.clocks[-2] - 1
    assert [operation for _, operation, _ in run.cage.packets] == [Operation.SURVEY]
    assert run.cage.idle[began]  # the survey's words are gone
    assert not run.units.passes and set(run.units.backgrounds) == {0}
    assert set(run.units.tags) == {(1, 1, 1)}
    assert not run.source.taken
    assert not run.scans.swaps


@pytest.mark.parametrize("total", [0, 3, 5, 7, 300])
@pytest.mark.parametrize("seed", [None, 1])
def test_an_unsupported_number_of_units_is_refused_and_does_not_hang(total, seed):
    configuration = small_machine("PM", maximum_units=max(7, total))
    words = [commands.frame_start((1, 2, 3)), commands.command(Opcode.FRAME_END),
             commands.command(Opcode.READ_DEPTH), commands.command(Opcode.PREPARED_TRIANGLE)]
    fault = (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)
    run = Run(configuration, words, 2 + 1 + len(words), total=total, domains=[(0, total)],
              seed=seed)
    assert run.responses == [(ResponseKind.DOMAIN, total),
                             (ResponseKind.UNITS, total << 16 | total),
                             *[fault] * (1 + len(words))]
    # Nothing is drawn, nothing is initialised.
    assert not run.units.initialised
    assert [operation for _, operation, _ in run.cage.packets] == [Operation.SURVEY]


@pytest.mark.parametrize("domains", [[(0, 2), (2, 1), (3, 1)], [(0, 0), (0, 2), (2, 2)],
                                     [(0, 1), (1, 3)], [(0, 4)]])
def test_unequal_shares_of_squares_are_refused(domains):
    """Cards for two units a processing element; as found, it does not draw."""
    fault = (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)
    for block in (1, 4):
        configuration = small_machine("PMMPMM", block=block)
        booted = boot_responses(configuration, domains)
        run = Run(configuration, [commands.frame_start((1, 2, 3))], len(domains) + 3,
                  domains=domains)
        assert run.responses[:-1] == (booted if block == 1 else [*booted[:-1], fault])
        assert bool(run.units.initialised) == (block == 1)


@pytest.mark.parametrize("opcode", [0, Opcode.TRIANGLE, 7, 15])
def test_unknown_commands_are_answered_and_passed_over(opcode):
    configuration = small_machine("PM")
    unknown = opcode | 0x1234 << commands.BODY_OFFSET
    words = [unknown, commands.command(Opcode.READ_DEPTH), unknown]
    run = Run(configuration, words, 4 + 1 + len(DEPTHS) + 1)
    fault = (ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)
    assert run.responses[4:] == [
        fault, *((ResponseKind.DEPTH, depth) for depth in DEPTHS), fault]


def triangles(configuration, seed, count=12):
    scene = random_triangles(seed, count, width=8, height=8, flat=True)
    return list(triangle_words.prepared_triangles(configuration, prepare(configuration, scene)))


@pytest.mark.parametrize("seed", [None, 0, 1])
def test_frames(seed):
    """Packets in order; drawn when all are done, shown from the next scan's start on."""
    pick = random.Random(f"frames {seed}")
    configuration = small_machine("PM")
    words, expected, packets = [], [], [Operation.SURVEY]
    frames, bodies, colors = 4, [None], []
    for frame in range(frames):
        color = tuple(pick.randrange(256) for _ in range(3))
        drawn = triangles(configuration, f"{seed} {frame}")
        words += [commands.frame_start(color), *drawn, commands.command(Opcode.FRAME_END)]
        packets += [Operation.FRAME_START] + [Operation.DRAW] * len(drawn)
        colors += [sum(value << 8 * place for place, value in enumerate(color))]
        bodies += [None]
        bodies += [word >> commands.BODY_OFFSET for word in drawn]
        expected += [ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN]
        if frame % 2:
            words += [commands.command(Opcode.READ_DEPTH), commands.command(Opcode.READ_COUNTERS)]
            packets += [Operation.READ_DEPTH, Operation.READ_COUNTERS]
            bodies += [None, None]
            expected += [ResponseKind.DEPTH] * len(DEPTHS) + [kind for kind, _ in COUNTS]
    run = Run(configuration, words, 4 + len(expected), seed=seed,
              work=0 if seed is None else 30, period=40)
    assert [kind for kind, _ in run.responses[4:]] == expected
    assert [operation for _, operation, _ in run.cage.packets] == packets
    for number, body in enumerate(bodies):
        if body is not None:
            assert run.fields(number)[1] == body

    assert len(run.scans.swaps) == frames
    opcodes = [word & 15 for word in words]
    starts = [clock for clock, opcode in zip(run.source.taken, opcodes, strict=True)
              if opcode == Opcode.FRAME_START]
    for frame, swap in enumerate(run.scans.swaps):
        began = starts[frame]
        drawn, shown = (run.clock_of(kind, frame) for kind in (ResponseKind.FRAME_DRAWN,
                                                               ResponseKind.FRAME_SHOWN))
        # Only at a scan's start, the first one after the report of the finished picture.
        assert swap == min(clock for clock in run.scans.starts if clock > drawn)
        assert shown > swap
        # From then on its background is shown, and that of no picture before its swap.
        assert run.units.backgrounds[swap + 1] == colors[frame]
        assert run.units.backgrounds[swap] == ([0, *colors])[frame]
        # It got a tag of its own when it started.
        [start] = [clock for clock, operation, _ in run.cage.packets
                   if operation == Operation.FRAME_START and began < clock < drawn]
        assert run.cage.idle[start] and (start == began + 1 or seed is not None)
        (depth, *color), before = run.units.tags[start + 1], run.units.tags[start]
        back = 1 - run.scans.fronts[start]
        assert color[back] == depth not in (0, *before)
        assert color[1 - back] == before[2 - back]
        # No packet of this frame is still at work when it is drawn, nor follows before the swap.
        assert run.cage.idle[drawn]
        assert not any(drawn < clock <= swap for clock, _, _ in run.cage.packets)
        values = [value for kind, value in run.responses if kind == ResponseKind.FRAME_SHOWN]
        # Scans that began with the old picture.
        assert values[frame] == sum(began <= clock < swap for clock in run.scans.starts)
        cycles = [value for kind, value in run.responses if kind == ResponseKind.FRAME_DRAWN]
        last = max(clock for clock, _, _ in run.cage.packets if clock <= drawn)
        done = next(clock for clock in range(last + 1, drawn + 1) if run.cage.idle[clock])
        # Clocks between the frame start and done, known within the controller's settling time.
        assert -1 <= cycles[frame] - (done - began) <= Cage.LATE
        assert cycles[frame] < drawn - began + 1


def test_a_picture_that_takes_longer_than_a_scan_is_shown_late():
    configuration = small_machine("PM")
    words = [commands.frame_start((0, 0, 0)), *triangles(configuration, "late"),
             commands.command(Opcode.FRAME_END)]
    run = Run(configuration, words, 6, work=40, period=25)
    shown = dict(run.responses)[ResponseKind.FRAME_SHOWN]
    assert shown > 2
    assert len(run.scans.swaps) == 1


@pytest.mark.parametrize("words", [5, 400])
@pytest.mark.parametrize("tag_bits", [2, 3])
def test_a_frame_start_waits_for_a_tag_that_no_word_has(tag_bits, words):
    """With passes that are quick, and with some that take longer than a frame; the wait counts."""
    configuration = small_machine("PM", tag_bits=tag_bits)
    frames = 3 << tag_bits
    run = Run(configuration, [commands.frame_start((number, 0, 0)) for number in range(frames)]
              + [commands.command(Opcode.FRAME_END)], 6, depth=words)
    starts = [clock for clock, operation, _ in run.cage.packets
              if operation == Operation.FRAME_START]
    assert len(starts) == frames
    held = {1}
    for clock in range(starts[0], starts[-1] + 1):
        if clock in run.units.passes:
            stale = held - set(run.units.tags[clock])
        if clock in run.units.ended:
            held -= stale
        if clock in starts:
            tag = run.units.tags[clock + 1][0]
            assert tag not in held
            held.add(tag)
    # The front's tag is never used again, the others are if need be.
    used = {run.units.tags[clock + 1][0] for clock in starts}
    assert 1 not in used and (len(used) == (1 << tag_bits) - 2 or words == 5)
    waits = [start - taken - 1 for start, taken in zip(starts, run.source.taken, strict=False)]
    assert max(waits) > words / 2 if words == 400 else max(waits) < 20
    drawn = dict(run.responses)[ResponseKind.FRAME_DRAWN]
    assert drawn <= waits[-1] + 8


def test_an_empty_frame_takes_as_long_whatever_the_memory_holds():
    frames = [commands.frame_start((1, 2, 3)), commands.command(Opcode.FRAME_END)]
    took = {words: [value for kind, value in
                    Run(small_machine("PM"), frames * 3, 4 + 6, depth=words).responses
                    if kind == ResponseKind.FRAME_DRAWN] for words in (1, 5, 20)}
    assert took[1] == took[5] == took[20]
    assert max(took[1]) <= 6


@pytest.mark.parametrize("first", [Opcode.READ_DEPTH, Opcode.READ_COUNTERS])
@pytest.mark.parametrize("seed", range(3))
def test_read_back_waits_for_done(seed, first):
    """Behind triangles, and behind another read-back."""
    answers = {Opcode.READ_DEPTH: [(ResponseKind.DEPTH, depth) for depth in DEPTHS],
               Opcode.READ_COUNTERS: COUNTS}
    other, = set(answers) - {first}
    configuration = small_machine("PM")
    words = [commands.frame_start((0, 0, 0)), *triangles(configuration, seed, 5),
             *map(commands.command, (first, other, first))]
    expected = answers[first] + answers[other] + answers[first]
    run = Run(configuration, words, 4 + len(expected), seed=seed, work=25)
    for clock, operation, _ in run.cage.packets:
        if operation in (Operation.READ_DEPTH, Operation.READ_COUNTERS):
            assert run.cage.idle[clock]
    assert run.responses[4:] == expected


@pytest.mark.parametrize("seed", range(3))
def test_what_comes_along_the_chain_while_the_controller_speaks_waits(seed):
    """Cards that are done say nothing; the words of one that does are not lost."""
    class Unasked(Cage):
        """Has something to say without having been asked."""

        said = 0

        def drive(self, ctx):
            if not self.answers and self.said < 40 and self.pick.random() < 0.5:
                self.answers.append((ResponseKind.DEPTH, 100 + self.said))
                self.said += 1
            super().drive(ctx)

        finished = True  # done, whatever it says

    configuration = small_machine("PM")
    words = [7, commands.frame_start((0, 0, 0)), commands.command(Opcode.FRAME_END), 7]
    dut = CentralBroadcastController(configuration=configuration)
    cage = Unasked(dut, domains=[], seed=seed)
    fault = (ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)
    own = [ResponseKind.UNITS, ResponseKind.PICTURE, ResponseKind.BOOTED, fault[0],
           ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN, fault[0]]
    sink = Sink(dut.responses, 40 + len(own))
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, 1)), Source(dut.commands, words),
             sink, cage, Units(dut, 20), Scans(dut, 50), after=10)
    passed = [item.value for item in sink.items if item.kind == ResponseKind.DEPTH]
    assert passed == list(range(100, 140))
    assert [item.kind for item in sink.items if item.kind != ResponseKind.DEPTH] == own


@pytest.mark.parametrize("delay", range(10))
def test_scans_are_counted_from_the_frame_start_on(delay):
    """Whatever the phase of the scans is, also where both come in the same clock."""
    configuration = small_machine("PM")
    words = [commands.frame_start((0, 0, 0)), commands.command(Opcode.FRAME_END)]
    dut = CentralBroadcastController(configuration=configuration)
    waits = iter((60 + delay, 15, 0))
    source, sink = Source(dut.commands, words, lambda: next(waits)), Sink(dut.responses, 6)
    scans = Scans(dut, 10)
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, 1)), source, sink,
             Cage(dut, domains=[(0, 1)]), Units(dut, 5), scans, after=2)
    (swap,) = scans.swaps
    assert sink.items[-1].value == sum(source.taken[0] <= clock < swap for clock in scans.starts)
    assert sink.items[-1].value > 0


@pytest.mark.parametrize("seed", [None, 0, 1])
@pytest.mark.parametrize("interval", [1, 256])
def test_vertices_are_prepared_and_everything_keeps_its_order(seed, interval):
    """Triangles with and without set-up mixed; commands after them find them announced."""
    configuration = small_machine("PM", setup="hardware", setup_interval=interval)
    pick = random.Random(f"mixed {seed}")
    words, bodies = [commands.frame_start((1, 2, 3))], [(Operation.FRAME_START, None)]
    for part in range(6):
        scene = random_triangles(f"{seed} {part}", pick.randrange(1, 6), width=8, height=8)
        prepared = triangle_words.prepared_triangles(configuration, prepare(configuration, scene))
        words += [*(prepared if part % 2 else triangle_words.triangles(configuration, scene))]
        bodies += [(Operation.DRAW, word >> commands.BODY_OFFSET) for word in prepared]
        if part == 2:
            words.append(commands.command(Opcode.READ_COUNTERS))
            bodies.append((Operation.READ_COUNTERS, None))
    words.append(commands.command(Opcode.FRAME_END))
    run = Run(configuration, words, 4 + len(COUNTS) + 2, seed=seed,
              work=0 if seed is None else 20)
    found = [run.fields(number) for number in range(1, len(run.cage.packets))]
    assert len(found) == len(bodies)
    for (operation, body), (expected_operation, expected) in zip(found, bodies, strict=True):
        assert operation == expected_operation
        assert expected is None or body == expected
    assert [kind for kind, _ in run.responses[4:]] == [
        *(kind for kind, _ in COUNTS), ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN]
    assert run.clock_of(ResponseKind.FRAME_DRAWN) > run.cage.packets[-1][0]


def test_latency_and_throughput():
    """A prepared triangle is broadcast in the clock in which it is taken; one every clock."""
    configuration = small_machine("PM")
    words = triangles(configuration, "speed", 30)

    class Wide(Cage):
        """Room for everything."""

        def drive(self, ctx):
            super().drive(ctx)
            self.ready = True
            ctx.set(self.dut.broadcast.ready, 1)

    dut = CentralBroadcastController(configuration=configuration)
    cage, source = Wide(dut, domains=[(0, 1)]), Source(dut.commands, words)
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, 1)), source,
             Sink(dut.responses, 4), cage, Units(dut, 5))
    clocks = [clock for clock, operation, _ in cage.packets if operation == Operation.DRAW]
    assert clocks == source.taken
    assert clocks == list(range(clocks[0], clocks[0] + len(words)))
