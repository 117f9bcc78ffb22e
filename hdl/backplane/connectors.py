"""The lines of the backplane: what every slot has, whatever card is in it.

``bus`` is the memory bus of a processing element (the member ``lines`` of a ``Connector``)::

      CBC ──broadcast──────┬───────────┬──────────┬──────────┬────────
                           │           │          │          │
           ┌─────┐  id   ┌─┴──┐  id  ┌─┴──┐ id+1┌─┴──┐ id+2┌─┴──┐
           │ CBC ├──────▶│ PE ├─────▶│ MU ├────▶│ MU ├────▶│ PE │ …  ──┐
           │     │◀──────┤    │◀════▶│    │◀═══▶│    │  ┆  │    │      │ total units
           └─────┘ resp. └────┘ bus  └─┬──┘     └─┬──┘  ┆  └────┘      │
              ▲ total                  │          │     ┆ a PE ignores the bus from its left
              └────────────────────────┼──────────┼───────────────────┘
                                       │          │
      CBC ──pictures───────────────────┼──────────┼───────────────────
          ◀─swept──────────────────────┼──────────┼─────────────────── (wired and)
      video scan generator ──scan──────┴──────────┴───────────────────
                           ◀─video──────────────────────────────────── (wired or)
"""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import COLOR_BITS
from .words import broadcast_layout, response_layout

__all__ = [
    "BroadcastLines",
    "Connector",
    "MemoryBus",
    "PictureLines",
    "ScanLines",
    "memory_bus_bits",
    "read_request_layout",
    "region_place_layout",
    "scan_address_layout",
    "write_request_layout",
]


def memory_bus_bits(configuration: MachineConfiguration) -> dict[str, int]:
    """The numbers that a ``MemoryBus`` is made from."""
    return {"id_bits": configuration.id_bits, "address_bits": configuration.address_bits,
            "depth_bits": configuration.rank_bits}


def read_request_layout(*, id_bits: int, address_bits: int) -> data.StructLayout:
    """Read the depth at an address of a unit."""
    return data.StructLayout({"valid": 1, "unit": id_bits, "address": address_bits})


def write_request_layout(*, id_bits: int, address_bits: int, depth_bits: int) -> data.StructLayout:
    """Write the depth and the back colour at an address of a unit."""
    return data.StructLayout({
        "valid": 1,
        "unit": id_bits,
        "address": address_bits,
        "depth": depth_bits,
        "color": COLOR_BITS,
    })


