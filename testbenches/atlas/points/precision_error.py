"""How far the picture of a machine with few fraction bits is off."""

from __future__ import annotations

from dataclasses import asdict
from functools import lru_cache
from math import ceil
from typing import Any

from ....golden.organisations.organisation_of import organisation_of
from ....golden.planning.scene_needs import scene_needs, with_sub_bits
from ....golden.precision.precision_study import picture_error
from ....golden.reference import bit_true, exact
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.display_list import Shading
from ....golden.specification.fixed_point import error_bound
from ....golden.specification.picture import Picture
from .atlas_scene import AtlasScene

Shifts = tuple[tuple[str, int], ...]


def precision_error(scene: AtlasScene, configuration: MachineConfiguration) -> dict[str, Any]:
    """Against the exact picture at the machine's resolution, which is the same on all cages.

    ``bound`` in LSB, 0 where the scene is exact; then the fields of ``PictureError``.
    """
    resolution = organisation_of(configuration).resolution
    shifts: Shifts = ("x_shift", resolution.x_shift), ("y_shift", resolution.y_shift)
    listed = with_sub_bits(scene.load().display_list, configuration.sub_bits)
    needs = scene_needs(listed, **dict(shifts))
    bits = configuration.fraction_bits
    if bits >= needs.exact_fraction_bits:
        bits = -1
    error = _error(scene, configuration.sub_bits, configuration.shading, shifts, bits)
    return {"bound": 0 if bits < 0 else ceil(error_bound(bits, needs.extent))} | error


@lru_cache(maxsize=32)
def _error(scene: AtlasScene, sub_bits: int, shading: Shading, shifts: Shifts,
           fraction_bits: int) -> dict[str, Any]:
    """``fraction_bits`` of the machine, -1 for one that is exact."""
    right = _exact(scene, shading, shifts)
    got = right
    if fraction_bits >= 0:
        got = bit_true.draw(with_sub_bits(scene.load().display_list, sub_bits),
                            fraction_bits=fraction_bits, shading=shading, **dict(shifts))
    return asdict(picture_error(got, right.winner, right.depth, right.color))


@lru_cache(maxsize=8)
def _exact(scene: AtlasScene, shading: Shading, shifts: Shifts) -> Picture:
    return exact.draw(scene.load().display_list, shading=shading, **dict(shifts))
