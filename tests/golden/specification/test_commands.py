"""Command words: packed and unpacked again, and laid out as the hardware lays them out."""

import numpy as np
import pytest
from amaranth.hdl import Const
from amaranth.lib import data
from hypothesis import given
from hypothesis import strategies as st

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.reference import triangle_setup as setup
from cardcage.golden.reference import triangle_words
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.hdl.backplane import words as layouts

CONFIGURATIONS = {
    "tiny": MachineConfiguration(**PRESETS["tiny"]),
    "small": MachineConfiguration(**PRESETS["small"]),
    "paper": MachineConfiguration(**PRESETS["paper"]),
    "flat": MachineConfiguration("PMM", 20, 12, sub_bits=3, depth_bits=9, fraction_bits=0,
                                 shading="flat"),
    "least": MachineConfiguration("PM", 1, 1, sub_bits=1, depth_bits=2, fraction_bits=0),
}


def flattened(layout, offset=0, prefix=""):
    """(path, offset, bits) of every field, in order."""
    for name, entry in layout.items():
        if isinstance(entry, int):
            yield prefix + name, offset, entry
        else:
            yield from flattened(entry, offset, f"{prefix}{name}.")
        offset += entry if isinstance(entry, int) else commands.layout_bits(entry)


def hardware_fields(layout, offset=0, prefix=""):
    for name, field in layout:
        if isinstance(field.shape, data.StructLayout):
            yield from hardware_fields(field.shape, offset + field.offset, f"{prefix}{name}.")
        else:
            yield prefix + name, offset + field.offset, field.width


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_offsets_are_those_of_the_hardware(name):
    configuration = CONFIGURATIONS[name]
    table = commands.prepared_triangle_layout(configuration)
    hardware = layouts.prepared_triangle_layout(configuration)
    assert list(flattened(table)) == list(hardware_fields(hardware))
    assert hardware.size == commands.layout_bits(table)
    background = commands.frame_start_layout()
    assert list(flattened(background)) == list(hardware_fields(layouts.struct_layout(background)))
    assert list(hardware_fields(layouts.response_layout())) == [
        ("kind", 0, commands.RESPONSE_KIND_BITS),
        ("value", commands.RESPONSE_KIND_BITS, commands.RESPONSE_VALUE_BITS)]


def test_shading_decides_what_a_triangle_carries():
    flat = dict(flattened_names(CONFIGURATIONS["flat"]))
    gouraud = dict(flattened_names(CONFIGURATIONS["tiny"]))
    assert flat["planes.red"] == 8
    assert "planes.red" not in gouraud
    assert gouraud["planes.red.start"] == CONFIGURATIONS["tiny"].channel_plane_bits


def flattened_names(configuration):
    return [(path, bits) for path, _, bits
            in flattened(commands.prepared_triangle_layout(configuration))]


@pytest.mark.parametrize("name", CONFIGURATIONS)
@given(data=st.data())
def test_what_is_packed_comes_out_of_the_hardware_structure(name, data):
    configuration = CONFIGURATIONS[name]
    table = commands.prepared_triangle_layout(configuration)

    def values(layout):
        return {field: data.draw(st.integers(-2**entry, 2**entry)) if isinstance(entry, int)
                else values(entry) for field, entry in layout.items()}

    chosen = values(table)
    word = commands.pack(table, chosen)
    assert 0 <= word < 1 << commands.layout_bits(table)
    structure = layouts.prepared_triangle_layout(configuration).from_bits(word)
    for path, _, bits in flattened(table):
        number, field = chosen, structure
        for part in path.split("."):
            number, field = number[part], field[part]
        assert field == number % (1 << bits)


@pytest.mark.parametrize(("name", "words"), [("tiny", 21), ("small", 27), ("paper", 33)])
def test_words_of_a_command(name, words):
    configuration = CONFIGURATIONS[name]
    assert commands.command_words(configuration) == words
    assert commands.command_bits(configuration) == 32 * words
    body = commands.layout_bits(commands.prepared_triangle_layout(configuration))
    # The fewest words that hold opcode, gap and body.
    assert 32 * (words - 1) < commands.BODY_OFFSET + body <= 32 * words


def test_the_least_machine_still_has_room_for_a_colour():
    assert commands.command_bits(CONFIGURATIONS["least"]) >= commands.BODY_OFFSET + 24


def test_simple_commands():
    assert commands.command(Opcode.FRAME_END) == 4
    assert commands.command(Opcode.READ_DEPTH, 5) == 5 | 5 << 8
    assert commands.frame_start((0x11, 0x22, 0x33)) == 0x33221101


