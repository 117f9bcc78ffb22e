"""The display lists of a sequence, each made when it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...golden.scene_display_list import LoadedScene, SceneDisplayList, read_scene
from ...golden.scenes.camera import View
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ..machine_options import MachineOptions, load_scene
from ..support.counted import counted
from .frame_views import DEFAULT_TURN, MOST_FRAMES, read_path, turning

#: Lists that are kept: the one that is drawn, and those that are prepared meanwhile.
_KEPT = 4


class SceneFrames(Sequence[DisplayList]):
    """What ``scene`` looks like in each picture.

    ``views``           how many pictures, and from where each is seen
    ``first``           the first one's list, with the scene's name and notes
    ``most_triangles``  of a list, of those that have been made

    ``frames``, ``turn`` and ``path`` are those of ``AskedViews``.  A scene that is no
    mesh cannot be turned; it is drawn as often as asked.  A list is made again where it is no
    longer kept, so that a long sequence takes no more memory than a short one.  Raises
    ``InputError``.
    """

    def __init__(self, scene: str | Path, options: MachineOptions, *, frames: int | None,
                 turn: float | None, path: Path | None) -> None:
        if path is not None and (turn is not None or options.view is not None
                                 or options.zoom is not None):
            raise InputError("--path: says from where each picture is seen; leave out --turn, "
                             "--view and --zoom")
        self._options = options
        self._loaded = read_scene(scene)
        self.views = _views(self._loaded, options, frames, turn, path)
        self.most_triangles = 0
        self._kept: dict[int, SceneDisplayList] = {}  # those that were made last
        self.first: SceneDisplayList = self.scene(0)

    @property
    def views_as_seen(self) -> list[View]:
        """The same, with the direction from which a mesh asks to be seen, where none is said."""
        direction = self._loaded.direction
        return [view if view.direction or direction is None else
                replace(view, direction=direction) for view in self.views]

    def __len__(self) -> int:
        return len(self.views)

    def __getitem__(self, number: Any) -> Any:
        if isinstance(number, slice):
            return [self[place] for place in range(*number.indices(len(self)))]
        return self.scene(range(len(self))[number]).display_list

    def scene(self, number: int) -> SceneDisplayList:
        """The display list of one picture, with its name."""
        if number not in self._kept:
            made = load_scene(self._loaded, self._options, self.views[number])
            self.most_triangles = max(self.most_triangles, made.display_list.triangles)
            while len(self._kept) >= _KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[number] = made
        return self._kept[number]


def _views(loaded: LoadedScene, options: MachineOptions, frames: int | None, turn: float | None,
           path: Path | None) -> list[View]:
    if path is not None:
        views = read_path(path)
        if frames is not None and frames != len(views):
            raise InputError(f"--frames: {frames}, but {path} has "
                             f"{counted(len(views), 'view')}; leave it out")
        return views
    if frames is None or not 1 <= frames <= MOST_FRAMES:
        raise InputError(f"--frames: must be 1 to {MOST_FRAMES:,}, not {frames}")
    asked: View = options.looking()["view"]
    if loaded.direction is None:
        if turn is not None:
            raise InputError(f"--turn: {loaded.scene.name} is no mesh and cannot be turned; leave "
                             "it out, or take a mesh")
        return [asked] * frames
    start = asked.direction or loaded.direction
    views = turning(start, asked.zoom, frames, DEFAULT_TURN if turn is None else turn)
    # The first is seen as a picture by itself is, to the last bit.
    return [replace(views[0], direction=asked.direction), *views[1:]]
