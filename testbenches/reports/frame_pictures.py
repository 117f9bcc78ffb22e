"""The pictures of a report, as arrays and as PNG files."""

from __future__ import annotations

import base64
import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..frames.compare import Comparison
from ..frames.rendering import Rendering

Pixels = NDArray[np.uint8]

DIFFERENT_COLOR = (235, 30, 30)
ORPHAN_COLOR = (40, 60, 130)
DEPTH_BACKGROUND_COLOR = (28, 32, 48)

#: Grey of equal pixels: the picture shows faintly, so that one sees where a difference lies.
_EQUAL_DARKEST, _EQUAL_LIGHTEST = 90, 190


def png(pixels: Pixels) -> bytes:
    """A PNG file, pixel for pixel."""
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG", optimize=True)
    return file.getvalue()


def data_uri(pixels: Pixels) -> str:
    """The PNG as an address that a page carries in itself."""
    return f"data:image/png;base64,{base64.b64encode(png(pixels)).decode()}"


def color_difference(rendering: Rendering, reach: int = 0) -> Pixels:
    """Grey where the video is as expected, red where not, blue where nothing was compared.

    Red spreads ``reach`` pixels to every side, to be seen where the picture is shown smaller.
    """
    return different_pixels(rendering.comparison, reach)


def different_pixels(comparison: Comparison, reach: int = 0) -> Pixels:
    """The same of a comparison alone."""
    luminance = comparison.expected.astype(np.float64) @ np.array([0.299, 0.587, 0.114])
    return _marked(luminance / 255, _spread(comparison.color_different, reach),
                   comparison.color_orphans)


def depth_difference(rendering: Rendering, reach: int = 0) -> Pixels:
    """The same picture as ``color_difference``, of the depths that were read back."""
    comparison = rendering.comparison
    return _marked(_nearness(rendering, comparison.golden.depth),
                   _spread(comparison.depth_different, reach), comparison.depth_orphans)


def depth_pictures(rendering: Rendering) -> tuple[Pixels, Pixels]:
    """The machine's depths and the golden ones on one scale, near is light; background apart.  Only
    where depths were read back."""
    read = rendering.simulation.depth
    assert read is not None
    got, wanted = (_depth_picture(rendering, depth)
                   for depth in (read, rendering.comparison.golden.depth))
    got[rendering.comparison.depth_orphans] = ORPHAN_COLOR
    return got, wanted


def _depth_picture(rendering: Rendering, depth: NDArray[np.int64]) -> Pixels:
    grey = np.rint(40 + 215 * _nearness(rendering, depth)).astype(np.uint8)
    picture = np.repeat(grey[..., None], 3, axis=2)
    picture[depth == rendering.configuration.depth_background] = DEPTH_BACKGROUND_COLOR
    return picture


def _nearness(rendering: Rendering, depth: NDArray[np.int64]) -> NDArray[np.float64]:
    """1 at the nearest depth of the golden picture, 0 at its farthest and beyond."""
    golden = rendering.comparison.golden.depth
    drawn = golden[golden != rendering.configuration.depth_background]
    near = int(drawn.min(initial=rendering.configuration.depth_background))
    far = int(drawn.max(initial=near)) if drawn.size else near
    return np.clip((far - depth) / max(far - near, 1), 0.0, 1.0)


def _spread(marks: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    height, width = marks.shape
    padded = np.pad(marks, reach)
    spread = np.zeros_like(marks)
    for down in range(2 * reach + 1):
        for right in range(2 * reach + 1):
            spread |= padded[down:down + height, right:right + width]
    return spread


def _marked(lightness: NDArray[np.float64], different: NDArray[np.bool_],
            orphans: NDArray[np.bool_]) -> Pixels:
    grey = _EQUAL_DARKEST + (_EQUAL_LIGHTEST - _EQUAL_DARKEST) * lightness
    picture = np.repeat(np.rint(grey).astype(np.uint8)[..., None], 3, axis=2)
    picture[orphans] = ORPHAN_COLOR
    picture[different] = DIFFERENT_COLOR
    return picture
