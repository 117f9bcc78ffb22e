"""From a scene to its display list: framing, depth, light, colours, replay, bad arguments."""

import dataclasses
import math

import numpy as np
import pytest

from cardcage.golden.scene_display_list import (
    DEFAULT_BACKGROUND,
    display_list_of_mesh,
    make_display_list,
)
from cardcage.golden.scenes.built_in.sphere import spheres_mesh
from cardcage.golden.scenes.built_in.teapot import teapot
from cardcage.golden.scenes.camera import Camera, View, framing_camera, transform
from cardcage.golden.scenes.lighting import Lighting, lit_corners
from cardcage.golden.scenes.mesh import BASE_COLOR, UP_Y, UP_Z, Mesh
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.specification.errors import InputError

BALL = spheres_mesh(np.array([[3.0, -2.0, 5.0]]), np.array([2.0]), 4)


def same(a, b):
    names = ("position", "depth", "color")
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names)


def facing_wall(distance=4.0, **more):
    """A square across the line of sight of an eye at the origin that looks along -z."""
    vertices = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float64)
    return Mesh(vertices - [0, 0, distance], np.array([[0, 1, 2], [0, 2, 3]]), **more)


STRAIGHT = Camera(eye=(0, 0, 0), target=(0, 0, -1), up=UP_Y, field_of_view=90.0, near=1.0, far=9.0)


# ---- camera


@pytest.mark.parametrize("width, height", [(64, 64), (128, 32), (40, 300)])
def test_the_bounding_sphere_fills_the_picture(width, height):
    picture = PictureFormat(width, height)
    listed = display_list_of_mesh(BALL, picture)
    assert listed.triangles == BALL.triangles
    pixels = listed.position.reshape(-1, 2) / 256
    middle = np.array([width, height]) / 2
    radius = np.abs(pixels - middle).max(axis=0)
    smaller = min(width, height) / 2
    assert np.all(radius <= smaller) and np.all(radius > 0.95 * smaller)
    assert listed.depth.min() < 0.02 * 2**24 and listed.depth.max() > 0.75 * 2**24


def test_matrices_agree_with_a_projection_by_hand():
    picture = PictureFormat(64, 48)
    matrix = STRAIGHT.matrix(picture, facing_wall().vertices)
    # 90 degrees across 48 pixels: at distance d a unit is 24/d pixels.
    points = np.array([[0, 0, -4], [1, 1, -4], [-1, 2, -1], [3, -1, -9], [0, 0, -2.0]])
    x, y, z, w = transform(matrix, points).T
    assert np.allclose(w, [4, 4, 1, 9, 2])
    assert np.allclose(x / w, [32, 38, 8, 40, 32])
    assert np.allclose(y / w, [24, 18, -24, 24 + 24 / 9, 24])
    assert np.allclose(z / w, [27 / 32, 27 / 32, 0, 1, 9 / 16])  # far (d - near) / d (far - near)


def test_depth_is_affine_on_the_screen():
    wall = Mesh(np.array([[-2, -1, -2], [2, -1, -8], [0, 3, -4.0]]), np.array([[0, 1, 2]]))
    middle = Mesh(wall.vertices.mean(axis=0) + np.zeros((3, 3)), wall.faces)
    picture = PictureFormat(64, 64, depth_bits=32)
    matrix = STRAIGHT.matrix(picture, wall.vertices)
    corner = transform(matrix, wall.vertices)
    inside = transform(matrix, middle.vertices)[0]
    screen = corner[:, :3] / corner[:, 3:]
    system = np.vstack([screen[:, :2].T, np.ones(3)])
    share = np.linalg.solve(system, [*(inside[:2] / inside[3]), 1.0])
    assert share @ screen[:, 2] == pytest.approx(inside[2] / inside[3], abs=1e-12)


@pytest.mark.parametrize("up", [UP_Y, UP_Z, (1.0, 1.0, 1.0), (-1.0, 0.0, 0.0)])
def test_up_is_up_in_the_picture(up):
    tower = np.array([[0, 0, 0], np.array(up) * 5, [0.1, 0.2, 0.3]], np.float64)
    camera = framing_camera(Mesh(tower, np.array([[0, 1, 2]]), up=up))
    foot, top, _ = transform(camera.matrix(PictureFormat(), tower), tower)
    assert top[1] / top[3] < foot[1] / foot[3] - 20
    assert top[0] / top[3] == pytest.approx(foot[0] / foot[3], abs=1)


def test_a_scene_is_seen_from_above_in_front_with_x_to_the_right():
    for up, front in ((UP_Y, (0, 0, 1)), (UP_Z, (0, -1, 0))):
        camera = framing_camera(dataclasses.replace(BALL, up=up))
        direction = np.subtract(camera.eye, camera.target)
        direction /= np.linalg.norm(direction)
        assert math.degrees(math.asin(direction @ up)) == pytest.approx(30)
        assert direction @ front > 0.7
        assert camera.axes()[0] @ (1, 0, 0) > 0.8


