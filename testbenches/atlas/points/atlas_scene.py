"""A scene of the atlas: what it is made from, so that a result can be kept by it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ....golden.scene_argument import BuiltInScene, HardCaseScene, parse_scene
from ....golden.scene_display_list import SceneDisplayList
from ....golden.scenes.scene_files.examples import EXAMPLE_FOLDER, EXAMPLES
from ....golden.scenes.scene_files.object_list import ObjectDisplayList
from ....golden.specification.display_list import DisplayList
from ...machine_options import MachineOptions, load_scene
from ...support.cache import content_hash


@dataclass(frozen=True)
class AtlasScene:
    """A scene at a size, as it is looked at.

    ``name``      as on the command line
    ``size``      width and height
    ``options``   how it is looked at; what is asked of the machine is left out
    ``identity``  of everything that it is made from, but for the package itself
    ``listed``    its display list, where it comes of files that a process elsewhere may not have;
                  None where the package makes it
    """

    name: str
    size: tuple[int, int]
    options: MachineOptions
    identity: str
    listed: SceneDisplayList | None = field(default=None, compare=False, repr=False)

    @classmethod
    def of(cls, name: str, size: tuple[int, int], options: MachineOptions) -> AtlasScene:
        """Raises ``InputError`` for a scene that cannot be read or made at that size."""
        seen = MachineOptions(size=size, shading=options.shading, view=options.view,
                              zoom=options.zoom, background=options.background,
                              cull=options.cull, light=options.light)
        if isinstance(parse_scene(name), BuiltInScene | HardCaseScene):
            return cls(name, size, seen, "built in")
        if name in EXAMPLES:
            return cls(name, size, seen, _examples())
        listed = load_scene(name, seen)
        return cls(name, size, seen, _hash(listed.display_list), listed)

    def load(self) -> SceneDisplayList:
        """Its display list, made once in each process.  Raises ``InputError``."""
        return _load(self) if self.listed is None else self.listed


@lru_cache(maxsize=8)
def _load(scene: AtlasScene) -> SceneDisplayList:
    return load_scene(scene.name, replace(scene.options, size=scene.size))


@lru_cache(maxsize=1)
def _examples() -> str:
    """Of the files of all examples: they may read one another's."""
    files = sorted(path for path in Path(EXAMPLE_FOLDER).iterdir() if path.is_file())
    return content_hash(path.read_text(encoding="utf-8") for path in files)


def _hash(listed: DisplayList) -> str:
    """Of all that a machine is told of it: of objects as well, since other ones may have the same
    triangles."""
    numbers = (listed.width, listed.height, listed.sub_bits, listed.depth_bits, listed.background)
    arrays: list[NDArray[Any]] = [listed.position, listed.depth, listed.color]
    made: object = None
    if isinstance(listed, ObjectDisplayList):
        objects = listed.objects
        made = objects.picture, objects.background, [mesh.triangles for mesh in objects.meshes]
        arrays += [listed.counts, objects.mesh, objects.offset, objects.color,
                   *(part for mesh in objects.meshes
                     for part in (mesh.position, mesh.depth, mesh.shade))]
    return content_hash([repr((numbers, made)), *(array.tobytes().hex() for array in arrays)])
