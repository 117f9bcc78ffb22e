"""The cage connects its cards, whatever they are, and nothing else."""

from collections import Counter

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.pictures import exact_words, prepare, random_triangles, small_machine
from hdl_bench.streams import Sink, Source, pauses
from suite.cases import chosen

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.reference import triangle_words
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification import commands
from cardcage.golden.specification.activity import Activity
from cardcage.golden.specification.card_order import domains
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.machine import BOARDS, Machine
from cardcage.hdl.memory_unit.memory_unit import MemoryUnit
from cardcage.hdl.processing_element.processing_element import ProcessingElement

#: Card orders with what is odd about them.
ORDERS = {
    "the least": "PM",
    "PE last": "PMMP",
    "adjacent PEs": "PPMPPM",
    "only PEs in between": "PMPPPM",
    "unequal shares": "PMPMMMPMMMM",
    "two and two": "PMMPMM",
    "orphans on the left": "MMPMPM",
}


def configuration_of(cards, **changes):
    return small_machine(cards, allow_orphans=cards.startswith("M"), **changes)


@pytest.mark.parametrize("order", chosen(
    ORDERS, "only PEs in between", "unequal shares", "orphans on the left"))
def test_wires(order):
    """Numbers and total along the chain; the lines of each element end at the next one."""
    cards = ORDERS[order]
    configuration = configuration_of(cards)
    machine = Machine(configuration=configuration)
    assert [isinstance(card, ProcessingElement) for card in machine.cards] == [
        card == "P" for card in cards]
    assert machine.memory_units == [card for card in machine.cards if isinstance(card, MemoryUnit)]
    assert len(machine.processing_elements) == cards.count("P")
    checked = []

    def watch(ctx, clock):
        number = owner = 0
        nothing = {"write": 0, "read": 0}
        lines = nothing
        for card, letter in zip(machine.cards, cards, strict=True):
            assert ctx.get(card.left.id) == number
            assert ctx.get(card.total) == configuration.units
            driven = {name: ctx.get(getattr(card.right.lines, name).as_value())
                      for name in ("write", "read")}
            if letter == "P":
                owner += 1
                lines = driven
            else:
                number += 1
                # A memory unit passes on what it gets; left of all elements that is nothing.
                assert driven == lines
                assert {name: ctx.get(getattr(card.left.lines, name).as_value())
                        for name in ("write", "read")} == lines
                for name in ("fetch", "show"):
                    generator = machine.scan_generator.scan
                    assert ctx.get(getattr(card.scan, name).as_value()) == ctx.get(
                        getattr(generator, name).as_value())
                for name in ("front", "depth_tag", "initialise", "sweep"):
                    assert ctx.get(getattr(card.pictures, name)) == ctx.get(
                        getattr(machine.controller.pictures, name))
                for place in range(2):
                    assert ctx.get(card.pictures.color_tag[place]) == ctx.get(
                        machine.controller.pictures.color_tag[place])
        assert ctx.get(machine.scan_generator.background) == ctx.get(machine.controller.background)
        assert ctx.get(machine.controller.total) == number == configuration.units
        ready, done = ([ctx.get(getattr(element.broadcast, name))
                        for element in machine.processing_elements] for name in ("ready", "done"))
        assert ctx.get(machine.controller.broadcast.ready) == all(ready)
        assert ctx.get(machine.controller.broadcast.done) == all(done)
        assert ctx.get(machine.controller.pictures.swept) == all(
            ctx.get(unit.pictures.swept) for unit in machine.memory_units)
        for element in machine.processing_elements:
            assert ctx.get(element.broadcast.strobe) == ctx.get(machine.controller.broadcast.strobe)
        checked.append(lines != nothing)

    simulate(machine, Watch(watch, 120), Sink(machine.responses))
    assert any(checked)



@pytest.mark.parametrize("order", chosen(
    ORDERS, "the least", "PE last", "two and two", "orphans on the left"))
