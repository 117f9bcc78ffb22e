"""Words that no host should send, and resets at any clock, before good frames."""

import random

import numpy as np
import pytest
from frames import golden_picture
from hdl_bench.region_tables import Tables, region_word
from node_frames import compiled
from region_bench.models import BALANCERS, MODELS, machine, random_table, some_list

from cardcage.golden.cycles.frame_clocks import most_frame_clocks
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.testbenches.engines.engine import Job, Reset
from cardcage.testbenches.frames.conversation import owed_at_boot, owed_to
from cardcage.testbenches.frames.frame_job import frame_commands
from testbenches.studies.stray_words import StrayWords

READ_DEPTH, READ_TABLE = (commands.command(opcode) for opcode in (
    Opcode.READ_DEPTH, Opcode.READ_TABLE))


def strays(configuration, pick, count):
    """Tables with words missing, or wrong, or others between them; and what is nothing at all."""
    good = frame_commands(configuration, some_list(configuration, pick.randrange(99), 4))
    others, words = StrayWords(configuration, good, pick), []
    while len(words) < count:
        table = [region_word(configuration, region, int(element)) for region, element
                 in enumerate(random_table(pick, configuration))]
        kind = pick.randrange(4)
        if kind == 0:
            table[pick.randrange(len(table))] ^= 1 << pick.randrange(
                commands.BODY_OFFSET, commands.BODY_OFFSET + 12)
        elif kind == 1:
            place = pick.randrange(len(table))
            table[place:place + pick.randrange(2)] = others.words(1)
        elif kind == 2:
            table = others.words(5)
        words += table
    return words


class Owed:
    """What is answered, word by word from a boot on, and the table of the frame begun last."""

    def __init__(self, configuration):
        self.organisation = organisation_of(configuration)
        self.by_host = configuration.balancer == "host"
        self.tables = Tables(configuration)
        self.kinds = [kind for kind, _ in owed_at_boot(self.organisation)]

    def take(self, words):
        for word in words:
            fault = self.tables.take(word) if self.by_host else None
            if fault is not None:
                self.kinds.append(ResponseKind.ERROR)
            self.kinds += [kind for kind, _ in owed_to(self.organisation, word)]


@pytest.mark.parametrize("balancer", ["host", "hardware"])
@pytest.mark.parametrize("seed", range(2))
def test_good_frames_after_stray_words_and_resets(balancer, seed):
    """Each word has its answers, and what is drawn last is exact, on the pins and in the depths."""
    configuration = (machine(MODELS, "three, two ports") if balancer == "host"
                     else machine(BALANCERS, "three, two ports", balancer="hardware"))
    pick, words, resets, cycle = random.Random(f"strays {seed}"), [], [], 0
    for _ in range(2):
        words += strays(configuration, pick, 30)
        cycle += pick.choice((pick.randrange(1, 400), pick.randrange(1, 9000)))
        resets.append(Reset(cycle, len(words)))
    owed, lists = Owed(configuration), [some_list(configuration, (seed, 1), 12),
                                        some_list(configuration, (seed, 2), 5)]
    before, kept, places, tables = len(words), [], [], []
    for listed in lists:
        lost = strays(configuration, pick, 40)
        lost += [READ_TABLE] * (balancer == "hardware")
        owed.take(lost)
        places.append(len(owed.kinds))
        frame = [*frame_commands(configuration, listed), READ_DEPTH]
        owed.take(frame)
        tables.append(owed.tables.used)
        kept += lost + frame
    assert before == resets[-1].command
    frames = sum(commands.opcode_of(word) == Opcode.FRAME_END for word in kept)
    answered = compiled().run(Job(
        configuration, commands=words + kept, responses=len(owed.kinds), memory_seed=seed,
        stall_seed=pick.choice((None, seed)), resets=resets,
        maximum_cycles=cycle + most_frame_clocks(configuration, len(kept))
        + (2 + frames) * 4 * configuration.cycles_per_scan + 100 * len(owed.kinds)))
    responses = [response for response in answered.responses if response[2] > cycle]
    assert [kind for kind, *_ in responses] == owed.kinds
    organisation = organisation_of(configuration)
    depths, count = organisation.depths_read_back, configuration.dealt_regions.count
    for listed, place, table in zip(lists, places, tables, strict=True):
        if balancer == "hardware":
            told = responses[place - count:place]
            assert {kind for kind, *_ in told} == {ResponseKind.TABLE_ENTRY}
            table = [element for _, element, _ in told]
        # Before FRAME_DRAWN a table that was begun may be refused.
        place = next(number for number in range(place, len(responses))
                     if responses[number][0] == ResponseKind.FRAME_DRAWN)
        (_, _, shown), *read = responses[place + 1:place + 2 + depths]
        picture = golden_picture(configuration, listed)
        np.testing.assert_array_equal(
            organisation.dealt(table).depth_image([depth for _, depth, _ in read]), picture.depth)
        scan = next(scan for scan in answered.scans if scan.cycle > shown)
        np.testing.assert_array_equal(scan.picture, picture.color)