@pytest.mark.parametrize("up", [UP_Y, UP_Z])
@pytest.mark.parametrize("azimuth", [-350.0, -90.0, 0.0, 25.0, 135.0])
@pytest.mark.parametrize("elevation", [-90.0, -30.0, 0.0, 60.0, 90.0])
def test_a_view_says_where_the_eye_is(up, azimuth, elevation):
    mesh = dataclasses.replace(BALL, up=up)
    straight = framing_camera(mesh, View((0.0, 0.0)))
    camera = framing_camera(mesh, View((azimuth, elevation)))
    right, upwards, front = straight.axes()
    assert np.allclose(upwards, up)
    direction = np.subtract(camera.eye, camera.target)
    distance = np.linalg.norm(direction)
    assert distance == pytest.approx(np.linalg.norm(np.subtract(straight.eye, straight.target)))
    assert math.degrees(math.asin(direction @ upwards / distance)) == pytest.approx(elevation,
                                                                                   abs=1e-5)
    # What is to the right stays level, from wherever it is seen.
    turned = math.radians(azimuth)
    assert np.allclose(camera.axes()[0], right * math.cos(turned) - front * math.sin(turned))


def test_without_a_view_a_mesh_is_seen_as_it_asks():
    mesh = teapot(2)
    assert framing_camera(mesh) == framing_camera(mesh, View())
    assert framing_camera(BALL, View((25.0, 30.0))).eye == framing_camera(BALL).eye


@pytest.mark.parametrize("zoom", [0.05, 0.5, 2.0, 30.0])
def test_zoom_enlarges_the_middle(zoom):
    picture = PictureFormat(64, 48)
    points = BALL.vertices[:40]
    framed, zoomed = (transform(framing_camera(BALL, view).matrix(picture, BALL.vertices), points)
                      for view in (View(), View(zoom=zoom)))
    middle = np.array([32, 24])
    before, after = (seen[:, :2] / seen[:, 3:] - middle for seen in (framed, zoomed))
    assert np.allclose(after, before * zoom)
    assert np.array_equal(framed[:, 2:], zoomed[:, 2:])  # depths stay


@pytest.mark.parametrize(("view", "message"), [
    ({"direction": (math.nan, 0.0)}, "^view: azimuth: nan is not a number of degrees$"),
    ({"direction": (0.0, 90.5)}, "^view: elevation: 90.5 is not from -90 to 90 degrees$"),
    ({"zoom": 0.0}, "^zoom: 0.0 is not from 0.05 to 30.0$"),
    ({"zoom": math.inf}, "^zoom: inf is not from 0.05 to 30.0$"),
])
def test_views_that_are_refused(view, message):
    with pytest.raises(InputError, match=message):
        View(**view)


@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (math.nan, 0.0, 1.0), (1e200, 0.0, 0.0)])
def test_a_light_has_a_direction(direction):
    with pytest.raises(InputError, match=r"^light: .* is no direction; take three numbers"):
        Lighting(direction=direction)


def test_the_far_plane_is_at_the_end_of_the_scene():
    picture = PictureFormat()
    short = dataclasses.replace(STRAIGHT, far=2.0)
    listed = display_list_of_mesh(facing_wall(4.0), picture, camera=short)
    assert listed.triangles == 2
    assert np.all(listed.depth == picture.depth_limit)


def test_an_eye_inside_the_scene_sees_what_is_before_it():
    inside = Camera(eye=(3.0, -2.0, 5.0), target=(3.0, 0.0, 5.0))
    listed = display_list_of_mesh(BALL, PictureFormat(), camera=inside)
    assert 0 < listed.triangles < BALL.triangles
    pixels = listed.position / 256
    assert pixels.min() < 0 and pixels.max() > 64  # all of the screen


def test_a_scene_behind_the_eye_is_an_empty_picture(tmp_path):
    away = dataclasses.replace(STRAIGHT, target=(0, 0, 1), near=None, far=None)
    assert display_list_of_mesh(facing_wall(), PictureFormat(), camera=away).triangles == 0
    result = make_display_list("tetra", camera=Camera(eye=(0, 0, 9), target=(0, 0, 10), up=UP_Y))
    assert result.notes == ("no face is in view: the picture is empty",)


