"""Small display lists to plan machines for."""

import random

import numpy as np

from cardcage.golden.specification.display_list import DisplayList

CARDS = "2x(PMM)"


def triangles(*positions, depth=100, color=(10, 20, 30), width=16, height=16, sub_bits=4,
              depth_bits=12):
    """A display list from corners in sub-pixel units, each of one depth and one colour."""
    count = len(positions)
    return DisplayList(
        width=width, height=height, sub_bits=sub_bits, depth_bits=depth_bits,
        position=np.array(positions, np.int32).reshape(count, 3, 2),
        depth=np.full((count, 3), depth, np.int64),
        color=np.broadcast_to(np.array(color, np.uint8), (count, 3, 3)).copy())


def random_list(seed, count=20, *, width=16, height=16, sub_bits=4, depth_bits=12, even=0):
    """Large and small triangles, some into the corners of the guard band; coordinates are
    multiples of ``2**even``."""
    source = random.Random(f"plan {seed}")
    limit = 1 << ((max(width, height) - 1).bit_length() + 1 + sub_bits)
    position = []
    for _ in range(count):
        reach = source.choice([3 << sub_bits, width << sub_bits, limit])
        near = [source.randrange(size << sub_bits) for size in (width, height)]
        position.append([[max(-limit, min(limit - 1, near[axis] + source.randint(-reach, reach)))
                          >> even << even for axis in range(2)] for _ in range(3)])
    numbers = np.random.default_rng(seed)
    return DisplayList(
        width=width, height=height, sub_bits=sub_bits, depth_bits=depth_bits,
        position=np.array(position, np.int32),
        depth=numbers.integers(0, (1 << depth_bits) - 1, (count, 3)),
        color=numbers.integers(0, 256, (count, 3, 3)).astype(np.uint8))
