"""What the controller does in its own way where the cage is all one node."""

from typing import ClassVar

from amaranth.hdl import *
from amaranth.lib import wiring

from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration

__all__ = ["OneNode"]


class OneNode:
    """A cage without merge cards: what is drawn is shown, and then the next command is taken.

    This is no component: it adds members, signals and states to the controller that has it, so
    that a controller pays for what its cage has.  ``NodeControl`` is what takes its place.
    """

    members: ClassVar[dict[str, wiring.Member]] = {}
    #: Commands that are not the controller's own.
    opcodes: ClassVar[tuple[Opcode, ...]] = ()
    #: RAMs whose contents outlast a frame.
    storages = ()
    #: The state after the report of the units.
    after_units = "CHECK_UNITS"

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration

    def add_to(self, m, controller):
        """What goes on beside the commands."""

    def answers(self, controller):
        """The stream into which the machine that takes commands, and the chain, give responses."""
        return controller.responses

    def in_turn(self, controller, ready):
        """The offered command may be taken, if it is ``ready`` otherwise."""
        return ready

    def setting_up(self, controller, setup):
        """Triangles are being set up, in the controller's own ``setup`` where it has one."""
        return 0 if setup is None else setup.busy

    def all_units(self, controller):
        """Memory units in the cage."""
        return controller.total

    def front(self, controller):
        """Which of two pictures is shown."""
        return controller.pictures.front

    def swept(self, controller):
        """No unit is in a pass."""
        return controller.pictures.swept

    def start(self, m, controller):
        """Inside the clock in which a frame's start is taken, and its next state is told: its
        background is kept."""
        for place, background in enumerate(controller.backgrounds):
            with m.If(controller.pictures.front != place):
                m.d.sync += background.eq(controller.body)

    def refused(self, controller):
        """The cage draws nothing."""
        return controller.unsupported_units

    def fault(self, controller):
        """Why; only where it does not."""
        return Fault.UNITS_UNSUPPORTED

    def commands(self, m, controller):
        """Inside the switch over opcodes."""

    def states(self, m, controller):
        """Further states."""

    def drawn(self, m):
        """Inside the clock in which all is drawn."""

    def after_drawn(self, m, controller):
        """Inside the state that reports it; returns the next one."""
        return "SWAP"

    def swapped(self, m):
        """Inside the clock in which front and back change places."""

    #: The state after a swap.
    after_swap = "REPORT_SHOWN"

    def show(self, m, controller):
        """The states from there on."""
        pictures = controller.pictures
        with m.State("SWAP"), m.If(controller.scan_start):
            # Every pixel of the scan that begins here is fetched after this edge.
            shown = Signal.like(controller.scans, name="shown")
            m.d.sync += [pictures.front.eq(~pictures.front), shown.eq(controller.scans)]
            self.swapped(m)
            m.next = self.after_swap
        with m.State("REPORT_SHOWN"):
            controller.respond(m, ResponseKind.FRAME_SHOWN, shown, "COMMAND")