def test_a_frame_read_back(order):
    """Boot, one frame and its depths, with a host that stalls: every order of the cards."""
    cards = ORDERS[order]
    scene = random_triangles(order, 10, width=8, height=8, flat=True)
    configuration = configuration_of(cards, fraction_bits=scene_fraction_bits(scene))
    interlace = configuration.interlace
    machine = Machine(configuration=configuration)
    shares = domains(cards)
    words = [commands.frame_start(scene.background),
             *triangle_words.prepared_triangles(configuration, prepare(configuration, scene)),
             commands.command(Opcode.FRAME_END), commands.command(Opcode.READ_DEPTH),
             commands.command(Opcode.READ_COUNTERS)]
    drawn, fragments = exact_words(scene, interlace, flat=True)
    expected = [(ResponseKind.DOMAIN, first << 16 | count) for first, count in shares]
    expected += [
        (ResponseKind.UNITS, sum(count for _, count in shares) << 16 | configuration.units),
        (ResponseKind.PICTURE, interlace.height << 16 | interlace.width),
        (ResponseKind.BOOTED, None), (ResponseKind.FRAME_DRAWN, None),
        (ResponseKind.FRAME_SHOWN, None)]
    background = (1 << configuration.depth_bits) - 1
    expected += [(ResponseKind.DEPTH, drawn.get(interlace.pixel(unit, address), (background,))[0])
                 for first, count in shares for unit in range(first, first + count)
                 for address in range(interlace.words)]
    for first, count in shares:
        own = sum(first <= interlace.unit(*pixel) < first + count for pixel in fragments)
        expected += [(ResponseKind.FRAGMENTS, own), (ResponseKind.BUSY, None)]
    sink = Sink(machine.responses, len(expected), pauses(f"{order} out"))
    colors = set()

    def video(ctx, clock):
        driven = [ctx.get(unit.scan.video) for unit in machine.memory_units]
        drawn = [ctx.get(unit.scan.drawn) for unit in machine.memory_units]
        assert sum(drawn) <= 1  # one unit has the bus
        assert not any(color for color, own in zip(driven, drawn, strict=True) if not own)
        assert ctx.get(machine.scan_generator.scan.video) == sum(driven)
        assert ctx.get(machine.scan_generator.scan.drawn) == sum(drawn)
        colors.update(driven)

    simulate(machine, Source(machine.commands, words, pauses(order)), sink, Watch(video),
             limit=8000, after=configuration.cycles_per_scan)
    assert len(colors) > 2
    for item, (kind, value) in zip(sink.items, expected, strict=True):
        assert item.kind == kind
        assert value is None or item.value == value, ResponseKind(item.kind)


def test_an_idle_element_is_told_why():
    """By the full FIFO of another one and by what the host offers; the others speak themselves."""
    scene = random_triangles("observed", 24, width=8, height=8, flat=True)
    configuration = configuration_of("PMPMMM", fraction_bits=scene_fraction_bits(scene),
                                     observe=True)
    machine = Machine(configuration=configuration)
    controller = machine.controller
    triangles = triangle_words.prepared_triangles(configuration, prepare(configuration, scene))
    words = [commands.frame_start(scene.background), *triangles,
             commands.command(Opcode.FRAME_END)]
    told = Counter()

    def watch(ctx, clock):
        offered = ctx.get(machine.commands.valid) and ctx.get(machine.commands.payload) in triangles
        assert ctx.get(controller.more) == offered
        idle = Activity.SETUP if offered else Activity.DRAIN
        if not ctx.get(controller.broadcast.ready):
            idle = Activity.BROADCAST
        for place, element in enumerate(machine.processing_elements):
            said = ctx.get(element.activity)
            wanted = idle if said == Activity.SETUP else said
            assert ctx.get(machine.activity[place]) == wanted
            told[wanted] += said == Activity.SETUP

    simulate(machine, Source(machine.commands, words, pauses("observed")),
             Sink(machine.responses, 7), Watch(watch))
    assert min(told[kind] for kind in (Activity.SETUP, Activity.DRAIN, Activity.BROADCAST)) > 2


@pytest.mark.parametrize(("name", "cards", "units"),
                         [("tiny", "PM", 1), ("small", "PMMPMM", 4), ("paper", "PMMMM" * 4, 16)])
def test_presets_are_machines(name, cards, units):
    configuration = MachineConfiguration(**PRESETS[name])
    assert isinstance(configuration, MachineConfiguration)
    machine = Machine(configuration=configuration)
    assert "".join("P" if isinstance(card, ProcessingElement) else "M"
                   for card in machine.cards) == cards
    assert len(machine.memory_units) == units
    simulate(machine, Sink(machine.responses), after=1)


def test_a_subclass_makes_the_boards():
    """Each place in the machine has the board that ``make_board`` gave for it."""
    made = []

    class OtherBoards(Machine):
        def make_board(self, name):
            class Other(BOARDS[name]):
                """The same, by another class."""

            made.append((name, Other(configuration=self.configuration)))
            return made[-1][1]

    machine = OtherBoards(configuration=small_machine("PMPM"))
    element, unit = "processing_element", "memory_unit"
    assert [name for name, _ in made] == ["central_broadcast_controller", "video_scan_generator",
                                          element, unit, element, unit]
    boards = [board for _, board in made]
    assert [machine.controller, machine.scan_generator, *machine.cards] == boards
    assert machine.memory_units == [board for name, board in made if name == unit]
    simulate(machine, Sink(machine.responses), after=1)
