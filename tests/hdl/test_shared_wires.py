"""Wires that several boards share: held back by each board in turn, the machine waits for it.

``ready``, ``done`` and ``swept`` are low while one board says so, and from the chain of responses
nothing passes a slot that holds it; everything then comes as it does without a wait.
"""

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import exact_words, prepare, random_triangles, small_machine
from hdl_bench.streams import Sink, Source
from suite.cases import chosen

from cardcage.golden.reference import triangle_words
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification import commands
from cardcage.golden.specification.card_order import domains
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.hdl.machine import Machine

ORDER = "PMPMPMM"
ELEMENTS = [slot for slot, letter in enumerate(ORDER) if letter == "P"]
UNITS = [slot for slot, letter in enumerate(ORDER) if letter == "M"]
SCENE = random_triangles("shared wires", 8, width=4, height=4, flat=True)
CONFIGURATION = small_machine(ORDER, 4, 4, fraction_bits=scene_fraction_bits(SCENE), tag_bits=2,
                              fifo_depth=16)

#: Clocks for which a wire is held, and of these the last ones, in which nothing is left to do.
HELD, QUIET = 150, 40


class Held(wiring.Component):
    """A card that while ``held`` is high keeps ``wire`` low, or lets no responses through."""

    def __init__(self, card, wire):
        self.card, self.wire = card, wire
        self.held = Signal(name="held")
        super().__init__(card.signature)

    def elaborate(self, platform):
        m = Module()
        m.submodules.card = card = self.card
        wiring.connect(m, wiring.flipped(self), card)
        free = ~self.held
        if self.wire == "responses":
            for sender, taker in ((card.left.response, self.left.response),
                                  (self.right.response, card.right.response)):
                m.d.comb += [taker.valid.eq(sender.valid & free),
                             sender.ready.eq(taker.ready & free)]
        else:
            lines = "pictures" if self.wire == "swept" else "broadcast"
            answer, own = (getattr(getattr(part, lines), self.wire) for part in (self, card))
            m.d.comb += answer.eq(own & free)
        return m


class HeldMachine(Machine):
    """The card in ``slot`` can be held."""

    def __init__(self, wire, slot):
        # The controller and the scan generator are made before the cards.
        self._wires = iter([None] * (2 + slot) + [wire])
        super().__init__(configuration=CONFIGURATION)
        self.held = self.cards[slot].held

    def make_board(self, name):
        board, wire = super().make_board(name), next(self._wires, None)
        return Held(board, wire) if wire else board


def conversation():
    """What the host sends, and the answers: kinds, and values where these are known.

    The third frame needs a tag that a pass has taken out.
    """
    interlace = CONFIGURATION.interlace
    words = [*[commands.frame_start(SCENE.background)] * 3,
             *triangle_words.prepared_triangles(CONFIGURATION, prepare(CONFIGURATION, SCENE)),
             *map(commands.command, (Opcode.FRAME_END, Opcode.READ_DEPTH, Opcode.READ_COUNTERS))]
    drawn, fragments = exact_words(SCENE, interlace, flat=True)
    shares = domains(ORDER)
    answers = [(ResponseKind.DOMAIN, first << 16 | count) for first, count in shares]
    answers += [(ResponseKind.UNITS, len(UNITS) << 16 | len(UNITS)), (ResponseKind.PICTURE, None),
                (ResponseKind.BOOTED, None), (ResponseKind.FRAME_DRAWN, None),
                (ResponseKind.FRAME_SHOWN, None)]
    answers += [(ResponseKind.DEPTH, drawn.get(interlace.pixel(unit, address), (255,))[0])
                for unit in range(len(UNITS)) for address in range(interlace.words)]
    for first, count in shares:
        own = sum(first <= interlace.unit(*pixel) < first + count for pixel in fragments)
        answers += [(ResponseKind.FRAGMENTS, own), (ResponseKind.BUSY, None)]
    return words, answers


class Run:
    """The whole conversation, every answer checked; the wire is held from reset on, and once more
    when ``again`` words have been taken.

    For both times: ``then``, the numbers of answers and of words taken as it is let go, and
    ``next``, clocks from there until anything happens.  Long before there was silence.
    """

    def __init__(self, wire, slot, again):
        machine = HeldMachine(wire, slot)
        words, answers = conversation()
        source, sink = Source(machine.commands, words), Sink(machine.responses, len(answers))
        begun, strobes, self.then = [], [], []

        def hold(ctx, clock):
            if len(begun) == len(self.then) < 2 and len(source.taken) >= again * len(begun):
                begun.append(clock)
            held = clock < begun[-1] + HELD
            if not held and len(self.then) < len(begun):
                self.then.append((len(sink.items), len(source.taken)))
            ctx.set(machine.held, held)

        def watch(ctx, clock):
            if ctx.get(machine.controller.broadcast.strobe):
                strobes.append(clock)

        simulate(machine, Drive(hold), Watch(watch), source, sink)
        for item, (kind, value) in zip(sink.items, answers, strict=True):
            assert item.kind == kind
            assert value is None or item.value == value, kind
        happened = sorted([*strobes, *sink.clocks, *source.taken])
        released = [clock + HELD for clock in begun]
        for free in released:
            assert not any(free - QUIET <= clock < free for clock in happened)
        self.next = [next(clock for clock in happened if clock >= free) - free
                     for free in released]


BOOTED = len(ELEMENTS) + 3
TRIANGLES = len(prepare(CONFIGURATION, SCENE))


@pytest.mark.parametrize("slot", ELEMENTS)
def test_nothing_is_announced_until_each_element_is_ready(slot):
    """The survey at first, then a triangle among others; in the clock in which all are."""
    run = Run("ready", slot, again=5)
    assert run.then == [(0, 0), (BOOTED, 5)]
    assert run.next == [0, 0]


@pytest.mark.parametrize("slot", ELEMENTS)
def test_no_report_until_each_element_is_done(slot):
    """All domains have been reported, not the units; all triangles are drawn, not reported so."""
    run = Run("done", slot, again=3 + TRIANGLES)
    assert run.then == [(len(ELEMENTS), 0), (BOOTED, 3 + TRIANGLES + 1)]
    assert run.next == [1, 1]


@pytest.mark.parametrize("slot", chosen(UNITS, *UNITS[::2]))
def test_no_tag_is_used_again_until_each_unit_is_swept(slot):
    """At boot, and when a frame starts for which there is no tag."""
    run = Run("swept", slot, again=2)
    assert run.then == [(len(ELEMENTS) + 1, 0), (BOOTED, 3)]
    assert run.next == [1, 1]


@pytest.mark.parametrize("slot", chosen(range(ELEMENTS[-1] + 1), 1, 4))
def test_responses_wait_for_each_slot_that_they_pass(slot):
    """Those from its left come in the meantime: domains, then depths."""
    run = Run("responses", slot, again=3 + TRIANGLES + 2)
    left = ORDER[:slot].count("P")
    units = ORDER[:ELEMENTS[left]].count("M")
    assert run.then == [(left, 0), (BOOTED + 2 + units * CONFIGURATION.interlace.words,
                                    3 + TRIANGLES + 2)]
    assert run.next == [left, left]  # each element on the way is a clock
