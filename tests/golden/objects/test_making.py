"""What a host says of objects, and what the machine makes of them, by the golden twin."""

import numpy as np
import pytest
from object_bench.objects import from_far

from cardcage.golden.objects.making import link_words, made_at_controller, made_at_nodes
from cardcage.golden.objects.object_words import frame_words, made_of_objects, mesh_words
from cardcage.golden.organisations.object_shares import ObjectShares
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.planning.scene_needs import fitted
from cardcage.golden.reference.triangle_setup import prepare
from cardcage.golden.scene_display_list import make_display_list, read_scene
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import modulated


def machine(cards="3x(PMT)", size=(32, 32), **changes):
    return MachineConfiguration(cards, *size, setup="hardware",
                                **{"objects": "nodes", "mesh_triangles": 600, "meshes": 9,
                                   "packet": 2} | changes)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """Of its objects one is clipped, and stars are before all."""
    path = tmp_path_factory.mktemp("scenes") / "some.scene"
    path.write_text("percent 1\nobj sphere scale 0.2 recursion 2 num 9 seed 3\n"
                    "obj cube scale 0.3 rot 20,30,0 num 4 seed 5 color red\n"
                    "obj cone scale 4 position 3,1,0 recursion 1\n")
    return make_display_list(path, width=32, height=32).display_list


