"""Every hard case: what is expected by hand, in fractions, and at coarser precisions."""

import json
from functools import partial

import numpy as np
import pytest
from click.testing import CliRunner

from cardcage.golden.hard_cases.catalogue import HARD_CASES, hard_case
from cardcage.golden.hard_cases.rational import rational_picture
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import prepare, scene_fraction_bits
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import ceil_divide
from cardcage.golden.specification.picture import NO_PRIMITIVE
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.machine_options import MachineOptions, machine_for_scene

COARSE = (6, 0)

#: Every situation that the catalogue is to hold, and the cases that are it.
SITUATIONS = {
    "shared edge": ["shared-edge"],
    "closed fan of 720 slivers around a vertex on a pixel centre": ["sliver-fan"],
    "all vertices on pixel centres": ["vertices-on-centres"],
    "half-pixel grid": ["half-pixel-grid"],
    "slivers thinner than a pixel, horizontal, vertical, both diagonals": [
        "sliver-horizontal", "sliver-vertical", "sliver-diagonal-down", "sliver-diagonal-up"],
    "zero area": ["zero-area"],
    "collinear only after the snap": ["collinear-after-snap"],
    "D = 1": ["double-area-one"],
    "reversed winding": ["reversed-winding"],
    "horizontal top against horizontal bottom edge": ["top-against-bottom-edge"],
    "vertical edges on centres": ["vertical-edges-on-centres"],
    "coplanar with the other diagonal": ["other-diagonal"],
    "coplanar nested": ["nested-coplanar"],
    "interpenetrating, crossing at 3, 30 and 300 LSB": [
        "crossing-3-lsb", "crossing-30-lsb", "crossing-300-lsb"],
    "equal depth ties": ["equal-depth-ties"],
    "depth from near to far within one pixel": ["near-to-far-in-a-pixel"],
    "depth 0, the greatest a vertex may have": ["nearest-and-farthest-depth"],
    "depth meant to equal the background": ["depth-of-the-background"],
    "coordinates at both ends of the range": ["coordinate-ends"],
    "guard-band triangle with all vertices outside that covers the screen": ["guard-band-cover"],
    "wholly outside on each of eight sides": ["outside-eight-sides"],
    "T-junction": ["t-junction", "t-junction-off-centre"],
    "one-pixel triangle and one between centres": ["one-pixel", "between-centres"],
    "full-screen triangle (drift)": ["full-screen", "sliver-half-way-depths", "half-way-depths",
                                     "drift-past-both-ends"],
    "100 full-screen layers front to back, back to front and shuffled": [
        "layers-front-to-back", "layers-back-to-front", "layers-shuffled"],
    "near-plane crossing": ["near-plane-crossing"],
    "vertex behind the eye": ["behind-the-eye"],
    "w near 0": ["w-near-zero"],
    "vertices made by clipping beside an unclipped neighbour": ["clipped-beside-unclipped"],
    "97x61, 1000x333, 640x480": ["size-97x61", "size-1000x333", "size-640x480"],
    "snap ties": ["snap-ties"],
    "inputs off the grid in float32 and float64": ["off-grid-float32", "off-grid-float64"],
    "colour 0 to 255 within a pixel": ["color-0-to-255-in-a-pixel"],
    "duplicates and permutations of the list": ["duplicates", "any-order"],
    "empty scene": ["empty"],
    "one triangle": ["one-triangle"],
    "more triangles than any FIFO": ["more-than-any-fifo"],
}

every_case = pytest.mark.parametrize("case", HARD_CASES.values(), ids=HARD_CASES)


def assert_same(got, expected):
    for field in ("winner", "depth", "color"):
        np.testing.assert_array_equal(getattr(got, field), getattr(expected, field), field)


def test_every_situation_has_its_cases_and_every_case_its_situation():
    names = [name for cases in SITUATIONS.values() for name in cases]
    assert len(names) == len(set(names))
    assert set(names) == set(HARD_CASES)


