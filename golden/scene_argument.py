"""The built-in scenes by name, and the scene argument of the command line."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from .scenes.built_in.capsid import capsid, capsid_triangles
from .scenes.built_in.head import head, head_triangles
from .scenes.built_in.sphereflake import sphereflake, sphereflake_triangles
from .scenes.built_in.spheres import spheres, spheres_triangles
from .scenes.built_in.teapot import teapot, teapot_triangles
from .scenes.built_in.terrain import terrain, terrain_triangles
from .scenes.built_in.tetra import tetra, tetra_triangles
from .scenes.mesh import Mesh
from .scenes.mesh_files.load_mesh import MESH_EXTENSIONS
from .scenes.scene_files.examples import EXAMPLES, example_path
from .scenes.scene_files.scene_file import SceneFile
from .specification.errors import InputError

DISPLAY_LIST_EXTENSION: Final = ".npz"
DESCRIPTION_EXTENSION: Final = ".scene"
HARD_CASE: Final = "hard"

#: More would take minutes and gigabytes before the first pixel.
TRIANGLE_LIMIT: Final = 4_000_000

Number = int | float


@dataclass(frozen=True)
class Parameter:
    """A number that shapes a built-in scene; whole where its default is."""

    name: str
    default: Number
    low: Number
    high: Number
    description: str

    @property
    def range(self) -> str:
        kind = "whole number" if isinstance(self.default, int) else "number"
        return f"{kind} from {self.low} to {self.high}"

    def parse(self, text: str, scene: str) -> Number:
        """The value of ``text``; ``InputError`` names the parameter and its range."""
        value: Number
        try:
            value = int(text) if isinstance(self.default, int) else float(text)
        except ValueError:
            value = math.nan
        if not self.low <= value <= self.high:
            raise InputError(f"{scene}: {self.name}: {text!r} is not a {self.range}")
        return value


@dataclass(frozen=True)
class BuiltIn:
    """A scene the package makes itself.

    ``triangles``  its exact number of triangles, for the parameters as keywords
    ``mesh``       makes it, for the same keywords; None for screen-space triangles
    """

    name: str
    description: str
    parameters: tuple[Parameter, ...]
    triangles: Callable[..., int]
    mesh: Callable[..., Mesh] | None

    @property
    def defaults(self) -> dict[str, Number]:
        return {parameter.name: parameter.default for parameter in self.parameters}


@dataclass(frozen=True)
class BuiltInScene:
    """A built-in scene with every parameter given a value."""

    built_in: BuiltIn
    arguments: Mapping[str, Number] = field(default_factory=dict)
    name: str = ""

    @property
    def triangles(self) -> int:
        return self.built_in.triangles(**self.arguments)


@dataclass(frozen=True)
class MeshFileScene:
    """A mesh file, not yet looked at."""

    path: Path

    @property
    def name(self) -> str:
        return self.path.name


@dataclass(frozen=True)
class DisplayListScene:
    """A saved display list to replay, not yet looked at."""

    path: Path

    @property
    def name(self) -> str:
        return self.path.name


@dataclass(frozen=True)
class HardCaseScene:
    """A case of the hard-case catalogue, not yet looked up: a display list with its own size."""

    case: str

    @property
    def name(self) -> str:
        return f"{HARD_CASE}:{self.case}"


@dataclass(frozen=True)
class DescribedScene:
    """A scene file, or one of the examples, not yet looked at; ``name`` is as it was asked for."""

    path: Path
    name: str


Scene = BuiltInScene | MeshFileScene | DisplayListScene | HardCaseScene | DescribedScene


@dataclass(frozen=True)
class SceneListing:
    """One line of the list of scenes; ``triangles`` at the parameters' defaults."""

    name: str
    description: str
    parameters: tuple[Parameter, ...]
    triangles: int


def _random_triangles(n: int, size: float, seed: int) -> int:
    return n


_SEED: Final = Parameter("seed", 1, 0, 2**32 - 1, "start of the random numbers")

