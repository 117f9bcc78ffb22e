"""The options that choose a machine, and what their values mean: sizes and precisions."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import click

from ...golden.balancing.table_policy import Policy
from ...golden.planning.presets import PRESETS
from ...golden.specification.card_order import CARD_NAMES
from ...golden.specification.configuration import (
    MAXIMUM_PACKET,
    ONE_PACKET_EACH,
    QUEUE_RANGE,
    RANGES,
)
from ...golden.specification.fields.making import MAXIMUM_MESHES, Objects
from ...golden.specification.fixed_point import MAX_FRACTION_BITS, MAXIMUM_ERROR
from ...golden.specification.ranges import MAXIMUM_SIZE, MAXIMUM_WORDS
from ...golden.specification.regions import MAXIMUM_REGIONS, Balancer
from ..machine_options import DEFAULT_PACKET, SETUPS
from ..views.frame_views import DEFAULT_TURN, MOST_FRAMES


class Size(click.ParamType):
    """``640x480`` as (640, 480)."""

    name = "WxH"

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> tuple[int, int]:
        match = re.fullmatch(r"([0-9]{1,9})[xX]([0-9]{1,9})", value.strip())
        if match is None:
            self.fail(f"{value!r} is not a width and a height such as 64x64", param, ctx)
        width, height = int(match[1]), int(match[2])
        for field, pixels in (("width", width), ("height", height)):
            if not 1 <= pixels <= MAXIMUM_SIZE:
                self.fail(f"{value!r}: {field} {pixels} is not from 1 to {MAXIMUM_SIZE}", param,
                          ctx)
        return width, height


class RegionCounts(click.ParamType):
    """``8x4`` as (8, 4): columns and rows of regions; where a word stands for none of them, that
    as None."""

    name = "COLUMNSxROWS"

    def __init__(self, none: str | None = None) -> None:
        self.none = none

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> tuple[int, int] | None:
        if value == self.none:
            return None
        match = re.fullmatch(r"([0-9]{1,4})[xX]([0-9]{1,4})", value.strip())
        if match is None:
            self.fail(f"{value!r} is not a number of columns and of rows of regions such as 8x8",
                      param, ctx)
        return int(match[1]), int(match[2])


class NumberOr(click.ParamType):
    """A whole number from ``low`` to ``high``, or one of ``words``."""

    def __init__(self, *words: str, low: int, high: int) -> None:
        self.name = "|".join(["N", *words])
        self.words, self.low, self.high = words, low, high

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> int | str:
        if value in self.words:
            return str(value)
        if not re.fullmatch(r"[0-9]{1,10}", value) or not self.low <= int(value) <= self.high:
            named = ", ".join(f"'{word}'" for word in self.words)
            self.fail(f"{value!r} is neither {named} nor a whole number from {self.low} to "
                      f"{self.high}", param, ctx)
        return int(value)


class Numbers(click.ParamType):
    """Several numbers with commas between them, as many as ``name`` has."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.count = name.count(",") + 1

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> tuple[float, ...]:
        try:
            numbers = tuple(float(word) for word in value.split(","))
        except ValueError:
            numbers = ()
        if len(numbers) != self.count or not all(map(math.isfinite, numbers)):
            self.fail(f"{value!r} is not {self.count} numbers, {self.name}", param, ctx)
        return numbers


class Color(click.ParamType):
    """``#1c2030``, or the name of a colour, as (red, green, blue)."""

    name = "COLOUR"

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> tuple[int, ...]:
        from PIL import ImageColor  # takes a while to load

        try:
            return ImageColor.getrgb(value)[:3]
        except ValueError:
            self.fail(f"{value!r} is no colour; take a name such as navy, or red, green and blue "
                      "as in #1c2030", param, ctx)


FRACTION_BITS = NumberOr("exact", low=0, high=MAX_FRACTION_BITS)
PACKET = NumberOr(*ONE_PACKET_EACH, low=1, high=MAXIMUM_PACKET)
QUEUE = NumberOr("element", low=QUEUE_RANGE[0], high=QUEUE_RANGE[1])


class Several(click.ParamType):
    """Values with commas between them, each of another type."""

    def __init__(self, each: click.ParamType, name: str) -> None:
        self.each = each
        self.name = name

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> tuple[Any, ...]:
        return tuple(self.each.convert(word, param, ctx) for word in value.split(","))


_BOARDS = ", ".join(f"{letter} {name}" for letter, name in CARD_NAMES.items())

#: Together one for each field of ``machine_options.MachineOptions``.
_CARDS_OPTION = click.option(
    "--cards", metavar="CARDS",
    help=f"Order of the boards, left to right: {_BOARDS}.  [default: 2x(PMM)]")