def decoded(configuration, words):
    """The display list that a machine would make of these words: positions, depths, colours, node
    and round, in the order of the words."""
    meshes, drawn = [], []
    limit = 1 << configuration.coordinate_bits

    def corners(body):
        parts = [body[f"vertex_{corner}"] for corner in range(3)]
        return np.array([[part[name] for name in (
            "x", "y", "depth", "red", "green", "blue")] for part in parts])

    for word in words:
        opcode, body = Opcode(commands.opcode_of(word)), word >> commands.BODY_OFFSET
        if opcode == Opcode.MESH:
            meshes.append([])
        elif opcode == Opcode.MESH_TRIANGLE:
            meshes[-1].append(corners(commands.unpack(
                commands.mesh_triangle_layout(configuration), body)))
        elif opcode == Opcode.TRIANGLE:
            fields = commands.unpack(commands.triangle_layout(configuration), body)
            drawn.append((corners(fields), fields["node"], fields["round"]))
        else:
            assert opcode == Opcode.OBJECT
            fields = commands.unpack(commands.object_layout(configuration), body)
            place = np.array([fields[name] for name in ("x", "y", "depth")])
            color = np.array([fields[name] for name in ("red", "green", "blue")])
            for triangle in meshes[fields["mesh"]]:
                moved = triangle.copy()
                moved[:, :3] += place
                moved[:, 3:] = modulated(color, triangle[:, 3:])
                drawn.append((moved, fields["node"], fields["round"]))
    values = np.array([triangle for triangle, *_ in drawn])
    position = values[..., :2] % limit
    position -= limit * (position >= limit // 2)
    return (position, values[..., 2] % (1 << configuration.depth_bits), values[..., 3:],
            np.array([node for _, node, _ in drawn]), np.array([turn for *_, turn in drawn]))


@pytest.mark.parametrize("packet", [1, 2, 50, "contiguous", "work"])
def test_words_decode_to_the_display_list(scene, packet):
    configuration = machine(packet=packet, order_bits=7)
    listed = fitted(configuration, scene)
    words = [*mesh_words(configuration, scene.objects), *frame_words(configuration, listed)]
    shares = organisation_of(configuration).shares(listed)
    position, depth, color, node, turn = decoded(configuration, words)
    order = shares.host_order
    np.testing.assert_array_equal(position, listed.position[order])
    np.testing.assert_array_equal(depth, listed.depth[order])
    np.testing.assert_array_equal(color, listed.color[order])
    np.testing.assert_array_equal(node, shares.node[order])
    np.testing.assert_array_equal(turn, shares.round[order])
    assert scene.objects.clipped.sum() == 1


def test_shares_are_of_objects(scene):
    shares = organisation_of(machine()).shares(scene)
    assert isinstance(shares, ObjectShares) and shares.triangles == scene.triangles
    number = scene.object_of
    np.testing.assert_array_equal(shares.node, number // 2 % 3)
    np.testing.assert_array_equal(shares.round, number // 6)
    assert shares.order_bits == (int(number.max()) // 6).bit_length()
    # Each node gets its own in the list's order, and one object after another.
    for node in range(3):
        own = shares.host_order[shares.node[shares.host_order] == node]
        assert (np.diff(own) > 0).all()
    changes = np.flatnonzero(np.diff(number[shares.host_order]))
    assert len(changes) + 1 == len(np.unique(number))


def test_what_is_made_where(scene):
    configuration = machine()
    listed = fitted(configuration, scene)
    kept = prepare(listed, fraction_bits=0).primitive
    shares = organisation_of(configuration).shares(listed)
    made = made_at_nodes(configuration, listed)
    clipped = scene.objects.clipped
    for node, each in enumerate(made):
        own = shares.of_node(node)
        whole = own[~clipped[scene.object_of[own]]]
        assert (each.made, each.sent) == (len(whole), len(own) - len(whole))
        assert each.dropped == len(np.setdiff1d(own, kept))
    assert sum(each.objects for each in made) == len(clipped) - 1
    assert min(each.dropped for each in made) > 0
    alone = made_at_controller(machine("PM", objects="controller", packet=1), listed)
    assert alone.made == sum(each.made for each in made)
    assert alone.dropped == sum(each.dropped for each in made)


def test_words_on_the_link_are_those_of_the_commands(scene):
    configuration = machine()
    words, each = link_words(configuration, scene), commands.command_words(configuration)
    listed = fitted(configuration, scene)
    assert words.meshes == each * (1 + len(mesh_words(configuration, scene.objects)))
    assert words.frame == each * (2 + len(frame_words(configuration, listed)))


def test_where_the_origin_of_a_mesh_lies_changes_no_word_count_and_no_picture(scene):
    """Only vertices count: an origin out of the guard band makes nothing clipped."""
    configuration = machine()
    far = from_far(scene.objects, 5 << configuration.coordinate_bits - 2, -5000)
    listed = far.display_list()
    assert far.clipped.tolist() == scene.objects.clipped.tolist()
    assert abs(far.offset[:, 0]).min() >= 1 << configuration.coordinate_bits - 1
    np.testing.assert_array_equal(listed.position, scene.position)
    assert link_words(configuration, listed) == link_words(configuration, scene)
    words = [*mesh_words(configuration, far), *frame_words(configuration, listed)]
    position, depth, *_ = decoded(configuration, words)
    order = organisation_of(configuration).shares(listed).host_order
    np.testing.assert_array_equal(position, listed.position[order])
    np.testing.assert_array_equal(depth, listed.depth[order])


def test_objects_that_are_halved_stay_whole():
    """Sums may be even where the mesh and the offset are odd."""
    file = read_scene("three_cubes").file
    objects = file.objects(PictureFormat(32, 32, sub_bits=4))
    fewest = objects.fewest_sub_bits
    finer = objects.in_sub_bits(8)
    assert finer.fewest_sub_bits == fewest and (finer.offset[:, :2] % 16 == 0).all()
    np.testing.assert_array_equal(finer.display_list().position,
                                  objects.display_list().position * 16)
    with pytest.raises(InputError, match=r"^objects: sub_bits 4, .* built for 3"):
        objects.in_sub_bits(3)


def test_refusals(scene):
    teapot = make_display_list("teapot:tessellation=2", width=32, height=32).display_list
    for ask in (made_of_objects, organisation_of(machine()).shares):
        with pytest.raises(InputError, match=r"^objects: only a scene file without perspective"):
            ask(teapot)
    for field in ("meshes", "mesh_triangles"):
        with pytest.raises(InputError, match=f"^objects: {field} .*, the machine is built for 1"):
            mesh_words(machine(**{field: 1}), scene.objects)
