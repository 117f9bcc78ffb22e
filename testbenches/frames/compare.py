"""The machine's frame against the golden picture, value for value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...golden.organisations.organisation_of import organisation_of
from ...golden.planning.scene_needs import fitted
from ...golden.reference import bit_true, exact
from ...golden.reference.triangle_setup import scene_fraction_bits
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.picture import Picture
from .responses import Simulation

Color = tuple[int, int, int]


@dataclass(frozen=True)
class PixelValue:
    """What a pixel shows and how far away it is."""

    color: Color
    depth: int


@dataclass(frozen=True)
class FirstDifference:
    """The first pixel in raster order whose colour or depth is wrong.

    ``pixel``          x, y at the highest resolution, as on the video pins
    ``machine_pixel``  x, y at the resolution the machine draws at
    ``winner``         the primitive that should be seen there; -1 for the background
    ``fragments``      everything that fell on it, in drawing order, with its exact values
    """

    pixel: tuple[int, int]
    machine_pixel: tuple[int, int]
    expected: PixelValue
    got: PixelValue
    winner: int
    fragments: exact.Fragments


@dataclass(frozen=True, eq=False)
class Comparison:
    """A frame judged.

    ``golden``               the picture the machine must equal, at the machine's resolution: the
                             exact one, or the bit-true one where the machine has fewer fraction
                             bits than the scene needs
    ``exact_fraction_bits``  what the scene needs
    ``expected``             uint8 (height, width, 3): ``golden`` as the video pins show it
    ``color_different``      bool (height, width), highest resolution
    ``depth_different``      bool (h, w), machine's resolution
    ``color_orphans``, ``depth_orphans``  bool: pixels of units no processing element owns; they
                             are not compared
    ``depth_max_error``      greatest difference from the *exact* depth, in LSB
    ``color_max_error``      greatest difference of a channel from the *exact* colour
    """

    golden: Picture
    exact_fraction_bits: int
    expected: NDArray[np.uint8]
    color_different: NDArray[np.bool_]
    depth_different: NDArray[np.bool_]
    color_orphans: NDArray[np.bool_]
    depth_orphans: NDArray[np.bool_]
    depth_max_error: int
    color_max_error: int
    first_difference: FirstDifference | None

    @property
    def equal(self) -> bool:
        return self.first_difference is None

    @property
    def pixels_compared(self) -> int:
        return int((~self.color_orphans).sum())

    @property
    def pixels_different(self) -> int:
        return int(self.color_different.sum())

    @property
    def depths_compared(self) -> int:
        return int((~self.depth_orphans).sum())

    @property
    def depths_different(self) -> int:
        return int(self.depth_different.sum())


def compare(configuration: MachineConfiguration, display_list: DisplayList,
            simulation: Simulation) -> Comparison:
    """Judge ``simulation``, a frame of ``display_list`` drawn by a machine of ``configuration``.

    Colour is compared as it left the video pins, at the highest resolution; depth as it was read
    back, if it was, at the machine's.  Raises ``InputError`` for a list that is too wide for the
    machine.

    >>> import cardcage
    >>> machine = cardcage.MachineConfiguration(cards="PM", width=16, height=16, fraction_bits=28)
    >>> scene = cardcage.make_display_list("tetra:depth=0", width=16, height=16)
    >>> simulation = cardcage.simulate_frame(machine, scene.display_list, engine="pysim")
    >>> cardcage.compare(machine, scene.display_list, simulation).equal
    True
    """
    organisation = organisation_of(configuration)
    shifts = organisation.resolution.shifts
    reference = exact.draw(display_list, shading=configuration.shading, **shifts)
    fitting = fitted(configuration, display_list)
    needed = scene_fraction_bits(fitting, **shifts)
    golden = reference
    if configuration.fraction_bits < needed:
        golden = bit_true.draw(fitting, fraction_bits=configuration.fraction_bits,
                               shading=configuration.shading, **shifts)
    expected = organisation.video(golden.color)
    depth = simulation.depth
    if depth is None:  # nothing of it is compared
        depth = np.full_like(golden.depth, -1)
        color_orphans = organisation.video(~organisation.owned_pixels)
    else:
        color_orphans = organisation.video(depth < 0)
    depth_orphans = depth < 0
    color_different = (simulation.video != expected).any(axis=2) & ~color_orphans
    depth_different = (depth != golden.depth) & ~depth_orphans
    return Comparison(
        golden=golden,
        exact_fraction_bits=needed,
        expected=expected,
        color_different=color_different,
        depth_different=depth_different,
        color_orphans=color_orphans,
        depth_orphans=depth_orphans,
        depth_max_error=_greatest(depth, reference.depth, ~depth_orphans),
        color_max_error=_greatest(simulation.video, organisation.video(reference.color),
                                  ~color_orphans),
        first_difference=_first_difference(
            configuration, display_list, simulation.video, depth, golden,
            color_different | organisation.video(depth_different)),
    )


def _greatest(got: NDArray[np.integer], wanted: NDArray[np.integer],
              compared: NDArray[np.bool_]) -> int:
    error = abs(got.astype(np.int64) - wanted.astype(np.int64))[compared]
    return int(error.max(initial=0))


def _first_difference(
    configuration: MachineConfiguration,
    display_list: DisplayList,
    video: NDArray[np.uint8],
    depth: NDArray[np.int64],
    golden: Picture,
    different: NDArray[np.bool_],
) -> FirstDifference | None:
    """``different``: bool (height, width) at the highest resolution."""
    if not different.any():
        return None
    y, x = (int(index) for index in np.unravel_index(different.argmax(), different.shape))
    organisation = organisation_of(configuration)
    column, row = organisation.video_pixel(x, y)
    return FirstDifference(
        pixel=(x, y),
        machine_pixel=(column, row),
        expected=PixelValue(_color(golden.color[row, column]), int(golden.depth[row, column])),
        got=PixelValue(_color(video[y, x]), int(depth[row, column])),
        winner=int(golden.winner[row, column]),
        fragments=exact.fragments(
            display_list, shading=configuration.shading, pixel=(column, row),
            **organisation.resolution.shifts),
    )


def _color(channels: NDArray[np.uint8]) -> Color:
    red, green, blue = (int(channel) for channel in channels)
    return red, green, blue