@pytest.mark.parametrize("change, message", [
    ({"target": (0, 0, 0)}, "camera: target: is where the eye is"),
    ({"up": (0, 0, 2)}, "camera: up: is along the line of sight"),
    ({"up": (0, 0, 0)}, "camera: up: is along the line of sight"),
    ({"field_of_view": 0.0}, "camera: field_of_view: 0.0 is not from 1 to 170 degrees"),
    ({"field_of_view": math.nan}, "camera: field_of_view: nan is not from 1"),
    ({"near": 0.0}, "camera: near: 0.0 is not a distance above 0"),
    ({"far": -1.0}, "camera: far: -1.0 is not a distance above 0"),
    ({"eye": (0, math.nan, 0)}, "camera: eye: (0, nan, 0) is not three finite numbers"),
])
def test_bad_cameras(change, message):
    with pytest.raises(InputError) as caught:
        dataclasses.replace(STRAIGHT, **change)
    assert str(caught.value).startswith(message)


# ---- light


def test_a_surface_that_faces_the_light_has_its_full_color():
    lighting = Lighting(ambient=0.25, direction=(0, 0, 1))
    for shading in ("flat", "gouraud"):
        assert np.allclose(lit_corners(facing_wall(), STRAIGHT, shading, lighting), BASE_COLOR)


@pytest.mark.parametrize("degrees, share", [(0, 1.0), (60, 0.5), (90, 0.0), (150, 0.0)])
def test_lambert_and_ambient(degrees, share):
    angle = math.radians(degrees)
    lighting = Lighting(ambient=0.25, direction=(math.sin(angle), 0, math.cos(angle)))
    colors = np.full((2, 3, 3), 200, np.uint8)
    lit = lit_corners(facing_wall(colors=colors), STRAIGHT, "flat", lighting)
    assert np.allclose(lit, 200 * (0.25 + 0.75 * share))


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
def test_both_sides_are_lit_alike(shading):
    wall = facing_wall()
    turned = dataclasses.replace(wall, faces=wall.faces[:, ::-1].copy())
    assert np.array_equal(
        lit_corners(wall, STRAIGHT, shading), lit_corners(turned, STRAIGHT, shading)
    )


def test_a_ball_has_no_light_seam_at_its_outline():
    camera = framing_camera(BALL)
    lit = lit_corners(BALL, camera, "gouraud", Lighting(ambient=0.0))
    towards = np.array(Lighting().direction) @ camera.axes()
    towards /= np.linalg.norm(towards)
    to_eye = np.array(camera.eye) - BALL.corners()[:, 0]
    seen = (BALL.normals[BALL.faces].mean(axis=1) * to_eye).sum(axis=1) > 0.5
    expected = np.maximum(BALL.normals[BALL.faces] @ towards, 0)[..., None] * BASE_COLOR
    assert np.allclose(lit[seen], expected[seen])


def test_flat_is_one_color_a_face_and_gouraud_one_a_vertex():
    flat = make_display_list("teapot", shading="flat").display_list
    gouraud = make_display_list("teapot", shading="gouraud").display_list
    assert flat.flat and not gouraud.flat
    assert np.array_equal(flat.position, gouraud.position)
    front = display_list_of_mesh(BALL, PictureFormat(256, 256), cull=True)
    places = np.concatenate([front.position, front.depth[..., None]], axis=2).reshape(-1, 3)
    colored = np.concatenate([places, front.color.reshape(-1, 3)], axis=1)
    count = len(np.unique(places, axis=0))
    assert len(np.unique(colored, axis=0)) == count > 300


def test_vertex_colors_of_a_flat_face_are_averaged():
    colors = np.array([[[0, 30, 60], [30, 60, 90], [60, 90, 120]]] * 2, np.uint8)
    lighting = Lighting(direction=(0, 0, 1))
    lit = lit_corners(facing_wall(colors=colors), STRAIGHT, "flat", lighting)
    assert np.allclose(lit, [30, 60, 90])


def test_the_default_teapot_is_more_than_a_thousand_fragments_in_many_colors():
    result = make_display_list("teapot")
    listed = result.display_list
    assert (listed.width, listed.height, listed.sub_bits, listed.depth_bits) == (64, 64, 8, 24)
    assert (result.name, result.notes, listed.triangles) == ("teapot", (), 992)
    assert listed.background == DEFAULT_BACKGROUND
    assert len(np.unique(listed.color.reshape(-1, 3), axis=0)) > 50
    a, b, c = listed.position.astype(np.int64).swapaxes(0, 1)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    assert np.abs(twice).sum() / 2 / 256**2 > 1000  # area in pixels, one on average a fragment


# ---- the whole way


def test_the_same_call_gives_the_same_list():
    for scene in ("teapot:tessellation=2", "spheres:count=3,seed=5", "random:n=20,seed=9"):
        one, two = (make_display_list(scene, width=80, height=50) for _ in range(2))
        assert same(one.display_list, two.display_list)
        assert one.name == scene