@every_case
def test_each_says_what_goes_wrong_and_is_always_the_same(case):
    assert case.name == case.name.lower() and "_" not in case.name
    assert case.mistake and case.mistake[0].islower() and not case.mistake.endswith(".")
    assert case.expectations
    one, other = case.make(), case.make()
    for field in ("position", "depth", "color"):
        assert np.array_equal(getattr(one, field), getattr(other, field))


@every_case
def test_exact_is_as_expected(case):
    for expectation in case.expectations:
        complaint = expectation.judge(case.make(), partial(exact.draw, shading="gouraud"))
        assert complaint is None, f"{expectation.says}: {complaint}"


@every_case
def test_exact_is_the_rational_picture(case):
    display_list = case.make()
    pixels = display_list.width * display_list.height
    assert pixels / case.sample <= 12_000, "more than fractions can look at"
    assert case.sample == 1 or np.gcd(case.sample, display_list.width) == 1, "columns are left out"
    expected = rational_picture(display_list, case.sample)
    picture = exact.draw(display_list, shading="gouraud")
    seen = 0
    for number in range(0, pixels, case.sample):
        y, x = divmod(number, display_list.width)
        winner = int(picture.winner[y, x])
        if winner == NO_PRIMITIVE:
            assert (x, y) not in expected
            continue
        pixel = expected[x, y]
        assert (pixel.primitive, pixel.depth, pixel.color) == (
            winner, picture.depth[y, x], tuple(picture.color[y, x].tolist())), f"pixel {x, y}"
        seen += 1
    assert seen == len(expected)


@every_case
def test_bit_true_at_exact_is_as_expected(case):
    display_list = case.make()
    bits = scene_fraction_bits(display_list)
    draw = partial(bit_true.draw, fraction_bits=bits, shading="gouraud")
    assert_same(draw(display_list), exact.draw(display_list, shading="gouraud"))
    for expectation in case.expectations:
        complaint = expectation.judge(display_list, draw)
        assert complaint is None, f"{expectation.says}: {complaint}"


@every_case
@pytest.mark.parametrize("fraction_bits", COARSE)
def test_every_fragment_at_coarser_precisions_is_within_the_bound(case, fraction_bits):
    display_list = case.make()
    expected = exact.draw(display_list, shading="gouraud")
    picture = bit_true.draw(display_list, fraction_bits=fraction_bits, shading="gouraud")
    drawn = expected.winner != NO_PRIMITIVE
    assert np.array_equal(picture.winner != NO_PRIMITIVE, drawn), "coverage"
    fragments = exact.fragments(display_list, shading="gouraud")
    if not len(fragments):
        return

    # What each fragment would store, seen or not.
    prepared = prepare(display_list, fraction_bits=fraction_bits, shading="gouraud")
    triangle = np.searchsorted(prepared.primitive, fragments.primitive)
    right = fragments.x - prepared.left[triangle]
    down = fragments.y - prepared.top[triangle]
    per_extent = [fixed_point.error_bound(fraction_bits, extent)
                  for extent in range(int((right + down).max()) + 1)]
    bound = np.array([ceil_divide(bound.numerator, bound.denominator)
                      for bound in per_extent])[right + down]

    def stored(planes, limit):
        return bit_true.evaluate(planes, fraction_bits, triangle, right, down, limit)

    depth = stored(prepared.depth, display_list.depth_limit)
    assert (abs(depth - fragments.depth) <= bound).all()
    assert depth.min() >= 0 and depth.max() <= display_list.depth_limit
    color = np.stack([stored(planes, 255) for planes in prepared.color], axis=1)
    assert (abs(color - fragments.color.astype(np.int64)).max(axis=1) <= bound).all()

    # The picture is the least (stored depth, primitive) of them.
    order = np.lexsort((fragments.primitive, depth, fragments.x, fragments.y))
    at = (fragments.y.astype(np.int64) * display_list.width + fragments.x)[order]
    first = order[np.flatnonzero(np.diff(at, prepend=-1))]
    y, x = fragments.y[first], fragments.x[first]
    assert len(first) == drawn.sum()
    assert np.array_equal(picture.winner[y, x], fragments.primitive[first])
    assert np.array_equal(picture.depth[y, x], depth[first])
    assert np.array_equal(picture.color[y, x], color[first])


