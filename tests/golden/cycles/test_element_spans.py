"""What of each triangle falls to each processing element, against the picture."""

from __future__ import annotations

from collections import Counter

import pytest
from cycle_lists import CARDS, owner, scene, spans_of
from wide_machines import wide_machine

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.exact import fragments


@pytest.mark.parametrize(("cards", "block", "skew"), [
    *((cards, 1, skew) for cards in CARDS for skew in (False, True)), ("PMM", 4, False),
    ("2x(PM)", 2, False), ("4x(PMM)", 4, False), ("8x(PM)", 8, False),
    ("4x(PMM)", "lines", False), ("8x(PM)", "lines", False)])
def test_spans_hold_every_fragment_of_their_element(cards, block, skew):
    listed = scene(1)
    block, lines = (1, True) if block == "lines" else (block, False)
    configuration = wide_machine(listed, cards=cards, block=block, skew=skew, lines=lines)
    triangles, parts = spans_of(configuration, listed)
    assert len(parts) > 1 and [part.begin for part in parts[1:]] == [
        part.end for part in parts[:-1]]
    drawn = fragments(listed)
    owners = [owner(configuration, unit) for unit in range(configuration.units)]
    wanted: Counter[tuple[int, int, int]] = Counter()
    squares: dict[tuple[int, int, int], set[int]] = {}
    for primitive, x, y in zip(drawn.primitive.tolist(), drawn.x.tolist(), drawn.y.tolist(),
                               strict=True):
        key = primitive, owners[configuration.interlace.unit(x, y)], y
        wanted[key] += 1
        squares.setdefault(key, set()).add(x // block)
    found: Counter[tuple[int, int, int]] = Counter()
    for part in parts:
        for triangle, element, row, length, crossed, x_bits in zip(
                part.triangle, part.element, part.row, part.length, part.squares, part.x_bits,
                strict=True):
            key = int(triangles.primitive[part.begin + triangle]), int(element), int(row)
            found[key] += int(length)
            assert crossed == (len(squares[key]) if block > 1 and x_bits else 1)
    assert found == wanted


@pytest.mark.parametrize("cards", CARDS)
@pytest.mark.parametrize("skew", [False, True])
def test_rows_are_those_of_the_lattice(cards, skew):
    listed = scene(2)
    configuration = wide_machine(listed, cards=cards, skew=skew)
    triangles, parts = spans_of(configuration, listed)
    for number, block in enumerate(organisation_of(configuration).blocks):
        for part in parts:
            for place, triangle in enumerate(range(part.begin, part.end)):
                rows = [row for row in range(triangles.top[triangle], triangles.bottom[triangle])
                        if row % (1 << block.y_bits) == block.y_offset]
                columns = [column for column in range(triangles.left[triangle],
                                                      triangles.right[triangle])
                           if column % (1 << block.x_bits) in map(block.x_offset_of, range(8))]
                assert part.rows[place, number] == len(rows)
                assert part.met[place, number] == bool(rows and columns)
                here = (part.triangle == place) & (part.block == number)
                assert [rows[step] for step in part.step[here]] == part.row[here].tolist()
