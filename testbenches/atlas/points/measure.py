"""The pure function of the atlas: points in, figures or the reason why there are none out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby

from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.errors import InputError
from ...support.machine_error import MachineError
from ...support.measurement_cache import package_hash
from .atlas_point import AtlasPoint, Failure, Figures
from .model_figures import Work, model_figures, of_any_precision, work_of
from .node_check import node_check
from .rtl_figures import rtl_figures

Outcome = Figures | Failure


@dataclass(frozen=True)
class Batch:
    """Points that are measured by one process, since they share most of the work: they differ in
    precision alone.  ``release`` is the package's that asks."""

    points: tuple[AtlasPoint, ...]
    release: str

    @property
    def label(self) -> str:
        return self.points[0].label


def batches(points: Iterable[AtlasPoint], release: str) -> list[Batch]:
    """Points that follow one another together, where only one works them out."""
    return [Batch(tuple(some), release) for _, some in groupby(
        points, lambda point: (point.scene, point.cage))]


def measure(batch: Batch) -> list[Outcome]:
    """What is found of each point; it reads no file but those of the package, and keeps none.

    Raises ``InputError`` in a process that has another release of the package.
    """
    if package_hash() != batch.release:
        raise InputError("--cluster: a worker has another release of Cardcage, or its sources were "
                         "changed meanwhile; install on all machines the same")
    works: dict[MachineConfiguration, Work] = {}
    return [_measured(point, works) for point in batch.points]


def _measured(point: AtlasPoint, works: dict[MachineConfiguration, Work]) -> Outcome:
    """``works``, by machine of any precision, are looked up and added to."""
    try:
        configuration = point.machine()
        same = of_any_precision(configuration)
        if same not in works:
            works[same] = work_of(configuration, point.scene.load().display_list,
                                  point.cage.retained)
        figures = model_figures(point, configuration, works[same])
        if point.simulate:
            figures = rtl_figures(point, figures)
        if point.check_node:
            figures = figures | {"node_check": node_check(point, configuration)}
        return figures
    except InputError as error:
        return Failure(str(error), failed=False)
    except MachineError as error:
        return Failure(str(error), failed=True)
    except Exception as error:  # one point must not stop the others
        return Failure(f"{type(error).__name__}: {error}", failed=True)
