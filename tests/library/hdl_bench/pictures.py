"""Small machines, random display lists, and which pixels a triangle covers, by definition."""

import random
from fractions import Fraction
from math import floor

import numpy as np

from cardcage.golden.reference import triangle_setup as setup
from cardcage.golden.specification import commands
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.video_timing import compact_timing


def small_machine(cards="PM", width=8, height=8, **changes):
    """A configuration that simulates fast."""
    fields = {"sub_bits": 2, "depth_bits": 8, "fraction_bits": 6, "shading": "flat",
              "fifo_depth": 4, "clocks_per_pixel": 2, "timing": compact_timing(width, height)}
    return MachineConfiguration(cards=cards, width=width, height=height, **fields | changes)


def random_triangles(seed, count, *, width, height, sub_bits=2, depth_bits=8, flat=False,
                     extreme=False):
    """Large and small triangles, slivers, coordinates on pixel centres, some off the screen.

    ``extreme``: some more that reach into the corners of the guard band.
    """
    source = random.Random(f"triangles {seed}")
    unit = 1 << sub_bits
    limit = 1 << ((max(width, height) - 1).bit_length() + 1 + sub_bits)

    def vertex(kind, near):
        if kind == "guard":
            return [source.choice((-limit, limit - 1, source.randrange(-limit, limit)))
                    for _ in range(2)]
        if kind == "small":
            return [near[axis] + source.randrange(-2 * unit, 2 * unit + 1) for axis in range(2)]
        if kind == "centres":
            return [source.randrange(-1, size + 1) * unit + unit // 2 for size in (width, height)]
        if kind == "sliver":
            step = source.randrange(-unit * width, unit * width)
            return [near[0] + step, near[1] + step + source.randrange(-unit // 2, unit // 2 + 1)]
        return [source.randrange(-unit * 2, unit * (size + 2)) for size in (width, height)]

    kinds = ["large", "large", "small", "centres", "sliver"] + ["guard"] * extreme
    position, depth, color = [], [], []
    for _ in range(count):
        kind = source.choice(kinds)
        near = [source.randrange(unit * width), source.randrange(unit * height)]
        position.append([[max(-limit, min(limit - 1, c)) for c in vertex(kind, near)]
                         for _ in range(3)])
        depth.append([source.randrange((1 << depth_bits) - 1) for _ in range(3)])
        colors = [[source.randrange(256) for _ in range(3)] for _ in range(3)]
        color.append([colors[0]] * 3 if flat else colors)
    return DisplayList(
        width=width, height=height, sub_bits=sub_bits, depth_bits=depth_bits,
        position=np.array(position, np.int32).reshape(-1, 3, 2),
        depth=np.array(depth, np.int64).reshape(-1, 3),
        color=np.array(color, np.uint8).reshape(-1, 3, 3),
        background=tuple(source.randrange(256) for _ in range(3)))


def prepared_values(configuration, prepared):
    """What the machine is told of each triangle, as nested dicts of non-negative integers."""
    edges = {name: setup.carry_edges(getattr(prepared, name),
                                     column_bits=configuration.edge_column_bits,
                                     fraction_bits=configuration.edge_fraction_bits)
             for name in commands.EDGES}

    def edge(carried, index):
        return {"start": int(carried.start[index]), "step": int(carried.step[index])}

    def plane(planes, index):
        return {part: int(getattr(planes, part)[index]) for part in ("start", "step_x", "step_y")}

    values = []
    for index in range(len(prepared)):
        if prepared.color is None:
            colors = [int(channel) for channel in prepared.flat_color[index]]
        else:
            colors = [plane(planes, index) for planes in prepared.color]
        values.append({
            **{name: int(getattr(prepared, name)[index])
               for name in ("top", "middle", "bottom", "left", "right", "long_edge_left")},
            **{name: edge(carried, index) for name, carried in edges.items()},
            "planes": {"depth": plane(prepared.depth, index),
                       **dict(zip(("red", "green", "blue"), colors, strict=True))},
        })
    return values


def prepare(configuration, display_list):
    """Set-up at the resolution the machine settles on."""
    interlace = configuration.interlace
    return setup.prepare(display_list, fraction_bits=configuration.fraction_bits,
                         shading=configuration.shading,
                         x_shift=interlace.x_shift, y_shift=interlace.y_shift)


def covered(display_list, primitive, interlace):
    """Pixels of one triangle by the definition: sample strictly inside, or on a top or left edge.

    Brute force over the picture, one pixel after the other.
    """
    corners = [tuple(map(int, corner)) for corner in display_list.position[primitive]]
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if area == 0:
        return set()
    if area < 0:
        corners.reverse()
    unit_x, unit_y = (1 << (display_list.sub_bits + shift)
                      for shift in (interlace.x_shift, interlace.y_shift))
    pixels = set()
    for y in range(interlace.height):
        for x in range(interlace.width):
            px, py = x * unit_x + unit_x // 2, y * unit_y + unit_y // 2
            for (fx, fy), (tx, ty) in zip(corners, corners[1:] + corners[:1], strict=True):
                # Clockwise as seen: inside is on the right hand of every edge.
                side = (tx - fx) * (py - fy) - (ty - fy) * (px - fx)
                top_or_left = (ty == fy and tx > fx) or ty < fy
                if side < 0 or (side == 0 and not top_or_left):
                    break
            else:
                pixels.add((x, y))
    return pixels


def plane_value(display_list, primitive, values, x, y, interlace):
    """The plane through three vertex ``values`` at a pixel's sample, rounded half up.

    By barycentric weights, as rational numbers.
    """
    (ax, ay), (bx, by), (cx, cy) = (tuple(map(int, corner))
                                    for corner in display_list.position[primitive])
    unit_x, unit_y = (1 << (display_list.sub_bits + shift)
                      for shift in (interlace.x_shift, interlace.y_shift))
    px, py = x * unit_x + unit_x // 2, y * unit_y + unit_y // 2
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    at_b = (px - ax) * (cy - ay) - (cx - ax) * (py - ay)
    at_c = (bx - ax) * (py - ay) - (px - ax) * (by - ay)
    first, second, third = map(int, values)
    value = first + Fraction((second - first) * at_b + (third - first) * at_c, area)
    return floor(value + Fraction(1, 2))


def exact_words(display_list, interlace, *, flat):
    """(depth, color) of every pixel with something drawn on it, and all fragments' pixels.

    The winner is the least (depth, primitive); brute force by the definitions.
    """
    words, fragments = {}, []
    for primitive in range(display_list.triangles):
        for x, y in covered(display_list, primitive, interlace):
            fragments.append((x, y))
            depth = plane_value(display_list, primitive, display_list.depth[primitive], x, y,
                                interlace)
            if (x, y) in words and words[x, y][0] <= depth:
                continue
            colors = display_list.color[primitive]
            channels = (map(int, colors[0]) if flat else
                        (plane_value(display_list, primitive, colors[:, channel], x, y, interlace)
                         for channel in range(3)))
            words[x, y] = depth, sum(value << 8 * place for place, value in enumerate(channels))
    return words, fragments
