"""How fast the exact reference is: ``python -m testbenches.studies.golden_benchmark``.

Draws random small triangles with ``golden.reference.exact`` and, where moderngl and an EGL library
are there (extra ``opengl``), with the software OpenGL behind it, and prints both times.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median

import click
import numpy as np

from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.display_list import DisplayList

_VERTEX = """
#version 330
in vec3 position; in vec3 color; out vec3 tint;
void main() { gl_Position = vec4(position, 1.0); tint = color; }
"""
_FRAGMENT = """
#version 330
in vec3 tint; out vec4 pixel;
void main() { pixel = vec4(tint, 1.0); }
"""


def opengl_drawer(display_list: DisplayList) -> tuple[Callable[[], None], str]:
    """A function that clears, draws the list with a depth test and reads it back, and the name of
    the renderer behind it.

    Raises ``ImportError`` or the library's own error where there is no OpenGL.
    """
    import moderngl

    context = moderngl.create_standalone_context(backend="egl")
    width, height = display_list.width, display_list.height
    target = context.simple_framebuffer((width, height), components=4)
    target.use()
    context.enable(moderngl.DEPTH_TEST)
    scale = 2.0 / (np.array([width, height]) * 2**display_list.sub_bits)
    vertices = np.concatenate([
        display_list.position.reshape(-1, 2) * scale - 1.0,
        display_list.depth.reshape(-1, 1) / 2.0**display_list.depth_bits * 2.0 - 1.0,
        display_list.color.reshape(-1, 3) / 255.0,
    ], axis=1).astype(np.float32)
    program = context.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
    array = context.vertex_array(program, context.buffer(vertices.tobytes()), "position", "color")

    def draw() -> None:
        target.clear(depth=1.0)
        array.render()
        target.read(components=4)

    return draw, str(context.info["GL_RENDERER"])


@click.command()
@click.option("--triangles", default=50_000, show_default=True)
@click.option("--pixels", default=3.0, show_default=True, help="Side of a triangle's box.")
@click.option("--size", default=512, show_default=True, help="Width and height of the picture.")
@click.option("--runs", default=15, show_default=True)
def main(triangles: int, pixels: float, size: int, runs: int) -> None:
    """Time the exact reference picture.

    \b
    Examples:
      python -m testbenches.studies.golden_benchmark
      python -m testbenches.studies.golden_benchmark --triangles 1000 --pixels 800 --runs 1
    """
    display_list = make_display_list(f"random:n={triangles},size={pixels}", width=size,
                                     height=size).display_list
    fragments = int(exact.depth_complexity(display_list).sum())
    click.echo(f"{triangles:,} triangles, {fragments:,} fragments, {size}x{size}")
    drawers: dict[str, Callable[[], object]] = {"exact": lambda: exact.draw(display_list)}
    try:
        draw, name = opengl_drawer(display_list)
        drawers[name.partition(" (")[0]] = draw
    except Exception as error:  # no library, no driver: the drivers' errors have no common type
        click.echo(f"no OpenGL to compare with: {error}; pip install 'cardcage[opengl]'")
    times: dict[str, list[float]] = {name: [] for name in drawers}
    for _ in range(runs + 1):  # in turn; the first time is not counted
        for name, function in drawers.items():
            began = time.perf_counter()
            function()
            times[name].append(1e3 * (time.perf_counter() - began))
    for name, figures in times.items():
        counted = figures[1:]
        click.echo(f"{name:14} best {min(counted):7.1f} ms, median {median(counted):7.1f} ms")
    if len(times) == 2:
        ours, theirs = (median(figures[1:]) for figures in times.values())
        click.echo(f"ratio of the medians {ours / theirs:.2f}")


if __name__ == "__main__":
    main()