_CAGE_OPTIONS = (
    click.option("--size", type=Size(), metavar="WxH",
                 help="Highest resolution.  [default: 64x64]"),
    click.option("--preset", type=click.Choice(list(PRESETS)),
                 help="A named machine; other options override it."),
)
_PRECISION_OPTIONS = (
    click.option("--fraction-bits", type=FRACTION_BITS, metavar="N|exact",
                 help="Fraction bits of depth and colour; exact takes what the scene needs.  "
                 "[default: exact]"),
    click.option("--max-error", type=click.IntRange(0, MAXIMUM_ERROR), metavar="LSB",
                 help="In place of fraction bits: the fewest at which no depth is more than that "
                 "off; 0 is exact."),
)
_FURTHER_OPTIONS = (
    click.option("--shading", type=click.Choice(["auto", "flat", "gouraud"]), default="auto",
                 show_default=True, help="Colour interpolators in the machine, or not; auto has "
                 "them where the scene needs them."),
    click.option("--words", type=click.IntRange(1, MAXIMUM_WORDS), metavar="N",
                 help="Words of each memory unit; too few make the picture coarser.  "
                 "[default: what the size needs]"),
    click.option("--clocks-per-pixel", type=click.IntRange(*RANGES["clocks_per_pixel"]),
                 metavar="N", help="Clocks a pixel lasts on the video output.  [default: 2]"),
    click.option("--memory-ports", type=click.IntRange(*RANGES["memory_ports"]), metavar="1|2",
                 help="Ports of each memory unit's RAM: one for all as in 1979, or one to read and "
                 "one to write, as FPGAs have.  [default: 1]"),
    click.option("--block", type=click.IntRange(*RANGES["block"]), metavar="N",
                 help="Interlace processing elements in squares of NxN pixels, N a power of two; "
                 "each wants as many memory units.  1 interlaces pixel by pixel, as in 1979, in "
                 "any shares.  [default: 1]"),
    click.option("--skew", is_flag=True, default=None, help="Interlaced pixel by pixel, let two "
                 "memory units of a processing element alternate along its rows, not only from "
                 "row to row: faster where each has one port."),
    click.option("--lines", is_flag=True, default=None, help="Give processing elements whole "
                 "lines of the picture in turn: of n elements, a power of two, element i has the "
                 "lines i, n + i, 2n + i and so on; each wants as many memory units."),
    click.option("--setup", type=click.Choice(list(SETUPS)),
                 help="Who sets triangles up: the host, or the machine itself, with one divider "
                 "of each kind or a pipeline of them.  [default: host]"),
)

#: Several pictures.
_SEQUENCE_OPTIONS = (
    click.option("--frames", type=click.IntRange(1, MOST_FRAMES), metavar="N",
                 help="N pictures one after another, of a mesh that turns."),
    click.option("--turn", type=float, metavar="DEGREES",
                 help=f"With --frames: from one picture to the next.  [default: {DEFAULT_TURN}]"),
    click.option("--path", type=click.Path(path_type=Path), metavar="VIEWS.csv",
                 help="A picture for each line of this file, which has azimuth,elevation or "
                 "azimuth,elevation,zoom; the first line names them."),
)

#: How a mesh is looked at.
_VIEW_OPTIONS = (
    click.option("--view", type=Numbers("AZIMUTH,ELEVATION"), metavar="AZIMUTH,ELEVATION",
                 help="Where the eye is, in degrees: to the right of straight on, and above.  "
                 "[default: 25,30, or as the scene asks to be seen]"),
    click.option("--zoom", type=float, metavar="N", help="How many times larger the middle of the "
                 "picture is than framed.  [default: 1]"),
    click.option("--background", type=Color(), metavar="COLOUR",
                 help="A name such as navy, or #1c2030.  [default: #1c2030]"),
    click.option("--cull", is_flag=True, default=None,
                 help="Leave out triangles that face away from the eye."),
    click.option("--light", type=Numbers("X,Y,Z"), metavar="X,Y,Z", help="Towards the light: "
                 "right, up, towards the eye.  [default: -0.45,0.65,0.6]"),
)

_NODE_OPTIONS = (
    click.option("--packet", type=PACKET, metavar=PACKET.name,
                 help="Where there are merge cards: how many triangles that follow one another go "
                 "to one node, or one run of the list for each node: contiguous, of as many "
                 f"triangles, or work, of as much work.  [default: {DEFAULT_PACKET}]"),
    click.option("--queue", type=QUEUE, metavar="N|element",
                 help="Where nodes merge directly (D): how many fragments can wait from each "
                 "processing element to each memory unit, or one queue for each element.  "
                 "[default: 4]"),
    click.option("--list-words", type=click.IntRange(1, MAXIMUM_WORDS), metavar="N",
                 help="Triangles that each list memory holds; gives nodes one, like --retain.  "
                 "[default: what the scene needs]"),
)
_RETAIN_OPTION = click.option(
    "--retain", is_flag=True, default=None, help="Give each node a list memory: its triangles are "
    "loaded once, and all nodes draw theirs at the same time.")

