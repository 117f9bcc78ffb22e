"""How the screen is cut up for so many processors and a granularity ratio."""

from __future__ import annotations

import math

import numpy as np

from .....golden.balancing.region_grid import RegionGrid
from .models import Size

#: Along figure 4, and its curves: regions a processor.
PROCESSORS = (2, 4, 8, 16, 32, 64, 128, 256, 512)
RATIOS = (1, 2, 3, 4, 6, 8, 12)

#: Pixels of a region's side, below which a grid is left out.
LEAST_SIDE = 4


def screen_grid(size: Size, regions: int) -> RegionGrid:
    """So many regions as nearly square as they can be, of two that are equally so the wider ones;
    their sides differ by a pixel where the screen's do not divide."""
    columns = _columns(size, regions)
    return cut(size, columns, regions // columns)


def _columns(size: Size, regions: int) -> int:
    width, height = size

    def elongation(columns: int) -> float:
        return round(abs(math.log(width * regions / (height * columns**2))), 9)

    divisors = (columns for columns in range(1, regions + 1) if regions % columns == 0)
    return min(divisors, key=lambda columns: (elongation(columns), columns))


def cut(size: Size, columns: int, rows: int) -> RegionGrid:
    """So many columns and rows of regions, as equal as whole pixels allow."""
    width, height = size
    return RegionGrid(np.arange(columns + 1) * width // columns,
                      np.arange(rows + 1) * height // rows)


def fits(size: Size, regions: int) -> bool:
    """Whether none has a side of less than ``LEAST_SIDE`` pixels."""
    columns = _columns(size, regions)
    return (size[0] // columns >= LEAST_SIDE
            and size[1] // (regions // columns) >= LEAST_SIDE)


def processors_for(size: Size) -> list[int]:
    """Those of ``PROCESSORS`` for which there is a grid at every ratio."""
    return [each for each in PROCESSORS if all(fits(size, each * ratio) for ratio in RATIOS)]
