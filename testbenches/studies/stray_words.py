"""Command words that no host should send, and the jobs that hide good frames among them."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from cardcage.golden.cycles.frame_clocks import most_frame_clocks
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Layout, Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.engine import EngineRun, Job, Reset
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.conversation import Owed, owed_at_boot, owed_to, owed_to_each
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.heard_tables import HeardTables
from cardcage.testbenches.frames.region_host import table_commands
from cardcage.testbenches.frames.responses import Answers

#: Kind, value and cycle.
Response: TypeAlias = tuple[ResponseKind, int, int]
Int64 = NDArray[np.int64]

#: What, where nodes merge on a bus, may be said of a frame while later commands are answered.
PRESENTED = (ResponseKind.MERGED, ResponseKind.FRAME_SHOWN)

#: After every good frame.
READINGS = (commands.command(Opcode.READ_DEPTH), commands.command(Opcode.READ_COUNTERS))


class StrayWords:
    """Words from a seed: random ones, good ones with a bit flipped, fields at their ends, frames
    that are cut short or put together wrongly."""

    def __init__(self, configuration: MachineConfiguration, good: Sequence[int],
                 source: random.Random) -> None:
        self._configuration = configuration
        self._good = good
        self._source = source
        self._kinds = (self._random, self._random_body, self._flipped, self._extreme,
                       self._one_field, self._one_field, self._one_field, self._piece)

    def words(self, count: int) -> list[int]:
        """At least ``count`` of them, kind after kind."""
        found: list[int] = []
        while len(found) < count:
            found += self._source.choice(self._kinds)()
        return found

    def _bits(self, count: int) -> int:
        return self._source.getrandbits(count)

    def _random(self) -> list[int]:
        return [self._bits(commands.command_bits(self._configuration))]

    def _random_body(self) -> list[int]:
        """A drawing command mostly: those that are answered take long."""
        drawing = [Opcode.PREPARED_TRIANGLE, Opcode.TRIANGLE]
        if self._configuration.objects is not None:
            drawing += [Opcode.OBJECT] * 2
        opcode = self._source.choice([*Opcode, *drawing * 4])
        body = self._bits(commands.command_bits(self._configuration) - commands.BODY_OFFSET)
        return [commands.command(opcode, body)]

    def _flipped(self) -> list[int]:
        bits = commands.command_bits(self._configuration)
        return [word ^ (1 << self._source.randrange(bits) if self._source.randrange(2) else 0)
                for word in self._run()]

    def _piece(self) -> list[int]:
        """A piece of a frame, perhaps with a start, an end or a reading too many within."""
        piece = self._run()
        wrong = self._source.choice((Opcode.FRAME_START, Opcode.FRAME_END, Opcode.READ_DEPTH,
                                     Opcode.READ_COUNTERS, None, None))
        if wrong is not None:
            piece.insert(self._source.randrange(len(piece) + 1), commands.command(wrong))
        return piece

    def _run(self) -> list[int]:
        """Good words, one after another, from anywhere."""
        begin = self._source.randrange(len(self._good))
        return list(self._good[begin:begin + self._source.randrange(1, 6)])

    def _extreme(self) -> list[int]:
        """A triangle whose fields all are at the ends of their ranges, or of the picture."""
        opcode = self._source.choice((Opcode.PREPARED_TRIANGLE, Opcode.TRIANGLE))
        return [self._altered(commands.command(opcode), every=True)]

    def _one_field(self) -> list[int]:
        """Good words, but each with one field at such an end."""
        return [self._altered(word, every=False) for word in self._run()]

    def _altered(self, word: int, every: bool) -> int:
        opcode = commands.opcode_of(word)
        layouts = {Opcode.PREPARED_TRIANGLE: commands.prepared_triangle_layout,
                   Opcode.TRIANGLE: commands.triangle_layout}
        if self._configuration.objects is not None:
            layouts |= {Opcode.MESH_TRIANGLE: commands.mesh_triangle_layout,
                        Opcode.OBJECT: commands.object_layout}
        if opcode not in layouts:
            return word
        layout = layouts[Opcode(opcode)](self._configuration)
        fields = list(_fields(layout, commands.BODY_OFFSET))
        # Of a triangle set up by the host the first five are its rows and columns.
        few = self._source.choice((fields, fields[:5]))
        for offset, bits in fields if every else [self._source.choice(few)]:
            mask = (1 << bits) - 1
            word = word & ~(mask << offset) | (self._end(bits) & mask) << offset
        return word

    def _end(self, bits: int) -> int:
        c = self._configuration
        screen = [side + more for side in (c.width, c.height) for more in (-1, 0, 1)]
        return self._source.choice((0, 1, -1, -2, 1 << bits - 1, (1 << bits - 1) - 1,
                                    self._bits(bits), self._source.choice(screen)))


def _fields(layout: Layout, offset: int) -> Iterator[tuple[int, int]]:
    """First bit and bits of each number of a layout that begins at ``offset``."""
    for entry in layout.values():
        bits = entry if isinstance(entry, int) else commands.layout_bits(entry)
        if isinstance(entry, int):
            yield offset, bits
        else:
            yield from _fields(entry, offset)
        offset += bits


@dataclass(frozen=True)
class Trial:
    """A job of stray words and good frames, and what it has to come to.

    ``frames``   the display lists of the good frames, all of them after the last reset
    ``cut``      what is owed from each boot until its reset, of which the rest never comes
    ``owed``     what is owed after the last reset, and ``places`` where in it each frame begins
    ``tables``   by which regions are dealt out in each, where the host says so
    """

    job: Job
    frames: Sequence[DisplayList]
    cut: Sequence[Sequence[Owed]]
    owed: Sequence[Owed]
    places: Sequence[int]
    tables: Sequence[Int64 | None]


def make_trial(configuration: MachineConfiguration, lists: Sequence[DisplayList], seed: int, *,
               resets: int, rounds: int, stray: int) -> Trial:
    """From boot to boot ``stray`` words or more and a reset at any clock, ``resets`` times; then
    ``rounds`` times as many stray words and a good frame, each of ``lists`` in turn."""
    source = random.Random(f"stray words {seed}")
    organisation = organisation_of(configuration)
    good = [frame_commands(configuration, one) for one in lists]
    before = [_about_tables(configuration, number) for number in range(len(lists))]
    strays = StrayWords(configuration, [*before[0], *good[0]], source)
    words: list[int] = []
    cut, at = [], []
    cycle = 0
    for _ in range(resets):
        lost = strays.words(stray)
        words += lost
        cut.append(list(_owed(configuration, lost)))
        cycle += source.choice((source.randrange(1, 60), source.randrange(1, 4000)))
        at.append(Reset(cycle, len(words)))
    kept: list[int] = []
    owed, begins = owed_at_boot(organisation), []
    for number in range(rounds):
        lost = strays.words(stray)
        frame = [*good[number % len(good)], *READINGS]
        kept += lost + before[number % len(good)]
        begins.append(len(kept))
        kept += frame
    each = list(owed_to_each(organisation, kept))
    ends = np.cumsum([len(owed), *map(len, each)])
    places = ends[begins].tolist()
    owed += [answer for answers in each for answer in answers]
    opcodes = [commands.opcode_of(word) for word in kept]
    job = Job(
        configuration, commands=words + kept, responses=len(owed), memory_seed=seed,
        stall_seed=source.choice((None, seed)), resets=at,
        maximum_cycles=cycle + most_frame_clocks(configuration, len(kept))
        + 2 * configuration.cycles_per_scan * opcodes.count(Opcode.FRAME_END)
        + 30 * organisation.depths_read_back * opcodes.count(Opcode.READ_DEPTH))
    return Trial(job, [lists[number % len(lists)] for number in range(rounds)], cut, owed, places,
                 _tables(configuration, kept, begins))


def _about_tables(configuration: MachineConfiguration, turn: int) -> list[int]:
    """Before a good frame: the host deals regions out, or asks how the machine does it."""
    if configuration.regions is None:
        return []
    if configuration.balancer == "hardware":
        return [commands.command(Opcode.READ_TABLE)]
    if not configuration.takes_tables:
        return []
    regions, elements = configuration.dealt_regions.count, configuration.processing_elements
    return table_commands(configuration, (np.arange(regions) + turn) % elements)


def _tables(configuration: MachineConfiguration, words: Sequence[int],
            begins: Sequence[int]) -> list[Int64 | None]:
    """By which each good frame is drawn, where the host says so: another one than before it, if
    the words before had begun a frame."""
    if not configuration.takes_tables:
        return [None] * len(begins)
    heard, used = HeardTables(configuration), []
    for word in words:
        heard.take(word)
        used.append(np.array(heard.used))
    return [used[begin] for begin in begins]


def _owed(configuration: MachineConfiguration, words: Sequence[int]) -> Iterator[Owed]:
    organisation = organisation_of(configuration)
    yield from owed_at_boot(organisation)
    for answers in owed_to_each(organisation, words):
        yield from answers


def check_trial(trial: Trial, run: EngineRun) -> None:
    """Every word has its answers, in order, and every good frame is exact, on the video pins and
    in the depths.  Raises ``AssertionError``."""
    configuration = trial.job.configuration
    presented = PRESENTED if configuration.snoops else ()
    begin = 0
    for reset, owed in zip(trial.job.resets, trial.cut, strict=True):
        end = sum(cycle <= reset.cycle for *_, cycle in run.responses)
        _check_answers(run.responses[begin:end], owed, presented)
        begin = end
    responses = run.responses[begin:]
    _check_answers(responses, trial.owed, presented)
    assert len(responses) == len(trial.owed), f"{len(responses)} answers, not {len(trial.owed)}"
    responses = _by_command(responses, presented)
    organisation = organisation_of(configuration)
    boot = responses[:len(owed_at_boot(organisation))]
    asked = configuration.dealt_regions.count if configuration.balancer == "hardware" else 0
    answers = sum(len(owed_to(organisation, word))
                  for word in (commands.command(Opcode.FRAME_END), *READINGS))
    for number, (display_list, place, table) in enumerate(zip(
            trial.frames, trial.places, trial.tables, strict=True)):
        alone = replace(run, responses=[*boot, *responses[place - asked:place + answers]])
        found = Answers(configuration, alone)
        comparison = compare(configuration, display_list, found.frame(
            0, reading=0, table=found.tables[0] if asked else table))
        assert comparison.equal, f"frame {number}: {comparison.first_difference}"


def _by_command(responses: Sequence[Response],
                presented: Sequence[ResponseKind]) -> list[Response]:
    """What is said of a frame while later commands are answered, put behind its first answer."""
    late = iter([response for response in responses if response[0] in presented])
    found: list[Response] = []
    for response in responses:
        if response[0] not in presented:
            found.append(response)
            if response[0] == ResponseKind.FRAME_DRAWN:
                found += islice(late, len(presented))
    return found


def _check_answers(responses: Sequence[Response], owed: Sequence[Owed],
                   presented: Sequence[ResponseKind]) -> None:
    """Those that came are those that are owed; either may go on.  Kinds that are ``presented``
    have an order of their own."""
    for late in (False, True):
        came = [response for response in responses if (response[0] in presented) == late]
        due = [answer for answer in owed if (answer.kind in presented) == late]
        for place, ((kind, value, cycle), answer) in enumerate(zip(came, due, strict=False)):
            assert kind == answer.kind and answer.value in (None, value), (
                f"answer {place}, cycle {cycle}: {kind.name} {value}, {answer} is due")
