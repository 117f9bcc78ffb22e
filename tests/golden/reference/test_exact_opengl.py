"""Optional: coverage and winners against OpenGL, drawn by Mesa's llvmpipe.

An opinion from outside: a rasteriser with eight sub-pixel bits and the same
fill rule, written by other people.  Depths are not compared, its are float32;
every triangle here has one depth, well apart from the others'.
"""

import numpy as np
import pytest

from cardcage.golden.reference import exact
from cardcage.golden.specification.display_list import DisplayList

SIZE = 128
REMEDY = "pip install 'cardcage[opengl]' and Mesa's EGL library"

VERTEX_SHADER = """
#version 330
in vec3 position;
in int primitive;
flat out int number;
void main() {
    gl_Position = vec4(position, 1.0);
    number = primitive;
}
"""

FRAGMENT_SHADER = """
#version 330
flat in int number;
out int winner;
void main() { winner = number; }
"""


@pytest.fixture(scope="module")
def context():
    moderngl = pytest.importorskip("moderngl", reason=f"no moderngl: {REMEDY}")
    try:
        context = moderngl.create_standalone_context(backend="egl")
    except Exception as error:  # whatever the driver's loader finds missing
        pytest.skip(f"no OpenGL context ({error}): {REMEDY}")
    if "llvmpipe" not in context.info["GL_RENDERER"]:
        pytest.skip(f"{context.info['GL_RENDERER']} is not llvmpipe: its rules may differ")
    yield context
    context.release()


def winners(context, position, depth):
    """int32 (SIZE, SIZE) from OpenGL; positions in 1/256 pixel, all exact in float32."""
    count = len(position)
    vertices = np.empty((count * 3, 3), np.float32)
    vertices[:, :2] = position.reshape(-1, 2) / (128 * SIZE) - 1
    vertices[:, 2] = np.repeat(depth, 3) / count * 2 - 1
    numbers = np.repeat(np.arange(count, dtype=np.int32), 3)
    program = context.program(vertex_shader=VERTEX_SHADER, fragment_shader=FRAGMENT_SHADER)
    array = context.vertex_array(program, [
        (context.buffer(vertices.tobytes()), "3f", "position"),
        (context.buffer(numbers.tobytes()), "1i", "primitive"),
    ])  # fmt: skip
    target = context.texture((SIZE, SIZE), 1, dtype="i4")
    frame = context.framebuffer([target], context.depth_renderbuffer((SIZE, SIZE)))
    frame.use()
    # An integer target is cleared by writing it; depth by clear.
    frame.clear(depth=1.0)
    target.write(np.full((SIZE, SIZE), -1, np.int32).tobytes())
    context.enable(context.DEPTH_TEST)
    context.disable(context.CULL_FACE)
    array.render()
    # OpenGL's first row is its lowest, where y is least: our row 0, and its
    # bottom-left rule in a picture upside down is top-left.
    return np.frombuffer(target.read(), np.int32).reshape(SIZE, SIZE)


@pytest.mark.parametrize("kind", ["small", "large", "lattice", "sliver", "mesh"])
def test_winners_equal_llvmpipe(context, kind):
    random = np.random.default_rng(4)
    full, count = SIZE * 256, 600
    position = random.integers(0, full, (count, 3, 2))
    if kind == "small":
        position = random.integers(0, full, (count, 1, 2)) + random.integers(-600, 600,
                                                                             (count, 3, 2))
    elif kind == "lattice":
        position = random.integers(0, 2 * SIZE, (count, 3, 2)) * 128
    elif kind == "sliver":
        middle = (position[:, 0] + position[:, 1]) // 2
        position[:, 2] = middle + random.integers(-40, 40, (count, 2))
    elif kind == "mesh":
        # Shared edges without gaps or overlaps: a jittered grid of squares, each cut in two.
        side = 17
        grid = np.stack(np.meshgrid(*[np.linspace(0, full, side).astype(int)] * 2), axis=-1)
        grid[1:-1, 1:-1] += random.integers(-700, 700, (side - 2, side - 2, 2))
        a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
        position = np.concatenate([np.stack(corners, axis=2).reshape(-1, 3, 2)
                                   for corners in ((a, b, c), (c, d, a))])
        count = len(position)
    position = np.clip(position, 0, full).astype(np.int32)
    depth = random.permutation(count)
    display_list = DisplayList(SIZE, SIZE, position,
                               np.repeat(depth[:, None], 3, axis=1).astype(np.int64) * 1000,
                               np.zeros((count, 3, 3), np.uint8))
    expected = exact.draw(display_list).winner
    assert (expected >= 0).sum() > (SIZE * SIZE - 1 if kind == "mesh" else 500)
    assert np.array_equal(winners(context, position, depth), expected)
