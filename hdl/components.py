"""Every component that can be exported by itself, by the name of its module."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from amaranth.lib import data, wiring

from ..golden.specification.card_order import (
    CARD_MODULES,
    CHAIN_MERGE,
    DIRECT_MERGE,
    FRAME_UNIT,
    MERGE_CARDS,
    NODE_ENDS,
    SNOOP_MERGE,
)
from ..golden.specification.commands import RESPONSE_VALUE_BITS
from ..golden.specification.configuration import (
    MAXIMUM_SETUP_INTERVAL,
    SNOOP_TAG_BITS,
    MachineConfiguration,
)
from ..golden.specification.fields.making import NO_OBJECTS
from ..golden.specification.queues import FRAGMENTS_OF_ELEMENT, depth_lanes
from .arithmetic.divider import Divider
from .arithmetic.pipelined_multiplier import PipelinedMultiplier
from .backplane.connectors import memory_bus_bits
from .backplane.fragment_lines import unit_fragment_layout
from .backplane.id_increment import IdIncrement
from .backplane.response_link import ResponseLink
from .balancing.balancer import Balancer
from .balancing.least_loaded import LeastLoaded
from .balancing.merge_sorter import MergeSorter
from .balancing.region_order import RegionOrder, region_shape
from .controller.frame_tags import FrameTags
from .controller.region_table import RegionTable
from .depth_test.one_port import OnePortDepthTest
from .depth_test.one_port_lane import OnePortLane
from .depth_test.two_ports import TwoPortDepthTest
from .direct.crossbar import Crossbar
from .direct.direct_element import DirectElement
from .direct.element_control import DirectElementControl
from .direct.fragment_queue import FragmentQueue
from .direct.round_robin import RoundRobin
from .direct.unit_counters import UnitCounters
from .direct.unit_feed import UnitFeed
from .forwarding.element_gate import ElementGate
from .forwarding.forwarding_element import ForwardingElement
from .forwarding.object_forwarder import ObjectForwarder
from .forwarding.object_reach import ObjectReach
from .forwarding.reach import object_bits
from .machine import BOARDS, boards_of
from .mapping.interlace import PixelAddress, ScanAddress
from .mapping.lattice import LatticeBlock
from .mapping.region_address import RegionAddress
from .mapping.region_scan import RegionScanAddress
from .mapping.unit_pixel import UnitPixel
from .memory_unit.one_port_memory import OnePortMemory
from .memory_unit.tag_sweep import TagSweep
from .memory_unit.two_port_memory import TwoPortMemory
from .memory_unit.word_parts import word_parts
from .merging.drawn_map import DrawnMap
from .merging.nearest_word import NearestWord
from .merging.picture_maps import PictureMaps
from .objects.mesh_memory import MeshMemory
from .objects.object_reader import ObjectReader
from .objects.object_setup import ObjectSetup
from .processing_element.broadcast_queue import BroadcastQueue
from .processing_element.control import ProcessingElementControl
from .processing_element.depth_read_back import DepthReadBack
from .processing_element.memory_bus_selector import MemoryBusSelector
from .processing_element.survey import Survey
from .rasteriser.edge_columns import EdgeColumns
from .rasteriser.fragment_stepper import FragmentStepper
from .rasteriser.interpolator import Interpolator
from .rasteriser.span_clip import SpanClip
from .rasteriser.triangle_rows import TriangleRows
from .rasteriser.triangle_spans import TriangleSpans
from .regions.band_probes import BandProbes
from .regions.band_scan import BandScan
from .regions.large_visits import LargeVisits
from .regions.own_columns import OwnColumns
from .regions.own_regions import OwnRegions
from .regions.region_clip import RegionClip
from .regions.region_counts import RegionCounts
from .regions.region_rows import RegionRows
from .regions.region_spans import RegionSpans
from .regions.region_visits import RegionVisits
from .triangle_setup.edge_setup import EdgeSetup
from .triangle_setup.outline import TriangleOutline
from .triangle_setup.pixel_box import PixelBox
from .triangle_setup.plane_setup import PlaneSetup, plane_division
from .triangle_setup.result_queue import ResultQueue
from .triangle_setup.sampling_grid import SamplingGrid, grid_layout
from .triangle_setup.triangle_setup import TriangleSetup
from .triangle_setup.vertex_sort import VertexSort
from .video.region_places import RegionPlaces

__all__ = ["COMPONENTS"]


def _depth(configuration: MachineConfiguration) -> dict[str, int]:
    """The interpolant that every machine has."""
    return {"value_bits": configuration.depth_bits, "word_bits": configuration.depth_plane_bits}


def _board(name: str, configuration: MachineConfiguration) -> wiring.Component:
    """A merge card is as in a cage that it ends, where the configuration has none; a frame unit
    as in one that sends to it."""
    for letter in (*MERGE_CARDS, FRAME_UNIT):
        if name == CARD_MODULES[letter]:
            configuration = _merged_by(SNOOP_MERGE if letter == FRAME_UNIT else letter,
                                       configuration)
    return (BOARDS | boards_of(configuration))[name](configuration=configuration)


def _merged_by(letter: str, configuration: MachineConfiguration) -> MachineConfiguration:
    """The configuration with nodes that are merged by that card, of which there may be two."""
    if letter == configuration.merge:
        return configuration
    units = "M" * configuration.units
    if letter == DIRECT_MERGE:
        return replace(configuration, maximum_nodes=2, cards=f"PPD{units}", block=1, skew=False,
                       **NO_OBJECTS)
    nodes = [f"P{units}"] if configuration.merges_directly else configuration.node_cards
    cards = "".join(cards + letter for cards in nodes)
    if letter == SNOOP_MERGE:
        return replace(configuration, maximum_nodes=2, cards=cards + FRAME_UNIT,
                       tag_bits=max(SNOOP_TAG_BITS, configuration.tag_bits))
    return replace(configuration, maximum_nodes=2, cards=cards)


def _direct(make: Callable[[MachineConfiguration], wiring.Component],
            configuration: MachineConfiguration) -> wiring.Component:
    """What only cages that merge directly have."""
    return make(_merged_by(DIRECT_MERGE, configuration))


def _dealt(make: Callable[..., wiring.Component],
           configuration: MachineConfiguration) -> wiring.Component:
    """What only cages have whose regions are dealt out."""
    return make(configuration=_with_regions(configuration))


def _with_regions(configuration: MachineConfiguration) -> MachineConfiguration:
    """The configuration with regions, and what they cost counted; where it has none with two
    elements, of two units each, and up to four columns and rows of them."""
    if configuration.regions is not None:
        if configuration.balance != "static":
            return configuration
        # Where elements pass objects on they have no counts.
        plain = dict(order_bits=0, **NO_OBJECTS) if configuration.forwards_objects else {}
        return replace(configuration, balance="clocks", balancer="host", words=0, **plain)
    sizes = configuration.width, configuration.height
    columns, rows = (-(-size >> max(1, (size - 1).bit_length() - 2)) for size in sizes)
    # A picture of one row or column is too narrow to spread over units.
    cards = "2x(PMM)" if min(sizes) > 1 else "2x(PM)"
    return replace(configuration, cards=cards, words=0, maximum_units=0, block=1, skew=False,
                   packet=1, order_bits=0, list_words=0, maximum_nodes=0, allow_orphans=False,
                   regions=(columns, rows), **NO_OBJECTS)


def _regions(configuration: MachineConfiguration) -> dict[str, int]:
    """How many there are."""
    regions = configuration.dealt_regions
    return {"columns": regions.columns, "rows": regions.rows}


def _of_objects(make: Callable[..., wiring.Component],
                configuration: MachineConfiguration) -> wiring.Component:
    """What only machines have that make triangles of objects."""
    return make(configuration=_with_objects(configuration))


def _with_objects(configuration: MachineConfiguration) -> MachineConfiguration:
    """The configuration with objects; where it takes none, with nodes that make them, and room for
    some."""
    if configuration.objects is not None:
        return configuration
    if configuration.regions is not None:
        configuration = replace(configuration, regions=None, slots=0, words=0, balance="clocks",
                                balancer="host")
    nodes = (configuration if configuration.merge in NODE_ENDS
             else _merged_by(CHAIN_MERGE, configuration))
    return replace(nodes, setup="hardware", list_words=0, objects="nodes", mesh_triangles=256,
                   meshes=16)


def _forwarding(make: Callable[..., wiring.Component],
                configuration: MachineConfiguration) -> wiring.Component:
    """What only machines have whose processing elements pass objects on."""
    if configuration.forwards_objects:
        return make(configuration=configuration)
    return make(configuration=replace(
        _with_regions(replace(configuration, **NO_OBJECTS)), balance="static", balancer="host",
        setup="hardware", setup_interval=MAXIMUM_SETUP_INTERVAL, order_bits=6, objects="elements",
        mesh_triangles=256, meshes=16, words=0))


def _packing(configuration: MachineConfiguration) -> dict[str, int]:
    """What regions are packed into, by counts of how many bits."""
    return {"elements": configuration.maximum_units >> configuration.share_bits,
            "slots": configuration.slots, "count_bits": RESPONSE_VALUE_BITS}


def _fragment(configuration: MachineConfiguration) -> data.StructLayout:
    return unit_fragment_layout(address_bits=configuration.address_bits,
                                depth_bits=configuration.rank_bits)


def _depth_of_queues(configuration: MachineConfiguration) -> int:
    """Fragments that can wait in one."""
    return (FRAGMENTS_OF_ELEMENT if configuration.queue == "element" else configuration.queue)


#: Makes a component as a machine of that configuration has it; the boards first.
COMPONENTS: dict[str, Callable[[MachineConfiguration], wiring.Component]] = {
    **{name: partial(_board, name) for name in BOARDS},
    "balancer": partial(_dealt, lambda configuration: Balancer(
        **_regions(configuration), **_packing(configuration))),
    "band_probes": partial(_dealt, BandProbes),
    "band_scan": partial(_dealt, BandScan),
    "broadcast_queue": lambda c: BroadcastQueue(configuration=c),
    "crossbar": partial(_direct, lambda c: Crossbar(
        elements=c.maximum_nodes, units=c.maximum_units, queue=c.queue, **memory_bus_bits(c))),
    "depth_read_back": lambda c: DepthReadBack(**memory_bus_bits(c)),
    "direct_element": partial(_direct, lambda c: DirectElement(configuration=c)),
    "direct_element_control": partial(_direct, lambda c: DirectElementControl(
        id_bits=c.id_bits, node_bits=c.node_bits)),
    "divider": lambda c: Divider(**plane_division(c, **_depth(c))),
    "drawn_map": lambda c: DrawnMap(words=c.words),
    "edge_columns": lambda c: EdgeColumns(configuration=c),
    "edge_setup": lambda c: EdgeSetup(configuration=c),
    "element_gate": partial(_forwarding, ElementGate),
    "forwarding_element": partial(_forwarding, ForwardingElement),
    "fragment_queue": partial(_direct, lambda c: FragmentQueue(
        depth=_depth_of_queues(c), shape=_fragment(c))),
    "fragment_stepper": lambda c: FragmentStepper(configuration=c),
    "frame_tags": lambda c: FrameTags(tag_bits=c.tag_bits),
    "id_increment": lambda c: IdIncrement(bits=c.id_bits),
    "interpolator": lambda c: Interpolator(configuration=c),
    "large_visits": partial(_dealt, LargeVisits),
    "lattice_block": lambda c: LatticeBlock(configuration=c),
    "least_loaded": partial(_dealt, lambda configuration: LeastLoaded(
        label=region_shape(**_regions(configuration)), **_packing(configuration))),
    "memory_bus_selector": lambda c: MemoryBusSelector(**memory_bus_bits(c)),
    "merge_sorter": partial(_dealt, lambda configuration: MergeSorter(
        items=configuration.dealt_regions.count, weight_bits=RESPONSE_VALUE_BITS,
        label=region_shape(**_regions(configuration)))),
    "mesh_memory": partial(_of_objects, MeshMemory),
    "nearest_word": lambda c: NearestWord(depth_bits=c.depth_bits, order_bits=c.order_bits),
    "object_forwarder": partial(_forwarding, lambda configuration: ObjectForwarder(
        configuration=configuration, object_bits=object_bits(configuration))),
    "object_reach": partial(_forwarding, ObjectReach),
    "object_reader": partial(_of_objects, ObjectReader),
    "object_setup": partial(_of_objects, ObjectSetup),
    "one_port_depth_test": lambda c: OnePortDepthTest(**memory_bus_bits(c),
                                                      lanes=depth_lanes(c)),
    "one_port_lane": lambda c: OnePortLane(**memory_bus_bits(c)),
    "one_port_memory": lambda c: OnePortMemory(words=c.words, depth_bits=c.rank_bits,
                                               tag_bits=c.tag_bits, parts=word_parts(c)),
    "own_columns": partial(_dealt, OwnColumns),
    "own_regions": partial(_dealt, OwnRegions),
    "picture_maps": lambda c: PictureMaps(words=c.words),
    # The one that computes the area of a triangle.
    "pipelined_multiplier": lambda c: PipelinedMultiplier(
        a_bits=c.coordinate_bits + 1, b_bits=c.coordinate_bits + 1, pairs=2),
    "pixel_address": lambda c: PixelAddress(configuration=c),
    "pixel_box": lambda c: PixelBox(grid=grid_layout(c), coordinate_bits=c.coordinate_bits,
                                    sub_bits=c.sub_bits),
    "plane_setup": lambda c: PlaneSetup(configuration=c, **_depth(c)),
    "processing_element_control": lambda c: ProcessingElementControl(
        id_bits=c.id_bits, depth_bits=c.rank_bits, order_bits=c.order_bits),
    "region_address": partial(_dealt, RegionAddress),
    "region_clip": partial(_dealt, RegionClip),
    "region_counts": partial(_dealt, RegionCounts),
    "region_order": partial(_dealt, lambda configuration: RegionOrder(
        **_regions(configuration), **_packing(configuration))),
    "region_places": partial(_dealt, RegionPlaces),
    "region_rows": partial(_dealt, RegionRows),
    "region_scan_address": partial(_dealt, RegionScanAddress),
    "region_spans": partial(_dealt, RegionSpans),
    "region_table": partial(_dealt, RegionTable),
    "region_visits": partial(_dealt, RegionVisits),
    "response_link": lambda c: ResponseLink(),
    "result_queue": lambda c: ResultQueue(result_bits=c.depth_plane_bits, depth=16),
    "round_robin": partial(_direct, lambda c: RoundRobin(requesters=c.maximum_nodes)),
    "sampling_grid": lambda c: SamplingGrid(configuration=c),
    "scan_address": lambda c: ScanAddress(configuration=c),
    "span_clip": lambda c: SpanClip(configuration=c),
    "survey": lambda c: Survey(**memory_bus_bits(c)),
    "tag_sweep": lambda c: TagSweep(words=c.words, parts=len(word_parts(c))),
    "triangle_outline": lambda c: TriangleOutline(configuration=c),
    "triangle_rows": lambda c: TriangleRows(configuration=c),
    "triangle_setup": lambda c: TriangleSetup(configuration=c),
    "triangle_spans": lambda c: TriangleSpans(configuration=c),
    "two_port_depth_test": lambda c: TwoPortDepthTest(**memory_bus_bits(c)),
    "two_port_memory": lambda c: TwoPortMemory(words=c.words, depth_bits=c.rank_bits,
                                               tag_bits=c.tag_bits, parts=word_parts(c)),
    "unit_counters": partial(_direct, lambda c: UnitCounters(units=c.maximum_units)),
    "unit_feed": partial(_direct, lambda c: UnitFeed(elements=c.maximum_nodes,
                                                     shape=_fragment(c))),
    "unit_pixel": lambda c: UnitPixel(configuration=c),
    "vertex_sort": lambda c: VertexSort(configuration=c),
}