@pytest.mark.parametrize("name", ["tiny", "flat"])
def test_triangles_from_set_up(name):
    """Fields of the words against the arrays they come from, negative columns included."""
    configuration = CONFIGURATIONS[name]
    random = np.random.default_rng(3)
    unit = 1 << configuration.sub_bits
    size = configuration.width, configuration.height
    display_list = DisplayList(
        width=size[0], height=size[1], sub_bits=configuration.sub_bits,
        depth_bits=configuration.depth_bits,
        position=random.integers(-unit * 8, unit * 20, (40, 3, 2)).astype(np.int32),
        depth=random.integers(0, 2**configuration.depth_bits - 1, (40, 3)),
        color=random.integers(0, 256, (40, 3, 3)).astype(np.uint8))
    prepared = setup.prepare(display_list, fraction_bits=configuration.fraction_bits,
                             shading=configuration.shading)
    words = triangle_words.prepared_triangles(configuration, prepared)
    assert len(words) == len(prepared) > 10
    # Both kinds of words: without guard bits, and with.
    assert configuration.stays_in_range == (name == "tiny")
    narrower = prepared.depth.word_bits - configuration.depth_plane_bits
    assert narrower == (2 if name == "tiny" else 0)
    assert (prepared.long.column < 0).any()
    structure = layouts.prepared_triangle_layout(configuration)
    for index, word in enumerate(words):
        assert word < 1 << commands.command_bits(configuration)
        assert word & 0xFF == Opcode.PREPARED_TRIANGLE
        fields = structure.from_bits(word >> commands.BODY_OFFSET)
        for field in ("top", "middle", "bottom", "left", "right", "long_edge_left"):
            assert fields[field] == getattr(prepared, field)[index]
        for edge in commands.EDGES:
            carried = setup.carry_edges(getattr(prepared, edge),
                                        column_bits=configuration.edge_column_bits,
                                        fraction_bits=configuration.edge_fraction_bits)
            for field in ("start", "step"):
                assert fields[edge][field] == getattr(carried, field)[index]
        # A field that has fewer bits than set-up keeps, for want of a guard, has the low ones.
        for part in ("start", "step_x", "step_y"):
            assert fields.planes.depth[part] == (
                getattr(prepared.depth, part)[index] % (1 << configuration.depth_plane_bits))
        for channel, channel_name in enumerate(commands.CHANNELS):
            if configuration.shading == "flat":
                assert fields.planes[channel_name] == prepared.flat_color[index, channel]
            else:
                for part in ("start", "step_x", "step_y"):
                    assert fields.planes[channel_name][part] == (
                        getattr(prepared.color[channel], part)[index]
                        % (1 << configuration.channel_plane_bits))


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_what_is_packed_is_unpacked(name):
    table = commands.prepared_triangle_layout(CONFIGURATIONS[name])
    random = np.random.default_rng(5)

    def values(layout):
        return {field: int.from_bytes(random.bytes(16), "little") % (1 << entry)
                if isinstance(entry, int) else values(entry) for field, entry in layout.items()}

    chosen = values(table)
    assert commands.unpack(table, commands.pack(table, chosen)) == chosen


def test_responses():
    for kind in ResponseKind:
        assert commands.unpack_response(kind | 0xDEADBEEF << 8) == (kind, 0xDEADBEEF)
    assert commands.unpack_response(99) == (99, 0)


@pytest.mark.parametrize("kind", ResponseKind)
def test_the_value_of_a_response(kind):
    layout = commands.RESPONSE_FIELDS[kind]
    assert commands.layout_bits(layout) == commands.RESPONSE_VALUE_BITS
    fields = {name: 0xC0FFEE + place & (1 << bits) - 1
              for place, (name, bits) in enumerate(layout.items())}
    value = commands.response_value(kind, **fields)
    assert commands.response_fields(kind, value) == fields
    view = layouts.response_fields(kind, Const(value, 32)).shape().from_bits(value)
    assert {name: view[name] for name in layout} == fields


def test_values_of_two_numbers():
    """The upper and the lower half."""
    assert commands.response_value(ResponseKind.DOMAIN, first=3, units=2) == 0x30002
    assert commands.response_value(ResponseKind.UNITS, owned=3, total=4) == 0x30004
    assert commands.response_value(ResponseKind.PICTURE, width=16, height=9) == 0x90010


def test_opcodes_are_distinct_and_fit():
    assert len({int(opcode) for opcode in Opcode}) == len(Opcode)
    assert all(0 < opcode < 1 << commands.OPCODE_BITS for opcode in Opcode)
    assert all(0 < kind < 1 << commands.RESPONSE_KIND_BITS for kind in ResponseKind)


def test_the_opcode_of_a_word_is_its_lowest_bits():
    """Nothing above them, be it unused or of the body, counts."""
    for opcode in range(1 << commands.OPCODE_BITS):
        for rest in (0, 1, 1 << commands.BODY_OFFSET - commands.OPCODE_BITS, 2**200 + 5):
            assert commands.opcode_of(rest << commands.OPCODE_BITS | opcode) == opcode
