"""Speed-up and efficiency, whatever the time is measured in."""

from __future__ import annotations

from abc import ABC, abstractmethod

from .spheres import NODES


class SpeedUps(ABC):
    """A method on a machine.  He prints efficiency as "the product of speed-up and the number of
    processors"; what he means, and what it is here, is the quotient.

    ``name``  of the method
    """

    name: str

    @abstractmethod
    def time(self, spheres: int, nodes: int) -> float:
        """Of a frame."""

    @abstractmethod
    def merging(self, spheres: int, nodes: int) -> float:
        """Of that time, from the last node's drawing until one picture is there."""

    def speed_up(self, spheres: int, nodes: int) -> float:
        """Against one node by the same method."""
        return self.time(spheres, 1) / self.time(spheres, nodes)

    def efficiency(self, spheres: int, nodes: int) -> float:
        """Speed-up over nodes."""
        return self.speed_up(spheres, nodes) / nodes

    def curve(self, spheres: int) -> list[float]:
        """Speed-up along ``NODES``."""
        return [self.speed_up(spheres, nodes) for nodes in NODES]

    def efficiencies(self, spheres: int) -> list[float]:
        """Along ``NODES``."""
        return [self.efficiency(spheres, nodes) for nodes in NODES]
