"""Whole pictures only: what the scans show while frames come and go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.configuration import MachineConfiguration
from ..engines.engine import Scan
from .violation import ProtocolError


def check_scans(scans: Sequence[Scan], clear: int, ended: Sequence[int],
                shown: Sequence[int]) -> None:
    """Raise ``ProtocolError`` where a scan shows what it must not.

    ``clear`` is the first cycle from which both pictures are black; ``ended`` when each
    ``FRAME_END`` was taken, ``shown`` when its ``FRAME_SHOWN`` was.  From ``shown`` until the next
    ``ended`` all scans are one picture, before the first ``ended`` black; in between, each is
    either the picture before or the one after.
    """
    pictures: list[NDArray[np.uint8] | None] = []
    begins = [clear, *shown]
    for number, begin in enumerate(begins):
        end = ended[number] if number < len(ended) else None
        stable = [scan for scan in scans
                  if scan.cycle >= begin and (end is None or scan.cycle < end)]
        picture = stable[0].picture if stable else None
        if number == 0 and scans:
            picture = np.zeros_like(scans[0].picture)
        for scan in stable:
            assert picture is not None
            if not np.array_equal(scan.picture, picture):
                raise ProtocolError(_torn(scan, picture, f"picture {number}"))
        pictures.append(picture)
    for number, (end, begin) in enumerate(zip(ended, shown, strict=False)):
        before, after = pictures[number], pictures[number + 1]
        if before is None or after is None:
            continue
        for scan in scans:
            if end <= scan.cycle < begin and not any(
                    np.array_equal(scan.picture, whole) for whole in (before, after)):
                raise ProtocolError(_torn(scan, before, f"picture {number} or the next"))


def owned_pixels(configuration: MachineConfiguration) -> NDArray[np.bool_]:
    """(height, width), highest resolution: pixels whose memory unit has a processing element.

    Nobody draws the others.
    """
    organisation = organisation_of(configuration)
    return organisation.video(organisation.owned_pixels)


def masked(scans: Sequence[Scan], owned: NDArray[np.bool_]) -> list[Scan]:
    """The scans with every pixel black that nobody owns."""
    return [replace(scan, picture=scan.picture * owned[..., np.newaxis]) for scan in scans]


def _torn(scan: Scan, expected: NDArray[np.uint8], name: str) -> str:
    y, x = np.argwhere((scan.picture != expected).any(axis=-1))[0]
    return f"cycle {scan.cycle}: this scan is not whole {name}: pixel ({x}, {y}) differs"
