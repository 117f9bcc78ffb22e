"""The contract of orthographic scenes: object by object a mesh of integers plus an offset."""

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.reference.exact import draw
from cardcage.golden.scene_display_list import make_display_list, read_scene
from cardcage.golden.scenes.camera import View
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.examples import EXAMPLES
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import modulated

ORTHOGRAPHIC = [name for name in EXAMPLES if name != "colonnade"]


def scene(tmp_path, text, name="a.scene"):
    path = tmp_path / name
    path.write_text(text)
    return read_scene(path)


def test_modulating_is_exact_at_the_ends_and_never_brightens():
    color, shade = np.mgrid[:256, :256]
    drawn = modulated(color, shade)
    assert (drawn[:, 255] == np.arange(256)).all() and not drawn[0].any()
    assert (drawn <= color).all() and (np.diff(drawn, axis=1) >= 0).all()
    assert (np.abs(drawn - color * shade / 255) <= 1).all()
    assert modulated(255, 255) == 255


@pytest.mark.parametrize("name", ORTHOGRAPHIC)
def test_a_scene_is_its_meshes_plus_their_offsets(name):
    file = read_scene(name).file
    picture = PictureFormat(64, 48)
    objects = file.objects(picture)
    drawn = file.display_list(picture)
    first = 0
    for number, mesh in enumerate(objects.mesh.tolist()):
        if objects.clipped[number]:
            first = None
            break
        mesh = objects.meshes[mesh]
        part = slice(first, first + mesh.triangles)
        assert (drawn.position[part] == mesh.position + objects.offset[number, :2]).all()
        assert (drawn.depth[part] == mesh.depth + objects.offset[number, 2]).all()
        assert (drawn.color[part] == modulated(objects.color[number].astype(np.int64),
                                               mesh.shade.astype(np.int64))).all()
        first += mesh.triangles
    assert first == drawn.triangles


def test_copies_share_one_mesh_and_so_do_lines_that_say_the_same(tmp_path):
    file = scene(tmp_path, "obj cube scale 0.2 num 5\nobj cube scale 0.2 color red\n"
                           "obj cube scale 0.2 rot 0,1,0\nobj sphere scale 0.2").file
    objects = file.objects(PictureFormat(32, 32))
    assert len(objects.meshes) == 3
    assert objects.mesh.tolist() == [0] * 6 + [1, 2]
    assert len({tuple(place) for place in objects.offset.tolist()}) == 8


def test_moving_an_object_by_whole_steps_moves_its_picture_and_nothing_else(tmp_path):
    def picture(x):
        return draw(scene(tmp_path, "ambient 30\nsize 64x64\nobj cone scale 0.3 rot 1,0.3,0 "
                                    f"position {x},0.1,0").file.display_list(PictureFormat(64, 64)))

    left, right = picture(-0.25), picture(0.25)  # 16 pixels
    assert (left.color[:, :48] == right.color[:, 16:]).all()
    assert (left.depth[:, :48] == right.depth[:, 16:]).all()
    assert (left.winner >= 0).any()


def test_what_leaves_the_guard_band_is_clipped_and_draws_the_same(tmp_path):
    text = "size 32x32\nobj cube position 0.2,0,0 scale 9 rot 0.4,0.7,0.1\nobj sphere scale 0.2"
    file = scene(tmp_path, text).file
    objects = file.objects(PictureFormat(32, 32))
    assert objects.clipped.tolist() == [True, False]
    picture = draw(file.display_list(PictureFormat(32, 32)))
    assert (picture.winner >= 0).all()  # the cube fills the picture


def test_depths_stay_in_range_at_every_depth_width(tmp_path):
    text = "obj cube num 40 scale 0.3 seed 5\nobj sphere position 0,0,7 scale 0.1"
    for depth_bits in (2, 3, 5, 16, 32):
        drawn = scene(tmp_path, text).file.display_list(PictureFormat(32, 32, 8, depth_bits))
        assert drawn.depth.min() >= 0 and drawn.depth.max() <= drawn.depth_limit


def test_percent_says_how_many_pixels_have_a_star(tmp_path):
    file = scene(tmp_path, "percent 5\nobj cube scale 0.0001 position 0,0,0").file
    picture = draw(file.display_list(PictureFormat(64, 32)))
    stars = picture.depth == (1 << 24) - 2
    assert abs(stars.sum() - 0.05 * 64 * 32) < 2
    assert len(np.unique(picture.color[stars], axis=0)) > 50


def test_the_overlay_is_a_frame_before_everything(tmp_path):
    file = scene(tmp_path, "overlay red\nobj sphere position 0,0,0 scale 3").file
    picture = draw(file.display_list(PictureFormat(20, 16)))
    red = (picture.color == [255, 0, 0]).all(axis=2)
    edge = np.ones((16, 20), bool)
    edge[1:-1, 1:-1] = False
    assert (red == edge).all()


