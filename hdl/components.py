"""Every component that can be exported by itself, by the name of its module."""

from collections.abc import Callable

from amaranth.lib import wiring

from ..golden.specification.configuration import MachineConfiguration
from .broadcast_queue import BroadcastQueue
from .central_broadcast_controller import CentralBroadcastController
from .depth_lane import DepthLane
from .depth_test import DepthTest
from .divider import Divider
from .edge_columns import EdgeColumns
from .edge_setup import EdgeSetup
from .fragment_stepper import FragmentStepper
from .frame_tags import FrameTags
from .id_increment import IdIncrement
from .interlace import LatticeBlock, PixelAddress, ScanAddress
from .interpolator import Interpolator
from .line_selector import LineSelector
from .memory_unit import MemoryUnit
from .one_port_memory import OnePortMemory
from .pipelined_multiplier import PipelinedMultiplier
from .pixel_box import PixelBox
from .plane_setup import PlaneSetup, plane_division
from .processing_element import ProcessingElement
from .processing_element_control import ProcessingElementControl
from .read_back import ReadBack
from .response_link import ResponseLink
from .result_queue import ResultQueue
from .row_walker import RowWalker
from .sampling_grid import SamplingGrid
from .span_clip import SpanClip
from .span_walker import SpanWalker
from .survey import Survey
from .tag_sweep import TagSweep
from .triangle_outline import TriangleOutline
from .triangle_setup import TriangleSetup
from .two_port_depth_test import TwoPortDepthTest
from .two_port_memory import TwoPortMemory
from .vertex_sort import VertexSort
from .video_scan_generator import VideoScanGenerator

__all__ = ["COMPONENTS"]


def _depth(configuration: MachineConfiguration) -> dict[str, int]:
    """The interpolant that every machine has."""
    return {"value_bits": configuration.depth_bits, "word_bits": configuration.depth_plane_bits}


#: Makes a component as a machine of that configuration has it; the four boards first.
COMPONENTS: dict[str, Callable[[MachineConfiguration], wiring.Component]] = {
    "central_broadcast_controller": lambda c: CentralBroadcastController(configuration=c),
    "processing_element": lambda c: ProcessingElement(configuration=c),
    "memory_unit": lambda c: MemoryUnit(configuration=c),
    "video_scan_generator": lambda c: VideoScanGenerator(configuration=c),
    "broadcast_queue": lambda c: BroadcastQueue(configuration=c),
    "depth_lane": lambda c: DepthLane(configuration=c),
    "depth_test": lambda c: DepthTest(configuration=c),
    "divider": lambda c: Divider(**plane_division(c, **_depth(c))),
    "edge_columns": lambda c: EdgeColumns(configuration=c),
    "edge_setup": lambda c: EdgeSetup(configuration=c),
    "fragment_stepper": lambda c: FragmentStepper(configuration=c),
    "frame_tags": lambda c: FrameTags(configuration=c),
    "id_increment": lambda c: IdIncrement(bits=c.id_bits),
    "interpolator": lambda c: Interpolator(configuration=c),
    "lattice_block": lambda c: LatticeBlock(configuration=c),
    "line_selector": lambda c: LineSelector(configuration=c),
    "one_port_memory": lambda c: OnePortMemory(words=c.words, depth_bits=c.depth_bits,
                                               tag_bits=c.tag_bits),
    # That of a triangle's area.
    "pipelined_multiplier": lambda c: PipelinedMultiplier(
        a_bits=c.coordinate_bits + 1, b_bits=c.coordinate_bits + 1, pairs=2),
    "pixel_address": lambda c: PixelAddress(configuration=c),
    "pixel_box": lambda c: PixelBox(configuration=c),
    "plane_setup": lambda c: PlaneSetup(configuration=c, **_depth(c)),
    "processing_element_control": lambda c: ProcessingElementControl(configuration=c),
    "read_back": lambda c: ReadBack(configuration=c),
    "response_link": lambda c: ResponseLink(),
    "result_queue": lambda c: ResultQueue(result_bits=c.depth_plane_bits, depth=16),
    "row_walker": lambda c: RowWalker(configuration=c),
    "sampling_grid": lambda c: SamplingGrid(configuration=c),
    "scan_address": lambda c: ScanAddress(configuration=c),
    "span_clip": lambda c: SpanClip(configuration=c),
    "span_walker": lambda c: SpanWalker(configuration=c),
    "survey": lambda c: Survey(configuration=c),
    "tag_sweep": lambda c: TagSweep(configuration=c),
    "triangle_outline": lambda c: TriangleOutline(configuration=c),
    "triangle_setup": lambda c: TriangleSetup(configuration=c),
    "two_port_depth_test": lambda c: TwoPortDepthTest(configuration=c),
    "two_port_memory": lambda c: TwoPortMemory(words=c.words, depth_bits=c.depth_bits,
                                               tag_bits=c.tag_bits),
    "vertex_sort": lambda c: VertexSort(configuration=c),
}
