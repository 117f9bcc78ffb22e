"""Scenes stay apart on charts, however alike they are called."""

import pytest

from cardcage.testbenches.atlas.scene_names import short_names


@pytest.mark.parametrize("names", [
    ["scenes/a_rather_long_name_1.scene", "scenes/a_rather_long_name_2.scene"],
    ["one/teapot.obj", "two/teapot.obj", "teapot.obj"],
    ["the_same_beginning_1_and_the_same_end", "the_same_beginning_2_and_the_same_end"],
    ["tetra:depth=1", "tetra:depth=2", "teapot", "teapot"],
])
def test_no_two_are_alike(names):
    found = short_names(names, 12)
    assert len(set(found.values())) == len(set(names)) == len(found)


def test_a_name_is_as_short_as_asked_where_that_is_enough():
    found = short_names(["folder/spheres_of_glass_1.scene", "crystals"], 12)
    assert found["crystals"] == "crystals"
    assert all(len(name) <= 12 for name in found.values())
