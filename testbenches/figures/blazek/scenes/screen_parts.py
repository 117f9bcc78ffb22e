"""How the screen is cut up among nodes, and what each has to draw of each sphere."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .....golden.balancing.region_grid import RegionGrid
from ...ellsworth.dealing.screen_grids import cut, screen_grid
from .sphere_work import SphereTemplate, Work
from .spheres import Size

#: Horizontal strips, rectangles as nearly square as they can be, or every n-th line.
Parts = Literal["strips", "grid", "lines"]


def screen_grid_of(size: Size, nodes: int, parts: Parts) -> RegionGrid:
    """A rectangle for each node, row by row; not of lines."""
    return cut(size, 1, nodes) if parts == "strips" else screen_grid(size, nodes)


def work_in_parts(template: SphereTemplate, places: NDArray[np.int64], size: Size, nodes: int,
                  parts: Parts) -> Work:
    """(spheres, nodes) each, of spheres about ``places``."""
    if parts == "lines":
        return template.in_lines(places[:, 1], nodes)
    grid = screen_grid_of(size, nodes, parts)
    rows, columns = np.divmod(np.arange(nodes), grid.columns)
    x, y = places[:, :1], places[:, 1:]
    return template.in_rectangles(grid.x[columns] - x, grid.y[rows] - y,
                                  grid.x[columns + 1] - x, grid.y[rows + 1] - y)