def test_a_view_turns_the_whole_scene(tmp_path):
    text = "obj cube scale 0.2 position 0,0,0.6 color red\nobj cube scale 0.2 position 0,0,-0.6"
    file = scene(tmp_path, text).file
    front, back, side = (draw(file.display_list(PictureFormat(32, 32), view=View(direction)))
                         for direction in ((0, 0), (180, 0), (90, 0)))
    assert front.color[16, 16, 1] == 0 and back.color[16, 16, 1] > 0
    assert side.winner[16, 16] < 0 and side.color[16, 6, 1] == 0 and side.color[16, 25, 1] > 0
    same = draw(file.display_list(PictureFormat(32, 32)))
    assert (same.color == front.color).all()


def test_culling_leaves_out_backs_and_changes_no_pixel():
    for name in ORTHOGRAPHIC:
        file = read_scene(name).file
        whole, culled = (file.display_list(PictureFormat(48, 48), cull=cull)
                         for cull in (False, True))
        assert culled.triangles < whole.triangles
        assert (draw(whole).color == draw(culled).color).all()


def test_flat_shading_gives_one_colour_a_triangle():
    for name in EXAMPLES:
        assert make_display_list(name, width=32, height=32, shading="flat").display_list.flat


def test_perspective_scenes_draw_and_have_no_objects():
    loaded = read_scene("colonnade")
    assert (draw(make_display_list(loaded).display_list).winner >= 0).mean() > 0.3
    with pytest.raises(InputError, match=r"colonnade\.scene: projection: objects are sent whole"):
        loaded.file.objects(PictureFormat(32, 32))
    turned = make_display_list(loaded, view=View((loaded.direction[0] + 90, 20), 1.5))
    assert turned.display_list.triangles > 100


def test_what_is_asked_for_goes_before_what_the_file_says(tmp_path):
    loaded = scene(tmp_path, "background red\nsize 24x20\nobj cube scale 0.1 position 0,0,0")
    own = make_display_list(loaded).display_list
    assert (own.width, own.height, own.background) == (24, 20, (255, 0, 0))
    other = make_display_list(loaded, width=16, height=16, background=(1, 2, 3)).display_list
    assert (other.width, other.height, other.background) == (16, 16, (1, 2, 3))


def test_too_many_triangles_are_refused_before_they_are_made(tmp_path):
    with pytest.raises(InputError, match=r"a\.scene: line 1, column 1: makes 5242880000 triangles"):
        scene(tmp_path, "obj sphere recursion 8 num 10000")


def test_a_mesh_file_is_found_from_the_scene_files_folder_and_fitted(tmp_path):
    (tmp_path / "t.obj").write_text("v 10 0 0\nv 14 0 0\nv 10 2 0\nv 10 0 6\n"
                                    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    file = scene(tmp_path, "obj mesh t.obj position 0,0,0").file
    [mesh] = file.placed.meshes
    assert np.abs(mesh.vertices).max(axis=0).tolist() == pytest.approx([2 / 3, 1 / 3, 1.0])


@pytest.mark.parametrize(("name", "contents", "said"), [
    ("nothing.obj", None, "file: no such file; check the path"),
    (".obj", None, "extension: none is not a mesh format; use one of .obj .stl .ply .glb .gltf"),
    ("a.scene", None, "extension: .scene is not a mesh format; use one of .obj .stl"),
    ("folder.obj", "", "file: is a directory; name the mesh file inside it"),
    ("empty.ply", b"", "contents: the file is empty; export the mesh again"),
    ("no.ply", b"obj cube", "contents: does not begin with 'ply': no PLY file; export it again"),
    ("no.obj", b"v 1 2 x", "contents: line 1: cannot read the coordinates in '1 2 x'; repair the "),
    ("no.stl", b"\xff" * 90, "the file is cut short, or no binary STL; export it again"),
])
def test_a_mesh_file_that_cannot_be_used_is_named_with_its_place_and_a_remedy(
        tmp_path, name, contents, said):
    if contents == "":
        (tmp_path / name).mkdir()
    elif contents is not None:
        (tmp_path / name).write_bytes(contents)
    with pytest.raises(InputError) as caught:
        scene(tmp_path, f"ambient 10\n\tobj  mesh {name} scale 0.5")
    text = str(caught.value)
    assert text.startswith(f"{tmp_path}/a.scene: line 2, column 12: {tmp_path}/{name}: ")
    assert said in text and "\n" not in text


def test_a_replaced_description_is_drawn_too():
    file = read_scene("three_cubes").file
    plain = replace(file, description=replace(file.description, percent=0.0, overlay=None))
    fewer = plain.display_list(PictureFormat(32, 32)).triangles
    assert fewer == file.display_list(PictureFormat(32, 32)).triangles - 8 - 10


def test_an_object_that_faces_away_altogether_is_none(tmp_path):
    (tmp_path / "away.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 3 2\n")
    file = scene(tmp_path, "obj mesh away.obj position -30,0,0\nobj cube scale 0.2").file
    picture = PictureFormat(16, 16)
    assert [len(file.display_list(picture, cull=cull).objects.mesh) for cull in (False, True)] == [
        2, 1]