def test_coarser_precisions_do_err():
    """So that the bounds above are bounds on something."""
    worst = 0
    for name in ("full-screen", "half-way-depths", "size-97x61"):
        display_list = hard_case(name).make()
        difference = bit_true.draw(display_list, fraction_bits=0).depth - exact.draw(
            display_list).depth
        worst = max(worst, int(abs(difference).max()))
    assert worst > 10


# By name


def test_a_case_is_drawn_by_name_at_its_own_size():
    listed = make_display_list("hard:size-97x61")
    assert (listed.display_list.width, listed.display_list.height) == (97, 61)
    assert listed.name == "hard:size-97x61"
    assert make_display_list("hard:size-97x61", width=97).display_list.width == 97
    for wrong in ({"width": 64}, {"depth_bits": 16}, {"background": (1, 2, 3)}):
        with pytest.raises(InputError, match=rf"hard:size-97x61: {next(iter(wrong))}: "):
            make_display_list("hard:size-97x61", **wrong)


@pytest.mark.parametrize("options", [{}, {"preset": "paper"}, {"size": (97, 61)}])
def test_a_machine_is_built_for_its_size(options):
    listed, machine = machine_for_scene("hard:size-97x61", MachineOptions(**options))
    assert (machine.width, machine.height) == (97, 61)
    assert listed.display_list.triangles == 8


def test_an_unknown_name_lists_those_that_are_close():
    with pytest.raises(InputError, match=r"no case 'sliver-fun'; did you mean sliver-fan"):
        make_display_list("hard:sliver-fun")
    with pytest.raises(InputError, match="did you mean t-junction or t-junction-off-centre"):
        make_display_list("hard:T-JUNCTION")
    for name in ("hard:", "hard:qqqqqq", "hard:../x.npz"):
        with pytest.raises(InputError, match="cardcage scenes --hard"):
            make_display_list(name)


def test_the_list_of_cases():
    text = CliRunner().invoke(main, ["scenes", "--hard"]).stdout
    listed = json.loads(CliRunner().invoke(main, ["scenes", "--hard", "--json"]).stdout)
    assert [entry["name"] for entry in listed] == [f"hard:{name}" for name in HARD_CASES]
    for entry in listed:
        assert entry["name"] in text and entry["mistake"] in text
        assert f"{entry['width']}x{entry['height']}" in text
    assert "\x1b" not in text


# The expectations themselves


@pytest.mark.parametrize(("name", "break_it"), [
    ("shared-edge", lambda picture: picture.winner.__setitem__((10, 10), 1)),
    ("half-pixel-grid", lambda picture: picture.winner.__setitem__((10, 10), -1)),
    ("full-screen", lambda picture: picture.depth.__setitem__((31, 31), 0)),
    ("one-pixel", lambda picture: picture.winner.__setitem__((1, 1), 7)),
    ("color-0-to-255-in-a-pixel", lambda picture: picture.color.__setitem__((4, 4, 2), 105)),
    ("any-order", lambda picture: picture.depth.__setitem__((9, 9), picture.depth[9, 9] ^ 1)),
    ("empty", lambda picture: picture.winner.__setitem__((0, 0), 0)),
])
def test_a_wrong_pixel_is_complained_of(name, break_it):
    case = hard_case(name)
    calls = []

    def wrong(display_list):
        picture = exact.draw(display_list, shading="gouraud")
        if not calls:  # the first picture alone, so that comparisons of two see it too
            break_it(picture)
        calls.append(1)
        return picture

    complaints = []
    for expectation in case.expectations:
        calls.clear()
        complaints.append(expectation.judge(case.make(), wrong))
    assert any(complaints)


def test_the_snap_ties_lie_on_either_side_of_0():
    """-0.5, -1.5, -2.5, -3.5 and 0.5 units, rounded half up."""
    position = hard_case("snap-ties").make().position[2].tolist()
    assert position == [[0, -1], [-2, -3], [1, 9 * 256]]
