"""What differs from one organisation of the cage to another, asked for in one place.

Simulation, comparison, the cycle model, reports and the take-home bench ask an ``Organisation``
and nothing else where a pixel lies and whose it is.  A new organisation is a class here and an
entry in ``organisation_of``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, TypedDict, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..specification.commands import Fault
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .object_shares import ObjectShares
from .shares import Shares

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]
Coordinate = TypeVar("Coordinate", int, NDArray[np.int64])


class Shifts(TypedDict):
    """The resolution as the golden models take it."""

    x_shift: int
    y_shift: int


class Resolution(NamedTuple):
    """The picture that a cage draws: ``width`` by ``height`` pixels, each of them ``2**x_shift`` by
    ``2**y_shift`` pixels of the highest resolution."""

    width: int
    height: int
    x_shift: int
    y_shift: int

    @property
    def shifts(self) -> Shifts:
        """For the golden models: ``draw(display_list, **resolution.shifts)``."""
        return {"x_shift": self.x_shift, "y_shift": self.y_shift}


class Domain(NamedTuple):
    """The memory units of one processing element: ``units`` of them in ``node``, from number
    ``first`` on."""

    node: int
    first: int
    units: int


class ElementBlock(NamedTuple):
    """Pixels that a processing element walks as one lattice: those of ``units`` of its units.

    The lattice is of squares ``2**square_bits`` pixels wide, ``2**x_bits`` and ``2**y_bits``
    squares apart, from an offset in squares.

    ``element``      which of the processing elements
    ``place``        counts the blocks of one processing element
    ``shifted``      every other row, from the second on, has its pixels half as far to the side
    ``alternating``  neighbours in a row of the lattice lie in different units
    """

    element: int
    place: int
    x_offset: int
    y_offset: int
    x_bits: int
    y_bits: int
    square_bits: int
    shifted: bool
    units: int
    alternating: bool

    def x_offset_of(self, row: int) -> int:
        """``x_offset`` in a row of squares that has pixels of the block."""
        further = self.shifted and row >> self.y_bits & 1
        return self.x_offset ^ (1 << self.x_bits >> 1 if further else 0)


class Organisation(ABC):
    """One cage: who draws primitive i, where a pixel lies, who shows it, what is read back.

    A node of ``units`` memory units keeps pixel (x, y) in the unit ``unit(x, y)`` at the word
    ``word(x, y)``, x and y at the resolution the cage draws at.
    """

    #: What reports and ``machine.json`` call it.
    name: ClassVar[str]

    #: It has nodes, which it reports at boot, and makes one picture of what they draw.
    merges: ClassVar[bool] = False

    #: That is done when drawing is, and takes clocks of its own.
    merges_after_drawing: ClassVar[bool] = False

    def __init__(self, configuration: MachineConfiguration) -> None:
        self.configuration = configuration

    @property
    @abstractmethod
    def resolution(self) -> Resolution:
        """What the cage reports at boot."""

    @property
    @abstractmethod
    def fault(self) -> Fault | None:
        """Why the cage is refused: it boots, answers this and draws nothing; of what follows only
        ``domains`` and ``node_units`` can be asked.  None where it draws."""

    def dealt(self, table: Sequence[int] | Int64 | None) -> Organisation:
        """The same cage, as it is while a picture that was drawn by ``table`` is shown or read
        back: the processing element of each region, row by row; None where nothing is said of it.
        Only regions that are dealt out change places."""
        return self

    @property
    @abstractmethod
    def each(self) -> tuple[Organisation, ...]:
        """What each node is by itself: a cage of one node, whose domains, blocks and owners are
        numbered from 0."""

    @property
    @abstractmethod
    def node_units(self) -> tuple[int, ...]:
        """Memory units that each node draws into."""

    @property
    @abstractmethod
    def words(self) -> int:
        """Words of each memory unit that hold the picture."""

    @property
    @abstractmethod
    def domains(self) -> tuple[Domain, ...]:
        """The domain of each processing element, left to right; in this order the elements
        report them at boot and answer ``READ_COUNTERS``."""

    @abstractmethod
    def unit(self, x: Coordinate, y: Coordinate) -> Coordinate:
        """The number, in its node, of the memory unit that holds a pixel."""

    @abstractmethod
    def word(self, x: Coordinate, y: Coordinate) -> Coordinate:
        """The address at which the unit holds it."""

    @abstractmethod
    def pixel(self, unit: Coordinate, word: Coordinate) -> tuple[Coordinate, Coordinate]:
        """x and y of the pixel that a unit holds at a word; a word without one gives a pixel off
        the picture."""

    @abstractmethod
    def is_scanned(self, node: int) -> bool:
        """The video output reads the memory of that node."""

    @property
    @abstractmethod
    def depths_read_back(self) -> int:
        """Responses to ``READ_DEPTH``."""

    @abstractmethod
    def depth_image(self, depths: Any) -> Int64:
        """Depths in the order of the read-back, put where their pixels are: int64 (height, width),
        -1 where the pixel is not what all processing elements together have drawn."""

    @property
    @abstractmethod
    def owned_pixels(self) -> Bool:
        """bool (height, width): pixels that are what all processing elements together have
        drawn; none of their memory units is nobody's."""

    @property
    @abstractmethod
    def blocks(self) -> tuple[ElementBlock, ...]:
        """The blocks of every processing element, in the order in which it walks them."""

    @property
    @abstractmethod
    def scan_tile(self) -> Int64:
        """int64 (rows, columns): the unit of each pixel of a piece that repeats over the
        picture."""

    @property
    @abstractmethod
    def scan_group(self) -> int:
        """Pixels side by side for which a unit reads once, as the first of them is scanned."""

    @property
    @abstractmethod
    def scan_reads_per_line(self) -> int:
        """Scan reads of a memory unit in a line of the picture, at worst."""

    # What follows from these.

    @cached_property
    def owners(self) -> Int64:
        """int64 (nodes, units): the processing element that draws into each unit, or -1."""
        owners = np.full((self.nodes, max(self.node_units)), -1)
        for element, (node, first, units) in enumerate(self.domains):
            owners[node, first:first + units] = element
        return owners

    @property
    def shares_differ(self) -> bool:
        """Some processing element has not as many memory units as its cards, which interlace by
        equal shares, were built for."""
        configuration = self.configuration
        return configuration.equal_shares and any(
            domain.units != 1 << configuration.share_bits for domain in self.domains)

    @property
    def refused(self) -> bool:
        """The cage boots, but draws nothing."""
        return self.fault is not None

    @property
    def nodes(self) -> int:
        return len(self.node_units)

    @property
    def merge_steps(self) -> int:
        """Steps of merging after drawing, one after another; 0 where none is."""
        return 0

    @property
    def memory_units(self) -> int:
        """Those that anybody draws into, and those of nobody."""
        return sum(self.node_units)

    @property
    def units(self) -> int:
        """Memory units of a node, where all have as many."""
        return self.node_units[0]

    def shares(self, display_list: DisplayList) -> Shares:
        """Which node draws each triangle of a display list."""
        kind = ObjectShares if self.configuration.objects == "nodes" else Shares
        return kind.of(display_list, self.nodes, self.configuration.packet)

    @property
    def owned_units(self) -> int:
        """Memory units that some processing element draws into."""
        return sum(domain.units for domain in self.domains)

    def video(self, picture: NDArray[Any]) -> NDArray[Any]:
        """A picture (height, width, …) at the cage's resolution as the scan shows it: each pixel as
        often as the highest resolution has it."""
        _, _, x_shift, y_shift = self.resolution
        whole = picture.repeat(1 << y_shift, axis=0).repeat(1 << x_shift, axis=1)
        return whole[:self.configuration.height, :self.configuration.width]

    def video_pixel(self, x: int, y: int) -> tuple[int, int]:
        """The pixel of the cage's resolution that pixel (x, y) of the video output shows."""
        return x >> self.resolution.x_shift, y >> self.resolution.y_shift