class MemoryBus(wiring.Signature):
    """The bus of one processing element to the memory units of its domain (figure 12).

    A read and a write can go to two different units in the same clock, or to one
    with two ports.  Each takes place in a clock in which its ``valid`` is high
    and its busy signal is low; a request that no unit answers is never busy.  A read
    sees every write that took place before it; what it sees of one in the same clock,
    which only units with two ports take, is unknown.  Those are never busy.

    What is called depth here has the order of its node's round in its low bits, where pixels keep
    one (``MachineConfiguration.rank_bits``): as a number it is compared like a depth.

    The answers of the units are wired or: a unit to which nothing is addressed drives 0
    on all of them (``scanned`` excepted, which is no answer to anybody), and so does the
    empty right end of the bus.

    Members
    -------
    read: Out(read_request_layout)
    read_busy: In(1)
        The unit's one port is taken by the scan or by a write.
    read_data: In(depth_bits)
        Depth, in the clock after the read; 0 when no unit answered.
    write: Out(write_request_layout)
    write_busy: In(1)
        The unit's one port is taken by the scan.
    scanned: In(2)
        Known before any request: the scan takes the one port of a unit with an even number (bit
        0), of one with an odd number (bit 1).

    Raises ``ValueError`` where a number of bits is not positive.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        for name, bits in (("id_bits", id_bits), ("address_bits", address_bits),
                           ("depth_bits", depth_bits)):
            if bits < 1:
                raise ValueError(f"{name} must be positive, not {bits!r}")
        super().__init__({
            "read": Out(read_request_layout(id_bits=id_bits, address_bits=address_bits)),
            "read_busy": In(1),
            "read_data": In(depth_bits),
            "write": Out(write_request_layout(id_bits=id_bits, address_bits=address_bits,
                                              depth_bits=depth_bits)),
            "write_busy": In(1),
            "scanned": In(2),
        })


class Connector(wiring.Signature):
    """The lines that run from one slot to the next; ``Out`` is towards the right.

    The memory bus is called ``lines`` here, and so are its ports in the exported Verilog, which
    keep their names.

    Members
    -------
    id: Out(id_bits)
        Memory units to the left (figures 10 and 11).
    lines: Out(MemoryBus)
        The memory bus, driven by the nearest processing element to the left.
    response: In(stream of response words)
        What the processing elements further right have to say to the controller.
    node: Out(node_bits)
        Nodes to the left; only where merge cards end nodes.
    """

    def __init__(self, configuration: MachineConfiguration):
        super().__init__({
            **({"node": Out(configuration.node_bits)} if configuration.node_bits else {}),
            "id": Out(configuration.id_bits),
            "lines": Out(MemoryBus(**memory_bus_bits(configuration))),
            "response": In(stream.Signature(response_layout())),
        })


class BroadcastLines(wiring.Signature):
    """The controller's lines to every processing element, and their wired answers.

    ``done`` counts a strobe from ``settle_clocks + 1`` clocks after it on; until then it may
    still be high.  A word takes that long through the queue of a processing element
    (``BroadcastQueue.latency``), so the element may take note of it at either end.

    Members
    -------
    strobe: Out(1)
        ``packet`` is for every processing element to take in this clock; only while ``ready``.
    packet: Out(broadcast_layout)
        Operation and body.
    ready: In(1)
        The processing element can take a packet (wired and over all).
    done: In(1)
        It has finished everything it was told and sent all its responses (wired and over all).
    """

    settle_clocks = 3

    def __init__(self, configuration: MachineConfiguration):
        super().__init__({
            "strobe": Out(1),
            "packet": Out(broadcast_layout(configuration)),
            "ready": In(1),
            "done": In(1),
        })


class PictureLines(wiring.Signature):
    """The controller's lines to every memory unit: the picture shown and the one drawn.

    Each part of a memory word (``hdl.memory_unit.word_parts``) has one current tag.  What is
    written gets it; what has another tag reads as background.

    Members
    -------
    front: Out(1)
        Which of the two colours is shown; the other is the back picture.
    depth_tag: Out(tag_bits)
    color_tag: Out(tag_bits) [2]
        The current tags; never 0.
    initialise: Out(1)
        Begin a pass that gives tag 0 to every part of every word; only while ``swept``.
    sweep: Out(1)
        Begin a pass that gives tag 0 to parts whose tag is not the current one; only while
        ``swept``.
    swept: In(1)
        The memory unit is in no pass (wired and over all).
    """

    def __init__(self, configuration: MachineConfiguration):
        super().__init__({
            "front": Out(1),
            "depth_tag": Out(configuration.tag_bits),
            "color_tag": Out(configuration.tag_bits).array(2),
            "initialise": Out(1),
            "sweep": Out(1),
            "swept": In(1),
        })


def scan_address_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A pixel at the highest resolution; ``valid`` is high in the first clock of its time.  Where
    regions are dealt out, with the processing element that its region is given to, and the slot."""
    return data.StructLayout({
        "valid": 1,
        "x": configuration.x_bits,
        "y": configuration.y_bits,
        **({} if configuration.regions is None else region_place_layout(configuration).members),
    })


def region_place_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Where a region lies."""
    return data.StructLayout({"element": configuration.element_bits,
                              "slot": configuration.table_bits})


class ScanLines(wiring.Signature):
    """The video scan generator's lines to every memory unit (figures 6 to 9).

    Members
    -------
    fetch: Out(scan_address_layout)
        Announces a scan slot: a unit whose pixel is due reads it in the next clock.
    show: Out(scan_address_layout)
        The pixel on the video bus in the next clock: ``fetch`` of three clocks ago.
    video: In(COLOR_BITS)
        Red in the low byte, then green, blue: from the unit that holds the shown pixel, if that
        has been drawn; others drive 0 (wired or).
    drawn: In(1)
        It has been drawn since its frame started, else the background is shown; units that do not
        hold the shown pixel drive 0 (wired or).
    rank: In(rank_bits)
        Its depth and order, likewise; only where pictures are merged as they are scanned.
    """

    def __init__(self, configuration: MachineConfiguration):
        super().__init__({
            "fetch": Out(scan_address_layout(configuration)),
            "show": Out(scan_address_layout(configuration)),
            "video": In(COLOR_BITS),
            "drawn": In(1),
            **({"rank": In(configuration.rank_bits)} if configuration.scans_rank else {}),
        })
