"""From what was asked on the command line to a machine, with a scene or without."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal, get_args

from ..golden.balancing.table_policy import Policy, counted_by, default_policy
from ..golden.organisations.organisation_of import organisation_of
from ..golden.planning.machine_plan import plan
from ..golden.planning.presets import PRESETS
from ..golden.scene_argument import DisplayListScene, HardCaseScene, parse_scene
from ..golden.scene_display_list import LoadedScene, SceneDisplayList, make_display_list
from ..golden.scenes.camera import View
from ..golden.scenes.lighting import Lighting
from ..golden.specification.card_order import DIRECT_MERGE, merge_card, parse_cards
from ..golden.specification.configuration import (
    MAXIMUM_SETUP_INTERVAL,
    MachineConfiguration,
    Packet,
    Queue,
)
from ..golden.specification.errors import InputError
from ..golden.specification.fields.making import Objects
from ..golden.specification.fixed_point import check_max_error, on_screen_fraction_bits
from ..golden.specification.regions import Balancer

#: Small enough for every engine; the size is the scenes' own default.
DEFAULT_MACHINE: dict[str, Any] = {"cards": "2x(PMM)", "clocks_per_pixel": 2}
DEFAULT_SIZE = {"width": 64, "height": 64}
#: How nodes share the triangles: the shortest frames of all that a host knows how to do
#: (docs/figures-cox-hanrahan.md).
DEFAULT_PACKET: Packet = "work"

ShadingChoice = Literal["auto", "flat", "gouraud"]
SetupChoice = Literal["host", "small", "fast"]

#: What each choice of set-up is in the configuration.
SETUPS: dict[SetupChoice, dict[str, Any]] = {
    "host": {"setup": "host"},
    "small": {"setup": "hardware", "setup_interval": MAXIMUM_SETUP_INTERVAL},
    "fast": {"setup": "hardware", "setup_interval": 1},
}


@dataclass(frozen=True)
class MachineOptions:
    """What can be asked of a machine; None leaves a choice to the preset or the scene.

    ``preset``            a named machine of ``golden.planning.presets.PRESETS``; the rest overrides
                          it
    ``cards``             card order, such as ``4x(PMM)``
    ``size``              width, height of the highest resolution
    ``fraction_bits``     of the interpolants; ``"exact"`` takes what the scene needs
    ``max_error``         in place of fraction bits: LSB by which a depth may be off
    ``shading``           ``auto`` interpolates colours where the scene has more than one a triangle
    ``words``             of each memory unit
    ``clocks_per_pixel``  clocks a pixel lasts on the video output
    ``memory_ports``      of each memory unit
    ``block``             side of the squares of pixels that processing elements interlace in
    ``skew``              units of a processing element alternate along its rows, too
    ``lines``             processing elements have whole lines in turn
    ``setup``             who sets triangles up: ``host``, or the controller, ``small`` with one
                          divider of each kind or ``fast`` with a stage for each bit
    ``packet``            triangles of a packet for each node, ``"contiguous"`` or ``"work"``, which
                          cages of nodes have where nothing is said; where the machine makes
                          triangles of objects, objects; also for elements that pass them on
    ``queue``             fragments that can wait from each processing element to each memory unit,
                          or ``"element"``, where nodes merge directly
    ``retain``            nodes have list memories, as large as the scene needs
    ``list_words``        nodes have list memories of so many triangles
    ``regions``           columns and rows of the regions of the screen that are dealt out to
                          processing elements; None interlaces pixels
    ``slots``             regions that each of them has room for
    ``balance``           by which the next table is made: ``static`` and ``runs`` nothing,
                          ``triangles`` or ``clocks`` of each region in the last picture, which is
                          what the machine counts; ``learnt``, clocks that the host foretells from
                          the last three
    ``balancer``          who makes that table: ``host`` or ``hardware``

    ``objects``           where the machine makes the triangles of a scene's objects: ``nodes``,
                          ``controller`` or ``elements``; None has the host send triangles
    ``mesh_triangles``    triangles that a mesh memory holds, else as many as the scene needs
    ``meshes``            meshes that it can tell apart, likewise

    How a mesh is looked at; a display list can be asked for none of it:

    ``view``              azimuth and elevation of the eye in degrees
    ``zoom``              how many times larger than framed
    ``background``        red, green, blue
    ``cull``              leave out triangles that face away from the eye
    ``light``             towards the light: right, up, towards the eye
    """

    preset: str | None = None
    cards: str | None = None
    size: tuple[int, int] | None = None
    fraction_bits: int | Literal["exact"] | None = None
    max_error: int | None = None
    shading: ShadingChoice = "auto"
    words: int | None = None
    clocks_per_pixel: int | None = None
    memory_ports: int | None = None
    block: int | None = None
    skew: bool | None = None
    lines: bool | None = None
    setup: SetupChoice | None = None
    packet: Packet | None = None
    queue: Queue | None = None
    retain: bool | None = None
    list_words: int | None = None
    regions: tuple[int, int] | None = None
    slots: int | None = None
    balance: Policy | None = None
    balancer: Balancer | None = None
    objects: Objects | None = None
    mesh_triangles: int | None = None
    meshes: int | None = None
    view: tuple[float, float] | None = None
    zoom: float | None = None
    background: tuple[int, int, int] | None = None
    cull: bool | None = None
    light: tuple[float, float, float] | None = None

    def machine(self) -> dict[str, Any]:
        """Fields of ``MachineConfiguration`` that are settled; fraction bits None are exact ones.
        Raises ``InputError``."""
        if self.preset is not None and self.preset not in PRESETS:
            raise InputError(f"preset: {self.preset!r} is none of {', '.join(PRESETS)}")
        settled = dict(PRESETS[self.preset] if self.preset else DEFAULT_MACHINE)
        asked = {name: getattr(self, name) for name in _FIELDS}
        settled |= {name: value for name, value in asked.items() if value is not None}
        if self.max_error is not None:
            check_max_error(self.max_error)
            if self.fraction_bits is not None:
                raise InputError("--max-error: chooses the fraction bits itself; leave out "
                                 "--fraction-bits")
        if self.max_error is not None or self.fraction_bits == "exact":
            settled["fraction_bits"] = None  # in place of the preset's
        self._check_merging(settled["cards"])
        self._check_regions()
        if self.balance is not None:
            settled["balance"] = counted_by(self.balance)
        elif self.objects == "elements" and self.regions is not None:
            settled["balance"] = "static"  # each element keeps its run of regions
        if self.packet is None and merge_card(parse_cards(settled["cards"])) is not None:
            settled["packet"] = DEFAULT_PACKET
        if self.objects is not None:  # nobody else can set up what the machine makes
            settled |= SETUPS["fast"]
        if self.setup is not None:
            settled |= SETUPS[self.setup]
        if self.shading != "auto":
            settled["shading"] = self.shading
        if self.size is not None:
            settled["width"], settled["height"] = self.size
        return settled

    def _check_merging(self, cards: str) -> None:
        """``InputError`` for what a cage without such merge cards cannot be asked."""
        merge = merge_card(parse_cards(cards))
        if self.retain and merge is None:
            raise InputError(f"--retain: {cards} has no merge card, and so no list memory; end its "
                             "nodes with merge cards, as in 2x(PMMC)")
        if self.retain and self.objects is not None:
            raise InputError("--retain: where the machine makes the triangles of objects it keeps "
                             "meshes, not lists; leave one of the two out")
        if self.packet is not None and merge is None and self.objects != "elements":
            raise InputError(f"--packet: {cards} has no merge card, and so one node, which draws "
                             "all; leave it out, or end nodes with merge cards, as in 2x(PMMC)")
        if self.queue is not None and merge != DIRECT_MERGE:
            raise InputError(f"--queue: {cards} has no direct merge; leave it out, or take one, as "
                             "in PPPPDMMMM")

    def _check_regions(self) -> None:
        """``InputError`` for what only regions that are dealt out can be asked."""
        for name in ("slots", "balance", "balancer"):
            if self.regions is None and getattr(self, name) is not None:
                raise InputError(f"--{name}: is for regions that are dealt out; give --regions as "
                                 "well, as in --regions 8x8")
        if self.balance not in (None, *get_args(Policy)):
            raise InputError(f"balance: {self.balance!r} is none of {', '.join(get_args(Policy))}")
        if self.objects == "elements" and self.balance not in (None, "runs"):
            raise InputError(f"--balance: elements that pass objects on have a run of regions "
                             f"each, not {self.balance}; take runs, or leave it out")
        if (self.balance, self.balancer) == ("learnt", "hardware"):
            raise InputError("--balance: learnt is for a host; the hardware packs the last "
                             "picture's counts as they are: take --balance clocks, or --balancer "
                             "host")

    def policy(self, configuration: MachineConfiguration) -> Policy:
        """Of what the tables for that machine are made, which is as these options ask."""
        return self.balance or default_policy(configuration)

    def for_plan(self) -> dict[str, Any]:
        """What is asked of ``plan`` besides a display list, which has its own size.
        Raises ``InputError``."""
        settled = {name: value for name, value in self.machine().items()
                   if name not in ("width", "height")}
        return settled | {"max_error": self.max_error or 0,
                          "retain": bool(self.retain) and self.list_words is None}

    def looking(self) -> dict[str, Any]:
        """What is asked of ``make_display_list`` of how a mesh is looked at.  Raises
        ``InputError``."""
        asked: dict[str, Any] = {"background": self.background, "cull": bool(self.cull),
                                 "view": View(self.view, 1.0 if self.zoom is None else self.zoom)}
        if self.light is not None:
            asked["lighting"] = Lighting(direction=self.light)
        return asked


#: What is asked for by the name of a field of the configuration, and means it.
_FIELDS = [field.name for field in fields(MachineOptions)
           if field.name in {field.name for field in fields(MachineConfiguration)}
           and field.name not in ("shading", "setup")]


def load_scene(scene: str | Path | LoadedScene, options: MachineOptions,
               view: View | None = None) -> SceneDisplayList:
    """The display list at the size that was asked for, seen as asked, or as ``view`` says.  Raises
    ``InputError``."""
    settled = options.machine()
    width, height = settled.get("width"), settled.get("height")
    chosen = scene.scene if isinstance(scene, LoadedScene) else parse_scene(scene)
    if isinstance(chosen, DisplayListScene | HardCaseScene) and options.size is None:
        width = height = None  # a display list has its own size, whatever the preset's
    return make_display_list(scene, width=width, height=height,
                             shading="flat" if options.shading == "flat" else "gouraud",
                             **options.looking() | ({} if view is None else {"view": view}))


def machine_for_scene(scene: str | Path, options: MachineOptions
                      ) -> tuple[SceneDisplayList, MachineConfiguration]:
    """Load a scene and plan its machine.  Raises ``InputError`` for whatever cannot be used."""
    loaded = load_scene(scene, options)
    return loaded, plan(loaded.display_list, **options.for_plan()).configuration


def machine_without_scene(options: MachineOptions) -> MachineConfiguration:
    """The machine for any scene of that size: exact for every triangle on the screen, or as exact
    as asked for, unless the options or the preset give the fraction bits.  Raises ``InputError``.
    """
    if options.retain and options.list_words is None:
        raise InputError("--retain: without a scene nobody knows how many triangles its lists "
                         "hold; give --list-words, or a scene")
    if options.objects is not None and None in (options.mesh_triangles, options.meshes):
        raise InputError("--objects: without a scene nobody knows how many triangles its meshes "
                         "have; give --mesh-triangles and --meshes, or a scene")
    looking = options.looking()
    if looking != MachineOptions().looking():
        [name] = [name for name in ("view", "zoom", "background", "cull", "light")
                  if getattr(options, name) is not None][:1]
        raise InputError(f"--{name}: without a scene there is nothing to look at; give a scene")
    machine = MachineConfiguration(**DEFAULT_SIZE | options.machine())
    if not options.max_error:
        return machine
    return replace(machine, fraction_bits=on_screen_fraction_bits(
        machine.width, machine.height, machine.sub_bits, options.max_error))


def option_words(options: MachineOptions) -> list[str]:
    """The options as words of a command line, those that were asked for."""
    asked = {field.name: getattr(options, field.name) for field in fields(MachineOptions)}
    for name in ("size", "regions"):
        if asked[name] is not None:
            asked[name] = "x".join(map(str, asked[name]))
    for name in ("view", "light"):
        if asked[name] is not None:
            asked[name] = ",".join(f"{number:.17g}" for number in asked[name])
    if asked["background"] is not None:
        asked["background"] = f"#{bytes(asked['background']).hex()}"
    if asked["shading"] == "auto":
        asked["shading"] = None
    return [word for name, value in asked.items() if value is not None and value is not False
            for word in (f"--{name.replace('_', '-')}", *([] if value is True else [str(value)]))]


def resolution_warnings(configuration: MachineConfiguration) -> tuple[str, ...]:
    """A line where the memory cannot hold the highest resolution, and where some processing element
    has no part of it."""
    regions = 0 if configuration.regions is None else configuration.dealt_regions.count
    idle = configuration.processing_elements - regions
    if regions and idle > 0:
        return (f"{regions} regions for {configuration.processing_elements} processing elements: "
                f"{idle} have nothing to draw",)
    width, height, *_ = organisation_of(configuration).resolution
    if (width, height) == (configuration.width, configuration.height):
        return ()
    return (f"{configuration.words} words in each memory unit hold {width}x"
            f"{height} pixels, not {configuration.width}x{configuration.height}: the "
            "picture is coarser",)
