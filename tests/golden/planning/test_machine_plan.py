"""The planned machine: wide enough for its scene, no bit wider, every number with its reason."""

from dataclasses import replace
from fractions import Fraction
from math import ceil

import numpy as np
import pytest
from plan_scenes import CARDS, random_list, triangles
from wide_machines import wide_machine

from cardcage.golden.hard_cases.catalogue import HARD_CASES
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.planning.on_screen_widths import on_screen_widths
from cardcage.golden.planning.scene_needs import fewest_sub_bits, fitted, scene_needs, with_sub_bits
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import carry_edges, prepare, scene_fraction_bits
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import to_signed, wrap


def signed_bits(values):
    """The fewest bits of two's complement that hold them all, by trying."""
    return next(bits for bits in range(1, 64)
                if all(-(1 << (bits - 1)) <= value < 1 << (bits - 1) for value in values))


def edge_columns(display_list, x_shift=0, y_shift=0):
    """Every edge's first column on each of its rows, by rational intercepts; its height; and its
    height times its rows."""
    unit_x, unit_y = (1 << (display_list.sub_bits + shift) for shift in (x_shift, y_shift))
    prepared = prepare(display_list, fraction_bits=0, x_shift=x_shift, y_shift=y_shift)
    columns, heights, products = [], [], []
    for index, primitive in enumerate(prepared.primitive):
        corners = sorted(display_list.position[primitive].tolist(), key=lambda corner: corner[1])
        top, middle, bottom = (int(getattr(prepared, name)[index])
                               for name in ("top", "middle", "bottom"))
        for begin, end, first, after in ((0, 2, top, bottom), (0, 1, top, middle),
                                         (1, 2, middle, bottom)):
            (bx, by), (ex, ey) = corners[begin], corners[end]
            products.append((ey - by) * (after - first))
            for row in range(first, after):
                x = bx + (row * unit_y + unit_y // 2 - by) * Fraction(ex - bx, ey - by)
                columns.append(ceil((x - unit_x // 2) / unit_x))
                heights.append(ey - by)
    return columns, heights, products


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("x_shift", "y_shift"), [(0, 0), (0, 1), (1, 1)])
def test_widths_are_the_fewest(seed, x_shift, y_shift):
    """Against every value that an edge or a vertex takes, found one by one."""
    display_list = random_list(seed)
    needs = scene_needs(display_list, x_shift=x_shift, y_shift=y_shift)
    columns, heights, products = edge_columns(display_list, x_shift, y_shift)
    assert needs.columns == (min(columns), max(columns))
    assert needs.width == -(-display_list.width >> x_shift)
    on_screen = all(0 <= column <= needs.width for column in columns)
    assert needs.edge_column_bits == (max(1, max(columns).bit_length()) if on_screen else
                                      max(signed_bits(columns), needs.x_bits + 1))
    assert needs.edge_height == max(heights)
    assert needs.edge_height_bits == max(heights).bit_length()
    assert needs.edge_rows_height == max(products)
    assert needs.coordinate_bits == signed_bits(display_list.position.ravel().tolist())
    drawn = prepare(display_list, fraction_bits=0, x_shift=x_shift, y_shift=y_shift)
    assert needs.drawn == len(drawn)
    assert needs.exact_fraction_bits == scene_fraction_bits(display_list, x_shift=x_shift,
                                                            y_shift=y_shift)
    assert needs.extent == int((drawn.right - drawn.left + drawn.bottom - drawn.top).max()) - 2


@pytest.mark.parametrize("seed", range(6))
def test_carried_edges_are_exact_on_every_row(seed):
    """With the columns and the fraction of the plan, on triangles of all sizes."""
    display_list = random_list(seed, 30)
    needs = scene_needs(display_list)
    prepared = prepare(display_list, fraction_bits=0)
    for edges, begin, end in ((prepared.long, prepared.top, prepared.bottom),
                              (prepared.upper, prepared.top, prepared.middle),
                              (prepared.lower, prepared.middle, prepared.bottom)):
        assert wrong_columns(edges, end - begin, needs) == 0


def wrong_columns(edges, rows, widths, fraction_bits=None):
    """On how many rows the carried edge's column is not the quotient, in the words that
    ``widths`` (needs or a machine) say; ``fraction_bits`` instead of theirs."""
    column_bits = widths.edge_column_bits
    if fraction_bits is None:
        fraction_bits = widths.edge_fraction_bits
    read = wrap if column_bits <= widths.x_bits else to_signed
    carried = carry_edges(edges, column_bits=column_bits, fraction_bits=fraction_bits)
    index = np.repeat(np.arange(len(rows)), rows)
    row = np.concatenate([np.arange(count) for count in rows])
    column = read((carried.start[index] + row * carried.step[index]) >> fraction_bits, column_bits)
    exact_column = edges.column[index] + row * edges.column_step[index] + (
        edges.remainder[index] + row * edges.remainder_step[index]) // edges.denominator[index]
    return int((column != exact_column).sum())


def test_an_edge_that_needs_its_last_fraction_bit():
    """Among all edges of one height on a full screen some are wrong with a bit less."""
    height, wrong = 255, 0
    for run in range(-200, 200):
        display_list = triangles([[200, 0], [200 + run, height], [0, 0]])
        needs = scene_needs(display_list)
        prepared = prepare(display_list, fraction_bits=0)
        rows = prepared.bottom - prepared.top
        assert wrong_columns(prepared.long, rows, needs) == 0
        wrong += wrong_columns(prepared.long, rows, needs, needs.edge_fraction_bits - 1) > 0
    assert wrong > 0


def test_the_triangle_that_decides_may_be_the_smaller_one():
    """57 square units along 9 pixels need a bit more than 506 on one."""
    sliver, pixel = [[0, 8], [140, 9], [83, 9]], [[0, 0], [22, 0], [0, 23]]
    assert [scene_needs(triangles(each)).exact_fraction_bits for each in (sliver, pixel)] == [10, 9]
    needs = scene_needs(triangles(pixel, sliver))
    assert (needs.exact_double_area, needs.exact_extent) == (57, 8)
    assert needs.exact_fraction_bits == 10


def carried_range(display_list, fraction_bits):
    """The least and the greatest whole part of carried depth at any covered pixel."""
    prepared = prepare(display_list, fraction_bits=fraction_bits)
    index = {int(primitive): place for place, primitive in enumerate(prepared.primitive)}
    found = exact.fragments(display_list)
    planes, modulus = prepared.depth, 1 << prepared.depth.word_bits
    wholes = []
    for primitive, x, y in zip(found.primitive, found.x, found.y, strict=True):
        place = index[int(primitive)]
        word = (planes.start[place] + (int(x) - int(prepared.left[place])) * planes.step_x[place]
                + (int(y) - int(prepared.top[place])) * planes.step_y[place]) % modulus
        wholes.append((word - modulus if word >= modulus // 2 else word) >> fraction_bits)
    return min(wholes), max(wholes)


def machine_of(display_list, fraction_bits):
    return wide_machine(display_list, cards=CARDS, fraction_bits=fraction_bits)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("fraction_bits", [0, 2, 5, 6, "exact"])
def test_carried_depth_fits(seed, fraction_bits):
    """Signed with its error, or unsigned between the vertices: on 16 x 16 pixels from 6 bits on."""
    display_list = random_list(seed)
    needs = scene_needs(display_list)
    machine = machine_of(display_list, None if fraction_bits == "exact" else fraction_bits)
    low, high = carried_range(display_list, machine.fraction_bits)
    bits = needs.depth_integer_bits(machine)
    assert machine.stays_in_range == (machine.fraction_bits >= 6)
    if machine.stays_in_range:
        assert low >= display_list.depth.min() and high <= needs.greatest_depth < 1 << bits
        assert bits == needs.greatest_depth.bit_length()
    else:
        assert signed_bits([low, high]) <= bits
        assert bits > needs.greatest_depth.bit_length()


def test_carried_depth_has_no_bit_to_spare():
    """A level triangle at the greatest depth of its width fills the word; no sign is needed."""
    for depth in (1, 2, 3, 127, 128, 4094):
        display_list = triangles([[0, 0], [200, 8], [8, 200]], depth=depth)
        needs = scene_needs(display_list)
        machine = machine_of(display_list, None)
        assert carried_range(display_list, machine.fraction_bits) == (depth, depth)
        assert needs.depth_integer_bits(machine) == depth.bit_length()
        # Where the error may come to a quarter it is told from what is too low.
        coarse = machine_of(display_list, 5)
        assert not coarse.stays_in_range
        error = ceil(fixed_point.error_bound(5, needs.extent))
        assert needs.depth_integer_bits(coarse) == signed_bits([-error, depth + error])


def stored_in_words(planes, machine, word_bits, where, high):
    """What a machine stores of planes that are kept modulo ``2**word_bits``."""
    place, right, down = where
    carried = wrap(planes.start[place] + right * planes.step_x[place]
                   + down * planes.step_y[place], word_bits)
    if machine.stays_in_range:
        return (carried >> machine.fraction_bits).astype(np.int64)
    carried = to_signed(carried, word_bits) >> machine.fraction_bits
    return np.clip(carried, 0, high).astype(np.int64)


@pytest.mark.parametrize("max_error", [0, 1, 50])
def test_hard_cases_in_planned_words(max_error):
    """What each case is hard on fits: edges on every row, depth and colour at every fragment."""
    for name in HARD_CASES:
        display_list = make_display_list(f"hard:{name}").display_list
        machine = plan(display_list, cards=CARDS, max_error=max_error).configuration
        listed, bits = fitted(machine, display_list), machine.fraction_bits
        drawn = bit_true.draw(listed, fraction_bits=bits)
        assert abs(drawn.depth - exact.draw(display_list).depth).max() <= max_error, name
        prepared = prepare(listed, fraction_bits=bits, shading=machine.shading)
        for edges, begin, end in ((prepared.long, prepared.top, prepared.bottom),
                                  (prepared.upper, prepared.top, prepared.middle),
                                  (prepared.lower, prepared.middle, prepared.bottom)):
            if len(prepared):
                assert wrong_columns(edges, end - begin, machine) == 0, name
        if listed.width * listed.height > 1 << 16 or listed.triangles > 2000:
            continue
        found = exact.fragments(listed)
        place = np.searchsorted(prepared.primitive, found.primitive)
        where = place, found.x - prepared.left[place], found.y - prepared.top[place]
        # The words are Python's numbers, a few thousand of them are enough.
        where = tuple(part[::1 + len(place) // 3000] for part in where)
        for planes, word_bits, high in [
                (prepared.depth, machine.depth_plane_bits, listed.depth_limit),
                *((channel, machine.channel_plane_bits, 255) for channel in prepared.color or ())]:
            np.testing.assert_array_equal(
                stored_in_words(planes, machine, word_bits, where, high),
                bit_true.evaluate(planes, bits, *where, high), name)


LIMITS = {
    # A full screen: columns 0 to 16 in place of 0 to 15 need one bit more.
    "edge_column_bits": triangles([[0, 0], [256, 0], [0, 256]], [[256, 256], [256, 0], [0, 256]]),
    # 64 sub-pixel units high.
    "edge_height_bits": triangles([[8, 8], [40, 24], [12, 72]]),
    "edge_fraction_bits": triangles([[8, 8], [40, 24], [12, 72]]),
    "coordinate_bits": triangles([[8, 8], [128, 24], [12, 72]]),
    "depth_plane_bits": triangles([[0, 0], [200, 8], [8, 200]], depth=128),
    "channel_plane_bits": triangles([[0, 0], [200, 8], [8, 200]], color=((8, 9, 3), (1, 128, 2),
                                                                         (0, 0, 0))),
}
FIELDS = {"depth_plane_bits": "depth_integer_bits", "channel_plane_bits": "channel_integer_bits"}


@pytest.mark.parametrize("name", LIMITS)
def test_one_bit_less_is_refused(name):
    display_list = LIMITS[name]
    machine = plan(display_list, cards=CARDS).configuration
    listed = fitted(machine, display_list)
    assert scene_needs(listed).drawn > 0
    field = FIELDS.get(name, name)
    narrower = replace(machine, **{field: getattr(machine, field) - 1}
                       | ({"edge_fraction_bits": 0} if name == "edge_height_bits" else {}))
    with pytest.raises(InputError, match=f"display list: {name} ") as raised:
        fitted(narrower, display_list)
    assert "\n" not in str(raised.value)
    # A list that needs a bit less is drawn on it.
    if name == "edge_height_bits":
        position = listed.position.copy()
        position[0, 2, 1] -= 1 << (listed.sub_bits - 1)
        lower = replace(listed, position=position)
        assert scene_needs(lower).edge_height_bits == machine.edge_height_bits - 1
        assert fitted(narrower, lower) is lower


def test_columns_off_the_screen_take_a_sign():
    """A machine without refuses them; one with draws what is on the screen as well."""
    inside = triangles([[0, 0], [256, 0], [256, 256]])
    outside = triangles([[-64, 0], [256, 0], [256, 256]])
    machines = [plan(listed, cards=CARDS).configuration for listed in (inside, outside)]
    assert [machine.edges_on_screen for machine in machines] == [True, False]
    assert [machine.edge_column_bits for machine in machines] == [5, 6]
    for machine in machines:
        assert fitted(machine, inside).triangles == 1
    wide = replace(machines[0], coordinate_bits=0, edge_height_bits=0)
    with pytest.raises(InputError, match="edge_column_bits 6, the machine is built for 5"):
        fitted(wide, outside)
    # Beyond the right side as well, whatever fits the columns.
    right = triangles([[0, 0], [256 + 64, 0], [0, 256]])
    assert scene_needs(right).edge_column_bits == 6


SCREENS = [(16, 16, 1), (16, 16, 4), (13, 9, 3), (9, 23, 8), (1, 1, 1)]


def on_screen_list(seed, width, height, sub_bits, count=60):
    """All vertices on the screen, many of them at its sides and corners, both included."""
    source = np.random.default_rng(seed)
    size = np.array([width, height]) << sub_bits
    position = source.integers(0, size + 1, (count, 3, 2))
    position = np.where(source.random((count, 3, 2)) < 0.4,
                        np.where(source.random((count, 3, 2)) < 0.5, 0, size), position)
    position[0] = [[0, 0], [size[0], 0], [0, size[1]]]
    position[1] = [size, [size[0], 0], [0, size[1]]]
    return DisplayList(width, height, position.astype(np.int32),
                       source.integers(0, (1 << 12) - 1, (count, 3)),
                       source.integers(0, 256, (count, 3, 3)).astype(np.uint8),
                       sub_bits=sub_bits, depth_bits=12)


@pytest.mark.parametrize(("width", "height", "sub_bits"), SCREENS)
@pytest.mark.parametrize("seed", range(3))
def test_a_machine_for_what_is_on_the_screen(seed, width, height, sub_bits):
    display_list = on_screen_list(seed, width, height, sub_bits)
    machine = MachineConfiguration(cards="PM", width=width, height=height, sub_bits=sub_bits,
                                   depth_bits=12, **on_screen_widths(width, height, sub_bits))
    assert fitted(machine, display_list) is display_list
    assert machine.edges_on_screen and machine.stays_in_range
    bits = machine.fraction_bits
    prepared = prepare(display_list, fraction_bits=bits)
    for edges, begin, end in ((prepared.long, prepared.top, prepared.bottom),
                              (prepared.upper, prepared.top, prepared.middle),
                              (prepared.lower, prepared.middle, prepared.bottom)):
        assert wrong_columns(edges, end - begin, machine) == 0
    found = exact.fragments(display_list)
    place = np.searchsorted(prepared.primitive, found.primitive)
    where = place, found.x - prepared.left[place], found.y - prepared.top[place]
    stored = stored_in_words(prepared.depth, machine, machine.depth_plane_bits, where, None)
    np.testing.assert_array_equal(stored, found.depth)
    for field in ("coordinate_bits", "edge_column_bits", "edge_height_bits",
                  "edge_fraction_bits"):
        if (fewer := getattr(machine, field) - 1) == 0:
            continue
        narrower = {field: fewer} | ({"edge_fraction_bits": 0}
                                     if field == "edge_height_bits" else {})
        with pytest.raises(InputError, match=f"display list: {field} "):
            fitted(replace(machine, **narrower), display_list)


@pytest.mark.parametrize(("field", "value"), [("width", 32), ("height", 8), ("depth_bits", 10)])
def test_other_formats_are_refused(field, value):
    machine = MachineConfiguration(**{"cards": CARDS, "width": 16, "height": 16, "sub_bits": 4,
                                      "depth_bits": 12} | {field: value})
    with pytest.raises(InputError, match=f"display list: {field} .*built for {value}"):
        fitted(machine, random_list(1))


@pytest.mark.parametrize("seed", range(3))
def test_a_machine_for_every_triangle_refuses_none(seed):
    display_list = random_list(seed, 40)
    for bits in (0, 3, None):
        machine = wide_machine(display_list, cards=CARDS, fraction_bits=bits)
        assert fitted(machine, display_list) is display_list
        planned = plan(display_list, cards=CARDS, fraction_bits=bits).configuration
        for name in ("coordinate_bits", "edge_column_bits", "edge_height_bits",
                     "edge_fraction_bits", "depth_plane_bits", "channel_plane_bits"):
            assert getattr(planned, name) <= getattr(machine, name)


@pytest.mark.parametrize("even", [0, 1, 2, 3, 4])
def test_sub_pixel_bits_that_are_not_used_are_dropped(even):
    display_list = random_list(even, even=even)
    bits = max(1, 4 - even)
    assert fewest_sub_bits(display_list) == bits
    planned = plan(display_list, cards=CARDS)
    assert planned.configuration.sub_bits == bits
    listed = fitted(planned.configuration, display_list)
    picture, same = exact.draw(display_list), exact.draw(listed)
    np.testing.assert_array_equal(picture.color, same.color)
    np.testing.assert_array_equal(picture.depth, same.depth)
    drawn = bit_true.draw(listed, fraction_bits=planned.configuration.fraction_bits)
    np.testing.assert_array_equal(picture.depth, drawn.depth)
    if bits > 1:
        with pytest.raises(InputError, match=f"sub_bits {bits}"):
            with_sub_bits(display_list, bits - 1)
    finer = with_sub_bits(display_list, 8)
    np.testing.assert_array_equal(exact.draw(finer).depth, picture.depth)


@pytest.mark.parametrize("cards", ["PMM", "3x(PMC)"])
def test_one_machine_for_several_lists(cards):
    """It draws each of them exactly, and no width of it could be less."""
    lists = [random_list(seed) for seed in range(3)]
    # One of whole pixels, one of halves: all are drawn in the finest units.
    lists.append(replace(lists[0], position=lists[0].position & -256))
    machine = plan(lists, cards=cards, retain="C" in cards).configuration
    alone = [plan(each, cards=cards, retain="C" in cards) for each in lists]
    for name in ("sub_bits", "fraction_bits", "order_bits", "list_words", "fifo_depth"):
        assert getattr(machine, name) == max(getattr(each.configuration, name) for each in alone)
    assert machine.shading == "gouraud" and plan([lists[0]], cards=cards).configuration == (
        plan(lists[0], cards=cards).configuration)
    for each in lists:
        fitting = fitted(machine, each)
        assert fitting.sub_bits == machine.sub_bits
        drawn = bit_true.draw(fitting, fraction_bits=machine.fraction_bits)
        np.testing.assert_array_equal(drawn.depth, exact.draw(each).depth)
        np.testing.assert_array_equal(drawn.color, exact.draw(each).color)
    for name in ("coordinate_bits", "edge_column_bits", "edge_height_bits", "edge_fraction_bits"):
        fewer = {"edge_fraction_bits": 0, name: getattr(machine, name) - 1}
        narrower = replace(machine, **fewer)
        with pytest.raises(InputError, match=rf"^display list: {name}"):
            for each in lists:
                fitted(narrower, each)


def test_lists_of_one_machine_are_alike():
    with pytest.raises(InputError, match=r"^display list: none is given; a machine is planned"):
        plan([], cards="PM")
    other = make_display_list("tetra:depth=0", width=8, height=16).display_list
    with pytest.raises(InputError, match=r"^width: the display lists differ; one machine has one"):
        plan([other, make_display_list("tetra:depth=0", width=16, height=16).display_list],
             cards="PM")
