"""About how many clocks a whole frame takes, from reset until it is shown and read back.

``predict_frame`` adds up ``cycle_estimate`` for the drawing and what the components state for
boot and read-back; ``most_frame_clocks`` is more than any machine that works ever takes.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .broadcast import SetupTiming
from .cycle_estimate import estimate_cycles
from .merge_clocks import predict_merge
from .one_port.scan_reads import scan_share

#: Clocks in which a processing element surveys a unit of its own, and finds that one is not.
SURVEYED_UNIT = 8
SURVEY_END = 4

#: Clocks from the word of a depth to the next one, where the host reads them back.
READ_BACK = 2

#: Divisions that set-up in hardware makes for a triangle, one after another.
DIVISIONS = 3


@dataclass(frozen=True)
class FrameClocks:
    """The parts of a frame, in clocks.

    ``boot``       from reset until both pictures are clear
    ``draw``       from the frame's start to the last fragment
    ``scan``       of one scan
    ``read_back``  of all depths
    ``merge``      from the last fragment until the nodes' pictures are one
    """

    boot: int
    draw: int
    scan: int
    read_back: int
    merge: int = 0

    @property
    def shown(self) -> int:
        """The picture is swapped at the start of the first scan that finds it complete."""
        return ((self.boot + self.draw + self.merge) // self.scan + 1) * self.scan

    @property
    def total(self) -> int:
        """Until the picture has been scanned whole, and all depths are there."""
        return self.shown + max(self.scan, self.read_back)


def predict_frame(configuration: MachineConfiguration, display_list: DisplayList,
                  setup: SetupTiming | None = None) -> FrameClocks:
    """A guess, within a third or so, at what a frame of ``display_list`` takes.

    ``setup`` is the machine's own set-up, or None where the triangles come prepared.
    """
    organisation = organisation_of(configuration)
    survey = SURVEYED_UNIT * max(domain.units for domain in organisation.domains) + SURVEY_END
    # Nodes that make the triangles of their objects do so side by side, as from lists.
    estimate = estimate_cycles(configuration, display_list,
                               retained=configuration.objects == "nodes")
    draw = estimate.total
    if setup is not None:
        draw = max(draw, setup.interval * estimate.broadcast + setup.latency)
    return FrameClocks(
        # A word is cleared in each clock that is not the scan's.
        boot=round(survey + configuration.words / (1 - scan_share(configuration))),
        draw=draw,
        scan=configuration.cycles_per_scan,
        read_back=READ_BACK * organisation.depths_read_back,
        merge=predict_merge(configuration, display_list),
    )


def most_frame_clocks(configuration: MachineConfiguration, commands: int) -> int:
    """More clocks than any frame of so many commands can take: beyond, the machine hangs.

    Every triangle waits for its divisions and covers the screen, every pixel costs a scan slot,
    a read and a write, likewise in each step of a merge; then the stalls of the most patient host,
    and some scans.
    """
    organisation = organisation_of(configuration)
    steps = organisation.merge_steps
    pixels = configuration.width * configuration.height
    divisions = DIVISIONS * configuration.setup_interval
    per_command = (6 + 3 * steps) * pixels + 16 * configuration.height + 64 + divisions
    return (1000 + (commands + 4) * per_command
            + 30 * organisation.depths_read_back
            + 4 * configuration.cycles_per_scan)