#: Regions of the screen that a table gives to the processing elements of one node.
_REGIONS_OPTION = click.option(
    "--regions", type=RegionCounts(), metavar="COLUMNSxROWS",
    help="Deal so many regions of the screen out to the processing elements, of which there may be "
    "any number, in place of interlaced pixels.  With one region each these are Blazek's "
    "decompositions: --cards '4x(PMM)' --regions 1x4 his strips, --regions 2x2 his grid; with some "
    "8 each, and a new table for every picture, Ellsworth's.")
_DEALING_OPTIONS = (
    click.option("--slots", type=click.IntRange(1, MAXIMUM_REGIONS), metavar="N",
                 help="With regions: how many each processing element has room for.  [default: a "
                 "quarter more than an even share; that share with --objects elements]"),
    click.option("--balance", type=click.Choice(get_args(Policy)),
                 help="With regions: what is counted of each in a picture, by which they are dealt "
                 "out for the next one: triangles, or the clocks these take it; learnt are clocks, "
                 "too, which the host foretells from the last three pictures; static counts "
                 "nothing, and they stay, dealt out in turn; runs likewise, one run of regions for "
                 "each element.  [default: learnt; clocks with --balancer hardware]"),
    click.option("--balancer", type=click.Choice(get_args(Balancer)),
                 help="With regions: who deals them out, the host, or the machine itself.  "
                 "[default: host]"),
)

#: Objects, of which the machine makes triangles.
_OBJECT_OPTIONS = (
    click.option("--objects", type=click.Choice(get_args(Objects)),
                 help="Of an orthographic scene file: load its meshes into the machine, send its "
                 "objects, and have their triangles made there: by each node, for its share of the "
                 "objects, once by the controller, or by elements that pass objects on to each "
                 "other.  --setup is fast then, if nothing is said.  [default: the host sends "
                 "triangles]"),
    click.option("--mesh-triangles", type=click.IntRange(1, MAXIMUM_WORDS), metavar="N",
                 help="With objects: triangles that each mesh memory holds.  [default: what the "
                 "scene needs]"),
    click.option("--meshes", type=click.IntRange(1, MAXIMUM_MESHES), metavar="N",
                 help="With objects: meshes that it can tell apart.  [default: what the scene "
                 "needs]"),
)

#: In place of these where there are several cages.
_SEVERAL_CARDS_OPTION = click.option(
    "--cards", multiple=True, metavar="CARDS",
    help=f"A cage, its boards from left to right: {_BOARDS}; with /COLUMNSxROWS behind it, as in "
    "4x(PMM)/8x8, its elements draw regions of the screen; with @nodes, @elements or @controller "
    "at the end, as in 4x(PMMT)@nodes, it makes the triangles of objects there; give it once for "
    "each cage.  "
    "[default: 4x(PMM), 4x(PMMC) and 4x(PMMT)]")
_RETAIN_OR_NOT_OPTION = click.option(
    "--retain/--immediate", default=None, help="Cages of nodes only with list memories, of which "
    "nodes draw triangles that were loaded once, or only without.  [default: both]")


def machine_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that choose a machine."""
    return _with(command, (_CARDS_OPTION, *_CAGE_OPTIONS, *_PRECISION_OPTIONS, *_FURTHER_OPTIONS,
                           _RETAIN_OPTION, *_NODE_OPTIONS, _REGIONS_OPTION, *_DEALING_OPTIONS,
                           *_OBJECT_OPTIONS, *_VIEW_OPTIONS))


def machine_options_of_cages(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that choose several machines: ``cards`` are as many as were
    asked for, all else is for each of them."""
    return _with(command, (_SEVERAL_CARDS_OPTION, *_CAGE_OPTIONS, *_PRECISION_OPTIONS,
                           *_FURTHER_OPTIONS, _RETAIN_OR_NOT_OPTION, *_NODE_OPTIONS,
                           *_DEALING_OPTIONS, *_OBJECT_OPTIONS, *_VIEW_OPTIONS))


def machine_options_of_any_precision(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that choose a machine, but for its precision."""
    return _with(command, (_CARDS_OPTION, *_CAGE_OPTIONS, *_FURTHER_OPTIONS, _RETAIN_OPTION,
                           *_NODE_OPTIONS, _REGIONS_OPTION, *_DEALING_OPTIONS, *_VIEW_OPTIONS))


def view_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that say how a mesh is looked at."""
    return _with(command, _VIEW_OPTIONS)


def sequence_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that ask for several pictures."""
    return _with(command, _SEQUENCE_OPTIONS)


def _with(command: Callable[..., Any], options: tuple[Callable[..., Any], ...]
          ) -> Callable[..., Any]:
    for option in reversed(options):
        command = option(command)
    return command
