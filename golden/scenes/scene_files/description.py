"""What a scene file says, before anything is made of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ..mesh import UP_Y, Vector

Color = tuple[int, int, int]
Projection = Literal["orthographic", "perspective"]

#: In place of a colour, or of a position: another one for each object.
Random = Literal["random"]


@dataclass(frozen=True)
class ObjectDefinition:
    """One ``obj`` line: ``number`` objects of one kind.

    ``kind``       a primitive, or ``"mesh"``: what is in the file ``path``
    ``rotation``   radians about x, then about y, then about z
    ``scale``      along x, y and z, before it is turned
    ``position``   of its origin; None: each object has a random one
    ``color``      None: white, or the mesh's own
    ``recursion``  how often each triangle of a primitive becomes four; None: as usual for the kind
    ``seed``       start of the random numbers
    ``line``       in the scene file
    ``column``     in that line, of the mesh file's name; of ``obj`` where there is none
    """

    kind: str
    seed: int
    line: int
    column: int = 1
    path: Path | None = None
    rotation: Vector = (0.0, 0.0, 0.0)
    scale: Vector = (1.0, 1.0, 1.0)
    position: Vector | None = None
    number: int = 1
    color: Color | Random | None = None
    recursion: int | None = None


@dataclass(frozen=True)
class SceneDescription:
    """A whole scene file; None is what the file does not say.

    ``ambient``     per cent of light from everywhere
    ``light``       towards the light: right, up, towards the eye
    ``nodes``       how many nodes draw it where nobody says otherwise
    ``overlay``     colour of a frame around the picture
    ``outfile``     folder for the report where none is asked for
    ``percent``     of the picture's pixels that have a star
    ``eye`` … ``field_of_view``  of a perspective picture
    """

    path: Path
    ambient: float | None = None
    background: Color | None = None
    light: Vector | None = None
    nodes: int | None = None
    overlay: Color | None = None
    outfile: str | None = None
    percent: float = 0.0
    eye: Vector = (0.0, 0.0, 4.0)
    target: Vector = (0.0, 0.0, 0.0)
    up: Vector = UP_Y
    field_of_view: float = 35.0
    projection: Projection = "orthographic"
    size: tuple[int, int] | None = None
    objects: tuple[ObjectDefinition, ...] = field(default_factory=tuple)
