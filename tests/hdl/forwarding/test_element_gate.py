"""Rows of gates: every element draws the triangles of the objects that meet its regions."""

import random
from collections import Counter

import numpy as np
import pytest
from hdl_bench.bench import simulate
from object_bench.objects import object_commands, object_machine, random_objects
from region_bench.forwarding import Deal, Waiting
from region_bench.gates import ElementQueue, GateController, GateRow, forwarded

from cardcage.golden.objects.forwarding import forwarded_objects, made_at_elements
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference import triangle_words
from cardcage.golden.reference.triangle_setup import prepare
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.hdl.backplane.words import Operation

CLEAR = commands.command(Opcode.CLEAR_LISTS)
GRIDS = {"strips": ("2x(PM)", (1, 12)), "few": ("3x(PM)", (2, 1))}


def drawn_by(configuration, display_list):
    """Of each element the bodies of prepared triangles, as a multiset; of those that only some
    elements need and of those that all are sent."""
    share = {"round": display_list.object_of}
    prepared = prepare(display_list, fraction_bits=configuration.fraction_bits,
                       shading=configuration.shading)
    words = triangle_words.prepared_triangles(configuration, prepared, share)
    number = display_list.object_of[prepared.primitive]
    forwarded = forwarded_objects(configuration, display_list)
    wanted = forwarded.drawn | display_list.objects.clipped[:, np.newaxis]
    bits = commands.layout_bits(commands.prepared_triangle_layout(configuration))
    bodies = [word >> commands.BODY_OFFSET & (1 << bits) - 1 for word in words]
    return [Counter(body for body, of in zip(bodies, number, strict=True) if own[of])
            for own in wanted.T]


@pytest.mark.parametrize(("name", "seed", "slow", "fields"), [
    ("strips", 1, (1,), {"packet": 3}), ("few", 4, (), {"packet": "contiguous"})])
def test_everybody_draws_what_is_his_and_done_is_exact(name, seed, slow, fields):
    cards, regions = GRIDS[name]
    configuration = object_machine(cards, objects="elements", regions=regions, balance="static",
                                   order_bits=4, shading="flat", setup_interval=20, **fields)
    row = GateRow(configuration)
    queues = [ElementQueue(own, (seed, number), number in slow)
              for number, own in enumerate(row.own)]
    pick, words, totals = random.Random(seed), [], Counter()
    for frame in range(2):
        objects = random_objects(configuration, 14, (seed, frame), (0, 1, 3),
                                 wide=frame == 1)
        display_list = objects.display_list()
        meshes, drawing = object_commands(configuration, objects)
        words += [CLEAR, *meshes, *drawing]

        def look(ctx, display_list=display_list):
            wanted = drawn_by(configuration, display_list)
            golden = forwarded_objects(configuration, display_list)
            for number, (queue, gate, made) in enumerate(zip(
                    queues, row.gates, made_at_elements(configuration, display_list),
                    strict=True)):
                assert Counter(queue.drawn) == wanted[number], f"element {number}"
                queue.drawn.clear()
                assert (ctx.get(gate.made), ctx.get(gate.dropped)) == (made.made, made.dropped)
                assert forwarded(gate, ctx) == (golden.left[number], golden.right[number])
                totals["dropped"] += made.dropped
                totals["sent"] += made.sent
            totals["drawn"] += int(golden.drawn.sum())
            totals["forwarded"] += int(golden.left.sum() + golden.right.sum())

        words += [None, look, Operation.FRAME_START, *[Operation.READ_DEPTH] * pick.randrange(2)]
    controller = GateController(row, words, seed if seed % 2 else None)
    deal = Deal(row.regions, configuration, organisation_of(configuration).table)
    simulate(row, deal, Waiting(deal, [*queues, controller]), limit=60_000)
    for queue in queues:
        assert queue.operations.count(Operation.FRAME_START) == 2 and not queue.drawn
    assert totals["dropped"] > 5 and totals["sent"] > 5 and totals["drawn"] > 10, totals
    assert (totals["forwarded"] > 10) == (len(queues) > 1)