BUILT_INS: Final[dict[str, BuiltIn]] = {
    scene.name: scene
    for scene in (
        BuiltIn(
            "teapot",
            "the Utah teapot from its 32 Bézier patches (Newell 1975)",
            (Parameter("tessellation", 4, 2, 128, "steps along the side of a patch"),),
            teapot_triangles,
            teapot,
        ),
        BuiltIn(
            "sphereflake",
            "a sphere with nine children a third its size, and so on (Haines 1987, balls)",
            (
                Parameter("depth", 2, 0, 6, "generations of children"),
                Parameter("tessellation", 2, 0, 8, "subdivisions of each sphere's octahedron"),
            ),
            sphereflake_triangles,
            sphereflake,
        ),
        BuiltIn(
            "tetra",
            "the Sierpinski tetrahedron (Haines 1987, tetra)",
            (Parameter("depth", 4, 0, 9, "how often each tetrahedron becomes four"),),
            tetra_triangles,
            tetra,
        ),
        BuiltIn(
            "spheres",
            "uniformly random spheres of one size (Blazek 1991)",
            (
                Parameter("count", 16, 1, 2048, "number of spheres"),
                Parameter("depth", 2, 0, 8, "subdivisions of each sphere's octahedron"),
                Parameter("radius", 0.15, 0.001, 2.0, "of a sphere; centres lie within ±1"),
                _SEED,
            ),
            spheres_triangles,
            spheres,
        ),
        BuiltIn(
            "terrain",
            "mountains by their elevations (the fault at Jacksboro, of matplotlib's examples)",
            (
                Parameter("step", 16, 1, 64, "from one elevation that is taken to the next"),
                Parameter("relief", 3.0, 0.0, 20.0, "how often as high as they are"),
            ),
            terrain_triangles,
            terrain,
        ),
        BuiltIn(
            "head",
            "a head (in place of the one of Ellsworth 1994)",
            (Parameter("tessellation", 12, 1, 500, "parts of an edge of an octahedron"),),
            head_triangles,
            head,
        ),
        BuiltIn(
            "capsid",
            "balls on a sphere, as a virus' shell (in place of the one of Ellsworth 1994)",
            (
                Parameter("count", 32, 1, 2048, "number of balls"),
                Parameter("depth", 2, 0, 8, "subdivisions of each ball's octahedron"),
            ),
            capsid_triangles,
            capsid,
        ),
        BuiltIn(
            "random",
            "random triangles on the screen, each in a square box of a given size",
            (
                Parameter("n", 200, 1, 1_000_000, "number of triangles"),
                Parameter("size", 16.0, 0.125, 8191.0, "side of the box in pixels"),
                _SEED,
            ),
            _random_triangles,
            None,
        ),
    )
}


def list_scenes() -> list[SceneListing]:
    """The built-in scenes, and then the examples of scene files, in the order in which they are
    shown to a user."""
    return [
        *(SceneListing(s.name, s.description, s.parameters, s.triangles(**s.defaults))
          for s in BUILT_INS.values()),
        *(SceneListing(name, description, (),
                       SceneFile.read(example_path(name), TRIANGLE_LIMIT).placed.triangles)
          for name, description in EXAMPLES.items()),
    ]


def parse_scene(scene: str | Path) -> Scene:
    """What a scene argument means; no file is opened.

    A ``Path``, a known file extension or the name of an existing file means that
    file: a mesh, a display list (``.npz``), or a scene file (``.scene``).  ``hard:NAME`` is
    a hard case.  Anything else is the name of an example of a scene file, or of a built-in
    with arguments if need be:
    ``sphereflake:depth=3,tessellation=1``.

    Raises ``InputError``, with the nearest name for one that is unknown.
    """
    if isinstance(scene, str) and scene.startswith(f"{HARD_CASE}:"):
        return HardCaseScene(scene.removeprefix(f"{HARD_CASE}:").strip())
    path = Path(scene)
    suffix = path.suffix.lower()
    if suffix == DESCRIPTION_EXTENSION:
        return DescribedScene(path, path.name)
    if suffix == DISPLAY_LIST_EXTENSION:
        return DisplayListScene(path)
    if isinstance(scene, Path) or suffix in MESH_EXTENSIONS:
        return MeshFileScene(path)
    if scene in EXAMPLES:
        return DescribedScene(example_path(scene), scene)
    name, colon, arguments = scene.partition(":")
    built_in = BUILT_INS.get(name)
    if built_in is not None:
        return _built_in_scene(scene, built_in, arguments if colon else None)
    # A path by its looks: the reader of files says what is wrong with it.
    if "/" in name or path.suffix[1:].isalpha() or (name and _exists(path)):
        return MeshFileScene(path)
    known = [*BUILT_INS, *EXAMPLES]
    near = difflib.get_close_matches(name.lower(), known, n=1, cutoff=0.5)
    hint = f"did you mean {near[0]}?" if near else f"choose one of {', '.join(known)}"
    raise InputError(f"scene: {name!r} is neither a built-in scene nor a file; {hint}")


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # too long, or with characters no file name has
        return False


def _built_in_scene(text: str, built_in: BuiltIn, arguments: str | None) -> BuiltInScene:
    name = built_in.name
    known = {parameter.name: parameter for parameter in built_in.parameters}
    values = built_in.defaults
    given: set[str] = set()
    for argument in [] if arguments is None else arguments.split(","):
        key, equals, value = (part.strip() for part in argument.partition("="))
        if not equals or not key:
            raise InputError(f"{name}: parameters: {argument!r} is not of the form name=value, "
                             f"as in {name}:{built_in.parameters[0].name}="
                             f"{built_in.parameters[0].default}")
        if key not in known:
            choices = ", ".join(f"{p.name} ({p.range})" for p in built_in.parameters)
            raise InputError(f"{name}: {key}: no such parameter; use {choices}")
        if key in given:
            raise InputError(f"{name}: {key}: given twice; keep one")
        given.add(key)
        values[key] = known[key].parse(value, name)
    scene = BuiltInScene(built_in, values, text)
    if scene.triangles > TRIANGLE_LIMIT:
        raise InputError(f"{name}: {', '.join(sorted(given))}: makes {scene.triangles} triangles, "
                         f"more than {TRIANGLE_LIMIT}; choose smaller values")
    return scene
