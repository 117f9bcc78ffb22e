"""From where each picture is seen: what turns, and what a file says."""

import pytest

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.scenes.camera import View
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.views.frame_views import read_path, turning
from cardcage.testbenches.views.scene_frames import SceneFrames

SMALL = MachineOptions(size=(16, 12))


def frames_of(scene, options=SMALL, **asked):
    return SceneFrames(scene, options, **{"frames": None, "turn": None, "path": None} | asked)


def test_turning():
    assert turning((10.0, 20.0), 2.0, 3, -15.0) == [
        View((10.0, 20.0), 2.0), View((-5.0, 20.0), 2.0), View((-20.0, 20.0), 2.0)]


def test_the_first_picture_is_the_one_that_is_drawn_alone():
    for options in (SMALL, MachineOptions(size=(16, 12), view=(77.0, 5.0), zoom=1.5, cull=True)):
        lists = frames_of("teapot:tessellation=2", options, frames=3)
        alone = make_display_list("teapot:tessellation=2", width=16, height=12,
                                  **options.looking()).display_list
        assert (lists[0].position == alone.position).all() and len(lists) == 3
        assert lists[1].triangles and not (lists[1].position.shape == alone.position.shape
                                           and (lists[1].position == alone.position).all())


def test_a_turn_of_360_degrees_ends_where_it_began():
    lists = frames_of("tetra:depth=1", MachineOptions(size=(16, 12), view=(30.0, 20.0)),
                      frames=5, turn=90.0)
    assert (lists[4].position == lists[0].position).all()
    assert (lists[2].position != lists[0].position).any()


def test_lists_are_made_again_and_alike():
    lists = frames_of("tetra:depth=1", frames=9, turn=10.0)
    first = [each.position.copy() for each in lists]
    again = [lists[place].position for place in range(9)]
    assert all((one == other).all() for one, other in zip(first, again, strict=True))
    assert lists.most_triangles == max(each.triangles for each in lists)
    assert [each.triangles for each in lists[2:4]] == [lists[2].triangles, lists[3].triangles]


def test_what_is_no_mesh_is_drawn_again():
    lists = frames_of("random:n=3,size=4", frames=2)
    assert (lists[0].position == lists[1].position).all()


def test_a_path(tmp_path):
    path = tmp_path / "views.csv"
    path.write_text("Azimuth, elevation ,zoom\n10,20,1.5\n\n-30.5,-90,1\n")
    assert read_path(path) == [View((10.0, 20.0), 1.5), View((-30.5, -90.0), 1.0)]
    path.write_text("azimuth,elevation\n1,2\n", encoding="utf-8-sig")  # as spreadsheets write it
    assert read_path(path) == [View((1.0, 2.0))]
    assert len(frames_of("tetra:depth=0", path=path)) == 1


@pytest.mark.parametrize(("text", "message"), [
    ("", "line 1: begin with the columns azimuth,elevation, or azimuth,elevation,zoom"),
    ("1,2\n", "line 1: begin with the columns"),
    ("azimuth,elevation\n", "no view; write a line for each picture"),
    ("azimuth,elevation\n1,2\n3\n", "line 3: 1 columns, the first line has 2"),
    ("azimuth,elevation\n1,2\n\n3,x\n", "line 4: elevation: 'x' is not a number"),
    ("azimuth,elevation\n1,inf\n", "line 2: elevation: 'inf' is not a number"),
    ("azimuth,elevation\n1,91\n", "line 2: view: elevation: 91.0 is not from -90 to 90 degrees"),
    ("azimuth,elevation,zoom\n1,2,0\n", "line 2: zoom: 0.0 is not from 0.05 to 30.0"),
    (b"\xff\xfe\x00", "is no CSV file"),
    ("azimuth,elevation\n" + "0,0\n" * 10_001, "10,001 views, at most 10,000"),
])
def test_what_is_no_path(tmp_path, text, message):
    path = tmp_path / "views.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as caught:
        read_path(path)
    assert str(caught.value) == f"--path: {path}: {message}" or message in str(caught.value)
    assert str(caught.value).startswith(f"--path: {path}: ") and "\n" not in str(caught.value)


@pytest.mark.parametrize(("scene", "options", "asked", "message"), [
    ("tetra", SMALL, {"frames": 0}, "--frames: must be 1 to 10,000, not 0"),
    ("tetra", SMALL, {"frames": 3, "turn": float("inf")}, "--turn: inf degrees over 3 pictures"),
    ("tetra", SMALL, {"frames": 3, "turn": 1e308}, "--turn: 1e+308 degrees over 3 pictures are"),
    ("random:n=3", SMALL, {"frames": 2, "turn": 1.0}, "--turn: random:n=3 is no mesh and cannot"),
    ("hard:sliver-fan", SMALL, {"frames": 2, "turn": 1.0}, "--turn: hard:sliver-fan is no mesh"),
    ("tetra", MachineOptions(zoom=2.0), {"path": "views.csv"}, "--path: says from where each"),
    ("tetra", SMALL, {"path": "views.csv", "turn": 3.0}, "--path: says from where each"),
    ("tetra", SMALL, {"path": "views.csv", "frames": 3}, "--frames: 3, but views.csv has 1 view;"),
    ("tetra", SMALL, {"path": "none.csv"}, "--path: none.csv: No such file or directory"),
    ("random", MachineOptions(view=(0.0, 0.0)), {"frames": 2}, "random: view: its triangles are"),
])
def test_what_cannot_be_asked(tmp_path, monkeypatch, scene, options, asked, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "views.csv").write_text("azimuth,elevation\n1,2\n")
    if "path" in asked:
        asked = asked | {"path": tmp_path.__class__(asked["path"])}
    with pytest.raises(InputError) as caught:
        frames_of(scene, options, **asked)
    assert str(caught.value).startswith(message)
