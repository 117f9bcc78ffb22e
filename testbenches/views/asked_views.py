"""What was asked of several pictures, and the machine that draws all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ...golden.planning.machine_plan import plan
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError
from ..machine_options import MachineOptions
from .scene_frames import SceneFrames


@dataclass(frozen=True)
class AskedViews:
    """How many pictures are asked for, and from where they are seen; nothing asks for one picture.

    ``frames``  pictures, which ``path`` may say instead
    ``turn``    degrees by which a mesh turns from one to the next; None: those of Ellsworth 1994
    ``path``    a CSV file with the view of each
    """

    frames: int | None = None
    turn: float | None = None
    path: Path | None = None

    @property
    def several(self) -> bool:
        return self.frames is not None or self.path is not None

    def lists(self, scene: str | Path, options: MachineOptions) -> SceneFrames | None:
        """The pictures' display lists, or None where one picture is asked for.  Raises
        ``InputError``."""
        if self.several:
            return SceneFrames(scene, options, frames=self.frames, turn=self.turn, path=self.path)
        check_alone(turn=self.turn is not None)
        return None

    def check_no_scene(self) -> None:
        """``InputError`` for whatever is asked, where there is no scene to look at."""
        for name in ("frames", "turn", "path"):
            if getattr(self, name) is not None:
                raise InputError(f"--{name}: without a scene there is nothing to look at; give a "
                                 "scene")

    def words(self, named: Callable[[Path], str] = str) -> list[str]:
        """As words of a command line, the file as ``named`` calls it."""
        asked = {"frames": self.frames,
                 "turn": None if self.turn is None else f"{self.turn:.17g}",
                 "path": None if self.path is None else named(self.path)}
        return [word for name, value in asked.items() if value is not None
                for word in (f"--{name}", str(value))]


def check_alone(**given: bool) -> None:
    """``InputError`` for an option that is given and that only several pictures can be asked."""
    for name, is_given in given.items():
        if is_given:
            raise InputError(f"--{name}: is for several pictures; give --frames as well")


def machine_for_frames(lists: SceneFrames, options: MachineOptions) -> MachineConfiguration:
    """The machine that draws all of them exactly, or as exactly as asked.  Raises ``InputError``
    for whatever cannot be used."""
    return plan(lists, **options.for_plan()).configuration
