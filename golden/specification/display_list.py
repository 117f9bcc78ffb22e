"""The display list: triangles as integers, the one thing every model shares."""

from __future__ import annotations

import os
import tempfile
import zipfile
import zlib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .errors import InputError
from .ranges import FORMAT_RANGES, check_whole

FORMAT_VERSION = 1


def coordinate_bits(width: int, height: int, sub_bits: int) -> int:
    """Bits of a signed vertex coordinate, guard band included.

    Coordinates lie in ``[-2**(bits-1), 2**(bits-1))`` units of ``2**-sub_bits``
    pixel: the band reaches twice the screen's power of two to either side of
    the origin, so a triangle needs clipping only when it leaves that band.
    """
    return (max(width, height) - 1).bit_length() + 2 + sub_bits


@dataclass(frozen=True)
class DisplayList:
    """Triangles at the highest resolution, in drawing order.

    ``position``    int32 (n, 3, 2): x right, y down, in units of ``2**-sub_bits`` pixel;
                    the centre of pixel (i, j) is at ``((i + 1/2), (j + 1/2)) * 2**sub_bits``
    ``depth``       int64 (n, 3): 0 (nearest) … ``2**depth_bits - 2``
    ``color``       uint8 (n, 3, 3): red, green, blue of each vertex
    ``background``  red, green, blue where nothing is drawn

    The index of a triangle is its primitive number: on equal depth the lower
    one keeps the pixel.  Raises ``InputError`` where an array has the wrong
    dtype, shape or range.

    >>> import cardcage, numpy
    >>> one = cardcage.DisplayList(
    ...     width=16, height=16,
    ...     position=numpy.array([[[0, 0], [4096, 0], [0, 4096]]], numpy.int32),
    ...     depth=numpy.array([[0, 100, 100]], numpy.int64),
    ...     color=numpy.full((1, 3, 3), 200, numpy.uint8))
    >>> one.save("one.npz")
    >>> cardcage.DisplayList.load("one.npz").triangles
    1
    """

    width: int
    height: int
    position: NDArray[np.int32]
    depth: NDArray[np.int64]
    color: NDArray[np.uint8]
    sub_bits: int = 8
    depth_bits: int = 24
    background: tuple[int, int, int] = (0, 0, 0)

    def __post_init__(self) -> None:
        self._check("display list")

    def _check(self, source: str) -> None:
        def wrong(field: str, remedy: str) -> InputError:
            return InputError(f"{source}: {field}: {remedy}")

        for field, low, high in FORMAT_RANGES:
            check_whole(f"{source}: {field}", getattr(self, field), low, high)
        if len(self.background) != 3 or not all(0 <= c <= 255 for c in self.background):
            raise wrong("background", "needs three numbers from 0 to 255")
        count = len(self.position) if self.position.ndim else 0
        for field, dtype, shape in (
            ("position", np.int32, (count, 3, 2)),
            ("depth", np.int64, (count, 3)),
            ("color", np.uint8, (count, 3, 3)),
        ):
            array = getattr(self, field)
            if array.dtype != dtype:
                raise wrong(field, f"has dtype {array.dtype}, needs {np.dtype(dtype)}")
            if array.shape != shape:
                raise wrong(field, f"has shape {array.shape}, needs {shape}")
        limit = 1 << (self.coordinate_bits - 1)
        if count and not (-limit <= self.position.min() and self.position.max() < limit):
            raise wrong("position", f"must lie in [{-limit}, {limit}): clip to the guard band")
        if count and not (self.depth.min() >= 0 and self.depth.max() <= self.depth_limit):
            raise wrong("depth", f"must lie in [0, {self.depth_limit}]")

    @property
    def triangles(self) -> int:
        return len(self.position)

    @property
    def coordinate_bits(self) -> int:
        return coordinate_bits(self.width, self.height, self.sub_bits)

    @property
    def depth_limit(self) -> int:
        """The greatest depth a vertex may have: one less than the background's."""
        return (1 << self.depth_bits) - 2

    @property
    def flat(self) -> bool:
        """True when every triangle has one colour: no channel needs interpolating."""
        first, second, third = (self.color[:, vertex] for vertex in range(3))
        return np.array_equal(first, second) and np.array_equal(first, third)

    @property
    def object_triangles(self) -> NDArray[np.int64] | None:
        """int64 (objects,): triangles of each object that the list is made of, one after another;
        None where it is made of triangles."""
        return None

    def chosen(self, triangles: NDArray[np.int64]) -> DisplayList:
        """A list of these triangles, by their numbers, in this order."""
        return replace(self, position=self.position[triangles], depth=self.depth[triangles],
                       color=self.color[triangles])

    def followed_by(self, *others: DisplayList) -> DisplayList:
        """The triangles of this list, and then those of others in the same format."""
        def together(field: str) -> NDArray[Any]:
            return np.concatenate([getattr(each, field) for each in (self, *others)])

        return replace(self, position=together("position"), depth=together("depth"),
                       color=together("color"))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write an ``.npz``: to a temporary name first, then renamed into place."""
        target = Path(path)
        descriptor, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
        try:
            with os.fdopen(descriptor, "wb") as file:
                np.savez_compressed(
                    file,
                    version=np.int64(FORMAT_VERSION),
                    width=np.int64(self.width),
                    height=np.int64(self.height),
                    sub_bits=np.int64(self.sub_bits),
                    depth_bits=np.int64(self.depth_bits),
                    background=np.array(self.background, np.uint8),
                    position=self.position,
                    depth=self.depth,
                    color=self.color,
                )
            Path(name).chmod(0o644)
            Path(name).replace(target)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> DisplayList:
        """Read what ``save`` wrote; ``InputError`` names the file and the field."""
        try:
            with Path(path).open("rb") as file:  # numpy leaves a broken one open
                if not zipfile.is_zipfile(file):
                    raise InputError(f"{path}: not a display list: no complete .npz archive; "
                                     "write it again with save()")
                file.seek(0)
                with np.load(file, allow_pickle=False) as archive:
                    arrays: dict[str, Any] = dict(archive)
        except FileNotFoundError:
            raise InputError(f"{path}: no such file") from None
        except InputError:
            raise
        except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error) as error:
            reason = str(error).splitlines()[0] if str(error) else type(error).__name__
            raise InputError(f"{path}: not a readable display list (.npz): {reason}") from None
        fields = ("version", "width", "height", "sub_bits", "depth_bits", "background",
                  "position", "depth", "color")
        for field in fields:
            if field not in arrays:
                raise InputError(f"{path}: {field}: missing; is this a cardcage display list?")
        numbers: dict[str, int] = {}
        for field in fields[:5]:
            array = arrays[field]
            if array.shape != () or array.dtype.kind not in "iu":
                raise InputError(f"{path}: {field}: needs one whole number, got {array.dtype} "
                                 f"of shape {array.shape}")
            numbers[field] = int(array)
        if numbers["version"] != FORMAT_VERSION:
            raise InputError(f"{path}: version: {numbers['version']} is not {FORMAT_VERSION}; "
                             "make the display list again with this release")
        background = arrays["background"]
        if background.shape != (3,) or background.dtype != np.uint8:
            raise InputError(f"{path}: background: needs uint8 of shape (3,), got "
                             f"{background.dtype} of shape {background.shape}")
        try:
            return cls(
                width=numbers["width"],
                height=numbers["height"],
                sub_bits=numbers["sub_bits"],
                depth_bits=numbers["depth_bits"],
                background=(int(background[0]), int(background[1]), int(background[2])),
                position=arrays["position"],
                depth=arrays["depth"],
                color=arrays["color"],
            )
        except InputError as error:
            raise InputError(str(error).replace("display list", str(path), 1)) from None


#: "flat" takes the colour of a triangle's first vertex, "gouraud" interpolates.
Shading = Literal["flat", "gouraud"]


def shading_for(display_list: DisplayList, shading: Shading | None = None) -> Shading:
    """``shading`` itself, or by default the cheapest that draws the list as meant.

    ``InputError`` for any other word.
    """
    if shading is None:
        return "flat" if display_list.flat else "gouraud"
    if shading not in ("flat", "gouraud"):
        raise InputError(f"shading: {shading!r} is neither 'flat' nor 'gouraud'")
    return shading
