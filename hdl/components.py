"""Every component that can be exported by itself, by the name of its module."""

from collections.abc import Callable

from amaranth.lib import wiring

from ..golden.configuration import MachineConfiguration
from .central_broadcast_controller import CentralBroadcastController
from .clear import Clear
from .depth_test import DepthTest
from .edge_walker import EdgeWalker
from .fragment_stepper import FragmentStepper
from .id_increment import IdIncrement
from .interlace import LatticeBlock, PixelAddress, ScanAddress
from .line_selector import LineSelector
from .memory_unit import MemoryUnit
from .one_port_memory import OnePortMemory
from .processing_element import ProcessingElement
from .processing_element_control import ProcessingElementControl
from .read_back import ReadBack
from .response_link import ResponseLink
from .span_start import SpanStart
from .span_walker import SpanWalker
from .survey import Survey
from .video_scan_generator import VideoScanGenerator

__all__ = ["COMPONENTS"]

#: Makes a component as a machine of that configuration has it; the four boards first.
COMPONENTS: dict[str, Callable[[MachineConfiguration], wiring.Component]] = {
    "central_broadcast_controller": lambda c: CentralBroadcastController(configuration=c),
    "processing_element": lambda c: ProcessingElement(configuration=c),
    "memory_unit": lambda c: MemoryUnit(configuration=c),
    "video_scan_generator": lambda c: VideoScanGenerator(configuration=c),
    "clear": lambda c: Clear(configuration=c),
    "depth_test": lambda c: DepthTest(configuration=c),
    "edge_walker": lambda c: EdgeWalker(configuration=c),
    "fragment_stepper": lambda c: FragmentStepper(configuration=c),
    "id_increment": lambda c: IdIncrement(bits=c.id_bits),
    "lattice_block": lambda c: LatticeBlock(configuration=c),
    # The processing element has four users of its lines.
    "line_selector": lambda c: LineSelector(configuration=c, sources=4),
    "one_port_memory": lambda c: OnePortMemory(words=c.words, depth_bits=c.depth_bits),
    "pixel_address": lambda c: PixelAddress(configuration=c),
    "processing_element_control": lambda c: ProcessingElementControl(configuration=c),
    "read_back": lambda c: ReadBack(configuration=c),
    "response_link": lambda c: ResponseLink(),
    "scan_address": lambda c: ScanAddress(configuration=c),
    "span_start": lambda c: SpanStart(configuration=c),
    "span_walker": lambda c: SpanWalker(configuration=c),
    "survey": lambda c: Survey(configuration=c),
}