def test_culling_leaves_out_the_far_sides_of_a_closed_body():
    picture = PictureFormat(256, 256)
    whole = display_list_of_mesh(BALL, picture)
    front = display_list_of_mesh(BALL, picture, cull=True)
    assert 0.3 * whole.triangles < front.triangles < 0.5 * whole.triangles
    # Nothing that is seen from outside is missing: what stays is the nearer half.
    assert front.depth.mean() < whole.depth.mean()
    turned = dataclasses.replace(BALL, faces=BALL.faces[:, ::-1].copy())
    back = display_list_of_mesh(turned, picture, cull=True)
    assert front.triangles + back.triangles <= whole.triangles


def test_a_saved_list_is_replayed_as_it_is(tmp_path):
    made = make_display_list("teapot:tessellation=2", width=48, height=32, depth_bits=16)
    path = tmp_path / "list.npz"
    made.display_list.save(path)
    again = make_display_list(str(path))
    assert again.name == "list.npz"
    assert same(again.display_list, made.display_list)
    assert again.display_list.depth_bits == 16
    assert same(make_display_list(path, width=48, depth_bits=16).display_list, made.display_list)
    for wrong, message in (
        ({"width": 64}, "width: the display list was made for 48, not 64; leave it out, or make"),
        ({"height": 64}, "height: the display list was made for 32, not 64"),
        ({"sub_bits": 4}, "sub_bits: the display list was made for 8, not 4"),
        ({"background": (9, 9, 9)}, "background: the display list has (28, 32, 48), not (9, 9, 9)"),
    ):
        with pytest.raises(InputError) as caught:
            make_display_list(path, **wrong)
        assert str(caught.value).startswith(f"{path}: {message}")


@pytest.mark.parametrize(("name", "asked"), [
    ("camera", {"camera": STRAIGHT}), ("view", {"view": View((0.0, 0.0))}),
    ("zoom", {"view": View(zoom=2.0)}), ("light", {"lighting": Lighting(direction=(0, 0, 1))}),
    ("cull", {"cull": True})])
def test_only_a_mesh_can_be_looked_at_in_another_way(tmp_path, name, asked):
    path = tmp_path / "list.npz"
    make_display_list("tetra:depth=0").display_list.save(path)
    for scene, reason in ((path, "list.npz: {}: a display list is already projected and lit"),
                          ("hard:crossing-3-lsb", "hard:crossing-3-lsb: {}: a display list is"),
                          ("random", "random: {}: its triangles are made on the screen")):
        with pytest.raises(InputError) as caught:
            make_display_list(scene, **asked)
        assert str(caught.value).startswith(reason.format(name))
        assert str(caught.value).endswith("; leave it out, or take a mesh")


def test_a_camera_is_a_view_already():
    with pytest.raises(InputError, match=r"^view: the camera says where the eye is; leave one"):
        make_display_list("tetra:depth=0", camera=STRAIGHT, view=View((0.0, 0.0)))


@pytest.mark.parametrize("arguments, message", [
    ({"width": 0}, "picture: width: 0 is not a whole number from 1 to 4096"),
    ({"height": -4}, "picture: height: -4 is not a whole number from 1 to 4096"),
    ({"width": 4097}, "picture: width: 4097 is not"),
    ({"sub_bits": 0}, "picture: sub_bits: 0 is not a whole number from 1 to 8"),
    ({"depth_bits": 33}, "picture: depth_bits: 33 is not a whole number from 2 to 32"),
    ({"shading": "phong"}, "shading: 'phong' is unknown; use one of flat, gouraud"),
    ({"background": (0, 0, 256)}, "display list: background: needs three numbers from 0 to 255"),
])
def test_bad_arguments(arguments, message):
    for scene in ("tetra:depth=0", "random:n=3"):
        with pytest.raises(InputError) as caught:
            make_display_list(scene, **arguments)
        assert str(caught.value).startswith(message)


def test_bad_scenes_are_input_errors_here_too(tmp_path):
    for scene, message in (
        ("teapto", "did you mean teapot?"),
        (str(tmp_path / "none.obj"), "file: no such file"),
        (tmp_path / "none.npz", "no such file"),
        (str(tmp_path), "extension: none is not a mesh format"),
    ):
        with pytest.raises(InputError, match=message.replace("?", r"\?")):
            make_display_list(scene)
    with pytest.raises(InputError, match=r"^random: camera: "):
        make_display_list("random", camera=STRAIGHT)


def test_extreme_sizes_and_precisions():
    for numbers in ((1, 1, 1, 2), (4096, 4096, 8, 32), (4096, 1, 8, 24)):
        width, height, sub_bits, depth_bits = numbers
        picture = PictureFormat(width, height, sub_bits, depth_bits)
        listed = display_list_of_mesh(teapot(2), picture)
        assert listed.depth.max() <= 2**depth_bits - 2
        assert listed.triangles > 0
