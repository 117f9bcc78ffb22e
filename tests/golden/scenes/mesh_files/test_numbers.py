"""Numbers in text: as exact as Python's own, and nothing else passes for one."""

import random

import numpy as np
import pytest

from cardcage.golden.scenes.mesh_files.numbers import first_numbers, numbers


@pytest.mark.parametrize("decimals", range(18))
def test_fixed_point_is_rounded_as_python_rounds(decimals):
    seed = 1000 + decimals
    print("seed", seed)
    chance = random.Random(seed)
    words = [f"{chance.uniform(-1, 1) * 10 ** chance.randint(0, 6):.{decimals}f}"
             for _ in range(2000)]
    read = numbers(" ".join(words).encode(), np.float64, len(words))
    assert np.array_equal(read, [float(word) for word in words])


def test_any_spelling():
    words = ["1", "-2.5", "+3.25", ".5", "-.5", "7.", "1e3", "1E-3", "-0", "123456789012345678",
             "0.1", "1.7976931348623157e308"]
    read = numbers("\t\n ".join(words).encode(), np.float64, len(words))
    assert np.array_equal(read, [float(word) for word in words])
    assert numbers(b"nan inf -inf", np.float64, 3)[1:].tolist() == [np.inf, -np.inf]
    assert numbers(b" ", np.float64, 0).tolist() == []
    assert numbers(b"5 -7 +9", np.int64, 3).tolist() == [5, -7, 9]
    assert first_numbers(b"1/2/3 4//5 -6 7/", 4).tolist() == [1, 4, -6, 7]


@pytest.mark.parametrize("text", [
    "1.2.3 4", "1.25 1.2.5", "1.25 2. 5", "1-2 3.5.", "1.5 x", "1.5 2,5", "1_0 2", "1.5 0x10",
    "1.5 \x01 2.5", "1.5\x012.5", "1.5", "1.5 2.5 3.5", "1.5 -", ". 1", "1.5 2.5f", "",
])
def test_what_is_not_two_numbers(text):
    with pytest.raises(ValueError):
        numbers(text.encode(), np.float64, 2)


@pytest.mark.parametrize("text", [
    "1 2.5", "1 2e1", "1/1 /2", "1/x 2", "1 /", "1", "1/2 3/4 5", "1 a"])
def test_what_is_not_two_whole_numbers(text):
    with pytest.raises(ValueError):
        first_numbers(text.encode(), 2)
