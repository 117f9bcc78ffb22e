"""Objects and vertices, set up in the order in which they are told: every bit of what comes against
``golden.reference.triangle_setup.prepare``, every count against the golden twin."""

import numpy as np
import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.pictures import prepare, prepared_values
from hdl_bench.streams import Sink, Source, no_pause, pauses
from object_bench.objects import object_commands, object_machine, object_word, random_objects

from cardcage.golden.objects.making import made_at_nodes
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.hdl.objects.object_reader import ObjectReader
from cardcage.hdl.objects.object_setup import ObjectSetup


def expected(configuration, listed):
    """The prepared triangles as the host's order has them."""
    layout = commands.prepared_triangle_layout(configuration)
    shares = organisation_of(configuration).shares(listed)
    prepared, found = prepare(configuration, listed), {}
    for primitive, values in zip(prepared.primitive, prepared_values(configuration, prepared),
                                 strict=True):
        own = {"node": int(shares.node[primitive]), "round": int(shares.round[primitive])}
        values["planes"] |= {"round": own["round"]}
        found[int(primitive)] = commands.pack(layout, values | own)
    return [found[primitive] for primitive in shares.host_order if primitive in found]


class Watch(Agent):
    def __init__(self, dut):
        self.dut, self.busy, self.counts, self.full = dut, [], [], []

    def sample(self, ctx):
        self.busy.append(ctx.get(self.dut.busy))
        self.counts.append((ctx.get(self.dut.made), ctx.get(self.dut.dropped)))
        self.full.append(ctx.get(self.dut.full))


def run(configuration, lists, pause=(no_pause, no_pause)):
    """One list after another, each after its meshes, which are forgotten before the next one."""
    dut, words, wanted = ObjectSetup(configuration=configuration), [], []
    for objects in lists:
        load, draw = object_commands(configuration, objects)
        words += [commands.command(Opcode.CLEAR_LISTS), *load, *draw]
        wanted += expected(configuration, objects.display_list())
    source = Source(dut.words, list(map(object_word, words)), pause[0])
    sink = Sink(dut.triangles, len(wanted), pause[1])
    watch = Watch(dut)
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, configuration.units)), source, sink,
             watch, after=8 + dut.latency)
    assert [item.as_bits() for item in sink.items] == wanted
    assert not watch.busy[-1] and not any(watch.full)
    return dut, source, sink, watch


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
def test_objects_and_vertices_under_stalls(shading):
    configuration = object_machine(cards="PMC", shading=shading, setup_interval=4)
    lists = [random_objects(configuration, 16, seed, wide=True) for seed in (1, 2)]
    _, _, _, watch = run(configuration, lists, (pauses(f"told {shading}"),
                                                pauses(f"taken {shading}")))
    made = [made_at_nodes(configuration, objects.display_list())[0] for objects in lists]
    assert min(min(each.made, each.sent, each.dropped) for each in made) > 3
    assert watch.counts[-1] == (sum(each.made for each in made),
                                sum(each.dropped for each in made))


def test_latency_and_throughput():
    """An object's triangles follow one another as fast as set-up takes them."""
    configuration = object_machine(cards="PMC", packet="contiguous", order_bits=4)
    objects = random_objects(configuration, 12, 3, triangles=(6, 7))
    kept = prepare(configuration, objects.display_list()).primitive
    dut, source, sink, _ = run(configuration, [objects])
    loads = len(object_commands(configuration, objects)[0]) + 1
    # Triangles that are dropped take a clock each.
    assert sink.clocks[0] == source.taken[loads] + dut.latency + kept[0]
    assert dut.latency == dut.queue_latency + ObjectReader.latency + dut.setup.latency
    gaps = np.diff(sink.clocks)
    assert (gaps >= dut.setup.leaving).all() and gaps.mean() < dut.setup.interval + 0.5


def test_meshes_without_room_and_counts_that_start_anew():
    configuration = object_machine(cards="PMC", mesh_triangles=8, meshes=2, setup_interval=4)
    roomy = object_machine(cards="PMC")
    cases = [((4, 4), False), ((4, 5), True), ((1, 1, 1), True), ((8,), False)]
    forget, words, ends = object_word(commands.command(Opcode.CLEAR_LISTS)), [], []
    for triangles, _ in cases:
        load, draw = object_commands(roomy, random_objects(roomy, 1, 1, triangles=triangles))
        words += [forget, *map(object_word, load)]
        ends.append(len(words))
    words += [object_word(word) for word in draw]
    dut = ObjectSetup(configuration=configuration)
    source, watch, started = Source(dut.words, words), Watch(dut), []

    def drive(ctx, clock):
        ctx.set(dut.total, configuration.units)
        idle = source.finished and not ctx.get(dut.busy) and not started
        started.extend([clock] * idle)
        ctx.set(dut.start, idle)

    simulate(dut, source, Drive(drive), watch, Sink(dut.triangles), after=100)
    # A clock after the last word of each case was taken, before the next case forgets it.
    assert [bool(watch.full[source.taken[end - 1] + 1]) for end in ends] == [
        full for _, full in cases]
    assert watch.counts[started[0]][0] == 8 and watch.counts[-1] == (0, 0)
