"""Small sweeps of the atlas, and what measures them badly: for processes that import it."""

import os
import signal
from pathlib import Path

from cardcage.testbenches.atlas.atlas import AtlasOptions
from cardcage.testbenches.atlas.points.measure import measure

#: A file in the folder that this environment variable names says that a process has ended already.
ONCE = "CARDCAGE_TEST_ONCE"

#: The cage whose process ends.
UNLUCKY = "2x(PMT)"

SMALL = AtlasOptions(scenes=("tetra:depth=1",), sizes=((16, 16),), fraction_bits=("exact",),
                     cages=("PM", "2x(PMC)", UNLUCKY, "2x(PMS)F", "2xPD2xM", "2x(PM)/2x2"),
                     retain=False)


def labels(found):
    """Points by their labels: in order, what was found."""
    return {point.label: outcome for point, outcome in found.items()}


def ends_once(batch):
    """The first process that comes to the unlucky cage is ended from outside."""
    if batch.points[0].cage.label == UNLUCKY:
        marker = Path(os.environ[ONCE], "ended")
        if not marker.exists():
            marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)
    return measure(batch)


def ends_always(batch):
    """Every process that comes to it."""
    if batch.points[0].cage.label == UNLUCKY:
        os.kill(os.getpid(), signal.SIGKILL)
    return measure(batch)


def fails(batch):
    """The call itself goes wrong at the unlucky cage."""
    if batch.points[0].cage.label == UNLUCKY:
        raise ArithmeticError("nobody foresaw this")
    return measure(batch)
