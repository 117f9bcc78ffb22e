"""Words to numbers: whatever is not left to another reader is as exact as Python's own."""

import random
import re

import numpy as np
import pytest

from cardcage.golden.scenes.mesh_files.decimals import decimals
from cardcage.golden.scenes.mesh_files.text_lines import Lines

PLAIN = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?")
PLAIN_WHOLE = re.compile(r"[+-]?\d+")


def read(words, kind=np.float64, between=" "):
    lines = Lines((between.join(words) + "\n").encode())
    assert lines.clean and len(lines.words) == len(words)
    return decimals(lines.text, lines.words, lines.ends, kind)


def same(values, expected):
    """Equal, the sign of zero included."""
    return values is not None and np.array(expected, values.dtype).tobytes() == values.tobytes()


@pytest.mark.parametrize("form", [
    "{:.6f}", "{:.6e}", "{:.3E}", "{:g}", "{:.17g}", "{!r}", "{:+.2f}", "{:.0f}", "{:.15f}",
    "{:011.4f}"])
def test_numbers_as_programs_write_them(form):
    seed = 2000
    print("seed", seed)
    chance = random.Random(seed)
    values = [chance.uniform(-1, 1) * 10.0 ** chance.randint(-9, 6) for _ in range(3000)]
    words = [form.format(value) for value in [*values, 0.0, -0.0]]
    digits = [re.sub(r"[eE].*|[.+-]", "", word) for word in words]
    # What has more digits than a double holds exactly is another reader's.
    fits = [word for word, all_ in zip(words, digits, strict=True)
            if len(all_) <= 18 and int(all_) <= 2**53]
    assert len(fits) > 200
    assert same(read(fits), [float(word) for word in fits])
    if len(fits) < len(words):
        assert read(words) is None


def test_exponents_near_and_far():
    words = [f"{digits}e{exponent}" for digits in ("1", "-7.25", "123456789.5", "0.0", "-0")
             for exponent in (-330, -308, -40, -24, -23, -22, -1, 0, 1, 21, 22, 23, 24, 40, 308)]
    expected = [float(word) for word in words]
    assert same(read([*words, "5", ".5", "1e040"]), [*expected, 5.0, 0.5, float("1e040")])


def test_words_of_every_kind_side_by_side():
    words = ["1", "-2.5", "+3.25", ".5", "-.5", "7.", "1e3", "1E-3", "-0", "12345678.12345678"]
    for _ in range(len(words)):
        words = words[1:] + words[:1]
        assert same(read(words, between="\t \n"), [float(word) for word in words])
    assert same(read(["0", "+12", "-345678901234567", "999999999999999999"], np.int64),
                [0, 12, -345678901234567, 999999999999999999])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind, plain", [(np.float64, PLAIN), (np.int64, PLAIN_WHOLE)])
def test_what_is_no_number_does_not_pass_for_one(seed, kind, plain):
    print("seed", seed)
    chance = random.Random(seed)
    letters = "0123456789" * 2 + "..+-eE" * (1 + seed % 2) + "/:x,#\xfc"
    taken = 0
    for _ in range(3000):
        words = ["".join(chance.choices(letters, k=chance.randint(1, 9)))
                 for _ in range(chance.randint(1, 2))]
        values = read(words, kind)
        if all(plain.fullmatch(word) for word in words):
            taken += 1
            python = float if kind is np.float64 else int
            assert same(values, [python(word) for word in words]), words
        else:
            assert values is None, words
    assert taken > 50


def test_every_byte_in_the_place_of_a_digit():
    for place in range(8):
        for byte in set(range(33, 256)) - set(b"0123456789+-.eE"):
            word = bytearray(b"12345678")
            word[place] = byte
            lines = Lines(bytes(word) + b" 3\n")
            for kind in (np.float64, np.int64):
                assert decimals(lines.text, lines.words, lines.ends, kind) is None
