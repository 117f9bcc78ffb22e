"""Memory units that send what was drawn into them, in software."""

from itertools import zip_longest

from .bench import Agent
from .streams import no_pause


class Units(Agent):
    """Units that each have ``pixels[unit]`` to send, the first after ``first()`` clocks, the others
    each after ``gap()``; they settle after ``settle()`` clocks."""

    def __init__(self, lines, pixels, *, first=no_pause, gap=no_pause, settle=no_pause):
        self.lines, self.gap = lines, gap
        self.pixels = [list(pixels_of_unit) for pixels_of_unit in pixels]
        self.waits = [first() for _ in pixels]
        self.settle = settle()
        self.clock = 0
        self.started = None

    @property
    def finished(self):
        return self.started is not None and not any(self.pixels)

    def drive(self, ctx):
        lines, unit = self.lines, ctx.get(self.lines.unit)
        going = self.started is not None and self.clock > self.started
        left = self.pixels[unit] if going and unit < len(self.pixels) else []
        valid = bool(left) and self.waits[unit] == 0
        ctx.set(lines.settled, self.clock >= self.settle)
        ctx.set(lines.valid, valid)
        ctx.set(lines.pixel, left[0] if valid else dict.fromkeys(("address", "depth", "color"), 0))
        ctx.set(lines.more, len(left) > valid)
        self.offered = left if valid else None

    def sample(self, ctx):
        if ctx.get(self.lines.start):
            assert self.started is None and self.clock >= self.settle
            self.started = self.clock
        elif self.started is not None:
            self.waits = [max(0, wait - 1) for wait in self.waits]
        if self.offered and ctx.get(self.lines.ready):
            self.offered.pop(0)
            self.waits[ctx.get(self.lines.unit)] = self.gap()
        self.clock += 1


def random_pixels(pick, most, *, address_bits=5, depth_bits=9):
    """Up to ``most`` of one unit."""
    return [{"address": pick.getrandbits(address_bits), "depth": pick.getrandbits(depth_bits),
             "color": pick.getrandbits(24)} for _ in range(pick.randint(0, most))]


def in_turn(pixels):
    """(unit, pixel) of all, as a node sends them: two units at a time, and of these in turn."""
    own = [[(unit, pixel) for pixel in of_unit] for unit, of_unit in enumerate(pixels)]
    return [sent for first in range(0, len(own), 2) for turn in zip_longest(*own[first:first + 2])
            for sent in turn if sent is not None]
